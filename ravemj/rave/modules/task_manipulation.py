"""Gripper motions, and arm motions to grasps: the module ``TaskManipulation``."""

import time
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself
from ravemj.errors import ArgumentError
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.grasping.closing import STEPS, Approach, Steps
from ravemj.manipulation.grasping.hands import grasp, hand_of
from ravemj.manipulation.grasps import Grasp, GraspingArm, GraspSearch, GraspTable
from ravemj.manipulation.motions import move_until_contact
from ravemj.manipulation.options import GraspMotion, JointMotion
from ravemj.manipulation.tool import ToolConstraint
from ravemj.planning.projection import PROJECTION_STEPS, project
from ravemj.rave.enums import IkFilterOptions
from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.modules.base_manipulation import BaseManipulation, Manipulation, Options
from ravemj.rave.planning import values as problems
from ravemj.rave.planning.parameters import PlannerParameters
from ravemj.rave.planning.planner import PlanningError
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization
from ravemj.rave.trajectory import Trajectory

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment


_CHECKED = int(IkFilterOptions.CheckEnvCollisions)


class GraspQuery(NamedTuple):
    """Grasp table, and the options of choosing a grasp.

    Attributes:
        target: The body to grasp.
        table: The grasps.
        places: ``T_world_target`` of poses to put the target down; a grasp has to reach one of them.
        options: The options of the choice.
    """

    target: KinBody
    table: GraspTable
    places: Sequence[Floats]
    options: GraspMotion


class GraspPlan(NamedTuple):
    """Motion to a grasp.

    Attributes:
        goals: The tool goals for putting the target down with this grasp.
        number: The index of the grasp.
        seconds: The time that the planner took [s].
        traj: The motion of the arm, and of those gripper joints whose values change.
    """

    goals: list[IkParameterization]
    number: int
    seconds: float
    traj: Trajectory


def plan_grasp(base: BaseManipulation, query: GraspQuery) -> GraspPlan:
    """Return a motion of the arm to one of several grasps.

    Raises:
        ArgumentError: the table of grasps has no poses, or the robot has grabbed the target already.
        PlanningError: no grasp can be reached.
    """
    manip = base.arm()
    if manip.IsGrabbing(query.target):
        raise ArgumentError(f"manipulator '{manip.GetName()}' holds '{query.target.GetName()}' already")
    if manip.GetIkSolver() is None:
        raise PlanningError(f"manipulator '{manip.GetName()}' has no solver of inverse kinematics (IK)")
    seconds, reachable, refused = 0.0, 0, "no grasp can be reached without collisions"
    candidates = _reachable(base, manip, query)
    while batch := list(islice(candidates, max(1, query.options.seedgrasps))):
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
        return GraspPlan([_goal(T) for T in chosen.T_world_goals], chosen.number, seconds, traj)
    raise PlanningError(refused)


def _reachable(base: BaseManipulation, manip: Manipulator, query: GraspQuery) -> Iterator[Grasp]:
    def search(T_world_tool: Floats) -> ArmSearch:
        return manip.search(_goal(T_world_tool), _CHECKED)

    state, arm, space = base.robot.simulation_state, manip.description, base.stated(manip.description.arm_dofs).space()
    hand = GraspingArm(state, arm, space, base.env.GetCollisionChecker, search)
    return GraspSearch(hand, query.target.simulation_state, query.table, query.places, query.options).all()


def _planned(
    base: BaseManipulation, manip: Manipulator, batch: Sequence[Grasp], options: JointMotion
) -> tuple[Trajectory, Grasp]:
    robot = base.robot
    gripper = manip.GetGripperIndices()
    changed = np.array([candidate.preshape != robot.GetDOFValues(gripper) for candidate in batch]).any(axis=0)
    dofs = [*manip.description.arm_dofs, *gripper[changed].tolist()]
    owners = [candidate for candidate in batch for _ in candidate.rows]
    goals = [np.append(row, candidate.preshape[changed]) for candidate in batch for row in candidate.rows]
    traj = base.move_joints(goals, options, dofs=dofs)
    last = traj.GetWaypoint(-1, ConfigurationSpecification.of(base.groups(dofs)))
    return traj, owners[int(np.argmin([np.abs(goal - last).max() for goal in goals]))]


def _goal(T_world_tool: Floats) -> IkParameterization:
    return IkParameterization(T_world_tool, IkParameterization.Type.Transform6D)


_STEP = 0.01
"""Step size of joint motions between two collision checks [rad or m]."""


_ANY = np.array([0.0, 0.0, 1.0])
"""Placeholder for the approach direction if the hand does not move."""


def _check_motion(directions: Floats, step: float) -> None:
    if not (np.isfinite(directions).all() and np.isfinite(step) and step > 0):
        wanted = "finite directions, and a step above 0"
        raise ArgumentError(f"movingdir is {directions.tolist()} with steps of {step:g}, and should be {wanted}")


def finger_steps(options: Options) -> Steps:
    """Return the step lengths that options select; the fine step is by default a hundredth of a given coarse step."""
    coarse = options.get("coarsestep", STEPS.coarse)
    fine = options.get("finestep", coarse / 100)
    return Steps(coarse, fine, options.get("translationstepmult", STEPS.per_radian))


class TaskManipulation(Manipulation):
    """Gripper motions, and arm motions to grasps, of one robot."""

    def __init__(self, env: "Environment") -> None:
        super().__init__(env)
        self._base = BaseManipulation(env)

    def plan_grasp(self, query: GraspQuery) -> GraspPlan:
        """Return a motion of the active manipulator's arm to one of several grasps.

        Raises:
            PlanningError: no grasp can be reached.
        """
        self._base.choose(self.robot.GetName())
        self._base.planner = self.planner
        return plan_grasp(self._base, query)

    def evaluate_constraints(
        self, constraint: ToolConstraint, configurations: Sequence[Floats]
    ) -> tuple[list[int], list[Floats]]:
        """Project configurations of the active DOFs, which are the arm's, onto a constraint.

        Return the number of steps for each, -1 if the projection fails, and the results.

        Raises:
            ArgumentError: the active DOFs are not the joints of the arm, or the constraint is invalid.
        """
        params = PlannerParameters()
        params.SetRobotActiveJoints(self.robot)
        values = params.resolved()
        tool = problems.hand_of(self.env, values).tool
        error, threshold, _ = tool.to_constraint(constraint)
        with tool.bodies.kept():
            projected = [
                project(configuration, error, values.space(), threshold, PROJECTION_STEPS)
                for configuration in configurations
            ]
        return [steps for steps, _ in projected], [row for _, row in projected]

    def close_fingers(
        self, directions: Floats | None = None, offsets: Floats | None = None, steps: Steps = STEPS
    ) -> tuple[Floats, Trajectory]:
        """Close the gripper, one finger after the other: return the values at contacts and limits, and the motion.

        Args:
            directions: Sign of the motion of each joint; None: the closing direction.
            offsets: Distance that each joint moves on after it has stopped, in its direction [rad or m].
            steps: Step lengths.

        Raises:
            PlanningError: the robot has no gripper.
        """
        dofs, closing = self._gripper()
        directions = closing if directions is None else directions
        final = end = self._fingers(dofs, directions, steps, Approach(_ANY, _ANY, flies=False, only_target=False))
        if offsets is not None:
            lower, upper = self.robot.GetDOFLimits(dofs)
            end = np.clip(final + np.sign(directions) * offsets, lower, upper)
        return final, self._motion(dofs, end)

    def release_fingers(
        self, directions: Floats | None = None, target: KinBody | None = None, steps: Steps = STEPS
    ) -> tuple[Floats, Trajectory]:
        """Open the gripper, one finger after the other, and release a target: return the last values and the motion.

        Fingers leave the contact that they start in, and stop before they touch anything else.

        Args:
            directions: Sign of the motion of each joint; None: against the closing direction.
            target: A grabbed body to release.
            steps: Step lengths.

        Raises:
            PlanningError: the robot has no gripper, or a finger cannot leave its contact.
        """
        dofs, closing = self._gripper()
        if target is not None:
            self.robot.Release(target)
        approach = Approach(_ANY, _ANY, flies=False, only_target=False, avoid_contact=True, leaves_contact=True)
        final = self._fingers(dofs, -closing if directions is None else directions, steps, approach)
        return final, self._motion(dofs, final)

    def _fingers(self, dofs: Sequence[int], directions: Floats, steps: Steps, approach: Approach) -> Floats:
        """Simulate fingers that move one after the other; return the joint values at which they stop."""
        _check_motion(directions, min(steps))
        manip, state = self.robot.GetActiveManipulator(), self.robot.simulation_state
        assert manip is not None, "it has a gripper"
        with self.env.simulation.lock:
            hand = hand_of(state, manip.description, dict(zip(dofs, directions.tolist(), strict=True)))
            world = self.env.GetCollisionChecker().world()
            closed = grasp(world, state, hand, None, approach, steps).closed
        if closed.reason is not None and closed.reason.kind != "self-collision":
            raise PlanningError(closed.reason)
        return closed.values[list(dofs)]

    def release_active(self, directions: Floats, step: float = _STEP) -> tuple[Floats, Trajectory]:
        """Move each active joint in its direction until contact or its limit; return the last values and the motion."""
        dofs = [int(dof) for dof in self.robot.GetActiveDOFIndices()]
        if len(directions) != len(dofs):
            raise ArgumentError(f"movingdir: has {len(directions)} numbers, and there are {len(dofs)} active joints")
        final = self._until_contact(dofs, directions, step)
        return final, self._motion(dofs, final)

    def _gripper(self) -> tuple[list[int], Floats]:
        manip = self.robot.GetActiveManipulator()
        dofs = [] if manip is None else [int(dof) for dof in manip.GetGripperIndices()]
        if manip is None or not dofs:
            raise PlanningError(f"robot '{self.robot.GetName()}' has no active manipulator with a gripper")
        return dofs, np.asarray(manip.GetChuckingDirection(), dtype=float)

    def _motion(self, dofs: Sequence[int], final: Floats) -> Trajectory:
        return self.straight(np.stack([self.robot.GetDOFValues(dofs), final]), dofs)

    def _until_contact(self, dofs: Sequence[int], directions: Floats, step: float) -> Floats:
        """Simulate joints that move until contact or to their limits; return the values at which they stop."""
        _check_motion(directions, step)
        return move_until_contact(
            self.bodies_of(dofs),
            self.robot.GetDOFLimits(dofs),
            np.sign(directions),
            step,
            lambda joint: self._touches(dofs[joint]),
        )

    def _touches(self, dof: int) -> bool:
        """Return whether a link moved by a DOF touches another body, or a link not moved by that DOF."""
        state, simulation = self.robot.simulation_state, self.env.simulation
        moved = MovedBy((dof,))
        with simulation.lock:
            world = self.env.GetCollisionChecker().world()
            return world.collide(body_and_others(world, state, moved)) or world.collide(itself(world, state, moved))
