"""Motion along dense waypoints without stops: a curve through them with continuous direction."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.planning.retiming.cubics import at_rest, corners_of, timed_cubics
from ravemj.planning.retiming.segments import PathLimits, RetimingError, Timed

_SHARE = 0.5
"""Fraction of the acceleration limits reserved for curvature; the rest is for changes of speed."""

_SAME = 1e-9
"""Tolerance of equal waypoints [rad or m]."""


_ROUNDING = 1e-6
"""Relative rounding error of velocity differences over short times."""


class Spline:
    """Retimer along a cubic curve through the waypoints with continuous direction.

    Between close waypoints, as in paths on a constraint, it stays near the straight lines. The speed at each waypoint
    is the maximum from which the motion can still brake for all bends ahead; the motion is then slowed down until all
    limits hold.
    """

    interpolation = "cubic"
    order = 1

    def timed(self, points: Floats, limits: PathLimits, time_step: float = 0.0) -> Timed:
        """Time a path, shape (m, n); the duration is a multiple of ``time_step`` [s], if that is not 0.

        Raises:
            OutsideLimitsError: a waypoint is outside the limits.
            RetimingError: the path cannot be timed.
        """
        values = corners_of(points, limits, _SAME)
        if len(values) == 1:
            return at_rest(points[0])
        if len(values) == 2:
            raise RetimingError("a curve needs three waypoints at least")
        steps = np.diff(values, axis=0)
        moving = (steps != 0).any(axis=0)
        lengths = np.linalg.norm(steps / np.where(moving, limits.velocity, 1.0), axis=1)  # duration at full speed [s]
        directions = _directions(steps, lengths)
        rates = _rates(directions, steps, lengths, limits, moving)
        deltas = 2 * lengths / (rates[1:] + rates[:-1])
        velocities = directions * rates[:, None]
        limits = replace(limits, acceleration=limits.acceleration * (1 - _ROUNDING))
        return timed_cubics(values, velocities, deltas, np.ones(len(values), dtype=bool), limits, time_step)


def _directions(steps: Floats, lengths: Floats) -> Floats:
    """Return the tangent of the curve at each waypoint, shape (m, n).

    At inner waypoints it is that of the parabola through the waypoint and its neighbours.
    """
    slopes = steps / lengths[:, None]
    before, after = lengths[:-1, None], lengths[1:, None]
    inside = (slopes[:-1] * after + slopes[1:] * before) / (before + after)
    return np.vstack([slopes[:1], inside, slopes[-1:]])


def _rates(directions: Floats, steps: Floats, lengths: Floats, limits: PathLimits, moving: NDArray[np.bool_]) -> Floats:
    """Return the speed along the curve at each waypoint, shape (m,); it is 0 at both ends.

    The squared speed is linear between waypoints, so the acceleration along the curve is constant there.
    """
    velocity, acceleration = limits.velocity[moving], limits.acceleration[moving]
    along, steps, across = np.abs(directions[:, moving]), steps[:, moving], lengths[:, None]
    first, second = directions[:-1, moving], directions[1:, moving]
    bends = np.maximum(
        np.abs(6 * steps / across - 4 * first - 2 * second), np.abs(6 * steps / across - 2 * first - 4 * second)
    )
    bends = (bends / across / (_SHARE * acceleration)).max(axis=1)
    squares = 1 / np.maximum((along / velocity).max(axis=1), 1e-12) ** 2
    squares[:-1] = np.minimum(squares[:-1], 1 / np.maximum(bends, 1e-12))
    squares[1:] = np.minimum(squares[1:], 1 / np.maximum(bends, 1e-12))
    squares[[0, -1]] = 0.0
    largest = np.maximum(along[1:], along[:-1]) / ((1 - _SHARE) * acceleration)
    gains = 2 * lengths / np.maximum(largest.max(axis=1), 1e-12)  # change of the squared speed on each segment
    for index in range(1, len(squares)):
        squares[index] = min(squares[index], squares[index - 1] + gains[index - 1])
    for index in range(len(squares) - 2, -1, -1):
        squares[index] = min(squares[index], squares[index + 1] + gains[index])
    return np.sqrt(squares)
