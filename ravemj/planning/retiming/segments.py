"""Timing of paths segment by segment."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.space import Coordinates

ENOUGH = 1e-9
"""Rounding tolerance [s] of given durations that are shorter than the minimum."""

LONGER = 1.05
"""Factor by which a duration without a closed formula is increased until the limits hold, as in OpenRAVE."""

MOST_ATTEMPTS = 500

_SHORTEST, _LONGEST = 1e-100, 1e100
"""Range of durations [s] whose squares are finite and not 0."""


class RetimingError(Exception):
    """The path cannot be timed; the text gives the reason."""


class OutsideLimitsError(RetimingError):
    """A waypoint is outside the limits of its joint."""


@dataclass(frozen=True, slots=True)
class PathLimits:
    """Limits of a motion.

    Attributes:
        coordinates: The coordinates of configurations.
        lower: Lower limits [rad or m], shape (n,).
        upper: Upper limits, shape (n,).
        velocity: Maximum speeds [rad/s or m/s], shape (n,).
        acceleration: Maximum accelerations, shape (n,).
        jerk: Maximum jerks, shape (n,).
    """

    coordinates: Coordinates
    lower: Floats
    upper: Floats
    velocity: Floats
    acceleration: Floats
    jerk: Floats

    def check(self, points: Floats) -> None:
        """Check that waypoints, shape (m, n), are within the limits.

        Raises:
            OutsideLimitsError: a waypoint is outside the limits.
        """
        for row, column in np.argwhere(self.coordinates.outside(points, self.lower, self.upper)):
            value, lower, upper = points[row, column], self.lower[column], self.upper[column]
            message = f"value {column} of waypoint {row} is {value:.15g}, outside its limits [{lower:g}, {upper:g}]"
            raise OutsideLimitsError(message)


class Segment(NamedTuple):
    """Segment between consecutive waypoints.

    Attributes:
        step: The difference of the values [rad or m], shape (n,).
        start_velocity: Velocity at the first waypoint [rad/s or m/s], shape (n,).
        end_velocity: Velocity at the second waypoint, shape (n,).
    """

    step: Floats
    start_velocity: Floats
    end_velocity: Floats

    @property
    def is_from_rest_to_rest(self) -> bool:
        """Whether the segment starts and ends at rest."""
        return not self.start_velocity.any() and not self.end_velocity.any()

    @property
    def to_rest(self) -> "Segment":
        """The same segment with zero end velocity."""
        return Segment(self.step, self.start_velocity, np.zeros_like(self.step))


class SegmentRows(NamedTuple):
    """States of a timed segment in rows: intermediate states, and its end.

    Attributes:
        times: Times of the rows since the start of the segment [s], shape (m,).
        orders: Values relative to the first waypoint, velocities, accelerations, ...; shape (m, n) each.
    """

    times: Floats
    orders: Sequence[Floats]


class Interpolated(Protocol):
    """Name of the interpolation between the rows of a timed path, and its number of derivatives."""

    interpolation: str
    order: int


class Profile(Interpolated, Protocol):
    """Retimer that works segment by segment.

    If ``merges``, consecutive equal waypoints become one, and the first waypoint has time 0.
    """

    merges: bool

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the minimum duration of a segment [s]; infinite if the limits do not allow it."""
        ...

    def drive(self, segment: Segment, duration: float, limits: PathLimits) -> SegmentRows | None:
        """Return the rows of a segment that takes a given duration, or None if no motion keeps the limits."""
        ...


_QUATERNION = 4


class Timed(NamedTuple):
    """Timed path: waypoints and intermediate rows.

    Attributes:
        deltas: Times since the previous row [s], shape (m,).
        orders: Values, velocities, ... at the rows, shape (m, n) each.
        is_point: Whether each row is a waypoint of the path, shape (m,).
    """

    deltas: Floats
    orders: list[Floats]
    is_point: "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]"


def retime(
    profile: Profile,
    points: Floats,
    limits: PathLimits,
    *,
    deltas: Floats | None = None,
    velocities: Floats | None = None,
    time_step: float = 0.0,
) -> Timed:
    """Time a path.

    Args:
        profile: The retimer.
        points: The waypoints, shape (m, n).
        limits: The limits of the motion.
        deltas: Given times since the previous waypoint [s], shape (m,); None means the shortest.
        velocities: Given velocities at the waypoints, shape (m, n); None means zero if the retimer stops at waypoints.
        time_step: Times are multiples of it [s]; 0 means no rounding.

    Raises:
        OutsideLimitsError: a waypoint is outside the limits.
        RetimingError: the path cannot be timed.
    """
    limits.check(points)
    if not len(points):
        raise RetimingError("there are no waypoints")
    path = _TimedRows(profile, points[0], np.zeros_like(points[0]) if velocities is None else velocities[0])
    if deltas is not None and not profile.merges:
        path.start_at(float(deltas[0]))
    for index in range(1, len(points)):
        step = limits.coordinates.difference(points[index], points[index - 1])
        if profile.interpolation == "linear" and len(limits.coordinates.rotation) == _QUATERNION:
            columns = list(limits.coordinates.rotation)  # OpenRAVE interpolates their numbers, whatever their signs
            step[columns] = points[index, columns] - points[index - 1, columns]
        ends = np.zeros((2, len(step))) if velocities is None else velocities[index - 1 : index + 1]
        segment = Segment(step, ends[0], ends[1])
        given = None if deltas is None else float(deltas[index])
        try:
            if given is not None and not segment.is_from_rest_to_rest:
                duration = given
            else:  # OpenRAVE uses the times of a stop at each waypoint, whatever the given velocities are
                asked = segment if index == len(points) - 1 else segment.to_rest
                duration = _duration(profile.shortest(asked, limits), given, time_step)
            rows = _driven(profile, segment, limits, duration, MOST_ATTEMPTS if given is None else 1)
        except RetimingError as error:
            raise RetimingError(f"from waypoint {index - 1} to {index}: {error}") from None
        path.append(rows, points[index - 1], points[index])
    return path.timed()


def _duration(needed: float, given: float | None, time_step: float) -> float:
    """Return the duration of a segment [s]: the given one, or the minimum rounded up to whole time steps."""
    if not needed < _LONGEST:
        raise RetimingError("a joint moves whose velocity or acceleration limit is 0, or nearly so")
    if given is not None:
        if not given >= needed - ENOUGH:
            raise RetimingError(f"the given time is {given:.6g} s, and the limits ask for {needed:.6g} s at least")
        return max(given, needed)
    if not (time_step > 0 and math.isfinite(needed / time_step)):
        return needed
    return max(1, math.ceil(needed / time_step - ENOUGH)) * time_step


def _driven(profile: Profile, segment: Segment, limits: PathLimits, duration: float, attempts: int) -> SegmentRows:
    """Return the timed rows of a segment.

    If it starts and ends at rest, up to ``attempts`` ever longer durations are tried until the limits are kept.
    """
    if duration < _SHORTEST and profile.merges:
        return SegmentRows(np.zeros(1), ())
    for _ in range(attempts if segment.is_from_rest_to_rest else 1):
        rows = profile.drive(segment, duration, limits)
        if rows is not None:
            return rows
        duration *= LONGER
    raise RetimingError(f"no motion of {duration:.6g} s keeps the limits with the velocities at the waypoints")


class _TimedRows:
    """Timed path under construction."""

    def __init__(self, profile: Profile, first: Floats, velocity: Floats) -> None:
        self._profile = profile
        rest = np.zeros_like(first)
        self._deltas = [np.zeros(1)]
        orders = (first, velocity, *[rest] * (profile.order - 1))[: profile.order + 1]
        self._orders = [[order[None]] for order in orders]
        self._is_point = [np.ones(1, dtype=bool)]

    def start_at(self, time: float) -> None:
        """Set the time of the first waypoint [s]."""
        self._deltas[0][0] = time

    def append(self, rows: SegmentRows, start: Floats, end: Floats) -> None:
        """Append a segment; its last row is replaced by the exact waypoint ``end``."""
        times = rows.times
        if self._profile.merges and times[-1] <= 0:
            return
        self._deltas.append(np.concatenate([times[:1], times[1:] - times[:-1]]))
        values = start + rows.orders[0]
        values[-1] = end
        for known, fresh in zip(self._orders, (values, *rows.orders[1:]), strict=True):
            known.append(fresh)
        is_point = np.zeros(len(times), dtype=bool)
        is_point[-1] = True
        self._is_point.append(is_point)

    def timed(self) -> Timed:
        orders = [np.concatenate(rows) for rows in self._orders]
        return Timed(np.concatenate(self._deltas), orders, np.concatenate(self._is_point))
