"""How a joint follows others."""

import numpy as np

from ravemj.core.transforms import Ints
from ravemj.errors import ErrorCode, RavemjError
from ravemj.model.manipulators import joint_dofs
from ravemj.model.mimic import Equations, leaders, with_equations
from ravemj.rave.joints.base import JointPart


class JointFollowing(JointPart):
    """The equations of a mimic joint."""

    def IsMimic(self, axis: int = -1) -> bool:
        """Return whether an axis follows other joints; -1 means any."""
        return self._scene.mimic is not None and axis <= 0

    def GetMimicEquation(self, axis: int = 0, itype: int = 0, format: str = "") -> str:  # OpenRAVE's names
        """Return how the joint follows others, as the file has it.

        Args:
            axis: Which axis; only the first one can follow.
            itype: 0 the position, 1 the partial derivatives for velocities, 2 those for accelerations.
            format: OpenRAVE's choice of notation; only the plain one is known here.

        Returns:
            The equation, with the names of joints; empty for a joint that follows none.
        """
        del format
        mimic = self._scene.mimic
        if mimic is None or axis != 0:
            return ""
        return (mimic.position, mimic.velocity, mimic.acceleration)[itype]

    def GetMimicDOFIndices(self, axis: int = 0) -> Ints:
        """Return the DOFs in the joint's own equation; as in OpenRAVE, not those of other followers in it.

        Args:
            axis: Which axis of the joint.
        """
        mimic = self._scene.mimic
        if mimic is None or axis or mimic.expression is None:
            return np.array([], dtype=np.int_)
        active = [leader for leader in leaders(mimic.expression) if leader < len(self._state.scene.joints)]
        dofs = {dof for leader in active for dof in joint_dofs(self._state.scene, leader)}
        return np.array(sorted(dofs), dtype=np.int_)

    def SetMimicEquations(self, axis: int, poseq: str, veleq: str = "", acceleq: str = "") -> None:
        """Change how a passive joint follows others. It stays where it is until joint values are next set.

        Args:
            axis: Which axis; only the first one can follow.
            poseq: The equation, with the names of joints, for instance ``2*lead + 0.1``.
            veleq: The partial derivatives for velocities, kept for ``GetMimicEquation``; velocities are computed.
            acceleq: Those for accelerations, kept too.

        Raises:
            openrave_exception: the equation cannot be used, or the joint has a DOF. Nothing has changed then.

        Example:
            >>> body.GetJoint("finger2").SetMimicEquations(0, "-finger1")
        """
        if self._is_active or axis or not poseq:
            message = f"SetMimicEquations: '{self._scene.name}' cannot follow '{poseq}': only joints without DOFs can"
            raise RavemjError(message, ErrorCode.NotImplemented)
        with self._state.simulation.lock:
            passive = with_equations(self._state.scene, self._index, Equations(poseq, veleq, acceleq))
            self._state.edit_mimic(passive)
