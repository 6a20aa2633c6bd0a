"""What ``import ravemj`` takes."""

import functools
import statistics

from benchmarks.measure import Row, run_python

_PROCESSES = 21
_TIMED = """
import time
wall, processor = time.perf_counter(), time.process_time()
import {modules}
print(time.perf_counter() - wall, time.process_time() - processor)
"""


def rows() -> list[Row]:
    """Compare the import with that of the libraries it needs, each in new processes that take turns.

    The clocks run inside the processes, around the import alone, so that the start of Python does not count.
    """
    libraries = functools.partial(_seconds, "mujoco, numpy, lxml.etree")
    ours = functools.partial(_seconds, "ravemj")
    for measure in (libraries, ours):
        measure()  # compiles the modules, and brings the files into memory
    series = [(*ours(), *libraries()) for _ in range(_PROCESSES)]
    wall, processor, wall_floor, processor_floor = (
        statistics.median(seconds) * 1e3 for seconds in zip(*series, strict=True)
    )
    what = "import ravemj : import mujoco, numpy, lxml.etree"
    return [
        Row(f"{what}; wall clock", "ms", wall, wall_floor, 1.3),
        Row(f"{what}; processor time", "ms", processor, processor_floor, 1.3),
    ]


def _seconds(modules: str) -> tuple[float, ...]:
    """Return wall-clock and processor time of an import in a new process [s]."""
    return tuple(float(part) for part in run_python("-c", _TIMED.format(modules=modules)).split())
