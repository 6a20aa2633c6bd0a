"""How the affine DOFs of a body, the active parts of its base's pose, move it: velocities and Jacobians."""

import numpy as np

from ravemj.core.transforms import Floats, Pose, Vec3, wxyz_jacobian
from ravemj.geometry_functions.affine import DOFAffine, affine_values

_TRANSLATIONS = (DOFAffine.X, DOFAffine.Y, DOFAffine.Z)


def translation_columns(affinedofs: int) -> list[int]:
    """Return which of X, Y and Z, counted from 0, are among affine DOFs."""
    return [column for column, part in enumerate(_TRANSLATIONS) if part & affinedofs]


class AffineMotion:
    """The motion of a base by its affine DOFs, at one pose.

    ``translations`` are those of X, Y and Z among them, counted from 0. ``angular`` is the base's angular velocity in
    the world per unit of the rates of the rotation's values, shape (3, 0, 1, 3 or 4).
    """

    def __init__(self, pose: Pose, affinedofs: int, axis: Vec3) -> None:
        self._origin = np.array(pose.position)
        self.translations = translation_columns(affinedofs)
        self.angular = _angular_jacobian(pose, affinedofs, axis)

    def rates(self, velocity: Floats) -> Floats:
        """Return the rates of the affine values, shape (n,), that a velocity of the base shows.

        It is that of the base's origin [m/s] and the angular one [rad/s], in world axes, shape (6,).
        """
        return np.concatenate([velocity[:3][self.translations], np.linalg.pinv(self.angular) @ velocity[3:]])

    def velocity(self, rates: Floats, before: Floats) -> Floats:
        """Return the velocity of the base, shape (6,), with rates of the affine values; the rest is as before."""
        velocity, split = before.copy(), len(self.translations)
        velocity[self.translations] = rates[:split]
        if self.angular.shape[1]:
            velocity[3:] = self.angular @ rates[split:]
        return velocity

    def translation_jacobian(self, point: Floats) -> Floats:
        """Return the derivative of a point that moves with the base by the affine values, shape (3, n)."""
        turned = np.cross(self.angular.T, point - self._origin).T
        return np.hstack([np.eye(3)[:, self.translations], turned])

    def rotation_jacobian(self) -> Floats:
        """Return the base's angular velocity per unit of the rates of the affine values, shape (3, n)."""
        return np.hstack([np.zeros((3, len(self.translations))), self.angular])


def _angular_jacobian(pose: Pose, affinedofs: int, axis: Vec3) -> Floats:
    if affinedofs & DOFAffine.RotationAxis:
        return np.array(axis).reshape(3, 1)
    if affinedofs & DOFAffine.Rotation3D:
        from ravemj.engine.dynamics import rotation_rate  # noqa: PLC0415 - slow to import

        rate, _ = rotation_rate(affine_values(pose, DOFAffine.Rotation3D))
        return rate.T  # the left Jacobian of SO(3) is the right one's transpose
    if affinedofs & DOFAffine.RotationQuat:
        return 4 * wxyz_jacobian(pose.wxyz).T
    return np.zeros((3, 0))
