"""Paths with times: from waypoint to waypoint by one kind of retimer."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.space import Coordinates

ENOUGH = 1e-9
"""How much shorter [s] than needed a given time may be: rounding."""

LONGER = 1.05
"""Times that no formula gives are multiplied by this until the limits hold, as in OpenRAVE."""

MOST_ATTEMPTS = 500


class RetimingError(Exception):
    """There are no such times; the text says why."""


class OutsideLimitsError(RetimingError):
    """A waypoint is outside the limits of its joint."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a motion may do.

    Attributes:
        coordinates: What the numbers of a configuration are.
        lower: Least values [rad or m], shape (n,).
        upper: Greatest values, shape (n,).
        velocity: Greatest speeds [rad/s or m/s], shape (n,).
        acceleration: Greatest accelerations, shape (n,).
        jerk: Greatest jerks, shape (n,).
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
            OutsideLimitsError: one is not.
        """
        for row, column in np.argwhere(self.coordinates.outside(points, self.lower, self.upper)):
            value, lower, upper = points[row, column], self.lower[column], self.upper[column]
            message = f"value {column} of waypoint {row} is {value:.15g}, outside its limits [{lower:g}, {upper:g}]"
            raise OutsideLimitsError(message)


class Segment(NamedTuple):
    """The way from one waypoint to the next.

    Attributes:
        step: The difference of the values [rad or m], shape (n,).
        start_velocity: At the first waypoint [rad/s or m/s], shape (n,).
        end_velocity: At the second one, shape (n,).
    """

    step: Floats
    start_velocity: Floats
    end_velocity: Floats

    @property
    def is_from_rest_to_rest(self) -> bool:
        """Whether it starts and ends at rest."""
        return not self.start_velocity.any() and not self.end_velocity.any()

    @property
    def from_rest(self) -> "Segment":
        """The same way, started at rest."""
        return Segment(self.step, np.zeros_like(self.step), self.end_velocity)


class Rows(NamedTuple):
    """A driven segment.

    Attributes:
        times: Of the rows, from the start of the segment on [s]; the last is its end. Shape (m,).
        orders: Values relative to the first waypoint, velocities, accelerations, ...; shape (m, n) each.
    """

    times: Floats
    orders: Sequence[Floats]


class Interpolated(Protocol):
    """How results move between their rows: the interpolation of the values, and how many derivatives they have."""

    interpolation: str
    order: int


class Profile(Interpolated, Protocol):
    """A kind of retimer that goes from waypoint to waypoint.

    If it merges, equal neighbours become one waypoint, and time does not start before the first one.
    """

    merges: bool

    def shortest(self, segment: Segment, limits: Limits) -> float:
        """Return the time that a segment takes at least [s]; infinite where the limits forbid it."""
        ...

    def drive(self, segment: Segment, duration: float, limits: Limits) -> Rows | None:
        """Return the motion of a segment in a given time, or None where none keeps the limits."""
        ...


class Timed(NamedTuple):
    """A path with times.

    Attributes:
        deltas: Times since the waypoint before [s], shape (m,).
        orders: Values, velocities, ... at the waypoints, shape (m, n) each.
        is_point: For each row, whether it is a waypoint of the path, shape (m,).
    """

    deltas: Floats
    orders: list[Floats]
    is_point: "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]"


def retime(
    profile: Profile,
    points: Floats,
    limits: Limits,
    *,
    deltas: Floats | None = None,
    velocities: Floats | None = None,
    time_step: float = 0.0,
) -> Timed:
    """Give a path times.

    Args:
        profile: The kind of retimer.
        points: The waypoints, shape (m, n).
        limits: What the motion may do.
        deltas: Given times since the waypoint before [s], shape (m,); None: the shortest.
        velocities: Given velocities at the waypoints, shape (m, n); None: at rest, if the kind stops at waypoints.
        time_step: Times are multiples of it [s]; 0: any.

    Raises:
        OutsideLimitsError: a waypoint is outside the limits.
        RetimingError: there are none.
    """
    limits.check(points)
    if not len(points):
        raise RetimingError("there are no waypoints")
    path = _Path(profile, points[0], np.zeros_like(points[0]) if velocities is None else velocities[0])
    if deltas is not None and not profile.merges:
        path.start_at(float(deltas[0]))
    for index in range(1, len(points)):
        step = limits.coordinates.difference(points[index], points[index - 1])
        ends = np.zeros((2, len(step))) if velocities is None else velocities[index - 1 : index + 1]
        segment = Segment(step, ends[0], ends[1])
        given = None if deltas is None else float(deltas[index])
        try:
            rows = _driven(profile, segment, limits, given, time_step)
        except RetimingError as error:
            raise RetimingError(f"from waypoint {index - 1} to {index}: {error}") from None
        path.append(rows, points[index - 1], points[index])
    return path.timed()


def _driven(profile: Profile, segment: Segment, limits: Limits, given: float | None, time_step: float) -> Rows:
    needed = profile.shortest(segment, limits)
    if not segment.is_from_rest_to_rest:
        # OpenRAVE's times are those of a start at rest.
        needed = max(needed, profile.shortest(segment.from_rest, limits))
    if not math.isfinite(needed):
        raise RetimingError("a joint moves whose velocity or acceleration limit is 0")
    if given is not None and not given >= needed - ENOUGH:
        raise RetimingError(f"the given time is {given:.6g} s, and the limits ask for {needed:.6g} s at least")
    if given is not None:
        duration = max(given, needed)
    else:
        duration = max(1, math.ceil(needed / time_step - ENOUGH)) * time_step if time_step > 0 else needed
    if duration <= 0 and profile.merges:
        return Rows(np.zeros(1), ())
    for _ in range(MOST_ATTEMPTS if given is None else 1):
        rows = profile.drive(segment, duration, limits)
        if rows is not None:
            return rows
        duration *= LONGER
    tried = duration if given is None else given
    raise RetimingError(f"no motion of {tried:.6g} s keeps the limits with the velocities at the waypoints")


class _Path:
    """The rows so far."""

    def __init__(self, profile: Profile, first: Floats, velocity: Floats) -> None:
        self._profile = profile
        rest = np.zeros_like(first)
        self._deltas = [np.zeros(1)]
        orders = (first, velocity, *[rest] * (profile.order - 1))[: profile.order + 1]
        self._orders = [[order[None]] for order in orders]
        self._is_point = [np.ones(1, dtype=bool)]

    def start_at(self, time: float) -> None:
        """Let time pass before the first waypoint [s]."""
        self._deltas[0][0] = time

    def append(self, rows: Rows, start: Floats, end: Floats) -> None:
        """Append a segment; its last row is the waypoint itself."""
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
