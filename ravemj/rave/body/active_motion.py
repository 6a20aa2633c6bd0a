"""Velocities and Jacobians of the active DOFs."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.geometry_functions.affine import DOFAffine, affine_values
from ravemj.rave.body.active import ActiveDofs
from ravemj.rave.body.dynamics import Motion, quaternion_rates
from ravemj.rave.enums import CheckLimitsAction

_AXES = (DOFAffine.X, DOFAffine.Y, DOFAffine.Z)


class ActiveMotion(ActiveDofs, Motion):
    """How the active DOFs move the robot. The base's parts move all of it."""

    def GetActiveDOFVelocities(self) -> Floats:
        """Return the velocities of the active values: of joints [rad/s or m/s], then of the base; shape (n,)."""
        with self._simulation.lock:
            base = self._state.link_velocities()[0]
            linear = [base[i] for i, part in enumerate(_AXES) if part & self.active_choice.affine]
            turning = np.linalg.pinv(self._base_turning()) @ base[3:]
            return np.concatenate([self.GetDOFVelocities(self._active_dofs()), linear, turning])

    def SetActiveDOFVelocities(self, velocities: ArrayLike, checklimits: int = CheckLimitsAction.CheckLimits) -> None:
        """Set the velocities of the active values; what is not active keeps its own.

        Args:
            velocities: Those of the joints [rad/s or m/s], then those of the base's active parts.
            checklimits: What to do with joint velocities outside the limits, as in ``SetDOFVelocities``.

        Raises:
            ArgumentError: they are not as many as there are active values. Nothing has changed then.
        """
        given = checked_vector(velocities, self.GetActiveDOF(), "SetActiveDOFVelocities")
        joints, affine = self._active_dofs(), self.active_choice.affine
        with self._simulation.lock:
            base = self._state.link_velocities()[0]
            parts = [i for i, part in enumerate(_AXES) if part & affine]
            split = len(joints) + len(parts)
            base[parts] = given[len(joints) : split]
            if affine & DOFAffine.RotationMask:
                base[3:] = self._base_turning() @ given[split:]
            rates = self.GetDOFVelocities()
            rates[joints] = given[: len(joints)]
            self.SetDOFVelocities(rates, base[:3], base[3:], checklimits)

    def CalculateActiveJacobian(self, linkindex: int, offset: ArrayLike) -> Floats:
        """Return how a point of a link moves with the active values.

        Args:
            linkindex: Index of the link.
            offset: The point, in world coordinates [m], shape (3,).

        Returns:
            Derivative of the point's position in the world, shape (3, active dof).
        """
        point = checked_vector(offset, 3, "offset")
        with self._simulation.lock:
            joints = self.GetActiveDOFIndices()
            arm = point - self.GetTransform()[:3, 3]
            turned = np.cross(self._base_turning().T, arm).T
            moved = np.eye(3)[:, [i for i, part in enumerate(_AXES) if part & self.active_choice.affine]]
            return np.hstack([self.ComputeJacobianTranslation(linkindex, point)[:, joints], moved, turned])

    def CalculateActiveAngularVelocityJacobian(self, linkindex: int) -> Floats:
        """Return the angular velocity of a link, in world axes, per unit of the active values' velocity.

        Args:
            linkindex: Index of the link.

        Returns:
            Shape (3, active dof).
        """
        with self._simulation.lock:
            joints, turning = self.GetActiveDOFIndices(), self._base_turning()
            still = np.zeros((3, self.GetActiveDOF() - len(self._active_dofs()) - turning.shape[1]))
            return np.hstack([self.ComputeJacobianAxisAngle(linkindex)[:, joints], still, turning])

    def CalculateActiveRotationJacobian(self, linkindex: int, quat: ArrayLike) -> Floats:
        """Return how a quaternion turns with a link.

        Args:
            linkindex: Index of the link.
            quat: The quaternion [w, x, y, z]: the link's orientation, or that of anything fixed to it.

        Returns:
            Its derivative by the active values, shape (4, active dof).
        """
        return quaternion_rates(quat) @ self.CalculateActiveAngularVelocityJacobian(linkindex)

    def _base_turning(self) -> Floats:
        """Return the base's angular velocity per unit of its active rotation's velocity, shape (3, 0, 1, 3 or 4)."""
        affine = self.active_choice.affine
        pose = self._state.pose()
        if affine & DOFAffine.RotationAxis:
            return np.array(self.active_choice.axis).reshape(3, 1)
        if affine & DOFAffine.Rotation3D:
            from ravemj.engine.dynamics import rotation_rate  # noqa: PLC0415 - rarely wanted

            rate, _ = rotation_rate(affine_values(pose, DOFAffine.Rotation3D))
            return rate.T  # the left Jacobian of SO(3) is the right one's transpose
        if affine & DOFAffine.RotationQuat:
            return 4 * quaternion_rates(pose.wxyz).T
        return np.zeros((3, 0))
