"""Motions: joint values over time, and the files that hold them.

A motion file is a table. As ``.csv``, the first line names the columns, ``time`` in seconds and joints in radians
or metres, in any order; joints without a column keep their value. Empty lines and lines that start with ``#`` are
comments::

    # a swing
    time, Arm0, Arm1
    0.0,  0.0,  0.0
    1.0,  1.57, -0.5

As ``.npz``, it holds the arrays ``time`` of shape (N,) and ``values`` of shape (N, dof).
"""

import math
import os
import reprlib
from array import array
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.trajectories.interpolation import between

_TIME = "time"
_SAME_FRAME = 1e-6  # frames: a motion that ends this close to a frame ends on it


@dataclass(frozen=True, eq=False, init=False, slots=True)
class Motion:
    """Joint values at given times, with straight lines between them.

    Args:
        times: (N,) seconds, N >= 1, strictly increasing.
        values: (N, dof) joint values [rad or m].

    Attributes:
        times: The times, as a read-only copy.
        values: The joint values, as a read-only copy.

    Raises:
        ArgumentError: A shape does not fit, something is not a finite number, or the times do not increase.
    """

    times: Floats
    values: Floats

    def __init__(self, times: ArrayLike, values: ArrayLike) -> None:
        rows = _finite(values, "values", "(N, dof)", 2)
        seconds = _finite(times, "times", "(N,)", 1)
        if not 1 <= len(seconds) == len(rows):
            raise ArgumentError(f"expected one time for each row of values, found {len(seconds)} and {len(rows)} rows")
        if not math.isfinite(float(seconds[-1]) - float(seconds[0])):
            raise ArgumentError(f"the times from {seconds[0]} to {seconds[-1]} span more than a float can hold")
        stuck = np.flatnonzero(seconds[1:] <= seconds[:-1])
        if stuck.size:
            before, after = seconds[stuck[0] : stuck[0] + 2]
            raise ArgumentError(f"times must increase, found {after} s after {before} s")
        object.__setattr__(self, "times", seconds)
        object.__setattr__(self, "values", rows)

    @classmethod
    def line(cls, start: ArrayLike, goal: ArrayLike, duration: float = 1.0) -> "Motion":
        """Return the motion on the straight line in joint space, at constant speed, from time 0 on.

        Args:
            start: (dof,) joint values at time 0 [rad or m].
            goal: (dof,) joint values at the end.
            duration: Time that the motion takes [s], above 0.

        Raises:
            ArgumentError: The shapes differ, or a value or the duration makes no sense.
        """
        first, last = (_finite(end, name, "(dof,)", 1) for end, name in ((start, "start"), (goal, "goal")))
        if first.shape != last.shape:
            raise ArgumentError(f"start and goal must have equally many values, found {len(first)} and {len(last)}")
        return cls((0.0, _positive(duration, "duration")), (first, last))

    @property
    def duration(self) -> float:
        """Seconds from the first time to the last; 0 for a single row."""
        return float(self.times[-1]) - float(self.times[0])

    @property
    def dof(self) -> int:
        """Number of joint values in a row."""
        return self.values.shape[1]

    def sample(self, t: float) -> Floats:
        """Return the (dof,) joint values at time t [s]; before the start and after the end, those of the ends.

        Values between two rows never leave the range of these rows, so they keep joint limits that the rows keep.
        """
        if math.isnan(t):
            raise ArgumentError("expected a time in seconds, found nan")
        after = int(np.searchsorted(self.times, t, side="right"))
        if after in {0, len(self.times)}:
            return self.values[min(after, len(self.times) - 1)].copy()
        (t0, t1), (first, second) = self.times[after - 1 : after + 1], self.values[after - 1 : after + 1]
        return between((first, second), float((t - t0) / (t1 - t0)))

    def number_of_frames(self, fps: float) -> int:
        """Return how many frames ``frames(fps)`` yields.

        Frames lie 1/fps apart, from the start to the end of the motion. An end that is not on this raster gets a frame
        of its own, so there are ceil(duration * fps) + 1 frames; a motion of one row has one frame.
        """
        steps = self.duration * _positive(fps, "fps")
        if not math.isfinite(steps):
            raise ArgumentError(f"{self.duration} s at {fps} frames a second are too many frames")
        return max(1, math.ceil(steps - _SAME_FRAME)) + 1 if steps else 1

    def frames(self, fps: float) -> Iterator[Floats]:
        """Return an iterator over the (dof,) joint values of each frame of a video; it never holds them all.

        Frame k shows the time start + k/fps, and the last frame is exactly the end of the motion.

        Args:
            fps: Frames per second.
        """
        count = self.number_of_frames(fps)
        start = float(self.times[0])
        return (self.sample(start + k / fps) if k < count - 1 else self.values[-1].copy() for k in range(count))

    def rescaled(self, duration: float) -> "Motion":
        """Return the same path, from the same start time, in another duration [s].

        Raises:
            ArgumentError: The motion has one row only, or the duration is not above 0.
        """
        if not self.duration:
            raise ArgumentError("a motion of one row has no duration that could be rescaled")
        start = self.times[0]
        return Motion(start + (self.times - start) / self.duration * _positive(duration, "duration"), self.values)


def read_motion(path: str | os.PathLike[str], joint_names: Sequence[str], current: ArrayLike) -> Motion:
    """Return the motion of a ``.csv`` or ``.npz`` file; the module's text describes both.

    Args:
        path: The file.
        joint_names: Names of the dof joint values, in the order of the result's columns.
        current: (dof,) values that joints without a column keep [rad or m].

    Raises:
        SourceError: The file cannot be read as a motion; ``source`` has the line for ``.csv``.
        ArgumentError: ``current`` does not fit ``joint_names``.
    """
    rest = _finite(current, "current", f"({len(joint_names)},)", 1)
    if len(rest) != len(joint_names):
        raise ArgumentError(f"expected one current value for each of {len(joint_names)} joints, found {len(rest)}")
    file = os.fspath(path)
    suffix = Path(file).suffix.lower()
    if suffix not in {".csv", ".npz"}:
        raise SourceError(f"a motion is a .csv or a .npz file, not '{suffix}'", Source(file))
    with _problems_in(file):
        if suffix == ".npz":
            return _read_npz(file, len(joint_names))
        with open(file, encoding="utf-8-sig", errors="surrogateescape") as text:
            return _read_csv(file, text, joint_names, rest)


@contextmanager
def _problems_in(file: str) -> Generator[None]:
    """Turn what Python and numpy say about a file into ``SourceError``."""
    try:
        yield
    except SourceError:
        raise
    except ArgumentError as error:
        raise SourceError(error.message, Source(file)) from error
    except (OSError, ValueError) as error:  # ValueError: a path that holds a null byte
        reason = getattr(error, "strerror", None) or " ".join(str(error).split())
        raise SourceError(f"cannot read the file: {reason[:1].lower()}{reason[1:]}", Source(file)) from error


def _read_npz(file: str, dof: int) -> Motion:
    try:
        with open(file, "rb") as raw, np.load(raw, allow_pickle=False) as archive:
            arrays: dict[str, Floats] = {name: archive[name] for name in (_TIME, "values") if name in archive}
    except OSError:
        raise
    except Exception as error:  # zipfile, zlib and numpy have a dozen kinds for bytes that make no sense
        hint = "write it with numpy.savez(path, time=..., values=...)"
        raise SourceError("the file is not an intact .npz archive of number arrays", Source(file), hint) from error
    if len(arrays) < 2:
        missing = {_TIME, "values"}.difference(arrays).pop()
        raise SourceError(f"there is no array '{missing}'", Source(file), "a motion has 'time' and 'values'")
    motion = Motion(arrays[_TIME], arrays["values"])
    if motion.dof != dof:
        raise SourceError(f"expected values of shape (N, {dof}), found {motion.values.shape}", Source(file))
    return motion


def _read_csv(file: str, text: TextIO, joint_names: Sequence[str], rest: Floats) -> Motion:
    lines = _lines(file, text)
    line, header = next(lines, (0, [""]))
    source = Source(file, line)
    columns = _columns(header, joint_names, source)
    numbers = _numbers(file, lines, len(header), header.index(_TIME))
    if not numbers:
        raise SourceError("there are no rows under the names of the columns", source)
    table = np.frombuffer(numbers).reshape(-1, len(header))
    values = np.tile(rest, (len(table), 1))
    for column, dof in columns.items():
        values[:, dof] = table[:, column]
    return Motion(table[:, header.index(_TIME)], values)


def _lines(file: str, text: TextIO) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the cells of each line that holds some."""
    import csv  # noqa: PLC0415 - slow to import

    for number, line in enumerate(text, 1):
        content = line.strip()
        if not content or content.startswith("#"):
            continue
        try:
            content.encode()  # bytes that are not UTF-8 were read as surrogates, which cannot be encoded
            cells = next(csv.reader((content,), skipinitialspace=True))
        except (csv.Error, UnicodeEncodeError) as error:
            reason = error if isinstance(error, csv.Error) else "not UTF-8 text"
            raise SourceError(f"the line cannot be read: {reason}", Source(file, number)) from error
        yield number, [cell.strip() for cell in cells]


def _columns(header: list[str], joint_names: Sequence[str], source: Source) -> dict[int, int]:
    """Return the index of the joint value for each column but the time's."""
    dofs = {name: dof for dof, name in enumerate(joint_names)}
    columns: dict[int, int] = {}
    if _TIME not in header:
        hint = f"the first line names the columns, separated by commas: {_TIME},<joint>,…"
        raise SourceError(f"there is no column '{_TIME}'", source, hint)
    for column, name in enumerate(header):
        if name in header[:column]:
            raise SourceError(f"there are two columns {reprlib.repr(name)}", source)
        if name == _TIME:
            continue
        if name not in dofs:
            found = f"column {column + 1} is named {reprlib.repr(name)}, which is not a joint"
            raise SourceError(found, source, _did_you_mean(name, joint_names))
        columns[column] = dofs[name]
    return columns


def _did_you_mean(name: str, joint_names: Sequence[str]) -> str:
    import difflib  # noqa: PLC0415 - slow to import

    close = difflib.get_close_matches(name[:100], joint_names, 1)
    guess = f"did you mean '{close[0]}'? " if close else ""
    return f"{guess}the joints are {', '.join(joint_names) or 'none'}"


def _numbers(file: str, lines: Iterable[tuple[int, list[str]]], width: int, time: int) -> "array[float]":
    """Return all cells of the table in one array, row by row."""
    numbers = array("d")
    before = -math.inf
    for line, cells in lines:
        if len(cells) != width:
            raise SourceError(f"expected {width} cells as in the first line, found {len(cells)}", Source(file, line))
        row = [_number(cell, file, line) for cell in cells]
        if row[time] <= before:
            raise SourceError(f"times must increase, found {row[time]} s after {before} s", Source(file, line))
        before = row[time]
        numbers.extend(row)
    return numbers


def _number(cell: str, file: str, line: int) -> float:
    try:
        number = float(cell)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise SourceError(f"{reprlib.repr(cell)} is not a finite number", Source(file, line))
    return number


def _positive(number: float, name: str) -> float:
    if not (math.isfinite(number) and number > 0):
        raise ArgumentError(f"expected a {name} above 0, found {number}")
    return number


def _finite(numbers: ArrayLike, name: str, shape: str, ndim: int) -> Floats:
    """Return a checked, read-only copy."""
    try:
        found = np.asarray(numbers)
    except ValueError as error:
        raise ArgumentError(f"expected {name} of shape {shape}, found rows of different lengths") from error
    if found.dtype.kind not in "iuf" or found.ndim != ndim:
        raise ArgumentError(f"expected {name} as numbers of shape {shape}, found {found.dtype} of shape {found.shape}")
    with np.errstate(over="ignore"):
        checked = np.array(found, dtype=np.float64, order="C")
    if not np.isfinite(checked).all():
        raise ArgumentError(f"expected finite {name}, found {checked[~np.isfinite(checked)][0]}")
    checked.flags.writeable = False
    return checked
