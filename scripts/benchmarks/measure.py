"""Rows of the table, and how their numbers are taken."""

import gc
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
MODEL = ROOT / "models" / "env.xml"
CAMERA = ROOT / "models" / "tutorial-camera.json"

_LAUNCHER = (
    "import resource, subprocess, sys; done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL); "
    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(done.returncode)"
)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table.

    Attributes:
        what: What is measured, and what the floor is.
        unit: Unit of both numbers.
        measured: Ours.
        floor: That of the bare libraries; None: there is nothing to compare with.
        limit: What the ratio of the two may be; None: the row only informs.
        more_is_better: Whether the limit is the least ratio instead of the greatest.
        note: More about it.
    """

    what: str
    unit: str
    measured: float
    floor: float | None = None
    limit: float | None = None
    more_is_better: bool = False
    note: str = ""

    @property
    def ratio(self) -> float | None:
        """What is measured, in units of the floor."""
        return self.measured / self.floor if self.floor else None

    @property
    def is_over(self) -> bool:
        """Whether the limit is missed."""
        if self.ratio is None or self.limit is None:
            return False
        return self.ratio < self.limit if self.more_is_better else self.ratio > self.limit

    def cells(self) -> tuple[str, ...]:
        """Return the row as texts: what, measured, floor, ratio, limit, verdict, note."""
        sign = "≥" if self.more_is_better else "≤"
        return (
            self.what,
            f"{_digits(self.measured)} {self.unit}",
            "" if self.floor is None else f"{_digits(self.floor)} {self.unit}",
            "" if self.ratio is None else f"{self.ratio:.2f}",
            "" if self.limit is None else f"{sign} {self.limit:g}",
            "" if self.limit is None else "over" if self.is_over else "ok",
            self.note,
        )

    def as_json(self) -> dict[str, object]:
        """Return the row as what JSON can hold."""
        return {**asdict(self), "ratio": self.ratio, "over": self.is_over}


def take_turns(measurements: Sequence[Callable[[], float]], rounds: int, *, warm_up: bool = True) -> list[float]:
    """Take measurements in turn, A B C A B C …, and return the median of each.

    Whatever slows the machine for a while slows all of them, so that their ratios stay.

    Args:
        measurements: Each returns one number.
        rounds: How often each is taken.
        warm_up: Whether each is taken once before, which does not count.
    """
    if warm_up:
        for measure in measurements:
            measure()
    series = [[measure() for measure in measurements] for _ in range(rounds)]
    return [statistics.median(numbers) for numbers in zip(*series, strict=True)]


def microseconds(
    function: Callable[[], object], calls: int = 1, clock: Callable[[], float] = time.process_time
) -> Callable[[], float]:
    """Return a measurement of the mean time of a call [µs]: of the processor, which other programs do not lengthen.

    The garbage collector rests meanwhile, as in ``timeit``, and what the last call returns is freed off the clock.

    Args:
        function: What is called.
        calls: How many calls one measurement consists of; many for what is fast.
        clock: Returns the time [s]; ``time.perf_counter`` where several processors work at once.
    """
    repetitions = range(calls)

    def measure() -> float:
        result: object = None
        gc.disable()
        try:
            begin = clock()
            for _ in repetitions:
                result = function()
            end = clock()
        finally:
            gc.enable()
        del result  # off the clock
        return (end - begin) / calls * 1e6

    return measure


def run_python(*arguments: str) -> str:
    """Run this Python in a new process with the ravemj of this tree, and return what it prints."""
    done = subprocess.run(
        [sys.executable, *arguments], env=_environment(), stdout=subprocess.PIPE, text=True, check=True
    )
    return done.stdout


def peak_memory(*arguments: str) -> float:
    """Run this Python in a new process and return the most memory that it held [MB].

    Linux counts what a process held before it became another program, so a small process starts it, not this one.
    """
    peak = int(run_python("-I", "-S", "-c", _LAUNCHER, sys.executable, *arguments))
    return peak / (1e6 if sys.platform == "darwin" else 1e6 / 1024)  # bytes there, kilobytes elsewhere


def _environment() -> dict[str, str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # compiling is not what is measured
    return environment


def _digits(number: float) -> str:
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"
