"""Forces that sensors feel while physics is simulated."""

from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.physics import Physics
from ravemj.engine.simulation import BodyState
from ravemj.model.scene import ForceTorque


def wrench(physics: Physics, state: BodyState, link: int, T_world_sensor: Floats) -> tuple[Floats, Floats]:
    """Return the force with which its parent holds a link, and all that hangs on it, as MuJoCo's sensor does.

    Args:
        physics: What moves the body.
        state: The body.
        link: Index of the link.
        T_world_sensor: Pose of the sensor, shape (4, 4).

    Returns:
        Force on the link [N] and torque about the sensor's origin [N m], each of shape (3,), in the sensor's axes.
    """
    force, torque = physics.joint_wrench(state, link, T_world_sensor[:3, 3])
    axes = T_world_sensor[:3, :3]
    return force @ axes, torque @ axes


def corrected(device: ForceTorque, force: Floats, torque: Floats) -> tuple[Floats, Floats]:
    """Return force and torque as a calibrated device says them: with its sign and its matrix."""
    both = device.polarity * np.concatenate([force, torque])
    if device.correction:
        both = np.reshape(device.correction, (6, 6)) @ both
    return both[:3], both[3:]


class Touches(NamedTuple):
    """Where a link is touched, in the axes of a sensor.

    Attributes:
        positions: Points of contact [m], shape (n, 3).
        forces: Forces on the link there [N], shape (n, 3).
    """

    positions: Floats
    forces: Floats


def touches(physics: Physics, state: BodyState, link: int, T_world_sensor: Floats) -> Touches:
    """Return where a link is touched, and how strongly.

    Args:
        physics: What moves the body.
        state: The body.
        link: Index of the link.
        T_world_sensor: Pose of the sensor, shape (4, 4).
    """
    points, forces = physics.link_contacts(state, link)
    axes, origin = T_world_sensor[:3, :3], T_world_sensor[:3, 3]
    return Touches((points - origin) @ axes, forces @ axes)
