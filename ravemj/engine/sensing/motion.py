"""How the places of sensors move, and the values of joints."""

from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.physics import Physics
from ravemj.engine.simulation import BodyState


class Motion(NamedTuple):
    """How a place on a link moves, in world axes.

    Attributes:
        linear: Velocity of the place [m/s], shape (3,).
        angular: Angular velocity [rad/s], shape (3,).
    """

    linear: Floats
    angular: Floats


def motion_at(state: BodyState, link: int, point: Floats) -> Motion:
    """Return how a point on a link moves.

    Args:
        state: The body.
        link: Index of the link.
        point: The point, in the world [m], shape (3,).
    """
    velocity = state.present_velocities[link]
    arm = point - state.link_transform(link)[:3, 3]
    return Motion(velocity[:3] + np.cross(velocity[3:], arm), velocity[3:].copy())


def acceleration_at(physics: Physics, state: BodyState, link: int, point: Floats) -> Floats:
    """Return what an accelerometer at a point on a link measures: its acceleration without that of free fall.

    Args:
        physics: What moves the body.
        state: The body.
        link: Index of the link.
        point: The point, in the world [m], shape (3,).

    Returns:
        In world axes [m/s^2], shape (3,).
    """
    linear, angular = physics.link_acceleration(state, link)
    spin = state.present_velocities[link][3:]
    arm = point - state.link_transform(link)[:3, 3]
    return linear + np.cross(angular, arm) + np.cross(spin, np.cross(spin, arm))


def encoder_values(state: BodyState, resolution: tuple[float, ...]) -> tuple[Floats, Floats, Floats]:
    """Return what the encoders of a robot's joints read.

    Args:
        state: The body.
        resolution: Steps of the encoders [rad or m]: one for each DOF, one for all, or none.

    Returns:
        Values [rad or m], rounded to the steps, velocities [rad/s or m/s], and steps, each of shape (dof,).
    """
    values = state.kinematics.values()
    velocities = state.dynamics.dof_velocities(state.link_velocities())
    steps = np.broadcast_to(np.array(resolution or (0.0,)), values.shape).copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.where(steps > 0, np.round(values / steps) * steps, values)
    return values, velocities, steps
