"""Spherical joints: rotation vectors for users, quaternions for MuJoCo."""

from collections.abc import Sequence
from typing import NamedTuple

from ravemj.core.transforms import conjugate, multiply
from ravemj.model.joints import rotation_vector, wxyz_from_rotation_vector
from ravemj.model.scene import Joint


class SphericalJoint(NamedTuple):
    """A spherical joint: three DOFs that are a rotation vector, and a quaternion in ``qpos``."""

    joint: Joint
    dofs: slice
    qpos: slice

    def to_qpos(self, vector: Sequence[float]) -> tuple[float, float, float, float]:
        """Return MuJoCo's quaternion; it turns in the child's axes, the rotation vector in the parent's."""
        rest = self.joint.T_parent_child.wxyz
        turned = wxyz_from_rotation_vector((vector[0], vector[1], vector[2]))
        return multiply(conjugate(rest), multiply(turned, rest))

    def to_values(self, wxyz: Sequence[float]) -> tuple[float, float, float]:
        """Return the rotation vector of MuJoCo's quaternion."""
        rest = self.joint.T_parent_child.wxyz
        w, x, y, z = wxyz
        return rotation_vector(multiply(rest, multiply((w, x, y, z), conjugate(rest))))
