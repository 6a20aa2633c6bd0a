"""Reading of motion files.

A motion file is a table. As ``.csv``, the first line names the columns, ``time`` in seconds and joints in radians
or metres, in any order; joints without a column keep their value. Empty lines and lines that start with ``#`` are
comments::

    # a swing
    time, Arm0, Arm1
    0.0,  0.0,  0.0
    1.0,  1.57, -0.5

As ``.npz``, it holds the arrays ``time`` of shape (N,) and ``values`` of shape (N, columns), and may hold the names of
the columns as ``joints``; without these, there is a column for each DOF.
"""

import difflib
import math
import os
import reprlib
from array import array
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.trajectories.motion import Motion

MOTION_SUFFIXES = (".csv", ".npz")
"""The suffixes of motion files."""

_TIME, _VALUES, _JOINTS = "time", "values", "joints"


class MotionTable(NamedTuple):
    """Content of a motion file.

    Attributes:
        source: The file and, in ``.csv``, the line number of the column names.
        names: Column names by their number in the file, from 1; None if the file has none.
        motion: The columns over time.
    """

    source: Source
    names: dict[int, str] | None
    motion: Motion

    def for_joints(self, joint_names: Sequence[str], current: Floats) -> Motion:
        """Return the motion of some joints; arguments as for ``read_motion``.

        Raises:
            SourceError: a column belongs to none of these joints, or unnamed columns are not as many as the joints.
        """
        if self.names is None:
            if self.motion.dof != len(joint_names):
                mistake = f"expected values of shape (N, {len(joint_names)}), found {self.motion.values.shape}"
                raise SourceError(mistake, self.source)
            return self.motion
        dofs = {name: dof for dof, name in enumerate(joint_names)}
        values = np.tile(current, (len(self.motion.times), 1))
        for (number, name), column in zip(self.names.items(), self.motion.values.T, strict=True):
            if name not in dofs:
                mistake = f"column {number} is named {reprlib.repr(name)}, which is not a joint"
                raise SourceError(mistake, self.source, did_you_mean(name, joint_names))
            values[:, dofs[name]] = column
        return Motion(self.motion.times, values)


def read_motion(path: str | os.PathLike[str], joint_names: Sequence[str], current: ArrayLike) -> Motion:
    """Return the motion of a ``.csv`` or ``.npz`` file; see the module's docstring for both formats.

    Args:
        path: The file.
        joint_names: Names of the dof joint values, in the order of the result's columns.
        current: (dof,) values of joints without a column [rad or m].

    Raises:
        SourceError: The file cannot be read as a motion; its ``source`` has the line number in ``.csv``.
        ArgumentError: ``current`` does not fit ``joint_names``.
    """
    rest = checked_vector(current, len(joint_names), "current")
    return read_table(path).for_joints(joint_names, rest)


def read_table(path: str | os.PathLike[str]) -> MotionTable:
    """Return the content of a ``.csv`` or ``.npz`` file.

    Raises:
        SourceError: The file cannot be read as a motion; its ``source`` has the line number in ``.csv``.
    """
    file = os.fspath(path)
    suffix = Path(file).suffix.lower()
    if suffix not in MOTION_SUFFIXES:
        raise SourceError(f"a motion is a .csv or a .npz file, not '{suffix}'", Source(file))
    with problems_in(file):
        if suffix == ".npz":
            return _read_npz(file)
        return read_csv(file)


@contextmanager
def problems_in(file: str) -> Generator[None]:
    """Context manager that converts errors of Python, numpy and ravemj about a file to ``SourceError``."""
    try:
        yield
    except SourceError:
        raise
    except ArgumentError as error:
        raise SourceError(error.message, Source(file)) from error
    except (OSError, ValueError) as error:  # ValueError: a path with a null byte
        reason = getattr(error, "strerror", None) or " ".join(str(error).split())
        raise SourceError(f"cannot read the file: {reason[:1].lower()}{reason[1:]}", Source(file)) from error


def _read_npz(file: str) -> MotionTable:
    try:
        with open(file, "rb") as raw, np.load(raw, allow_pickle=False) as archive:
            arrays: dict[str, Any] = {name: archive[name] for name in (_TIME, _VALUES, _JOINTS) if name in archive}
    except OSError:
        raise
    except Exception as error:  # zipfile, zlib and numpy raise a dozen types for invalid bytes
        hint = "write it with numpy.savez(path, time=..., values=...)"
        raise SourceError("the file is not an intact .npz archive of arrays", Source(file), hint) from error
    for name in (_TIME, _VALUES):
        if name not in arrays:
            raise SourceError(f"there is no array '{name}'", Source(file), "a motion has 'time' and 'values'")
    motion = Motion(arrays[_TIME], arrays[_VALUES])
    names = arrays.get(_JOINTS)
    if names is None:
        return MotionTable(Source(file), None, motion)
    if names.dtype.kind != "U" or names.shape != (motion.dof,) or len(set(names.tolist())) < motion.dof:
        mistake = f"expected '{_JOINTS}' as {motion.dof} different names, found {names.dtype} of shape {names.shape}"
        raise SourceError(mistake, Source(file))
    return MotionTable(Source(file), {number: str(name) for number, name in enumerate(names, 1)}, motion)


def read_csv(file: str, time_name: str = _TIME) -> MotionTable:
    """Parse a table of numbers; ``time_name`` is the name of the time column [s]."""
    with open(file, encoding="utf-8-sig", errors="surrogateescape") as text:
        lines = _lines(file, text)
        line, header = next(lines, (0, [""]))
        source = Source(file, line)
        _check_header(header, source, time_name)
        time = header.index(time_name)
        numbers = _numbers(file, lines, len(header), time)
    if not numbers:
        raise SourceError("there are no rows under the names of the columns", source)
    table: Floats = np.frombuffer(numbers).reshape(-1, len(header))
    names = {number: name for number, name in enumerate(header, 1) if name != time_name}
    return MotionTable(source, names, Motion(table[:, time], np.delete(table, time, axis=1)))


def _lines(file: str, text: TextIO) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and cells of each line that is neither empty nor a comment."""
    import csv  # noqa: PLC0415 - slow to import

    for number, line in enumerate(text, 1):
        content = line.strip()
        if not content or content.startswith("#"):
            continue
        try:
            content.encode()  # invalid UTF-8 was read as surrogates, which cannot be encoded
            cells = next(csv.reader((content,), skipinitialspace=True))
        except (csv.Error, UnicodeEncodeError) as error:
            reason = error if isinstance(error, csv.Error) else "not UTF-8 text"
            raise SourceError(f"the line cannot be read: {reason}", Source(file, number)) from error
        yield number, [cell.strip() for cell in cells]


def _check_header(header: list[str], source: Source, time_name: str) -> None:
    if time_name not in header:
        hint = f"the first line names the columns, separated by commas: {time_name},<joint>,…"
        raise SourceError(f"there is no column '{time_name}'", source, hint)
    for column, name in enumerate(header):
        if not name:
            raise SourceError(f"column {column + 1} has no name", source)
        if name in header[:column]:
            raise SourceError(f"there are two columns {reprlib.repr(name)}", source)


def did_you_mean(name: str, joint_names: Sequence[str]) -> str:
    """Return a hint for an unknown joint: the most similar name, and all names."""
    close = difflib.get_close_matches(name[:100], joint_names, 1)
    guess = f"did you mean '{close[0]}'? " if close else ""
    return f"{guess}the joints are {', '.join(joint_names) or 'none'}"


def _numbers(file: str, lines: Iterable[tuple[int, list[str]]], width: int, time: int) -> "array[float]":
    """Return all cells in one array, row by row. Check that all rows have ``width`` cells, and that times increase."""
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
