"""The fastest motion along a smooth path: TOPP-RA, of the package ``toppra``, which comes with the extra ``retiming``.

H. Pham and Q.-C. Pham, "A new approach to time-optimal path parameterization based on reachability analysis", IEEE
Transactions on Robotics, 2018.
"""

import importlib
import importlib.util
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.planning.retiming.segments import ENOUGH, Limits, RetimingError, Timed

_LEAST_ROWS = 400
_ROWS_OF_SEGMENT = 20
"""TOPP-RA keeps limits at the rows of its grid; the finer it is, the less the motion has to be slowed down between."""

_ROUNDING = 1e-10
"""By how much the motion is slower than its limits allow, relatively: rounding of what others compute from it."""


def is_installed() -> bool:
    """Return whether there is the package ``toppra``."""
    return importlib.util.find_spec("toppra") is not None


class ToppRa:
    """Drives a cubic spline through the waypoints without a stop, at limits of speed or acceleration all the time.

    The result is one cubic polynomial for each row of a fine grid. Greatest speeds and accelerations of these are known
    exactly, and the whole is slowed down until none is beyond its limit.
    """

    interpolation = "cubic"
    order = 1

    def timed(self, points: Floats, limits: Limits, time_step: float = 0.0) -> Timed:
        """Give a path, shape (m, n), times; the whole is a multiple of ``time_step`` [s], if that is not 0.

        Raises:
            OutsideLimitsError: a waypoint is outside the limits.
            RetimingError: there are no such times.
        """
        limits.check(points)
        if not len(points):
            raise RetimingError("there are no waypoints")
        steps = limits.coordinates.difference(points[1:], points[:-1])
        moving = np.flatnonzero((steps != 0).any(axis=0))
        steps = steps[(steps != 0).any(axis=1)]
        if not len(steps):
            return Timed(np.zeros(1), [points[:1], np.zeros_like(points[:1])], np.ones(1, dtype=bool))
        if not (limits.velocity[moving].all() and limits.acceleration[moving].all()):
            raise RetimingError("a joint moves whose velocity or acceleration limit is 0")
        corners = points[0] + np.vstack([np.zeros_like(points[0]), np.cumsum(steps, axis=0)])
        rows = _fastest(corners, moving, limits)
        cubics = _Cubics(np.diff(rows.values, axis=0), rows.velocities[:-1], rows.velocities[1:], rows.deltas[:, None])
        _check_values(rows.values, cubics, limits)
        slower = max(
            float((cubics.greatest_speeds()[moving] / limits.velocity[moving]).max()),
            float(np.sqrt(cubics.greatest_accelerations()[moving] / limits.acceleration[moving]).max()),
        ) * (1 + _ROUNDING)
        duration = float(rows.deltas.sum()) * slower
        if time_step > 0:
            slower *= max(1, math.ceil(duration / time_step - ENOUGH)) * time_step / duration
        return Timed(np.append(0.0, rows.deltas * slower), [rows.values, rows.velocities / slower], rows.is_point)


def _fastest(corners: Floats, moving: Ints, limits: Limits) -> "_Rows":
    """Return the fastest motion along the spline through corners, at the rows of a grid."""
    toppra, constraint = (importlib.import_module(f"toppra{part}") for part in ("", ".constraint"))
    bounds = [np.stack([-one[moving], one[moving]], axis=1) for one in (limits.velocity, limits.acceleration)]
    places = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1)))
    path = toppra.SplineInterpolator(places, corners[:, moving])
    rows = max(_ROWS_OF_SEGMENT, math.ceil(_LEAST_ROWS / (len(places) - 1)))
    grid = np.interp(np.arange(rows * (len(places) - 1) + 1) / rows, np.arange(len(places)), places)
    constraints = [constraint.JointVelocityConstraint(bounds[0]), constraint.JointAccelerationConstraint(bounds[1])]
    solver = toppra.algorithm.TOPPRA(constraints, path, gridpoints=grid, solver_wrapper="seidel")
    _, rates, _ = solver.compute_parameterization(0.0, 0.0)
    if rates is None or not np.isfinite(rates).all():
        raise RetimingError("TOPP-RA finds no times for the path")
    values, velocities = np.tile(corners[0], (len(grid), 1)), np.zeros((len(grid), corners.shape[1]))
    values[:, moving] = path(grid)
    velocities[:, moving] = path(grid, 1) * rates[:, None]
    values[::rows] = corners
    is_point = np.zeros(len(grid), dtype=bool)
    is_point[::rows] = True
    return _Rows(values, velocities, 2 * np.diff(grid) / (rates[1:] + rates[:-1]), is_point)


def _check_values(values: Floats, cubics: "_Cubics", limits: Limits) -> None:
    """Check that the values between the rows are within the limits."""
    for extreme in cubics.extremes():
        beyond = values[:-1] + extreme
        for row, column in np.argwhere(limits.coordinates.outside(beyond, limits.lower, limits.upper)):
            bounds = f"[{limits.lower[column]:g}, {limits.upper[column]:g}]"
            found = f"value {column} swings to {beyond[row, column]:.6g}, outside its limits {bounds}"
            raise RetimingError(f"{found}; more waypoints keep the smooth path nearer to straight lines")


class _Rows(NamedTuple):
    """A motion at the m rows of a grid; deltas are the times between them [s]."""

    values: Floats
    velocities: Floats
    deltas: Floats
    is_point: NDArray[np.bool_]


class _Cubics:
    """Polynomials by their steps, the velocities at their ends, shape (m, n) each, and their times, shape (m, 1)."""

    def __init__(self, steps: Floats, starts: Floats, ends: Floats, times: Floats) -> None:
        self._starts, self._times = starts, times
        self._square = 3 * steps / times**2 - (2 * starts + ends) / times
        self._cube = (starts + ends) / times**2 - 2 * steps / times**3

    def _speed(self, time: Floats) -> Floats:
        return np.abs(self._starts + (2 * self._square + 3 * self._cube * time) * time)

    def greatest_speeds(self) -> Floats:
        """Return the greatest speed of each value, shape (n,)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = -self._square / (3 * self._cube)
        turn = np.where((turn > 0) & (turn < self._times), turn, 0.0)
        return np.max([self._speed(time).max(axis=0) for time in (0 * turn, turn, 0 * turn + self._times)], axis=0)

    def greatest_accelerations(self) -> Floats:
        """Return the greatest acceleration of each value, shape (n,); it is at an end of a polynomial."""
        first, last = 2 * self._square, 2 * self._square + 6 * self._cube * self._times
        return np.maximum(np.abs(first).max(axis=0), np.abs(last).max(axis=0))

    def extremes(self) -> Iterator[Floats]:
        """Yield how far values are from their start where they turn round, shape (m, n)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(self._square**2 - 3 * self._cube * self._starts)
            for top in (-self._square + root, -self._square - root):
                for turn in (top / (3 * self._cube), self._starts / top):
                    time = np.where((turn > 0) & (turn < self._times), turn, 0.0)
                    yield (self._starts + (self._square + self._cube * time) * time) * time
