"""Joint values of a body."""

from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_indices, checked_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.kinematics import BodyKinematics
from ravemj.errors import ArgumentError, Diagnostic, send_warning
from ravemj.rave.body.base import BodyPart
from ravemj.rave.enums import CheckLimitsAction

ROUNDING = 2e-10
"""How far outside its limits [rad or m] OpenRAVE moves a value without a warning."""


class JointValues(BodyPart):
    """Joint values: forward kinematics."""

    def GetDOFValues(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint values.

        Args:
            indices: Which DOFs, in which order; left out: all. None and [] are no DOFs, as in OpenRAVE.

        Returns:
            Values [rad, for sliders m] in DOF order: that of the joints in the file, shape (dof,); a copy.

        Raises:
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFValues([0.5, -0.5])
            >>> robot.GetDOFValues()
            array([ 0.5, -0.5])
            >>> robot.GetDOFValues([1])  # the second joint only
            array([-0.5])
        """
        with self._simulation.lock:
            values = self._state.kinematics.values()
        return values if indices is ... else values[checked_indices(indices, len(values))]

    def SetDOFValues(
        self,
        values: ArrayLike,
        dofindices: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
    ) -> None:
        """Set joint values and place all links by them: forward kinematics.

        It happens at once, without dynamics; viewers show it.

        Args:
            values: Joint values [rad, for sliders m], as many as there are DOFs, or as there are indices. NaN leaves
                a joint as it is.
            dofindices: Which DOFs to set, in which order; None: all.
            checklimits: What to do with values outside the limits, a ``CheckLimitsAction``: by default they are
                moved to the limit with a warning. Circular joints have no limits.

        Raises:
            ArgumentError: the number of values is wrong or one is infinite; with ``CheckLimitsThrow``, one is outside
                its limits. Nothing has changed then.
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFValues([3.14 / 4, 3.14 / 4])
            >>> robot.SetDOFValues([1.57], [1])  # the second joint only
        """
        with self._simulation.lock:
            kinematics = self._state.kinematics
            target = self._full_values(kinematics, values, dofindices)
            if not kinematics.limits.contain(target):
                target = self._settled(target, checklimits)
            kinematics.set_values(target, clamp_mimic=checklimits != CheckLimitsAction.Nothing)
            self._state.moved()

    def _full_values(self, kinematics: BodyKinematics, values: ArrayLike, dofindices: "ArrayLike | None") -> Floats:
        """Return one value for each DOF, in DOF order."""
        given = checked_numbers(values, "SetDOFValues")
        dof = kinematics.dof
        if dofindices is None:
            if given.shape == (dof,):
                return given
            if dof:
                raise ArgumentError(
                    f"SetDOFValues: values has shape {given.shape}, and '{self.GetName()}' has {dof} DOFs: give {dof} "
                    f"numbers, or dofindices"
                )
            return np.zeros(0)
        indices = checked_indices(dofindices, dof)
        if given.ndim != 1 or len(given) < len(indices):
            raise ArgumentError(f"SetDOFValues: values has shape {given.shape} for {len(indices)} dofindices")
        full = kinematics.values()
        full[indices] = given[: len(indices)]
        return full

    def _settled(self, target: Floats, checklimits: int) -> Floats:
        """Replace NaN by the present values and, as ``checklimits`` says, values outside the limits."""
        kinematics = self._state.kinematics
        if np.isinf(target).any():
            raise ArgumentError(f"SetDOFValues: values are {target}, and should be finite")
        target = np.where(np.isnan(target), kinematics.values(), target)
        if checklimits == CheckLimitsAction.Nothing:
            return target
        limited = kinematics.limits.clamp(target)
        outside = np.flatnonzero(np.abs(target - limited) > ROUNDING)
        if len(outside) and checklimits != CheckLimitsAction.CheckLimitsSilent:
            self._report_limits(target, outside[0], checklimits)
        return limited

    def _report_limits(self, target: Floats, dof: np.intp, checklimits: int) -> None:
        joint, axis = self._state.scene.joint_of_dof(int(dof)), self._state.scene.dof_axes[dof]
        limits = f"[{axis.lower:.6g}, {axis.upper:.6g}]"
        message = f"joint '{joint.name}' is set to {target[dof]:.6g}, outside its limits {limits}"
        if checklimits == CheckLimitsAction.CheckLimitsThrow:
            raise ArgumentError(message)
        diagnostic = Diagnostic("warning", "value-outside-limits", f"{message}; it stops at the limit", joint.source)
        send_warning(diagnostic, 4)

    @property
    def qpos_indices(self) -> Ints:
        """Where each DOF is in MuJoCo's ``qpos``, shape (dof,); -1 for the DOF of a weld."""
        with self._simulation.lock:
            return self._simulation.compiled().qpos_indices(self._state)
