"""Bounds of a displacement from position, velocity and acceleration limits, which are always consistent."""

from dataclasses import dataclass

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.ik.vectors import Floats


@dataclass(frozen=True, eq=False)
class MotionLimits:
    """Limits of the variables; infinite if a variable is unlimited.

    Attributes:
        lower: Lower limits of the values [rad or m], shape (n,).
        upper: Upper limits, shape (n,).
        velocity: Maximum velocities [rad/s or m/s], shape (n,).
        acceleration: Maximum accelerations [rad/s^2 or m/s^2], shape (n,).
    """

    lower: Floats
    upper: Floats
    velocity: Floats
    acceleration: Floats

    @cached_property
    def _accelerates(self) -> bool:
        return bool(np.isfinite(self.acceleration).any())

    def displacements(self, values: Floats, velocities: Floats, dt: float) -> tuple[Floats, Floats]:
        """Return the minimum and maximum displacements of the next ``dt`` seconds, shape (n,) each, lower <= upper.

        Velocity limits have precedence over acceleration limits, and these over position limits. So a variable outside
        of its limits returns as fast as possible. Near a limit it is slow enough to brake: after the displacement x,
        the stopping distance ``(x / dt)^2 / 2a`` remains; cf. F. Flacco et al., "Control of redundant robots under hard
        joint constraints", 2015.
        """
        highest = self.velocity * dt
        lowest = -highest
        below, above = self.lower - values, self.upper - values
        if self._accelerates:
            limited = np.isfinite(self.acceleration)
            change, speed = self.acceleration * dt, np.where(limited, velocities, 0.0)
            lowest, highest = _within(lowest, highest, (speed - change) * dt, (speed + change) * dt)
            below, above = -self._stopping(-below, change, dt), self._stopping(above, change, dt)
        return _within(lowest, highest, below, above)

    def _stopping(self, room: Floats, change: Floats, dt: float) -> Floats:
        """Return the largest displacement in a time step after which the joint can still stop before the limit.

        Args:
            room: Distance to the limit [rad or m].
            change: Largest change of velocity in ``dt`` [rad/s or m/s].
            dt: Time step [s].
        """
        with np.errstate(invalid="ignore"):
            speed = np.sqrt(change * change + 2 * self.acceleration * np.maximum(room, 0.0)) - change
        return np.where(np.isfinite(speed) & (room > 0), np.minimum(speed * dt, room), room)

    def reachable(self, values: Floats, step: float) -> tuple[Floats, Floats]:
        """Return the minimum and maximum displacements of at most ``step`` within the position limits."""
        return _within(
            np.full_like(values, -step), np.full_like(values, step), self.lower - values, self.upper - values
        )


def _within(lowest: Floats, highest: Floats, lower: Floats, upper: Floats) -> tuple[Floats, Floats]:
    """Return [lower, upper] clipped to [lowest, highest].

    If they do not overlap, both bounds are the end of [lowest, highest] that is nearest to [lower, upper].
    """
    least = np.minimum(np.maximum(lower, lowest), highest)
    return least, np.maximum(np.minimum(np.maximum(upper, lowest), highest), least)  # beyond a limit, lower > upper
