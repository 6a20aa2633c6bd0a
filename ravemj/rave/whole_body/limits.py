"""Limits of whole-body inverse kinematics in the API."""

from dataclasses import dataclass

from ravemj.core.arrays import checked_number
from ravemj.ik.whole_body import MotionLimits
from ravemj.manipulation.whole_body import Moving


@dataclass(slots=True)
class WholeBodyLimits:
    """Limits of every step.

    Attributes:
        values: Whether to keep joint limits.
        velocities: Whether ``step`` and ``follow`` keep joint velocity limits.
        accelerations: Whether ``step`` and ``follow`` keep joint acceleration limits, and brake before joint limits.
        base_velocity: Maximum of each component of the base's twist [m/s and rad/s]; None means no limit.
    """

    values: bool = True
    velocities: bool = True
    accelerations: bool = False
    base_velocity: float | None = None


def limits_of(moving: Moving, limits: WholeBodyLimits) -> MotionLimits:
    """Return the numerical limits of the joint and base displacements of a step.

    Raises:
        ArgumentError: the velocity of the base is negative or no finite number.
    """
    if limits.base_velocity is not None:
        checked_number(limits.base_velocity, "limits.base_velocity", 0.0, " m/s")
    return moving.limits(
        values=limits.values,
        velocities=limits.velocities,
        accelerations=limits.accelerations,
        base_velocity=limits.base_velocity,
    )
