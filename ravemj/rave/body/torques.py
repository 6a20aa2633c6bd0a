"""Torques at the joints of a body."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.rave.body.base import BodyPart


class Torques(BodyPart):
    """Torques for physics engines."""

    def SetDOFTorques(self, torques: ArrayLike, add: bool = False) -> None:
        """Let torques act on the joints during the next step of simulation time, and not longer.

        They need a physics engine: ``env.SetPhysicsEngine("mujoco")``. Without one they do nothing.

        Args:
            torques: Torques [N m, for sliders N], shape (dof,).
            add: Whether torques that were set for that step stay.

        Raises:
            ArgumentError: the number of torques is wrong.

        Example:
            >>> robot.SetDOFTorques(robot.ComputeInverseDynamics([0, 0]))  # hold against gravity
            >>> env.StepSimulation(0.01)
        """
        checked, dof = checked_numbers(torques, "SetDOFTorques: torques"), self.GetDOF()
        if checked.shape != (dof,) or not np.isfinite(checked).all():
            message = f"SetDOFTorques: torques has shape {checked.shape}, and should be finite, of shape ({dof},)"
            raise ArgumentError(message, ErrorCode.Assert)
        with self._simulation.lock:
            loads = self._env.GetPhysicsEngine().loads(self._state)
            if loads is not None:
                loads.torques = checked + add * loads.torques

    SetJointTorques = SetDOFTorques
