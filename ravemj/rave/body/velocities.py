"""Velocities of a body, and torques that act on its joints."""

from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_first, checked_indices, checked_numbers, checked_point, checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Diagnostic, ErrorCode, send_warning
from ravemj.rave.body.limits import Limits
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.interface import Interface

ROUNDING = 1e-10
"""How far beyond its limit [rad/s or m/s] a velocity counts as within."""


class Velocities(Limits, Interface):
    """Velocities, by which nothing moves, but on which accelerations and inverse dynamics depend; joint torques.

    What is kept are the velocities of the links; those of the DOFs are read off them, as in OpenRAVE. So set joint
    values first, then velocities.
    """

    def GetDOFVelocities(self, indices: "ArrayLike | EllipsisType | None" = ...) -> Floats:
        """Return the joint velocities that the velocities of the links show.

        Args:
            indices: Which DOFs, in which order; left out: all. None and [] are no DOFs, as in OpenRAVE.

        Returns:
            Velocities [rad/s, for sliders m/s], shape (dof,); a copy.

        Raises:
            IndexError: there is no such DOF.
        """
        with self._simulation.lock:
            velocities = self._state.dynamics.dof_velocities(self._state.link_velocities())
        return velocities if indices is ... else velocities[checked_indices(indices, len(velocities))]

    def SetDOFVelocities(
        self,
        dofvelocities: ArrayLike,
        linear: "ArrayLike | None" = None,
        angular: "ArrayLike | None" = None,
        checklimits: int = CheckLimitsAction.CheckLimits,
        indices: "ArrayLike | None" = None,
    ) -> None:
        """Set the joint velocities: the links get the velocities that follow, and so does what they hold.

        OpenRAVE has three forms: ``(dofvelocities)``, ``(dofvelocities, checklimits, indices)`` and
        ``(dofvelocities, linear, angular, checklimits)``. In the first two the base keeps its velocity.

        Args:
            dofvelocities: Velocities [rad/s, for sliders m/s], as many as there are DOFs, or as there are indices;
                without indices further numbers do not count.
            linear: Velocity of the first link's origin in the world [m/s], shape (3,); a number is ``checklimits``.
            angular: Angular velocity of the first link in the world [rad/s], shape (3,); behind a number it is
                ``indices``.
            checklimits: What to do with values outside the velocity limits, a ``CheckLimitsAction``.
            indices: Which DOFs, in which order; None: all. As in OpenRAVE only the first DOFs count, as many as there
                are indices: of them those that are not chosen keep their velocities, and all others stop. So name all.

        Raises:
            ArgumentError: the number of velocities is wrong or one is infinite; with ``CheckLimitsThrow``, one is
                outside its limits. Nothing has changed then.
            IndexError: there is no such DOF.

        Example:
            >>> robot.SetDOFVelocities([0.5, -0.2])
            >>> robot.GetLinkVelocities()[2]
        """
        if linear is not None and np.ndim(linear) == 0:
            checklimits, indices = int(np.asarray(linear)), angular if indices is None else indices
            linear = angular = None
        with self._simulation.lock:
            velocities = self._state.link_velocities()
            base = np.zeros(6) if not len(velocities) else velocities[0]
            if linear is not None:
                base[:3] = checked_point(linear, "SetDOFVelocities: linear")
            if angular is not None:
                base[3:] = checked_point(angular, "SetDOFVelocities: angular")
            rates = self._limited_rates(self._full_rates(dofvelocities, indices), checklimits)
            if len(velocities):
                self._state.set_link_velocities(self._state.dynamics.link_velocities(rates, base))

    def _full_rates(self, dofvelocities: ArrayLike, indices: "ArrayLike | None") -> Floats:
        """Return one velocity for each DOF."""
        dof = self.GetDOF()
        if indices is None:
            return checked_first(dofvelocities, dof, "SetDOFVelocities") if dof else np.zeros(0)
        chosen = checked_indices(indices, dof)
        given = dict(zip(chosen.tolist(), checked_vector(dofvelocities, len(chosen), "SetDOFVelocities"), strict=True))
        first = self.GetDOFVelocities()[: len(chosen)]
        rates = np.zeros(dof)
        rates[: len(first)] = [given.get(place, rate) for place, rate in enumerate(first)]  # random-api-117, dof-24
        return rates

    def _limited_rates(self, rates: Floats, checklimits: int) -> Floats:
        if checklimits == CheckLimitsAction.Nothing:
            return rates
        limits = self.GetDOFVelocityLimits()
        if np.count_nonzero(np.abs(rates) <= limits) == len(rates):  # most often, and faster than what follows
            return rates
        limited = np.clip(rates, -limits, limits)
        outside = np.flatnonzero(np.abs(rates - limited) > ROUNDING)
        if len(outside) and checklimits != CheckLimitsAction.CheckLimitsSilent:
            dof = int(outside[0])
            joint = self._state.scene.joint_of_dof(dof)
            message = f"joint '{joint.name}' should have velocity {rates[dof]:.6g}, and its limit is {limits[dof]:.6g}"
            if checklimits == CheckLimitsAction.CheckLimitsThrow:
                raise ArgumentError(message)
            diagnostic = Diagnostic("warning", "value-outside-limits", f"{message}, which it gets", joint.source)
            send_warning(diagnostic)
        return limited

    def GetLinkVelocities(self) -> Floats:
        """Return the velocities of all links, in world axes.

        Returns:
            For each link that of its origin [m/s] and the angular one [rad/s], shape (links, 6); a copy.
        """
        with self._simulation.lock:
            return self._state.link_velocities()

    def SetLinkVelocities(self, velocities: ArrayLike) -> None:
        """Set the velocities of all links, in world axes; those of the DOFs follow from the differences.

        Args:
            velocities: For each link that of its origin [m/s] and the angular one [rad/s], shape (links, 6).

        Raises:
            ArgumentError: the shape is wrong, or something is infinite. Nothing has changed then.
        """
        shape = (len(self._state.scene.links), 6)
        checked = checked_numbers(velocities, "SetLinkVelocities")
        if checked.shape != shape or not np.isfinite(checked).all():
            raise ArgumentError(f"SetLinkVelocities: has shape {checked.shape}, and should be finite, of shape {shape}")
        with self._simulation.lock:
            self._state.set_link_velocities(checked)

    def SetVelocity(self, linear: ArrayLike, angular: ArrayLike) -> bool:
        """Let the whole body move as one, with its joints at rest.

        Args:
            linear: Velocity of the first link's origin in the world [m/s], shape (3,).
            angular: Angular velocity in the world [rad/s], shape (3,).

        Returns:
            False for a body without links.
        """
        moved = checked_vector(linear, 3, "SetVelocity: linear")
        turned = checked_vector(angular, 3, "SetVelocity: angular")
        if not self._state.scene.links:
            return False
        with self._simulation.lock:
            self._state.set_velocity(moved, turned)
        return True

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
