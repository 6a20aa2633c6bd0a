"""Motions of joints and of the tool: the module ``BaseManipulation``."""

from collections.abc import Callable, Sequence
from itertools import islice
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.planning.edges import nearby
from ravemj.planning.rrt import MoreGoals
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules.motions import Manipulation, Postprocessing, SearchOptions
from ravemj.rave.planning.bodies import Bodies
from ravemj.rave.planning.names import is_planner
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.status import PlanningError
from ravemj.rave.specification import IkParameterization
from ravemj.rave.trajectory import Trajectory

_LARGEST_JUMP = 0.5
"""The largest step of a joint [rad or m] in one step of the tool along a line; a larger one is another IK branch."""


HAND_SEARCH = SearchOptions(tries=3, jitter=0.03)
"""OpenRAVE's defaults for motions to poses of the tool."""


class BaseManipulation(Manipulation):
    """Plans motions of the active DOFs, of an arm, or of its tool."""

    def move_active_joints(
        self,
        goals: Sequence[Floats],
        search: SearchOptions,
        *,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
        more: MoreGoals | None = None,
    ) -> Trajectory:
        """Return a motion of the active DOFs to one of several goals.

        Args:
            goals: The goals, each of shape (active dof,).
            search: The effort of the search.
            starts: The possible starts; by default the current configuration.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.
            more: A source of further goals while the planner works.

        Raises:
            PlanningError: no motion was found.
        """
        dof = self.robot.GetActiveDOF()
        if not len(goals):
            raise PlanningError("there is no goal")
        for one in [*goals, *starts]:
            if len(one) != dof or not np.isfinite(one).all():
                raise ArgumentError(f"a goal or start is {one.tolist()}, and should be {dof} finite numbers")
        return self.plan(goals, search, starts=starts, postprocessing=postprocessing, more=more)

    def move_manipulator(self, goals: Sequence[Floats], search: SearchOptions) -> Trajectory:
        """Return a motion of the joints of the active manipulator's arm to one of several goals.

        Args:
            goals: The goals, each of shape (arm dof,).
            search: The effort of the search.

        Raises:
            PlanningError: no motion was found.
        """
        with self.keeping_active():
            self.robot.SetActiveDOFs(self.arm().GetArmIndices())
            return self.move_active_joints(goals, search)

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
        search: SearchOptions,
        *,
        first: int = 8,
        samples: int = 40,
        probability: float = 0.1,
        starts: Sequence[Floats] = (),
        postprocessing: Postprocessing | None = None,
    ) -> Trajectory:
        """Return a motion of the arm that moves its tool to one of several goals.

        Args:
            goals: The goals of the tool.
            search: The effort of the search.
            first: The number of IK solutions that are goals from the start.
            samples: The largest number of IK solutions that are goals.
            probability: The fraction of the iterations that ask for a further IK solution.
            starts: The possible starts of the arm; by default its current values.
            postprocessing: The smoother and its parameters; by default OpenRAVE's.

        Raises:
            PlanningError: no motion was found.
            ArgumentError: a number of solutions is negative.
        """
        if not goals:
            raise PlanningError("there is no goal")
        if min(first, samples) < 0:
            raise ArgumentError(f"seedik is {first} and goalsamples {samples}, and both should be 0 or more")
        manip = self._solvable()
        stream = (row for goal in goals for row in solutions(manip, goal, IkFilterOptions.CheckEnvCollisions))
        found = list(islice(stream, min(first, samples)))
        if not found:
            raise PlanningError("inverse kinematics (IK) has no solution without collisions for any of the goals")
        rest = islice(stream, samples - len(found))
        more = MoreGoals(lambda: next(rest, None), probability)
        with self.keeping_active():
            self.robot.SetActiveDOFs(manip.GetArmIndices())
            return self.move_active_joints(found, search, starts=starts, postprocessing=postprocessing, more=more)

    def _solvable(self) -> Manipulator:
        manip = self.arm()
        if manip.GetIkSolver() is None:
            raise PlanningError(f"manipulator '{manip.GetName()}' has no solver of inverse kinematics (IK)")
        return manip

    def move_hand_straight(
        self,
        direction: Floats,
        *,
        step: float = 0.01,
        least: int = 0,
        most: int = 10000,
        start: Floats | None = None,
        ignored: float = 0.1,
    ) -> Trajectory:
        """Return a motion of the arm that moves its tool along a straight line, as far as the arm can follow.

        Args:
            direction: The direction of the line in the world, of any length, shape (3,).
            step: The distance between consecutive poses of the tool [m].
            least: The smallest number of steps.
            most: The largest number of steps.
            start: ``T_world_tool`` at the start; by default the current pose.
            ignored: The length of the line, from its start, in which collisions do not count [m].

        Raises:
            PlanningError: the arm can follow for less than ``least`` steps.
        """
        length = float(np.linalg.norm(direction))
        if not (np.isfinite(length) and length > 0 and step > 0):
            raise ArgumentError(f"direction {direction.tolist()} and stepsize {step:g} should not be 0")
        manip = self._solvable()
        T_world_tool = manip.GetTransform() if start is None else start.copy()
        reached = 0
        with self.keeping_active(), Bodies(self.env, self._arm_groups(manip)).kept():
            present = manip.GetArmDOFValues()
            self.robot.SetActiveDOFs(manip.GetArmIndices())
            first = [present] if start is None else self._nearest_first(manip, start, present, check=ignored < 0)
            for row in first:
                rows = self._along(manip, T_world_tool, direction / length * step, row, most, ignored)
                reached = max(reached, len(rows) - 1)
                if reached >= max(least, 1):
                    return self.straight(np.array(rows))
        raise PlanningError(f"the tool gets {reached} steps far, and should get {max(least, 1)}")

    def _along(
        self, manip: Manipulator, T_world_tool: Floats, step: Floats, first: Floats, most: int, ignored: float
    ) -> list[Floats]:
        """Return the arm's values in steps of the tool along a line, from its first values as far as it goes.

        Args:
            manip: The manipulator.
            T_world_tool: The first pose of the tool, shape (4, 4).
            step: The motion of the tool in one step, shape (3,) [m].
            first: The first values of the arm.
            most: The maximum number of steps.
            ignored: The distance from the start in which collisions do not count [m].
        """
        rows = [first]
        for number in range(1, most + 1):
            pose = T_world_tool.copy()
            pose[:3, 3] += step * number
            is_free = number * float(np.linalg.norm(step)) <= ignored
            row = self.next_solution(manip, pose, rows[-1], check=not is_free)
            if row is None:
                break
            rows.append(row)
        return rows

    def _arm_groups(self, manip: Manipulator) -> Any:  # noqa: ANN401 - groups
        return manip.GetArmConfigurationSpecification().GetGroups()

    def next_solution(self, manip: Manipulator, pose: Floats, before: Floats, *, check: bool) -> Floats | None:
        """Return the IK solution nearest to joint values, or None if none is near them and free of collisions."""
        found = self._nearest_first(manip, pose, before, check=check)
        return found[0] if found and np.abs(found[0] - before).max() <= _LARGEST_JUMP else None

    def _nearest_first(self, manip: Manipulator, pose: Floats, before: Floats, *, check: bool) -> list[Floats]:
        """Return the IK solutions for a pose, in the order of their distances from joint values."""
        self.robot.SetDOFValues(before, manip.GetArmIndices())
        options = IkFilterOptions.CheckEnvCollisions if check else IkFilterOptions.IgnoreSelfCollisions
        found = solutions(manip, IkParameterization(pose, IkParameterization.Type.Transform6D), options)
        return sorted(found, key=lambda row: float(np.abs(row - before).max()))

    def move_unsync_joints(
        self, hand: Floats, indices: Sequence[int], *, tries: int = 1, divisions: int = 10, planner: str = "BasicRRT"
    ) -> Trajectory:
        """Return a motion of the active DOFs to a place where other joints can reach given values without collisions.

        The other joints themselves are not moved.

        Args:
            hand: The values for the other joints.
            indices: The DOF indices of the other joints.
            tries: The number of attempts.
            divisions: The number of steps in which the motion of the other joints is tested.
            planner: The name of the planner.

        Raises:
            PlanningError: no motion was found.
        """
        robot = self.robot
        if not np.isfinite(hand).all() or divisions < 1:
            message = f"jointvalues are {hand.tolist()} in {divisions} divisions"
            raise ArgumentError(f"{message}, and should be finite numbers in 1 at least")
        params = PlannerParameters()
        params.SetRobotActiveJoints(robot)
        values, before = params.resolved(), robot.GetDOFValues(indices)
        space, here = values.space(), values.vectors["_vinitialconfig"]
        assert values.bodies is not None
        moving = Bodies(self.env, robot.GetConfigurationSpecificationIndices(indices).GetGroups())
        test = values.allowed()

        def hand_can_move(active: Floats) -> bool:
            if not test(active):
                return False
            try:
                parts = np.linspace(0.0, 1.0, divisions + 1)[1:]
                return all(_free(moving, before + part * (hand - before)) for part in parts)
            finally:
                moving.move(before)

        farthest = float((space.upper - space.lower).max())
        for attempt in range(tries):
            with values.bodies.kept(), moving.kept():
                random = np.random.default_rng(attempt)
                goal = nearby(space, here, hand_can_move, 1000, farthest, random)
            if goal is None:
                continue
            if goal is here:
                return self.straight(here[None])
            found = self._by(planner, lambda goal=goal: self.move_active_joints([goal], SearchOptions()))
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

    def jitter_active(self, tries: int = 5000, jitter: float = 0.03) -> tuple[Floats, Trajectory]:
        """Return a nearby configuration of the active DOFs without collisions, and the straight motion to it.

        Args:
            tries: The number of random configurations to test.
            jitter: The largest change of each value [rad or m].

        Raises:
            PlanningError: no tested configuration is free of collisions.
        """
        params = PlannerParameters()
        params.SetRobotActiveJoints(self.robot)
        values = params.resolved()
        here = values.vectors["_vinitialconfig"]
        assert values.bodies is not None
        with values.bodies.kept():
            random = np.random.default_rng(0)
            found = nearby(values.space(), here, values.allowed(), tries, jitter, random)
        if found is None:
            raise PlanningError(f"{tries} configurations within {jitter:g} are all in collision")
        return found, self.straight(here[None] if found is here else np.stack([here, found]))


def _free(bodies: Bodies, values: Floats) -> bool:
    bodies.move(values)
    return not bodies.collision()


def solutions(manip: Manipulator, goal: IkParameterization, options: int) -> list[Floats]:
    """Return the joint values of an arm that reach a goal."""
    return [np.asarray(row, dtype=float) for row in manip.FindIKSolutions(goal, int(options))]
