"""Constant jerks: accelerations that change gradually."""

from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.retiming.segments import Limits, Rows, Segment

_SAME_TIME = 1e-10
"""Changes of jerk this near [s] are at one time."""

_SIGNS = (1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0)
"""Of the jerk in the pieces of a motion."""


class JerkLimited:
    """Stops at each waypoint; accelerations go up and down in straight lines.

    From rest to rest each joint has up to seven pieces of constant jerk, mirrored in its middle. A joint with more time
    than it needs does the same more slowly.
    """

    interpolation = "cubic"
    order = 2
    merges = True

    def shortest(self, segment: Segment, limits: Limits) -> float:
        """Return the time of a segment [s]."""
        if not segment.is_from_rest_to_rest:
            return np.inf
        return max((_double_s(*one)[3] for one in _joints(segment.step, limits)), default=0.0)

    def drive(self, segment: Segment, duration: float, limits: Limits) -> Rows | None:
        """Return the rows of a segment: one for each change of jerk, and its end."""
        joints = _joints(segment.step, limits)
        changes = [_changes(_double_s(*one), duration) for one in joints]
        inner = np.unique(np.concatenate([np.zeros(1), *changes]))
        inner = inner[(inner > _SAME_TIME) & (inner < duration - _SAME_TIME)]
        times = np.append(inner[np.diff(inner, prepend=0.0) > _SAME_TIME], duration)
        orders = [np.zeros((len(times), len(segment.step))) for _ in range(3)]
        for column, own, (way, *_) in zip(np.flatnonzero(segment.step), changes, joints, strict=True):
            for order, rows in zip(orders, _states(own, way, duration, times), strict=True):
                order[:, column] = np.sign(segment.step[column]) * rows
        for order in orders[1:]:
            order[-1] = 0.0  # exactly at rest
        return Rows(times, orders)


def _joints(step: Floats, limits: Limits) -> list[tuple[float, float, float, float]]:
    rows = np.stack([np.abs(step), limits.velocity, limits.acceleration, limits.jerk], axis=1)
    return [(way, speed, acceleration, jerk) for way, speed, acceleration, jerk in rows.tolist() if way > 0]


def _double_s(way: float, speed: float, acceleration: float, jerk: float) -> tuple[float, float, float, float]:
    """Return the times of the fastest motion over a way from rest to rest.

    Returns:
        How long the jerk lasts, the acceleration with its two flanks, and the whole motion up to where it slows down;
        and the whole motion [s].
    """
    if not (speed > 0 and acceleration > 0 and jerk > 0):
        return 0.0, 0.0, 0.0, np.inf
    flank = min(acceleration / jerk, (speed / jerk) ** 0.5)
    ramp = flank + speed / (jerk * flank)
    if way >= speed * ramp:  # it cruises
        return flank, ramp, way / speed, way / speed + ramp
    if way >= 2 * acceleration**3 / jerk**2:  # it reaches the acceleration
        flank = acceleration / jerk
        ramp = flank / 2 + ((flank / 2) ** 2 + way / acceleration) ** 0.5
    else:
        flank = (way / (2 * jerk)) ** (1 / 3)
        ramp = 2 * flank
    return flank, ramp, ramp, 2 * ramp


def _changes(profile: tuple[float, float, float, float], duration: float) -> Floats:
    """Return when the jerk changes in the same motion over another time [s], from its start on."""
    flank, ramp, slows, whole = profile
    changes = np.array([0.0, flank, ramp - flank, ramp, slows, slows + flank, slows + ramp - flank])
    return changes * (duration / whole)


def _states(changes: Floats, way: float, duration: float, times: Floats) -> tuple[Floats, Floats, Floats]:
    """Return values, velocities and accelerations of a joint at some times, shape (len(times),) each."""
    ends = np.append(changes[1:], duration)
    states = [(0.0, 0.0, 0.0)]
    for jerk, elapsed in zip(_SIGNS, (ends - changes).tolist(), strict=True):
        states.append(_after(states[-1], jerk, elapsed))
    scale = way / states[-1][0]
    piece = np.searchsorted(ends[:-1], times, side="right")
    value, velocity, acceleration = np.array(states[:-1])[piece].T
    moved = _after((value, velocity, acceleration), np.array(_SIGNS)[piece], times - changes[piece])
    return scale * moved[0], scale * moved[1], scale * moved[2]


def _after(state: tuple[Any, Any, Any], jerk: Any, elapsed: Any) -> tuple[Any, Any, Any]:  # noqa: ANN401 - or arrays
    value, velocity, acceleration = state
    return (
        value + velocity * elapsed + acceleration * elapsed**2 / 2 + jerk * elapsed**3 / 6,
        velocity + acceleration * elapsed + jerk * elapsed**2 / 2,
        acceleration + jerk * elapsed,
    )
