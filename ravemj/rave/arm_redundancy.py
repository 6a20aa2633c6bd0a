"""Motions of an arm that leave a goal reached."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats, inverse
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.rave.arm_ik import ArmIk

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

_Type = IkParameterizationType


class ArmRedundancy(ArmIk):
    """Motions of redundant arms, which have more joints than their goal needs."""

    def null_space(self, iktype: IkParameterizationType = _Type.Transform6D) -> Floats:
        """Return the joint velocities that leave the goal reached in which the tool is now.

        Args:
            iktype: What counts of where the tool is.

        Returns:
            An orthonormal basis of them, a velocity in each column, shape (arm dof, k). In singular configurations
            there are more than elsewhere.

        Example:
            >>> velocity = 0.1 * manip.null_space()[:, 0]
        """
        from ravemj.ik import null_space

        solver = self.ik_solver(iktype)
        with self._state.simulation.lock:
            return null_space(solver.chain, self._values(), solver.task, self._goal_now(iktype))

    def null_space_path(
        self, along: ArrayLike, iktype: IkParameterizationType = _Type.Transform6D, *, step: float = 0.05
    ) -> Floats:
        """Return configurations on a path that leaves the goal reached in which the tool is now; nothing moves.

        The path ends where a joint meets its limit, where it comes back to its start, or after a length of 2 pi.
        Nothing is tested for collision.

        Args:
            along: Joint velocities, shape (arm dof,); the path begins with what of them is in the null space.
            iktype: What counts of where the tool is.
            step: Distance of neighbouring configurations in joint space [rad or m].

        Returns:
            Joint values, the present ones first, shape (M, arm dof).

        Raises:
            openrave_exception: the arm cannot move that way while its goal stays reached.

        Example:
            >>> for values in manip.null_space_path([1, 0, 0, 0, 0, 0, 0]):
            ...     robot.SetDOFValues(values, manip.GetArmIndices())
        """
        from ravemj.ik import null_space_path

        solver = self.ik_solver(iktype)
        wanted = checked_vector(along, len(self._scene.arm_dofs), "null_space_path: along")
        if not (np.isfinite(step) and step > 0):
            raise ArgumentError(f"null_space_path: step is {step}, and should be above 0")
        with self._state.simulation.lock:
            goal, start = self._goal_now(iktype), self._values()
            try:
                return null_space_path(solver, goal, start, wanted, step=step)
            except ValueError as error:
                raise ArgumentError(f"null_space_path: {error}") from error

    def _values(self) -> Floats:
        return self._robot.GetDOFValues(self._scene.arm_dofs)

    def _goal_now(self, iktype: IkParameterizationType) -> Floats:
        """Return where the tool is in the base of the arm, as solvers take goals."""
        if iktype == _Type.Transform6D:
            return inverse(self._T_world_base()) @ self.GetTransform()
        return np.asarray(self.GetIkParameterization(iktype, inworld=False).GetValues())
