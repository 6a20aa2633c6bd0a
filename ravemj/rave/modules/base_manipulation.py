"""Motions of joints and of the tool: the module ``BaseManipulation``."""

from collections.abc import Callable, Sequence
from itertools import islice

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.motions import follow_goals, free_configuration, place_for_others
from ravemj.manipulation.options import JitterMotion, JointMotion, StraightMotion, ToolMotion, UnsyncMotion
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules.motions import Manipulation, Postprocessing
from ravemj.rave.planning.names import is_planner
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

_CHECKED = int(IkFilterOptions.CheckEnvCollisions)


class BaseManipulation(Manipulation):
    """Plans motions of the active DOFs, of an arm, or of its tool."""

    def move_manipulator(self, goals: Sequence[Floats], options: JointMotion) -> Trajectory:
        """Return a motion of the active manipulator's arm to one of several goals, each of shape (arm dof,).

        Raises:
            PlanningError: no motion was found.
        """
        return self.move_joints(goals, options, dofs=self.arm().description.arm_dofs)

    def arm(self) -> Manipulator:
        """Return the active manipulator.

        Raises:
            PlanningError: the robot has no active manipulator.
        """
        manip = self.robot.GetActiveManipulator()
        if manip is None:
            raise PlanningError(f"robot '{self.robot.GetName()}' has no active manipulator")
        return manip

    def move_to_hand_position(
        self,
        goals: Sequence[IkParameterization],
        options: ToolMotion,
        *,
        constraint: ToolConstraint | None = None,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
    ) -> Trajectory:
        """Return a motion of the arm that moves its tool to one of several goals.

        Args:
            goals: The goals of the tool.
            options: The effort of the search.
            constraint: The constraint of the tool along the whole motion; None for none.
            starts: The possible starts of the arm; by default its current values.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.

        Raises:
            PlanningError: no motion was found.
            ArgumentError: a number of solutions is negative.
        """
        if not goals:
            raise PlanningError("there is no goal")
        seedik, goalsamples = options.seedik, options.goalsamples
        if min(seedik, goalsamples) < 0:
            raise ArgumentError(f"seedik is {seedik} and goalsamples {goalsamples}, and both should be 0 or more")
        manip = self._solvable()
        stream = (row for goal in goals for row in manip.search(goal, _CHECKED).every())
        found = list(islice(stream, min(seedik, goalsamples)))
        if not found:
            raise PlanningError("inverse kinematics (IK) has no solution without collisions for any of the goals")
        rest = islice(stream, goalsamples - len(found))
        more = MoreGoals(lambda: next(rest, None), options.goalsampleprob)
        return self.move_joints(
            found,
            options,
            dofs=manip.description.arm_dofs,
            starts=starts,
            postprocessing=postprocessing,
            more=more,
            constraint=constraint,
        )

    def _solvable(self) -> Manipulator:
        manip = self.arm()
        if manip.GetIkSolver() is None:
            raise PlanningError(f"manipulator '{manip.GetName()}' has no solver of inverse kinematics (IK)")
        return manip

    def move_hand_straight(
        self,
        direction: Floats,
        options: StraightMotion,
        starteematrix: Floats | None = None,
    ) -> Trajectory:
        """Return a motion of the arm that moves its tool along a straight line, as far as the arm can follow.

        Args:
            direction: The direction of the line in the world, of any length, shape (3,).
            options: Its steps.
            starteematrix: ``T_world_tool`` at the start; by default the current pose.

        Raises:
            PlanningError: the arm can follow for less than ``minsteps`` steps.
        """
        length, stepsize = float(np.linalg.norm(direction)), options.stepsize
        if not (np.isfinite(length) and length > 0 and stepsize > 0):
            raise ArgumentError(f"direction {direction.tolist()} and stepsize {stepsize:g} should not be 0")
        manip = self._solvable()
        T_world_tool = manip.GetTransform() if starteematrix is None else starteematrix
        step = direction / length * stepsize
        present, reached = manip.GetArmDOFValues(), 0
        firsts = [present]
        if starteematrix is not None:
            firsts = _search(manip, T_world_tool, options.ignorefirstcollision < 0).every()
            firsts.sort(key=lambda row: float(np.abs(row - present).max()))

        def pose(number: int) -> tuple[Floats, bool]:
            T_world_goal = T_world_tool.copy()
            T_world_goal[:3, 3] += step * number
            return T_world_goal, number * stepsize > options.ignorefirstcollision

        for row in firsts:
            rows = self.follow(manip, pose, options.maxsteps, row)
            reached = max(reached, len(rows) - 1)
            if reached >= max(options.minsteps, 1):
                return self.straight(rows, manip.description.arm_dofs)
        raise PlanningError(f"the tool gets {reached} steps far, and should get {max(options.minsteps, 1)}")

    def follow(
        self, manip: Manipulator, pose: Callable[[int], tuple[Floats, bool]], count: int, first: Floats
    ) -> Floats:
        """Return joint values with which the tool follows poses without jumps, as far as it gets, shape (m, n).

        Args:
            manip: The manipulator.
            pose: Returns ``T_world_tool`` and whether collisions count, for a number from 1 to ``count``.
            count: The number of poses.
            first: The joint values to start from, shape (n,), which are the first row.
        """
        space = self.stated(manip.description.arm_dofs).space()
        return follow_goals(space, first, count, lambda number: _search(manip, *pose(number)))

    def move_unsync_joints(
        self,
        hand: Floats,
        indices: Sequence[int],
        options: UnsyncMotion,
    ) -> Trajectory:
        """Return a motion of the active DOFs to a place where other joints can reach given values without collisions.

        The other joints themselves are not moved.

        Args:
            hand: The values for the other joints.
            indices: The DOF indices of the other joints.
            options: How to look for the place.

        Raises:
            PlanningError: no motion was found.
        """
        maxdivision = options.maxdivision
        if not np.isfinite(hand).all() or maxdivision < 1:
            message = f"jointvalues are {hand.tolist()} in {maxdivision} divisions"
            raise ArgumentError(f"{message}, and should be finite numbers in 1 at least")
        values, others = self.stated(), self.bodies_of(indices)
        space, here = values.space(), values.vectors["_vinitialconfig"]
        for attempt in range(options.maxtries):
            goal = place_for_others(values.conditions, space, here, others, hand, maxdivision, attempt)
            if goal is None:
                continue
            if goal is here:
                return self.straight(here[None])
            found = self._by(options.planner, lambda goal=goal: self.move_joints([goal], JointMotion()))
            if found is not None:
                return found
        raise PlanningError("there is no place where the joints can move to their values")

    def _by(self, planner: str, plan: Callable[[], Trajectory]) -> Trajectory | None:
        old, self.planner = self.planner, planner if is_planner(planner) else "birrt"
        try:
            return plan()
        except PlanningError:
            return None
        finally:
            self.planner = old

    def jitter_active(self, options: JitterMotion) -> tuple[Floats, Trajectory]:
        """Return a free configuration of the active DOFs near the current one, and the straight motion to it.

        Raises:
            PlanningError: none of the random configurations is free of collisions.
        """
        values = self.stated()
        here = values.vectors["_vinitialconfig"]
        found = free_configuration(values.conditions, values.space(), here, options.maxiter, options.jitter)
        if found is None:
            raise PlanningError(f"{options.maxiter} configurations within {options.jitter:g} are all in collision")
        return found, self.straight(here[None] if found is here else np.stack([here, found]))


def _search(manip: Manipulator, T_world_tool: Floats, check: bool) -> ArmSearch:
    options = IkFilterOptions.CheckEnvCollisions if check else IkFilterOptions.IgnoreSelfCollisions
    return manip.search(T_world_tool, int(options))
