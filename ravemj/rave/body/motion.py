"""Velocities, derivatives and dynamics of a body."""

from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.arrays import checked_indices, checked_vector
from ravemj.errors import ArgumentError
from ravemj.rave.body.base import BodyPart
from ravemj.rave.enums import CheckLimitsAction
from ravemj.transforms import Floats


class Motion(BodyPart):
    """Velocities, Jacobians and inverse dynamics."""

    def GetCenterOfMass(self) -> Floats:
        """Return the body's centre of mass in the world [m], shape (3,)."""
        links = self._state.scene.links
        masses = np.array([link.inertial.mass for link in links])
        local = np.array([(*link.inertial.com, 1.0) for link in links])
        with self._simulation.lock:
            transforms = self._state.link_transforms()
        return masses @ np.einsum("nij,nj->ni", transforms, local)[:, :3] / masses.sum()

    def GetDOFVelocities(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint velocities.

        Args:
            indices: Which DOFs, in which order; left out: all.

        Returns:
            Velocities [rad/s, for sliders m/s], shape (dof,); a copy.
        """
        velocities = self._state.dynamics.velocities.copy()
        return velocities if indices is ... else velocities[checked_indices(indices, len(velocities))]

    def SetDOFVelocities(
        self,
        dofvelocities: ArrayLike,
        linear: "ArrayLike | int" = 0,
        angular: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
    ) -> None:
        """Set the joint velocities. Nothing moves by it; ``ComputeInverseDynamics`` uses them.

        Args:
            dofvelocities: Velocities [rad/s, for sliders m/s], shape (dof,).
            linear: Velocity of the base [m/s], which has to be zero; as in OpenRAVE, a number here is ``checklimits``.
            angular: Angular velocity of the base [rad/s], which has to be zero.
            checklimits: What to do with values outside the velocity limits, a ``CheckLimitsAction``.

        Raises:
            ArgumentError: the number of velocities is wrong, one is infinite, or the base should move.
        """
        velocities = checked_vector(dofvelocities, self.GetDOF(), "SetDOFVelocities")
        if angular is None:
            checklimits = int(np.asarray(linear).reshape(-1)[0]) if np.ndim(linear) == 0 else checklimits
        elif np.any(linear) or np.any(angular):
            raise ArgumentError("SetDOFVelocities: the base cannot move here; give zeros")
        if checklimits != CheckLimitsAction.Nothing:
            limits = np.array([axis.max_velocity for axis in self._state.scene.dof_axes])
            if checklimits == CheckLimitsAction.CheckLimitsThrow and np.any(np.abs(velocities) > limits):
                raise ArgumentError(f"SetDOFVelocities: {velocities} are outside the limits {limits}")
            velocities = np.clip(velocities, -limits, limits)
        with self._simulation.lock:
            self._state.dynamics.velocities = velocities

    def ComputeJacobianTranslation(self, linkindex: int, position: ArrayLike) -> Floats:
        """Return how a point of a link moves with the joint values.

        Args:
            linkindex: Index of the link.
            position: The point, in world coordinates [m], shape (3,).

        Returns:
            Derivative of the point's position in the world by the DOF values, shape (3, dof).
        """
        return self._jacobian(linkindex, position)[0]

    def ComputeJacobianAxisAngle(self, linkindex: int) -> Floats:
        """Return how a link turns with the joint values.

        Args:
            linkindex: Index of the link.

        Returns:
            Angular velocity of the link, in world axes, per unit of DOF velocity, shape (3, dof).
        """
        return self._jacobian(linkindex, np.zeros(3))[1]

    def _jacobian(self, link: int, point: ArrayLike) -> tuple[Floats, Floats]:
        count = len(self._state.scene.links)
        if not 0 <= link < count:
            raise ArgumentError(f"linkindex is {link}, and should be from 0 to {count - 1}")
        with self._simulation.lock:
            return self._state.dynamics.jacobian(link, checked_vector(point, 3, "position"))

    def ComputeInverseDynamics(self, dofaccelerations: "ArrayLike | None") -> Floats:
        """Return the joint torques that accelerate the body as wanted, with its base at rest.

        At the present values and velocities, against the environment's gravity. Sliders give forces, and joints that
        others follow carry these too: where OpenRAVE errs about both, this is right.

        Args:
            dofaccelerations: Accelerations [rad/s^2, for sliders m/s^2], shape (dof,); None: none.

        Returns:
            Torques [N m, for sliders N], shape (dof,).
        """
        dof = self.GetDOF()
        wanted = np.zeros(dof) if dofaccelerations is None else dofaccelerations
        accelerations = checked_vector(wanted, dof, "ComputeInverseDynamics")
        with self._simulation.lock:
            return self._state.dynamics.inverse(accelerations)
