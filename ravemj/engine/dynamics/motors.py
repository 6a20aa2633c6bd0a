"""What the motors of joints need for themselves: inertia of rotors, and friction."""

from typing import Self

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.dynamics.tree import Tree
from ravemj.engine.kinematics import BodyKinematics

AT_REST = 1e-12
"""Speed [rad/s or m/s] that counts as none: dry friction jumps there, and speeds read off links are rounded."""


class Motors:
    """Motors of the joints between links, one for each velocity coordinate."""

    def __init__(self, armature: Floats, coulomb: Floats, viscous: Floats) -> None:
        """Take their data, each of shape (coordinates,).

        Inertia of the rotors behind their gears [kg m^2], friction at any speed [N m] and per speed [N m s/rad].
        """
        self._armature, self._coulomb, self._viscous = armature, coulomb, viscous

    @classmethod
    def of(cls, kinematics: BodyKinematics, tree: Tree) -> Self | None:
        """Return the motors of a body; None if all its joints move freely and without rotors."""
        data = np.zeros((3, tree.count))
        for joint, places in zip(kinematics.body.all_joints, kinematics.joint_qpos, strict=True):
            for axis, place in zip(joint.axes, places, strict=False):
                numbers = axis.armature, axis.coulomb_friction, axis.viscous_friction
                data[:, tree.of_qpos[place]] = numbers
        return cls(*data) if data.any() else None

    def torques(self, speeds: Floats, accelerations: Floats) -> Floats:
        """Return the torques and forces [N m or N] that motors need at speeds and accelerations of the coordinates.

        All three have the same shape (coordinates, ...).
        """
        armature, coulomb, viscous = (
            one.reshape(-1, *(1,) * (speeds.ndim - 1)) for one in (self._armature, self._coulomb, self._viscous)
        )
        direction = np.where(np.abs(speeds) > AT_REST, np.sign(speeds), 0.0)
        return armature * accelerations + coulomb * direction + viscous * speeds
