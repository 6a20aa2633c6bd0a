"""Piecewise cubic motions: their maximum velocities and accelerations, and times that keep limits."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.planning.retiming.segments import ENOUGH, PathLimits, RetimingError, Timed

_ROUNDING = 1e-10
"""Relative margin to the limits, for rounding errors in later computations."""


def corners_of(points: Floats, limits: PathLimits, same: float) -> Floats:
    """Return the waypoints of a path, shape (k, n), with unwrapped circular joints and without repetitions.

    Args:
        points: The waypoints, shape (m, n).
        limits: The limits.
        same: Tolerance of equal waypoints [rad or m].

    Raises:
        OutsideLimitsError: a waypoint is outside the limits.
        RetimingError: there are no waypoints, or a joint moves whose velocity or acceleration limit is 0.
    """
    limits.check(points)
    if not len(points):
        raise RetimingError("there are no waypoints")
    steps = limits.coordinates.difference(points[1:], points[:-1])
    kept = points[np.append(True, np.abs(steps).max(axis=1, initial=0.0) > same)]
    steps = limits.coordinates.difference(kept[1:], kept[:-1])
    moving = (steps != 0).any(axis=0)
    if not (limits.velocity[moving].all() and limits.acceleration[moving].all()):
        raise RetimingError("a joint moves whose velocity or acceleration limit is 0")
    return points[0] + np.vstack([np.zeros_like(points[0]), np.cumsum(steps, axis=0)])


def at_rest(point: Floats) -> Timed:
    """Return the motion at rest at a point, shape (n,)."""
    return Timed(np.zeros(1), [point[None], np.zeros_like(point[None])], np.ones(1, dtype=bool))


def timed_cubics(
    values: Floats,
    velocities: Floats,
    deltas: Floats,
    is_point: NDArray[np.bool_],
    limits: PathLimits,
    time_step: float,
) -> Timed:
    """Return a piecewise cubic motion, slowed down until it keeps its limits everywhere.

    Args:
        values: The values at m knots, shape (m, n).
        velocities: The velocities at the knots, shape (m, n).
        deltas: The times between the knots [s], shape (m - 1,).
        is_point: Whether each knot is a waypoint of the path, shape (m,).
        limits: The limits.
        time_step: The duration is a multiple of it [s]; 0 means no rounding.

    Raises:
        RetimingError: values between the knots are outside the limits.
    """
    moving = (np.diff(values, axis=0) != 0).any(axis=0) | (velocities != 0).any(axis=0)
    cubics = _Cubics(np.diff(values, axis=0), velocities[:-1], velocities[1:], deltas[:, None])
    _check_values(values, cubics, limits)
    slower = max(
        float((cubics.greatest_speeds()[moving] / limits.velocity[moving]).max()),
        float(np.sqrt(cubics.greatest_accelerations()[moving] / limits.acceleration[moving]).max()),
    ) * (1 + _ROUNDING)
    duration = float(deltas.sum()) * slower
    if time_step > 0:
        slower *= max(1, math.ceil(duration / time_step - ENOUGH)) * time_step / duration
    return Timed(np.append(0.0, deltas * slower), [values, velocities / slower], is_point)


def _check_values(values: Floats, cubics: "_Cubics", limits: PathLimits) -> None:
    """Raise a RetimingError if values leave their limits between the waypoints."""
    for extreme in cubics.extremes():
        beyond = values[:-1] + extreme
        for row, column in np.argwhere(limits.coordinates.outside(beyond, limits.lower, limits.upper)):
            bounds = f"[{limits.lower[column]:g}, {limits.upper[column]:g}]"
            mistake = f"value {column} swings to {beyond[row, column]:.6g}, outside its limits {bounds}"
            raise RetimingError(f"{mistake}; more waypoints keep the smooth path nearer to straight lines")


class _Cubics:
    """Cubic segments of a path: displacements and end velocities, shape (m, n), and durations, shape (m, 1)."""

    def __init__(self, steps: Floats, starts: Floats, ends: Floats, times: Floats) -> None:
        self._starts, self._times = starts, times
        self._square = 3 * steps / times**2 - (2 * starts + ends) / times
        self._cube = (starts + ends) / times**2 - 2 * steps / times**3

    def _speed(self, time: Floats) -> Floats:
        return np.abs(self._starts + (2 * self._square + 3 * self._cube * time) * time)

    def greatest_speeds(self) -> Floats:
        """Return the maximum speed of each value over all segments, shape (n,)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = -self._square / (3 * self._cube)
        turn = np.where((turn > 0) & (turn < self._times), turn, 0.0)
        return np.max([self._speed(time).max(axis=0) for time in (0 * turn, turn, 0 * turn + self._times)], axis=0)

    def greatest_accelerations(self) -> Floats:
        """Return the maximum acceleration of each value, shape (n,); it is reached at an end of a segment."""
        first, last = 2 * self._square, 2 * self._square + 6 * self._cube * self._times
        return np.maximum(np.abs(first).max(axis=0), np.abs(last).max(axis=0))

    def extremes(self) -> Iterator[Floats]:
        """Yield displacements, shape (m, n), at which values change direction inside segments; 0 if they do not."""
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(self._square**2 - 3 * self._cube * self._starts)
            for top in (-self._square + root, -self._square - root):
                for turn in (top / (3 * self._cube), self._starts / top):
                    time = np.where((turn > 0) & (turn < self._times), turn, 0.0)
                    yield (self._starts + (self._square + self._cube * time) * time) * time
