"""One polynomial for each segment: cubic or quintic."""

import math
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.retiming.segments import LONGER, MOST_ATTEMPTS, Limits, Rows, Segment

_SLACK = 1e-12
"""Relative: rounding."""


class Polynomial:
    """Drives each segment by the polynomial through values and derivatives at its ends."""

    interpolation: str
    order: int
    merges: bool

    def _first_time(self, way: Floats, limits: Limits) -> float:
        """Return the first time to try [s], for joints that all move: the least from rest to rest."""
        return self._from_rest_to_rest(way, limits)

    def _from_rest_to_rest(self, way: Floats, limits: Limits) -> float:
        """Return the least time from rest to rest [s]."""
        raise NotImplementedError

    def shortest(self, segment: Segment, limits: Limits) -> float:
        """Return the time of a segment [s]."""
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
            while duration < needed:
                duration *= LONGER
            return duration
        for _ in range(MOST_ATTEMPTS):
            if self._keeps_limits(segment, duration, limits):
                return duration
            duration *= LONGER
        return np.inf

    def drive(self, segment: Segment, duration: float, limits: Limits) -> Rows:
        """Return the one row of a segment."""
        del limits
        rest = np.zeros_like(segment.step)[None]
        rows = (segment.step[None], segment.end_velocity[None], *[rest] * (self.order - 1))
        return Rows(np.array([duration]), rows)

    def _keeps_limits(self, segment: Segment, duration: float, limits: Limits) -> bool:
        raise NotImplementedError


class Cubic(Polynomial):
    """A cubic with the velocities at the ends; the time grows by 5 % from the bare way over speed until limits hold."""

    interpolation = "cubic"
    order = 1
    merges = False

    def _first_time(self, way: Floats, limits: Limits) -> float:
        return float((way / limits.velocity).max())

    def _from_rest_to_rest(self, way: Floats, limits: Limits) -> float:
        by_speed, by_acceleration = 1.5 * way / limits.velocity, np.sqrt(6 * way / limits.acceleration)
        return float(max(by_speed.max(), by_acceleration.max()))

    def _keeps_limits(self, segment: Segment, duration: float, limits: Limits) -> bool:
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
    """A quintic with the velocities and without acceleration at the ends."""

    interpolation = "quintic"
    order = 2
    merges = True

    def _from_rest_to_rest(self, way: Floats, limits: Limits) -> float:
        by_speed = 15 / 8 * way / limits.velocity
        by_acceleration = np.sqrt(10 / np.sqrt(3) * way / limits.acceleration)
        with np.errstate(divide="ignore"):
            by_jerk = np.cbrt(60 * way / limits.jerk)
        return float(max(by_speed.max(), by_acceleration.max(), by_jerk.max()))

    def _keeps_limits(self, segment: Segment, duration: float, limits: Limits) -> bool:
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


def _only(limits: Limits, chosen: Any) -> Limits:  # noqa: ANN401 - a mask
    parts = (limits.lower, limits.upper, limits.velocity, limits.acceleration, limits.jerk)
    return Limits(limits.coordinates, *(part[chosen] for part in parts))
