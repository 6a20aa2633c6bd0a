"""Files of ``JointTrajectory``: ROS's message as YAML or JSON, and tables with units.

The YAML is that of ``ros2 topic echo`` and ``ros2 topic pub``; the form of ROS 1 is read, too. A table, ``.ros2.csv``,
has a column ``time [s]``, and for each joint ``NAME position [rad]`` (or ``[m]``), ``NAME velocity [rad/s]`` and ``NAME
acceleration [rad/s^2]``, the latter two for all joints or for none.
"""

import json
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from ravemj.core.output import check_file, new_file
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.formats.limits import json_bytes
from ravemj.trajectories.joint_trajectory import ANGLE_OR_LENGTH, JointTrajectory
from ravemj.trajectories.motion_reading import problems_in, read_csv
from ravemj.trajectories.motion_writing import comments, csv_table

JOINT_TRAJECTORY_SUFFIXES = (".yaml", ".yml", ".json", ".ros2.csv")
"""Suffixes of files of a ``JointTrajectory``."""

_ORDERS = {"positions": ("position", ""), "velocities": ("velocity", "/s"), "accelerations": ("acceleration", "/s^2")}
"""Word in column names, and unit, of each field of a trajectory point in a table."""

_NANOSECONDS = 10**9
LARGEST_NUMBER = 1e300
"""Largest magnitude of a number in a file, well below the overflow of floats."""

_EXPECTED = "a trajectory_msgs/JointTrajectory has joint_names, and points with positions and time_from_start"
_UNIT = rf"(rad|m|{ANGLE_OR_LENGTH})"
_COLUMN = re.compile(rf"(.+) (?:(position) \[{_UNIT}\]|(velocity) \[{_UNIT}/s\]|(acceleration) \[{_UNIT}/s\^2\])")
_TIME = "time [s]"


def is_joint_trajectory(path: str | os.PathLike[str]) -> bool:
    """Return whether a file name has a suffix of ``JointTrajectory`` files."""
    return os.fspath(path).lower().endswith(JOINT_TRAJECTORY_SUFFIXES)


def check_joint_trajectory_file(path: str | os.PathLike[str]) -> None:
    """Check that a ``JointTrajectory`` can be written to a path; nothing is written.

    Raises:
        ArgumentError: The suffix is unknown, or the package of YAML is missing.
        OutputError: The folder around it is missing or cannot be written, or the path is not a file.
    """
    if not is_joint_trajectory(path):
        known = ", ".join(JOINT_TRAJECTORY_SUFFIXES)
        raise ArgumentError(f"cannot write {os.fspath(path)}: a JointTrajectory is a file {known}")
    if _is_yaml(path):
        _yaml()
    check_file(path)


def write_joint_trajectory(
    path: str | os.PathLike[str], trajectory: JointTrajectory, notes: Sequence[str] = ()
) -> Path:
    """Write a motion for a robot controller; the suffix selects the format.

    Args:
        path: The file: ``.yaml`` or ``.json`` for ROS's message ``trajectory_msgs/JointTrajectory``, ``.ros2.csv`` for
            a table with units.
        trajectory: The motion. Times are rounded to nanoseconds in messages.
        notes: Lines written as comments at the end; JSON has none.

    Returns:
        The given path.

    Raises:
        ArgumentError: The suffix is unknown, the package of YAML is missing, or two times are the same nanosecond.
        OutputError: The file cannot be written.

    Example:
        >>> ravemj.write_joint_trajectory("motion.json", robot.to_joint_trajectory(trajectory))
        PosixPath('motion.json')
    """
    check_joint_trajectory_file(path)
    if os.fspath(path).lower().endswith(".csv"):
        text = _to_table(trajectory)
    elif _is_yaml(path):
        dumper = getattr(_yaml(), "CSafeDumper", _yaml().SafeDumper)
        text = _yaml().dump(message_of(trajectory), Dumper=dumper, sort_keys=False, default_flow_style=None, width=1e9)
    else:
        text, notes = json.dumps(message_of(trajectory)) + "\n", ()
    with new_file(path) as temporary:
        temporary.write_text(text + comments(notes), encoding="utf-8")
    return Path(path)


def read_joint_trajectory(path: str | os.PathLike[str]) -> JointTrajectory:
    """Return the motion in a file; ``write_joint_trajectory`` describes the formats.

    Args:
        path: The file, ``.yaml``, ``.json`` or ``.ros2.csv``.

    Raises:
        SourceError: The file cannot be read, or is not a joint trajectory.
        ArgumentError: The package of YAML is missing.
    """
    file = os.fspath(path)
    with problems_in(file):
        if file.lower().endswith(".csv"):
            return _from_table(file)
        return _from_message(load_structured(file), Source(file))


def load_structured(file: str) -> object:
    """Parse a file of JSON, or of YAML with a single document.

    Raises:
        SourceError: It is not JSON or YAML, or has several documents.
    """
    text = json_bytes(file)
    try:
        if not _is_yaml(file):
            return json.loads(text)
        loader = getattr(_yaml(), "CSafeLoader", _yaml().SafeLoader)
        documents = [document for document in _yaml().load_all(text, Loader=loader) if document is not None]
    except (RecursionError, ValueError, _yaml_error(file)) as error:
        mark = getattr(error, "problem_mark", None)
        line = getattr(error, "lineno", 0) if mark is None else mark.line + 1
        reason = getattr(error, "problem", None) or getattr(error, "msg", None) or str(error)
        kind = "YAML" if _is_yaml(file) else "JSON"
        raise SourceError(f"not {kind}: {reason}", Source(file, line)) from None
    if len(documents) != 1:
        raise SourceError(f"found {len(documents)} documents, expected one", Source(file), _EXPECTED)
    return documents[0]


def _is_yaml(path: str | os.PathLike[str]) -> bool:
    return os.fspath(path).lower().endswith((".yaml", ".yml"))


def _yaml() -> Any:  # noqa: ANN401 - a module
    try:
        import yaml  # noqa: PLC0415 - optional
    except ImportError:
        raise ArgumentError("YAML needs PyYAML: pip install 'ravemj[yaml]'; JSON needs nothing") from None
    return yaml


def _yaml_error(file: str) -> type[Exception]:
    return _yaml().YAMLError if _is_yaml(file) else ValueError


def message_of(trajectory: JointTrajectory) -> dict[str, object]:
    """Return a motion as ROS's message ``trajectory_msgs/JointTrajectory``, in the form of rosbridge.

    Raises:
        ArgumentError: Two times are the same nanosecond.
    """
    stamps = np.round(trajectory.times * _NANOSECONDS).astype(np.int64)
    if (np.diff(stamps) <= 0).any():
        raise ArgumentError(f"two points at {trajectory.times[int(np.diff(stamps).argmin())]:g} s are one nanosecond")
    points: list[dict[str, object]] = []
    for row, stamp in enumerate(stamps.tolist()):
        fields = {name: getattr(trajectory, name) for name in _ORDERS}
        point: dict[str, object] = {
            name: [] if array is None else array[row].tolist() for name, array in fields.items()
        }
        seconds, nanoseconds = divmod(stamp, _NANOSECONDS)
        points.append({**point, "effort": [], "time_from_start": {"sec": seconds, "nanosec": nanoseconds}})
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    return {"header": header, "joint_names": list(trajectory.joint_names), "points": points}


def fields_of(content: object) -> dict[str, object]:
    """Return the fields of a JSON or YAML object; empty for other values."""
    return cast("dict[str, object]", content) if isinstance(content, dict) else {}


def items_of(content: object) -> list[object]:
    """Return the items of a JSON or YAML list; empty for other values."""
    return cast("list[object]", content) if isinstance(content, list) else []


def _from_message(content: object, source: Source) -> JointTrajectory:
    message = fields_of(content)
    names, points = items_of(message.get("joint_names")), items_of(message.get("points"))
    if not (names and points):
        fields = ", ".join(map(str, message)) or type(content).__name__
        raise SourceError(f"found {fields:.60}, expected joint_names and points", source, _EXPECTED)
    if not all(isinstance(name, str) for name in names):
        raise SourceError("joint_names: expected texts", source, _EXPECTED)
    rows = [_MessagePoint(number, point, len(names), source) for number, point in enumerate(points)]
    positions, *rates = (_same_for_all([point.values(name) for point in rows], name, source) for name in _ORDERS)
    if positions is None:
        raise SourceError("the points have no positions", source, _EXPECTED)
    return JointTrajectory(list(map(str, names)), [point.time() for point in rows], positions, rates[0], rates[1])


class _MessagePoint:
    """Point of a trajectory message; its errors name the point."""

    def __init__(self, number: int, content: object, count: int, source: Source) -> None:
        self._place, self._count, self._source = f"points[{number}]", count, source
        self._fields = fields_of(content)
        if not self._fields:
            raise self._error("", content, "an object")

    def _error(self, field: str, given: object, expected: str) -> SourceError:
        hint = "ros2 topic echo --full-length prints all" if given == "..." else _EXPECTED
        return SourceError(f"{self._place}{field}: found {given!r:.40}, expected {expected}", self._source, hint)

    def values(self, name: str) -> list[float]:
        given = self._fields.get(name, [])
        numbers = items_of(given)
        if len(numbers) != self._count and given not in ([], None):
            raise self._error(f".{name}", given, f"{self._count} numbers, one for each joint")
        return [self._number(f".{name}", number) for number in numbers]

    def _number(self, field: str, number: object) -> float:
        if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) < LARGEST_NUMBER:
            raise self._error(field, number, "a finite number")
        return float(number)

    def time(self) -> float:
        """Return ``time_from_start`` [s], from the field names of ROS 2 or ROS 1."""
        stamp = self._fields.get("time_from_start")
        parts = fields_of(stamp)
        for names in (("sec", "nanosec"), ("secs", "nsecs")):
            if set(names) == parts.keys():
                seconds, nanoseconds = (self._number(f".time_from_start.{name}", parts[name]) for name in names)
                return seconds + nanoseconds / _NANOSECONDS
        raise self._error(".time_from_start", stamp, "sec and nanosec, or secs and nsecs")


def _same_for_all(rows: list[list[float]], name: str, source: Source) -> list[list[float]] | None:
    """Return a field's values at all points; None if no point has the field. Raise an error if only some have it."""
    empty = [number for number, row in enumerate(rows) if not row]
    if len(empty) == len(rows):
        return None
    if empty:
        raise SourceError(f"points[{empty[0]}] has no {name}, and others have", source, _EXPECTED)
    return rows


def _to_table(trajectory: JointTrajectory) -> str:
    header, columns = [_TIME], [trajectory.times[:, None]]
    for field, (word, per_time) in _ORDERS.items():
        rows: Floats | None = getattr(trajectory, field)
        if rows is not None:
            named = zip(trajectory.joint_names, trajectory.units, strict=True)
            header += [f"{name} {word} [{unit}{per_time}]" for name, unit in named]
            columns.append(rows)
    return csv_table(header, np.hstack(columns))


def _from_table(file: str) -> JointTrajectory:
    table = read_csv(file, _TIME)
    names, units = list[str](), dict[str, str]()
    columns_by_field: dict[str, dict[str, Floats]] = {field: {} for field in _ORDERS}
    for (number, title), column in zip((table.names or {}).items(), table.motion.values.T, strict=True):
        match = _COLUMN.fullmatch(title)
        if match is None:
            hint = "columns are NAME position [rad] or [m], NAME velocity [rad/s], NAME acceleration [rad/s^2]"
            raise SourceError(f"column {number} is named {title!r:.60}", table.source, hint)
        name, word, unit = (group for group in match.groups() if group is not None)
        field = next(field for field, (column_word, _) in _ORDERS.items() if column_word == word)
        names += [name] if name not in names else []
        units[name], columns_by_field[field][name] = unit, column
    for field, columns in columns_by_field.items():
        lacking = [name for name in names if name not in columns]
        if lacking and (columns or field == "positions"):
            raise SourceError(f"'{lacking[0]}' has no column of its {_ORDERS[field][0]}", table.source)
    rows = [
        np.column_stack([columns[name] for name in names]) if columns else None for columns in columns_by_field.values()
    ]
    assert rows[0] is not None, "no position would be lacking"
    return JointTrajectory(names, table.motion.times, rows[0], rows[1], rows[2], [units[name] for name in names])
