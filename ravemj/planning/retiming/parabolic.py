"""Constant accelerations: each joint speeds up, cruises and slows down."""

import numpy as np

from ravemj.planning.ramps import fit_from_rest, fit_ramps, shortest_ramps
from ravemj.planning.retiming.segments import Limits, Rows, Segment

_SAME_TIME = 1e-10
"""Changes of acceleration this near [s] are at one time."""


class Parabolic:
    """Stops at each waypoint; all joints take the time of the slowest.

    A joint that has more time than it needs moves with the least acceleration that does.

    Args:
        with_changes: Whether there are waypoints where joints change their acceleration.
    """

    interpolation = "quadratic"
    order = 1
    merges = True

    def __init__(self, *, with_changes: bool = True) -> None:
        self._with_changes = with_changes

    def shortest(self, segment: Segment, limits: Limits) -> float:
        """Return the time of a segment [s]."""
        if not segment.is_from_rest_to_rest:
            ends = segment.start_velocity, segment.end_velocity
            return float(shortest_ramps(segment.step, *ends, limits.velocity, limits.acceleration).max(initial=0.0))
        way = np.abs(segment.step)
        moving = way > 0
        way, speed, acceleration = way[moving], limits.velocity[moving], limits.acceleration[moving]
        if not (speed.all() and acceleration.all()):
            return np.inf
        cruises = way * acceleration > speed**2
        times = np.where(cruises, way / speed + speed / acceleration, 2 * np.sqrt(way / acceleration))
        return float(times.max(initial=0.0))

    def drive(self, segment: Segment, duration: float, limits: Limits) -> Rows | None:
        """Return the rows of a segment: one for each change of acceleration, and its end."""
        bounds = duration, limits.velocity, limits.acceleration
        if segment.is_from_rest_to_rest:
            ramps = fit_from_rest(segment.step, *bounds)
        else:
            ramps = fit_ramps(segment.step, segment.start_velocity, segment.end_velocity, *bounds)
        if ramps is None:
            return None
        times = ramps.changes(_SAME_TIME) if self._with_changes else np.array([duration])
        return Rows(times, ramps.states(times))
