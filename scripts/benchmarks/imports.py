"""What ``import ravemj`` takes, with and without the first model, and what help takes."""

import functools
import statistics
from collections.abc import Callable

from benchmarks.measure import MODEL, Row, run_python

_PROCESSES = 11
_TIMED = """
import time
wall, processor = time.perf_counter(), time.process_time()
{code}
print(time.perf_counter() - wall, time.process_time() - processor)
"""


def rows() -> list[Row]:
    """Compare the import with that of the libraries it needs, each in new processes that take turns.

    The clocks run inside the processes, around the import alone, so that the start of Python does not count.
    """
    libraries = functools.partial(_seconds, "import mujoco, numpy, lxml.etree")
    ours = functools.partial(_seconds, "import ravemj")
    loaded = functools.partial(_seconds, f"import ravemj; ravemj.load({str(MODEL)!r})")
    scripts = functools.partial(_seconds, "import ravemj.compat.openravepy")
    helped = functools.partial(_seconds, "import ravemj.cli.parser; ravemj.cli.parser.make_parser().format_help()")
    found = _medians([libraries, ours, loaded, scripts, helped])
    (wall_floor, floor), (wall, processor), *others = found
    what, bare = "import ravemj", "import mujoco, numpy, lxml.etree"
    more = ("  and load the first model", "import of ravemj as openravepy", "what ravemj --help imports and does")
    limits = (None, None, 1.0)
    return [
        Row(f"{what} : {bare}; wall clock", "ms", wall, wall_floor, 1.3),
        Row(f"{what} : {bare}; processor time", "ms", processor, floor, 1.3),
        *(
            Row(f"{label} : {bare}; processor time", "ms", time, floor, limit)
            for label, (_, time), limit in zip(more, others, limits, strict=True)
        ),
    ]


def _medians(measurements: list[Callable[[], tuple[float, ...]]]) -> list[tuple[float, ...]]:
    """Return the medians of what measurements return, which take turns [ms]."""
    for measure in measurements:
        measure()  # compiles the modules, and brings the files into memory
    series = [[measure() for measure in measurements] for _ in range(_PROCESSES)]
    return [
        tuple(statistics.median(seconds) * 1e3 for seconds in zip(*one, strict=True))
        for one in zip(*series, strict=True)
    ]


def _seconds(code: str) -> tuple[float, ...]:
    """Return wall-clock and processor time of some code in a new process [s]."""
    return tuple(float(part) for part in run_python("-c", _TIMED.format(code=code)).split())
