"""Retimers with a polynomial for each segment: linear, parabolic, cubic, quintic, and limited jerk."""

import math
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.ramps import Ramps, fit_from_rest, fit_matched_ramps, fit_ramps, shortest_ramps
from ravemj.planning.retiming.segments import LONGER, MOST_ATTEMPTS, PathLimits, Segment, SegmentRows

_SLACK = 1e-12


class Polynomial:
    """Retimer with the polynomial through values and derivatives at the ends of each segment."""

    interpolation: str
    order: int
    merges: bool

    def _first_time(self, way: Floats, limits: PathLimits) -> float:
        """Return the first duration of a segment to try [s], by default the minimum from rest to rest."""
        return self._from_rest_to_rest(way, limits)

    def _from_rest_to_rest(self, way: Floats, limits: PathLimits) -> float:
        """Return the minimum duration [s] of a segment that starts and ends at rest, for the displacements ``way``."""
        raise NotImplementedError

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the duration of a segment [s]."""
        moving = segment.step != 0
        moving |= (segment.start_velocity != 0) | (segment.end_velocity != 0)
        if not moving.any():
            return 0.0
        limits = _only(limits, moving)
        segment = Segment(*(part[moving] for part in segment))
        if not (limits.velocity.all() and limits.acceleration.all()):
            return np.inf
        fastest = np.maximum(np.abs(segment.start_velocity), np.abs(segment.end_velocity))
        duration = max(self._first_time(np.abs(segment.step), limits), float((fastest / limits.acceleration).max()) / 8)
        if segment.is_from_rest_to_rest:
            needed = self._from_rest_to_rest(np.abs(segment.step), limits) * (1 - _SLACK)
            if not (duration > 0 and np.isfinite(needed)):  # a limit is infinite, or 0
                return needed
            while duration < needed:
                duration *= LONGER
            return duration
        for _ in range(MOST_ATTEMPTS):
            if self._keeps_limits(segment, duration, limits):
                return duration
            duration *= LONGER
        return np.inf

    def drive(self, segment: Segment, duration: float, limits: PathLimits) -> SegmentRows | None:
        """Return rows with only the end state of a segment; None if the limits do not allow its velocities."""
        if not segment.is_from_rest_to_rest and (duration <= 0 or not self._keeps_limits(segment, duration, limits)):
            return None
        rest = np.zeros_like(segment.step)[None]
        rows = (segment.step[None], segment.end_velocity[None], *[rest] * (self.order - 1))
        return SegmentRows(np.array([duration]), rows)

    def _keeps_limits(self, segment: Segment, duration: float, limits: PathLimits) -> bool:
        raise NotImplementedError


class Cubic(Polynomial):
    """Cubic polynomial with given end velocities.

    Its duration is increased in steps of 5 %, from displacement divided by speed, until the limits hold.
    """

    interpolation = "cubic"
    order = 1
    merges = False

    def _first_time(self, way: Floats, limits: PathLimits) -> float:
        return float((way / limits.velocity).max())

    def _from_rest_to_rest(self, way: Floats, limits: PathLimits) -> float:
        by_speed, by_acceleration = 1.5 * way / limits.velocity, np.sqrt(6 * way / limits.acceleration)
        return float(max(by_speed.max(), by_acceleration.max()))

    def _keeps_limits(self, segment: Segment, duration: float, limits: PathLimits) -> bool:
        step, start, end = segment
        square = 3 * step / duration**2 - (2 * start + end) / duration
        cube = (start + end) / duration**2 - 2 * step / duration**3
        accelerations = np.abs(np.stack([2 * square, 2 * square + 6 * cube * duration]))
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = -square / (3 * cube)
        turn = np.where((turn > 0) & (turn < duration), turn, 0.0)
        fastest = np.abs(start + 2 * square * turn + 3 * cube * turn**2)
        return bool(
            (accelerations <= limits.acceleration * (1 + _SLACK)).all()
            and (fastest <= limits.velocity * (1 + _SLACK)).all()
        )


class Quintic(Polynomial):
    """Quintic polynomial with given end velocities and zero end accelerations."""

    interpolation = "quintic"
    order = 2
    merges = True

    def _from_rest_to_rest(self, way: Floats, limits: PathLimits) -> float:
        by_speed = 15 / 8 * way / limits.velocity
        by_acceleration = np.sqrt(10 / np.sqrt(3) * way / limits.acceleration)
        with np.errstate(divide="ignore"):
            by_jerk = np.cbrt(60 * way / limits.jerk)
        return float(max(by_speed.max(), by_acceleration.max(), by_jerk.max()))

    def _keeps_limits(self, segment: Segment, duration: float, limits: PathLimits) -> bool:
        step, start, end = segment
        rest = step - start * duration
        change = (end - start) * duration
        coefficients = np.stack(
            [
                0 * step,
                start * duration,
                0 * step,
                10 * rest - 4 * change,
                7 * change - 15 * rest,
                6 * rest - 3 * change,
            ]
        )
        bounds = (limits.velocity, limits.acceleration, limits.jerk)
        part = np.linspace(0.0, 1.0, 101)
        for order, bound in enumerate(bounds, start=1):
            powers = np.arange(order, 6)
            rates = coefficients[order:] * np.array([math.perm(power, order) for power in powers.tolist()])[:, None]
            fastest = np.abs(part[:, None] ** (powers - order) @ rates).max(axis=0) / duration**order
            if (fastest > bound * (1 + _SLACK)).any():
                return False
        return True


def _only(limits: PathLimits, chosen: Any) -> PathLimits:  # noqa: ANN401 - a mask
    parts = (limits.lower, limits.upper, limits.velocity, limits.acceleration, limits.jerk)
    return PathLimits(limits.coordinates, *(part[chosen] for part in parts))


class Linear:
    """Constant velocity on each segment, limited by the slowest joint; velocities jump at waypoints."""

    interpolation = "linear"
    order = 1
    merges = False

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the duration of a segment [s]; translation and rotation of a base count as one distance each."""
        parts = limits.coordinates
        ways, speeds = np.abs(segment.step), limits.velocity
        if parts.translation or len(parts.rotation) > 1:
            ways, speeds = _of_base(segment.step, limits)
        moving = ways > 0
        with np.errstate(divide="ignore"):
            return float((ways[moving] / speeds[moving]).max(initial=0.0))

    def drive(self, segment: Segment, duration: float, limits: PathLimits) -> SegmentRows:
        """Return the end of a segment as its only row."""
        del limits
        velocity = segment.step / duration if duration > 0 else np.zeros_like(segment.step)
        return SegmentRows(np.array([duration]), (segment.step[None], velocity[None]))


def _of_base(step: Floats, limits: PathLimits) -> tuple[Floats, Floats]:
    """Return distances and maximum speeds: of each joint value, and of the translation and the rotation of a base."""
    parts = limits.coordinates
    translation, rotation = list(parts.translation), list(parts.rotation)
    rest = [column for column in range(len(step)) if column not in parts.translation + parts.rotation]
    ways = [*np.abs(step[rest])]
    speeds = [*limits.velocity[rest]]
    for columns, way in ((translation, np.linalg.norm(step[translation])), (rotation, _angle(step[rotation]))):
        if columns:
            ways.append(way)
            speeds.append(limits.velocity[columns].min())
    return np.array(ways), np.array(speeds)


def _angle(step: Floats) -> float:
    """Return the rotation angle [rad] for a difference of angles, rotation vectors or unit quaternions of any sign."""
    length = float(np.linalg.norm(step))
    if len(step) != 4:
        return length
    angle = 4 * float(np.arcsin(min(1.0, length / 2)))
    return min(angle, 2 * np.pi - angle)


_SAME_TIME = 1e-10
"""Tolerance of equal times of acceleration or jerk changes [s]."""


class Parabolic:
    """Retimer with constant accelerations that stops at each waypoint; all joints take the time of the slowest.

    Faster joints use the minimal acceleration for this time.

    Args:
        with_changes: Whether to add waypoints at acceleration changes.
    """

    interpolation = "quadratic"
    order = 1
    merges = True

    def __init__(self, *, with_changes: bool = True) -> None:
        self._with_changes = with_changes

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the duration of a segment [s]."""
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

    def drive(self, segment: Segment, duration: float, limits: PathLimits) -> SegmentRows | None:
        """Return the rows of a segment: each change of acceleration, and the end."""
        if segment.is_from_rest_to_rest:
            ramps = self._fit_from_rest(segment.step, duration, limits)
        else:
            ends = segment.start_velocity, segment.end_velocity
            ramps = fit_ramps(segment.step, *ends, duration, limits.velocity, limits.acceleration)
        if ramps is None:
            return None
        times = ramps.changes(_SAME_TIME) if self._with_changes else np.array([duration])
        return SegmentRows(times, ramps.states(times))

    def _fit_from_rest(self, step: Floats, duration: float, limits: PathLimits) -> Ramps | None:
        return fit_from_rest(step, duration, limits.velocity, limits.acceleration)


class MatchedRamps(Parabolic):
    """Parabolic retimer with acceleration changes of all joints at the same times.

    The duration is that of the slowest joint, increased by 5 % until the limits hold.
    """

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the minimum duration of a segment [s], rounded up to a step of 5 %."""
        duration = super().shortest(segment, limits)
        if segment.is_from_rest_to_rest and np.isfinite(duration):
            while duration > 0 and self._fit_from_rest(segment.step, duration, limits) is None:
                duration *= LONGER
        return duration

    def _fit_from_rest(self, step: Floats, duration: float, limits: PathLimits) -> Ramps | None:
        return fit_matched_ramps(step, duration, limits.velocity, limits.acceleration)


_SIGNS = (1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0)
"""Sign of the jerk in each of the seven pieces of a double-S profile."""


class JerkLimited:
    """Retimer with limited jerk that stops at each waypoint; accelerations are piecewise linear.

    From rest to rest, each joint has up to seven pieces of constant jerk, symmetric in time. The profiles of faster
    joints are stretched to the common duration.
    """

    interpolation = "cubic"
    order = 2
    merges = True

    def shortest(self, segment: Segment, limits: PathLimits) -> float:
        """Return the duration of a segment [s]."""
        if not segment.is_from_rest_to_rest:
            return np.inf
        try:
            return max((_double_s(*joint)[3] for joint in _joints(segment.step, limits)), default=0.0)
        except ArithmeticError:  # of numbers near the largest or smallest
            return np.inf

    def drive(self, segment: Segment, duration: float, limits: PathLimits) -> SegmentRows | None:
        """Return the rows of a segment: each change of jerk, and the end."""
        if not segment.is_from_rest_to_rest:
            return None
        joints = _joints(segment.step, limits)
        profiles = [_double_s(*joint) for joint in joints]
        if not all(profile[-1] > 0 for profile in profiles):  # so short that its time is rounded to 0
            return None
        changes = [_changes(profile, duration) for profile in profiles]
        inner = np.unique(np.concatenate([np.zeros(1), *changes]))
        inner = inner[(inner > _SAME_TIME) & (inner < duration - _SAME_TIME)]
        times = np.append(inner[np.diff(inner, prepend=0.0) > _SAME_TIME], duration)
        orders = [np.zeros((len(times), len(segment.step))) for _ in range(3)]
        for column, own, (way, *_) in zip(np.flatnonzero(segment.step), changes, joints, strict=True):
            states = _states(own, way, duration, times)
            if states is None:
                return None
            for order, rows in zip(orders, states, strict=True):
                order[:, column] = np.sign(segment.step[column]) * rows
        for order in orders[1:]:
            order[-1] = 0.0  # exactly at rest
        return SegmentRows(times, orders)


def _joints(step: Floats, limits: PathLimits) -> list[tuple[float, float, float, float]]:
    rows = np.stack([np.abs(step), limits.velocity, limits.acceleration, limits.jerk], axis=1)
    return [(way, speed, acceleration, jerk) for way, speed, acceleration, jerk in rows.tolist() if way > 0]


def _double_s(way: float, speed: float, acceleration: float, jerk: float) -> tuple[float, float, float, float]:
    """Return the durations [s] of the fastest double-S profile over the distance ``way``, from rest to rest.

    Returns:
        Durations of the first jerk, of the whole acceleration, of the time before the deceleration, and of the motion.
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
    """Return the times of jerk changes of a double-S profile [s], stretched to ``duration``."""
    flank, ramp, slows, whole = profile
    changes = np.array([0.0, flank, ramp - flank, ramp, slows, slows + flank, slows + ramp - flank])
    return changes * (duration / whole)


def _states(changes: Floats, way: float, duration: float, times: Floats) -> tuple[Floats, Floats, Floats] | None:
    """Return values, velocities and accelerations of a joint at times, shape (len(times),) each.

    None means that the motion is so short that its distance is rounded to 0.
    """
    ends = np.append(changes[1:], duration)
    states = [(0.0, 0.0, 0.0)]
    for jerk, elapsed in zip(_SIGNS, (ends - changes).tolist(), strict=True):
        states.append(_after(states[-1], jerk, elapsed))
    if not states[-1][0]:
        return None
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
