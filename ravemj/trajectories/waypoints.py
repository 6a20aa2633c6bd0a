"""Waypoints: configurations over time."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.geometry_functions.rotations import InterpolateQuatSlerp
from ravemj.trajectories.conversion import FindBody, converted, nobody
from ravemj.trajectories.extraction import time_column
from ravemj.trajectories.groups import (
    DELTATIME,
    IK,
    INTERPOLATIONS,
    JOINTS,
    Group,
    derived_interpolation,
    ik_type,
    joint_indices,
)
from ravemj.trajectories.interpolation import (
    DERIVATIVES,
    HELD,
    ROUNDING,
    Ends,
    between,
    curve,
    differentiated,
    held,
    value,
)
from ravemj.trajectories.layout import copied, count, equal, find_shifted

_ORDER = (
    DELTATIME,
    *(f"{part}_{rate}" for rate in ("snaps", "jerks", "accelerations", "velocities") for part in ("joint", "affine")),
    *("joint_values", "affine_transform", "joint_torques"),
)
"""Order of group kinds in trajectories, as in OpenRAVE; other kinds come last."""


class Waypoints:
    """Configurations in the order of time, with interpolation.

    Attributes:
        groups: The layout of a configuration.
        data: One configuration per row.
    """

    def __init__(self, groups: Sequence[Group], data: Floats | None = None) -> None:
        self.groups = sorted(copied(groups), key=lambda group: _ORDER.index(group.kind) if group.kind in _ORDER else 99)
        self.data = np.empty((0, count(groups))) if data is None else data
        self._time_column = time_column(groups)
        self._times: Floats | None = None

    def __len__(self) -> int:
        return len(self.data)

    def insert(
        self, index: int, numbers: Floats, groups: Sequence[Group], *, overwrite: bool, find_body: FindBody
    ) -> None:
        """Insert configurations, or overwrite existing ones.

        Args:
            index: The waypoint before which they are inserted.
            numbers: The configurations, concatenated.
            groups: Their layout. Overwritten waypoints keep the values that it lacks. In new waypoints, missing joints
                of a group get their current values, and missing groups zeros.
            overwrite: Whether to overwrite waypoints; data beyond the last one is appended.
            find_body: Finds the bodies of the groups.

        Raises:
            ArgumentError: the data does not fill whole configurations, or the index is out of range.
        """
        if not numbers.size:
            return
        width = count(groups)
        if not width or numbers.size % width:
            raise ArgumentError(f"data: has {numbers.size} numbers, and should have a multiple of {width}")
        if not 0 <= index <= len(self):
            raise ArgumentError(f"index: is {index}, and should be from 0 to {len(self)}", ErrorCode.Assert)
        rows = numbers.reshape(-1, width)
        end = min(len(self), index + len(rows)) if overwrite else index
        old, fresh = rows[: end - index], rows[end - index :]
        blank = np.zeros((len(fresh), self.data.shape[1]))
        if equal(groups, self.groups):
            replaced, added = old, fresh
        else:
            replaced = converted(groups, old, self.groups, self.data[index:end], None)
            added = converted(groups, fresh, self.groups, blank, find_body, nobody)
        self._change(np.vstack([self.data[:index], replaced, added, self.data[end:]]))

    def remove(self, start: int, end: int) -> None:
        """Remove the waypoints from ``start`` to before ``end``."""
        self._check_range(start, end)
        self._change(np.delete(self.data, slice(start, end), axis=0))

    def _change(self, data: Floats) -> None:
        self.data, self._times = data, None

    def _check_range(self, start: int, end: int) -> None:
        if not 0 <= start <= end <= len(self):
            message = f"waypoints {start} to {end}: should be in order, and from 0 to {len(self)}"
            raise ArgumentError(message, ErrorCode.Assert)

    def rows(self, start: int, end: int) -> Floats:
        """Return a copy of the waypoints from ``start`` to before ``end``."""
        self._check_range(start, end)
        return self.data[start:end].copy()

    def as_layout(self, rows: Floats, groups: Sequence[Group], find_body: FindBody) -> Floats:
        """Return configurations in another layout; the bodies' present state supplies missing values."""
        return converted(self.groups, rows, groups, np.zeros((len(rows), count(groups))), find_body)

    def times(self) -> Floats:
        """Return the times of the waypoints [s]; empty if the layout has no time.

        Raises:
            RavemjError: the times decrease.
        """
        if self._times is None:
            if self._time_column is None:
                return np.empty(0)
            steps = self.data[:, self._time_column]
            backward = np.flatnonzero(steps[1:] < 0)
            if len(backward):
                message = f"deltatime is {steps[backward[0] + 1]:.6g} at waypoint {backward[0] + 1}, and should be >= 0"
                raise RavemjError(message, ErrorCode.InvalidState)
            self._times = np.cumsum(steps)
        return self._times

    def duration(self) -> float:
        """Return the time of the last waypoint [s]; 0 if the layout has no time."""
        times = self.times()
        return float(times[-1]) if len(times) else 0.0

    def first_after(self, time: float) -> int:
        """Return the index of the first waypoint at a time or later; if there is none, the number of waypoints."""
        self._timed()
        if math.isnan(time):
            raise ArgumentError("time: is nan, and should be a number", ErrorCode.Assert)
        return len(self) if time >= self.duration() else int(np.searchsorted(self.times(), time))

    def sample(self, time: float, *, restamped: bool, find_body: FindBody = nobody) -> Floats:
        """Return the configuration at a time; after the end, the last one.

        Args:
            time: Time [s] since the start.
            restamped: Whether to set ``deltatime`` to the time since the previous waypoint; otherwise it is that of the
                next waypoint.
            find_body: Finds the bodies of the groups, whose circular joints take the shorter arc.

        Raises:
            ArgumentError: the layout has no time, there are no waypoints, or derivatives for the interpolation are
                missing.
        """
        column = self._timed()
        if not time >= -ROUNDING:
            raise ArgumentError(f"time: is {time}, and should not be negative", ErrorCode.Assert)
        if not len(self):
            raise ArgumentError("a trajectory needs a waypoint to sample from")
        if time >= self.duration():
            return self.data[-1].copy()
        times = self.times()
        index = int(np.searchsorted(times, time))
        elapsed = time
        if index == 0:
            configuration = self.data[0].copy()
        else:
            duration = float(self.data[index, column])
            elapsed = min(max(0.0, time - float(times[index - 1])), duration)
            configuration = self._between(index, elapsed, duration, find_body)
        if restamped:
            configuration[column] = elapsed
        return configuration

    def _timed(self) -> int:
        if self._time_column is None:
            raise ArgumentError("the trajectory has no group 'deltatime', and so no time", ErrorCode.Assert)
        return self._time_column

    def _between(self, index: int, time: float, duration: float, find_body: FindBody) -> Floats:
        configuration = np.zeros(self.data.shape[1])
        for group in self.groups:
            if group.interpolation in HELD:
                values = held(group.interpolation, time / duration, self._ends(group, index))
            elif group.kind == IK[0] and group.interpolation == "linear":
                values = _goal_between(ik_type(group), self._ends(group, index), time / duration)
            else:
                way = self._curve(group, group.interpolation, index, duration, find_body)
                values = value(way, time / duration)
            configuration[group.columns] = values
        return configuration

    def pieces(self, groups: Sequence[Group], find_body: FindBody = nobody) -> Iterator[tuple[float, float, Floats]]:
        """Yield the interpolating polynomials of the given groups between consecutive waypoints.

        Yields:
            Start and end [s], and the coefficients of powers of the fraction of the segment, lowest first, shape
            (k, n).

        Raises:
            ArgumentError: the layout has no time, a value is discontinuous, or derivatives for the interpolation are
                missing.
        """
        column, times = self._timed(), self.times()
        for index in range(1, len(self)):
            duration = float(self.data[index, column])
            ways = [self._way(group, index, duration, find_body) for group in groups]
            degree = max(len(way) for way in ways)
            rows = [np.vstack([way, np.zeros((degree - len(way), way.shape[1]))]) for way in ways]
            yield float(times[index - 1]), float(times[index]), np.hstack(rows)

    def _way(self, group: Group, index: int, duration: float, find_body: FindBody) -> Floats:
        first, second = self._ends(group, index)
        if duration > 0 and group.interpolation not in HELD:
            return self._curve(group, group.interpolation, index, duration, find_body)
        if (first != second).any():
            raise ArgumentError(f"group '{group.name}': jumps at {self.times()[index]:.6g} s")
        return first[None]

    def _ends(self, group: Group, index: int) -> Ends:
        return self.data[index - 1, group.columns], self.data[index, group.columns]

    def _unwound(self, group: Group, ends: Ends, find_body: FindBody) -> Ends:
        """Return the values at both ends of a segment; full turns of circular joints are removed from the second."""
        first, second = ends
        body = find_body(group.body or "") if group.kind == JOINTS[0] else None
        if body is None:
            return ends
        axes = body.scene.dof_axes
        circular = np.array([dof < len(axes) and axes[dof].circular for dof in joint_indices(group)])
        turns = np.round((second - first) / (2 * np.pi))
        return first, np.where(circular, second - 2 * np.pi * turns, second)

    def _curve(self, group: Group, interpolation: str, index: int, duration: float, find_body: FindBody) -> Floats:
        """Return the polynomial of a group in the segment before waypoint ``index``.

        If derivatives needed by the interpolation are missing, differentiate the polynomial of the group's integral, as
        of positions for velocities.
        """
        if group.kind == IK[0]:
            what = f"'{interpolation}' interpolation of goals of inverse kinematics"
            raise UnsupportedError(f"sampling of '{group.name}'", what)
        if interpolation not in DERIVATIVES:
            raise ArgumentError(f"group '{group.name}': there is no interpolation '{interpolation}'")
        derivatives = [self._ends(derivative, index) for derivative in self._derivatives(group, interpolation)]
        if len(derivatives) >= DERIVATIVES[interpolation]:
            ends = self._ends(group, index)
            if interpolation not in {"linear", "quadratic"}:  # these follow their velocities, or the longer arc
                ends = self._unwound(group, ends, find_body)
            return curve(interpolation, ends, derivatives, duration)
        integral = find_shifted(self.groups, group.name, -1, exact=True)
        if integral is None or integral.dof != group.dof or interpolation == INTERPOLATIONS[-1]:
            needed = DERIVATIVES[interpolation]
            raise ArgumentError(f"group '{group.name}': {interpolation} interpolation needs {needed} derivatives of it")
        higher = INTERPOLATIONS[INTERPOLATIONS.index(interpolation) + 1]
        return differentiated(self._curve(integral, higher, index, duration, find_body), duration)

    def _derivatives(self, group: Group, interpolation: str) -> list[Group]:
        """Return the groups with the successive derivatives of ``group``, while size and interpolation match."""
        derivatives: list[Group] = []
        while interpolation != INTERPOLATIONS[0]:
            derivative = find_shifted(self.groups, group.name, len(derivatives) + 1, exact=True)
            interpolation = derived_interpolation(interpolation, 1)
            if derivative is None or derivative.dof != group.dof or derivative.interpolation != interpolation:
                break
            derivatives.append(derivative)
        return derivatives


def _goal_between(kind: int, ends: Ends, part: float) -> Floats:
    """Interpolate between two IK goals; rotations take the shorter arc."""
    values = between(ends, part)
    if kind in {IkParameterizationType.Transform6D, IkParameterizationType.Rotation3D}:
        values[:4] = InterpolateQuatSlerp(ends[0][:4], ends[1][:4], part)
    return values
