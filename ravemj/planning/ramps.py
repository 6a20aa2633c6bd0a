"""Joint motions with constant accelerations: a ramp to a cruising velocity, and a ramp from it.

The formulas follow from the areas under speed over time; see K. Hauser and V. Ng-Thow-Hing, "Fast smoothing of
manipulator trajectories using optimal bounded-acceleration shortcuts", ICRA 2010.
"""

from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Ramps:
    """Synchronized motion of several joints; both ramps of a joint have opposite accelerations.

    Attributes:
        duration: Duration [s].
        start: Velocities at its start [rad/s or m/s], shape (n,).
        rate: Accelerations of the first ramps; those of the last are their negatives, shape (n,).
        first: End time of each joint's first ramp [s], shape (n,).
        last: Start time of each joint's last ramp [s], shape (n,).
    """

    duration: float
    start: Floats
    rate: Floats
    first: Floats
    last: Floats

    def changes(self, same: float) -> Floats:
        """Return the times at which accelerations change [s], up to the end; times within ``same`` [s] are merged."""
        moving = self.rate != 0
        inner = np.concatenate([self.first[moving], self.last[moving], [self.duration]])
        inner.sort()
        kept = (inner > same) & (inner < self.duration - same)
        kept[1:] &= inner[1:] - inner[:-1] > same
        kept[-1] = True
        return inner[kept]

    def states(self, times: Floats) -> tuple[Floats, Floats]:
        """Return displacements from the start and velocities at some times, shape (len(times), n) each."""
        t = times[:, None]
        ramp, cruise, rest = np.minimum(t, self.first), np.maximum(t - self.first, 0.0), np.maximum(t - self.last, 0.0)
        values = self.start * t + self.rate * (ramp * (ramp / 2 + cruise) - rest * rest / 2)
        return values, self.start + self.rate * (ramp - rest)

    def reach(self) -> tuple[Floats, Floats]:
        """Return the minimum and maximum displacements from the start [rad or m], shape (n,)."""
        divisor = np.where(self.rate != 0, self.rate, 1.0)
        turns = np.stack([-self.start / divisor, self.last + self.start / divisor + self.first])
        ends = np.stack([self.first, self.last, np.full_like(self.first, self.duration)])
        times = np.clip(np.vstack([turns, ends]), 0.0, self.duration)
        joints = np.arange(len(self.start))
        passed = np.stack([self.states(row)[0][joints, joints] for row in times])
        return np.minimum(passed.min(axis=0), 0.0), np.maximum(passed.max(axis=0), 0.0)


def shortest_ramps(steps: Floats, start: Floats, end: Floats, speed: Floats, acceleration: Floats) -> Floats:
    """Return the minimum time of each joint [s], shape (n,); infinite if its limits do not allow the motion.

    Args:
        steps: Displacements [rad or m], shape (n,).
        start: Velocities at the start, shape (n,).
        end: Velocities at the end, shape (n,).
        speed: Maximum speeds, shape (n,).
        acceleration: Maximum accelerations, shape (n,).
    """
    forward = _one_way(steps, start, end, speed, acceleration)
    backward = _one_way(-steps, -start, -end, speed, acceleration)
    times = np.minimum(forward, backward)
    times[(np.abs(start) > speed) | (np.abs(end) > speed)] = np.inf
    times[(steps == 0) & (start == 0) & (end == 0)] = 0.0
    return times


def _one_way(steps: Floats, start: Floats, end: Floats, speed: Floats, acceleration: Floats) -> Floats:
    """Return durations of motions that accelerate to a positive velocity, then decelerate; infinite if impossible."""
    with np.errstate(divide="ignore", invalid="ignore"):
        square = acceleration * steps + (start**2 + end**2) / 2
        peak = np.sqrt(np.maximum(square, 0.0))
        possible = (square >= 0) & (peak >= np.maximum(start, end) - 1e-12) & (acceleration > 0) & (speed > 0)
        triangle = (2 * peak - start - end) / acceleration
        ramps = (2 * speed - start - end) / acceleration
        cruise = (steps - (2 * speed**2 - start**2 - end**2) / (2 * acceleration)) / speed
        return np.where(possible, np.where(peak <= speed, triangle, ramps + cruise), np.inf)


def fit_from_rest(steps: Floats, duration: float, speed: Floats, acceleration: Floats) -> Ramps | None:
    """Return the result of ``fit_ramps`` for motions from rest to rest, computed three times as fast."""
    first = last = np.full(len(steps), duration / 2)
    square = duration * duration  # of a long one infinite, where ** raises an error
    if not square:
        return None
    rate = steps * (4 / square)
    way = np.abs(steps)
    too_fast = way > speed * (duration / 2 * (1 + _ROUNDING))
    if too_fast.any():
        cruise = way[too_fast] / speed[too_fast]  # the time of the whole displacement at maximum speed
        if (cruise >= duration).any():
            return None
        last = first.copy()
        last[too_fast] = cruise
        first[too_fast] = duration - cruise
        rate[too_fast] = np.copysign(speed[too_fast] / first[too_fast], steps[too_fast])
    if (np.abs(rate) > acceleration * (1 + _ROUNDING)).any():
        return None
    return Ramps(duration, np.zeros(len(steps)), rate, first, last)


def fit_matched_ramps(steps: Floats, duration: float, speed: Floats, acceleration: Floats) -> Ramps | None:
    """Return motions from rest to rest with common times of acceleration changes; None if there are none.

    The ramps are as short as the limits allow. Arguments are as for ``shortest_ramps``.
    """
    moving = steps != 0
    way, speed, acceleration = np.abs(steps[moving]), speed[moving], acceleration[moving]
    if not way.size:
        return Ramps(duration, np.zeros_like(steps), np.zeros_like(steps), *[np.full(len(steps), duration / 2)] * 2)
    cruise = float((way / speed).max())  # the time of the whole displacement at maximum speed
    product = float((way / acceleration).max())  # at least that of ramp and displacement over speed
    longest = min(duration / 2, duration - cruise)
    if longest <= 0 or longest * (duration - longest) < product * (1 - _ROUNDING):
        return None
    ramp = min((duration - max(duration * duration - 4 * product, 0.0) ** 0.5) / 2, longest)
    rate = steps / (ramp * (duration - ramp))
    first = np.full(len(steps), ramp)
    return Ramps(duration, np.zeros(len(steps)), rate, first, duration - first)


def fit_ramps(
    steps: Floats, start: Floats, end: Floats, duration: float, speed: Floats, acceleration: Floats
) -> Ramps | None:
    """Return motions of a given positive duration with minimal accelerations; None if the limits of a joint allow none.

    Both ramps of a joint have opposite accelerations. A joint that would become too fast cruises at its maximum speed.
    Arguments are as for ``shortest_ramps``.
    """
    change, excess = end - start, steps - (start + end) * (duration / 2)
    # From the area under two ramps: a^2 T^2 - 4 a (d - (v0 + v1) T / 2) - (v1 - v0)^2 = 0; with the greater root, the
    # change of acceleration within the time.
    side = np.where(excess < 0, -1.0, 1.0)
    rate = (2 * excess + side * np.sqrt(4 * excess**2 + (duration * change) ** 2)) / (duration * duration)
    divisor = np.where(rate != 0, rate, 1.0)
    first = last = np.clip((duration + change / divisor) / 2, 0.0, duration)
    cruise = start + rate * first
    too_fast = np.abs(cruise) > speed * (1 + _ROUNDING)
    if too_fast.any():
        limited = side * speed
        room = limited * duration - steps
        squares = (limited - start) ** 2 + (limited - end) ** 2
        rate = np.where(too_fast, squares / np.where(too_fast & (room != 0), 2 * room, 1.0), rate)
        divisor = np.where(rate != 0, rate, 1.0)
        first = np.where(too_fast, (limited - start) / divisor, first)
        last = np.where(too_fast, duration - (limited - end) / divisor, last)
    in_order = (first >= 0) & (last >= first - _ROUNDING * duration) & (last <= duration * (1 + _ROUNDING))
    if not in_order.all() or (np.abs(rate) > acceleration * (1 + _ROUNDING)).any():
        return None
    return Ramps(duration, start, rate, first, np.maximum(last, first))
