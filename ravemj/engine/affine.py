"""Motion of a body by its affine DOFs, the active components of its base pose: velocities and Jacobians."""

import math
from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats, Pose, Vec3, wxyz_jacobian
from ravemj.geometry_functions.affine import DOFAffine, rotation_values

# Plain numbers, since combining flag members takes longer than the arithmetic.
_TRANSLATIONS = tuple(enumerate(map(int, (DOFAffine.X, DOFAffine.Y, DOFAffine.Z))))
_AXIS, _VECTOR, _QUATERNION = map(int, (DOFAffine.RotationAxis, DOFAffine.Rotation3D, DOFAffine.RotationQuat))
_SMALL = 1e-4
"""Squared angle below which the Taylor series of the left Jacobian is accurate to 1e-15."""


def translation_columns(affinedofs: int) -> list[int]:
    """Return the indices of the translational components, 0 for X to 2 for Z, among affine DOFs."""
    return [column for column, part in _TRANSLATIONS if part & affinedofs]


class AffineMotion:
    """Motion of a base by its affine DOFs, at one pose.

    ``translations`` are the indices, 0 to 2, of the translational DOFs. ``angular`` is the base's angular velocity in
    the world per rate of each rotational value, shape (3, k); k is 0, 1, 3 or 4.
    """

    def __init__(self, pose: Pose, affinedofs: int, axis: Vec3) -> None:
        self._origin = np.array(pose.position)
        self.translations = translation_columns(affinedofs)
        self.angular = _angular_jacobian(pose, affinedofs, axis)

    def rates(self, velocity: Floats) -> Floats:
        """Return the rates of the affine values, shape (n,), for a velocity of the base.

        The velocity is linear [m/s], then angular [rad/s], in world axes, shape (6,).
        """
        return np.concatenate([velocity[:3][self.translations], np.linalg.pinv(self.angular) @ velocity[3:]])

    def velocity(self, rates: Floats, before: Floats) -> Floats:
        """Return the base velocity ``before``, shape (6,), with its affine DOFs' components replaced by given rates."""
        velocity, split = before.copy(), len(self.translations)
        velocity[self.translations] = rates[:split]
        if self.angular.shape[1]:
            velocity[3:] = self.angular @ rates[split:]
        return velocity

    def translation_jacobian(self, point: Floats) -> Floats:
        """Return the Jacobian of the position of a point fixed to the base, with respect to the affine values, (3, n).

        ``point`` is its present world position [m], shape (3,).
        """
        split = len(self.translations)
        jacobian = np.zeros((3, split + self.angular.shape[1]))
        jacobian[self.translations, range(split)] = 1.0
        x, y, z = (point - self._origin).tolist()
        jacobian[:, split:] = np.array(((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))).dot(self.angular)
        return jacobian

    def rotation_jacobian(self) -> Floats:
        """Return the base's angular velocity in the world per rate of each affine value, shape (3, n)."""
        return np.hstack([np.zeros((3, len(self.translations))), self.angular])


def _angular_jacobian(pose: Pose, affinedofs: int, axis: Vec3) -> Floats:
    if affinedofs & _AXIS:
        return np.array(axis).reshape(3, 1)
    if affinedofs & _VECTOR:
        return left_jacobian(rotation_values(pose, DOFAffine.Rotation3D))
    if affinedofs & _QUATERNION:
        return 4 * wxyz_jacobian(pose.wxyz).T
    return np.zeros((3, 0))


def left_jacobian(vector: Sequence[float]) -> Floats:
    """Return the left Jacobian of SO(3), shape (3, 3): angular velocity in outer axes per rate of a rotation vector.

    It is I + a [v] + b [v]^2 with a = (1 - cos t) / t^2, b = (t - sin t) / t^3 and t = |v|.
    """
    x, y, z = vector
    square = x * x + y * y + z * z
    if square < _SMALL:
        a, b = 0.5 - square / 24 + square**2 / 720, 1 / 6 - square / 120
    else:
        t = math.sqrt(square)
        a, b = (1 - math.cos(t)) / square, (t - math.sin(t)) / (square * t)
    rest = 1 - b * square  # [v]^2 is v v^T - t^2 I
    return np.array(
        (
            (rest + b * x * x, b * x * y - a * z, b * x * z + a * y),
            (b * x * y + a * z, rest + b * y * y, b * y * z - a * x),
            (b * x * z - a * y, b * y * z + a * x, rest + b * z * z),
        )
    )
