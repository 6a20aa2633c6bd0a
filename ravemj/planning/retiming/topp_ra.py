"""Time-optimal motion along a smooth path: TOPP-RA by the package ``toppra``, with the extra ``retiming``.

H. Pham and Q.-C. Pham, "A new approach to time-optimal path parameterization based on reachability analysis", IEEE
Transactions on Robotics, 2018.
"""

import importlib
import importlib.util
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.planning.retiming.cubics import at_rest, corners_of, timed_cubics
from ravemj.planning.retiming.segments import PathLimits, RetimingError, Timed

_LEAST_ROWS = 400
_ROWS_OF_SEGMENT = 20
"""Minimum number of grid points per segment; between grid points, TOPP-RA may exceed limits, less on a finer grid."""


def is_installed() -> bool:
    """Return whether ``toppra`` is installed."""
    return importlib.util.find_spec("toppra") is not None


class ToppRa:
    """Time-optimal retimer along a cubic spline through the waypoints, without stops.

    The result has a cubic polynomial for each cell of a fine grid. The maximum speeds and accelerations of polynomials
    are computed exactly, and the motion is slowed down until all limits hold.
    """

    interpolation = "cubic"
    order = 1

    def timed(self, points: Floats, limits: PathLimits, time_step: float = 0.0) -> Timed:
        """Time a path, shape (m, n); the duration is a multiple of ``time_step`` [s], if that is not 0.

        Raises:
            OutsideLimitsError: a waypoint is outside the limits.
            RetimingError: the path cannot be timed.
        """
        corners = corners_of(points, limits, 0.0)
        if len(corners) == 1:
            return at_rest(points[0])
        moving = np.flatnonzero((corners != corners[0]).any(axis=0))
        rows = _fastest(corners, moving, limits)
        return timed_cubics(rows.values, rows.velocities, rows.deltas, rows.is_point, limits, time_step)


def _fastest(corners: Floats, moving: Ints, limits: PathLimits) -> "_Rows":
    """Return the time-optimal motion along the spline through waypoints, sampled at grid points."""
    toppra, constraint = (importlib.import_module(f"toppra{part}") for part in ("", ".constraint"))
    bounds = [np.stack([-bound[moving], bound[moving]], axis=1) for bound in (limits.velocity, limits.acceleration)]
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


class _Rows(NamedTuple):
    """Values and velocities at m grid points, time differences, shape (m - 1,), and which points are waypoints."""

    values: Floats
    velocities: Floats
    deltas: Floats
    is_point: NDArray[np.bool_]
