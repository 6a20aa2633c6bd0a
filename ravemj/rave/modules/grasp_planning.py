"""Motions of an arm to one of given grasps: ``GraspPlanning`` of the module ``TaskManipulation``."""

import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ravemj.core.blocks import block
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.manipulation.options import GraspMotion, JointMotion
from ravemj.rave.enums import IkFilterOptions, SaveParameters
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules.base_manipulation import BaseManipulation
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.robot import Robot
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization
from ravemj.rave.trajectory import Trajectory

_STEP = 0.01
"""The distance of the tested poses on the line from the approach to the grasp [m]."""

_IN_LIMITS = 1e-3
"""The tolerance of the limits for values of a preshape [rad or m], as in OpenRAVE."""

_CHECKED = int(IkFilterOptions.CheckEnvCollisions)
_SAVED = SaveParameters.LinkTransformation | SaveParameters.LinkEnable


@dataclass(frozen=True)
class GraspQuery:
    """A list of grasps, and how to choose from it.

    Attributes:
        target: The body to grasp.
        grasps: One grasp in each row, shape (n, m).
        indices: The first column of each property of a grasp, by OpenRAVE's names: ``igrasptrans`` (``T_target_tool``,
            12 numbers by columns) or ``grasptrans_nocol``, which has precedence; ``igraspdir`` (the approach direction
            of the hand in the target frame), ``imanipulatordirection`` (the same in the tool frame), ``igrasppreshape``
            (the values of the gripper).
        places: ``T_world_target`` of places to put the target down; a grasp has to reach one of them.
        options: How to choose.
    """

    target: KinBody
    grasps: Floats
    indices: Mapping[str, int]
    places: Sequence[Floats]
    options: GraspMotion


class GraspPlan(NamedTuple):
    """A motion to a grasp.

    Attributes:
        goals: The goals of the tool at the places, for this grasp.
        number: The index of the grasp.
        seconds: The time that the planner took [s].
        traj: The motion of the arm, and of those gripper joints whose values change.
    """

    goals: list[IkParameterization]
    number: int
    seconds: float
    traj: Trajectory


@dataclass
class _Candidate:
    """A reachable grasp: its index, values of the gripper, of the arm there, and goals of the tool at the places."""

    index: int
    preshape: Floats
    rows: list[Floats] = field(default_factory=lambda: [])
    goals: list[IkParameterization] = field(default_factory=lambda: [])


def plan_grasp(base: BaseManipulation, query: GraspQuery) -> GraspPlan:
    """Return a motion of the arm to one of several grasps.

    Raises:
        ArgumentError: the list of grasps has no poses, or the robot holds the target already.
        PlanningError: no grasp can be reached.
    """
    manip = base.arm()
    if manip.IsGrabbing(query.target):
        raise ArgumentError(f"manipulator '{manip.GetName()}' holds '{query.target.GetName()}' already")
    if manip.GetIkSolver() is None:
        raise PlanningError(f"manipulator '{manip.GetName()}' has no solver of inverse kinematics (IK)")
    seconds, reachable, refused = 0.0, 0, "no grasp can be reached without collisions"
    found = _Candidates(base, manip, query).all()
    while batch := _first(found, max(1, query.options.seedgrasps)):
        reachable += len(batch)
        begin = time.perf_counter()
        try:
            effort = JointMotion(query.options.maxiter, 1, 0.03, query.options.steplength)
            traj, chosen = _planned(base, manip, batch, effort)
        except PlanningError as error:
            refused = f"{reachable} grasps can be reached, and there is no way to them: {error}"
            continue
        finally:
            seconds += time.perf_counter() - begin
        return GraspPlan(chosen.goals, chosen.index, seconds, traj)
    raise PlanningError(refused)


def _first(found: Iterator[_Candidate], count: int) -> list[_Candidate]:
    return [one for _, one in zip(range(count), found, strict=False)]


def _planned(
    base: BaseManipulation, manip: Manipulator, batch: Sequence[_Candidate], options: JointMotion
) -> tuple[Trajectory, _Candidate]:
    """Return a motion to one of the candidates, and that candidate."""
    robot = base.robot
    gripper = manip.GetGripperIndices()
    changed = np.array([one.preshape != robot.GetDOFValues(gripper) for one in batch]).any(axis=0)
    dofs = [*manip.description.arm_dofs, *gripper[changed].tolist()]
    owners = [one for one in batch for _ in one.rows]
    goals = [np.append(row, one.preshape[changed]) for one in batch for row in one.rows]
    traj = base.move_joints(goals, options, dofs=dofs)
    last = traj.GetWaypoint(-1, ConfigurationSpecification.of(base.groups(dofs)))
    return traj, owners[int(np.argmin([np.abs(goal - last).max() for goal in goals]))]


class _Candidates:
    """Finds the reachable grasps of a list."""

    def __init__(self, base: BaseManipulation, manip: Manipulator, query: GraspQuery) -> None:
        self._base, self._manip, self._query = base, manip, query
        self._random = np.random.default_rng(0)
        names = [name for name in ("grasptrans_nocol", "igrasptrans") if query.indices.get(name, -1) >= 0]
        if not names:
            raise ArgumentError("graspindices: should have 'igrasptrans' or 'grasptrans_nocol', the pose of the tool")
        self._pose = names[0]

    def all(self) -> Iterator[_Candidate]:
        """Yield the reachable grasps. Between two of them, the robot and the target are in their original state."""
        count, query = len(self._query.grasps), self._query
        for index in self._random.permutation(count).tolist() if query.options.randomgrasps else range(count):
            with _kept(self._base.robot, query.target):
                candidate = self._candidate(index)
            if candidate is not None:
                yield candidate

    def _numbers(self, index: int, name: str, count: int) -> Floats | None:
        """Return the numbers of a property of a grasp, or None if grasps do not have it."""
        start = self._query.indices.get(name, -1)
        row = self._query.grasps[index]
        if start < 0:
            return None
        if start + count > len(row):
            raise ArgumentError(f"graspindices: '{name}' is {start}, and grasps have {len(row)} numbers")
        numbers = row[start : start + count]
        if not np.isfinite(numbers).all():
            raise ArgumentError(f"grasps: '{name}' of grasp {index} is {numbers.tolist()}, and should be finite")
        return numbers

    def _candidate(self, index: int) -> _Candidate | None:
        """Return a grasp if it is reachable, else None. The robot and the target are moved."""
        query, manip = self._query, self._manip
        gripper = manip.GetGripperIndices()
        given = self._numbers(index, "igrasppreshape", len(gripper))
        preshape = self._base.robot.GetDOFValues(gripper) if given is None else given
        if len(gripper):
            lower, upper = self._base.robot.GetDOFLimits(gripper)
            if (preshape < lower - _IN_LIMITS).any() or (preshape > upper + _IN_LIMITS).any():
                return None
            preshape = np.clip(preshape, lower, upper)
            self._base.robot.SetDOFValues(preshape, gripper)
        T_target_tool = np.eye(4)
        numbers = self._numbers(index, self._pose, 12)
        assert numbers is not None, "the name is one of those that are there"
        T_target_tool[:3] = numbers.reshape(4, 3).T
        T_world_tool = query.target.GetTransform() @ T_target_tool
        found = _Candidate(index, preshape)
        found.rows = self._approaches(T_world_tool, self._direction(index, T_world_tool))
        if found.rows and query.places:
            found.goals = self._goals(T_target_tool)
        return found if found.rows and (found.goals or not query.places) else None

    def _direction(self, index: int, T_world_tool: Floats) -> Floats:
        """Return the approach direction of the hand, a unit vector in the world."""
        in_target = self._numbers(index, "igraspdir", 3)
        if in_target is not None:
            direction = self._query.target.GetTransform()[:3, :3] @ in_target
        else:
            in_tool = self._numbers(index, "imanipulatordirection", 3)
            in_tool = self._manip.GetLocalToolDirection() if in_tool is None else in_tool
            direction = T_world_tool[:3, :3] @ in_tool
        return direction / (np.linalg.norm(direction) or 1.0)

    def _approaches(self, T_world_tool: Floats, direction: Floats) -> list[Floats]:
        """Return the values of the arm before a grasp from which the tool reaches it along a straight line."""
        start = T_world_tool.copy()
        start[:3, 3] -= self._query.options.approachoffset * direction
        rows: list[Floats] = []
        for row in self._manip.search(_goal(start), _CHECKED).every():
            if self._gets_there(row, start, direction):
                rows.append(row)
            if len(rows) == self._query.options.seedik > 0:
                break
        return rows

    def _gets_there(self, row: Floats, start: Floats, direction: Floats) -> bool:
        count = int(np.ceil(self._query.options.approachoffset / _STEP))
        enabled = self._query.target.GetLinkEnableStates()

        def pose(number: int) -> tuple[Floats, bool]:
            T_world_goal = start.copy()
            T_world_goal[:3, 3] += direction * (self._query.options.approachoffset * number / count)
            return T_world_goal, True

        self._query.target.Enable(False)  # the hand may touch the body that it is about to grasp
        try:
            return len(self._base.follow(self._manip, pose, count, row)) == count + 1
        finally:
            self._query.target.SetLinkEnableStates(enabled)

    def _goals(self, T_target_tool: Floats) -> list[IkParameterization]:
        """Return the goals of the tool at the places where the target can be put down with a grasp."""
        query, found = self._query, list[IkParameterization]()
        count = len(query.places)
        for place in self._random.permutation(count).tolist() if query.options.randomdests else range(count):
            T_world_target = query.places[place]
            goal = _goal(T_world_target @ T_target_tool)
            if self._is_free(T_world_target) and self._is_reached(goal):
                found.append(goal)
            if len(found) == query.options.seeddests > 0:
                break
        return found

    def _is_free(self, T_world_target: Floats) -> bool:
        """Return whether the target at a place collides with nothing but the robot."""
        with _kept(self._base.robot, self._query.target):
            self._base.robot.Enable(False)
            self._query.target.SetTransform(T_world_target)
            return not self._base.env.CheckCollision(self._query.target)

    def _is_reached(self, goal: IkParameterization) -> bool:
        with _kept(self._base.robot, self._query.target):
            self._query.target.Enable(False)
            return len(self._manip.search(goal, _CHECKED).every()) > 0


def _goal(T_world_tool: Floats) -> IkParameterization:
    return IkParameterization(T_world_tool, IkParameterization.Type.Transform6D)


@block
def _kept(robot: Robot, target: KinBody) -> Generator[None]:
    """Restore the robot and the target on leaving."""
    with robot.CreateRobotStateSaver(_SAVED), target.CreateKinBodyStateSaver(_SAVED):
        yield
