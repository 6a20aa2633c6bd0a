"""Inverse kinematics of several arms of one robot."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.rave.enums import CheckLimitsAction, IkFilterOptions
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.specification import IkParameterization

_COLLISIONS = IkFilterOptions.CheckEnvCollisions


class MultiManipIKSolver:
    """IK solver of several arms whose tools reach their goals simultaneously.

    Args:
        manips: The arms, of one robot, each with a solver.

    Example:
        >>> solver = misc.MultiManipIKSolver([robot.GetManipulator("left"), robot.GetManipulator("right")])
        >>> left, right = solver.findMultiIKSolution([T_world_left, T_world_right])
    """

    def __init__(self, manips: Sequence[Manipulator]) -> None:
        self.manips = list(manips)
        if not self.manips or any(arm.GetRobot() != self.manips[0].GetRobot() for arm in self.manips):
            raise ArgumentError("MultiManipIKSolver: manips should be arms of one robot")
        self.robot = self.manips[0].GetRobot()

    def findMultiIKSolution(
        self,
        Tgrasps: Sequence[ArrayLike | IkParameterization],
        filteroptions: int = _COLLISIONS,
        dooptimize: bool = False,
    ) -> list[Floats] | None:
        """Return joint values for each arm such that the arms do not collide with each other.

        Args:
            Tgrasps: A goal for each arm, as for ``FindIKSolution``.
            filteroptions: ``IkFilterOptions`` combined with ``|``.
            dooptimize: Whether to return the solutions nearest to the present joint values instead of the first.

        Returns:
            Joint values of each arm, or None if there is no solution.
        """
        if len(Tgrasps) != len(self.manips):
            raise ArgumentError(f"findMultiIKSolution: {len(Tgrasps)} goals for {len(self.manips)} arms; give one each")
        alone = [self._alone(arm, goal, filteroptions) for arm, goal in zip(self.manips, Tgrasps, strict=True)]
        best, nearest = np.inf, None
        with self.robot:
            now = [arm.GetArmDOFValues() for arm in self.manips]
            for rows in itertools.product(*alone):
                away = sum(float(np.sum((row - start) ** 2)) for row, start in zip(rows, now, strict=True))
                if away < best and self._together(rows, filteroptions):
                    best, nearest = away, list(rows)
                    if not dooptimize:
                        break
        return nearest

    def _alone(self, arm: Manipulator, goal: ArrayLike | IkParameterization, options: int) -> Floats:
        """Return the IK solutions of one arm, with the links of the other arms disabled in collision checks."""
        others = {link.GetIndex() for other in self.manips if other != arm for link in self._moved(other)}
        enabled = [link for link in self.robot.GetLinks(sorted(others)) if link.IsEnabled()]
        try:
            for link in enabled:
                link.Enable(False)
            return arm.FindIKSolutions(goal, options)
        finally:
            for link in enabled:
                link.Enable(True)

    def _moved(self, arm: Manipulator) -> list[Link]:
        dofs = arm.GetArmIndices().tolist()
        joints = [self.robot.GetJointFromDOFIndex(dof).GetJointIndex() for dof in dofs]
        return [
            link for link in self.robot.GetLinks() if any(self.robot.DoesAffect(j, link.GetIndex()) for j in joints)
        ]

    def _together(self, rows: Sequence[Floats], options: int) -> bool:
        """Set the joint values of all arms; return whether the robot is then free of collisions."""
        for arm, row in zip(self.manips, rows, strict=True):
            self.robot.SetDOFValues(row, arm.GetArmIndices(), CheckLimitsAction.Nothing)
        if not options & IkFilterOptions.IgnoreSelfCollisions and self.robot.CheckSelfCollision():
            return False
        return not (options & _COLLISIONS and self.robot.GetEnv().CheckCollision(self.robot))
