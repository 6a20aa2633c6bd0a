"""The command ``plan``."""

import argparse
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ravemj.cli.arms import arm_of, beyond_all_limits, out_of_reach, pose_goal, reached, start_values, validated
from ravemj.cli.console import progress
from ravemj.cli.models import chosen_robots, load_model, moving_robot
from ravemj.cli.plan_output import Plan, check_output, write
from ravemj.cli.regions import goal_regions, upright
from ravemj.cli.robot_motions import set_accelerations
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.planning.certificates import Certificate
from ravemj.rave import Environment, Planner, Region, Robot, Trajectory
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.path_planners import BiRrt
from ravemj.rave.planning.region_goals import preshaped_dofs
from ravemj.trajectories.joint_trajectory import JointTrajectory
from ravemj.trajectories.joint_trajectory_files import is_joint_trajectory
from ravemj.trajectories.motion import Motion

_POSE, _POINT = 7, 3  # numbers
_MOST_GOALS = 16  # solutions of inverse kinematics
_MOST_ITERATIONS = 10**9  # the time limit applies
_STEP = 0.01  # sampling period of a motion [s]


class MotionGoal(NamedTuple):
    """Goal of a motion.

    Attributes:
        dofs: DOF indices of the moving joints.
        values: Alternative goal configurations, shape (n, len(dofs)).
        regions: Alternative goal regions of the tool, instead of ``values``.
    """

    dofs: list[int]
    values: Floats
    regions: list[Region]


def plan(options: argparse.Namespace) -> int:
    """Plan a collision-free motion, and write it."""
    if options.output is not None:
        check_output(options.output)
    camera = None if options.camera is None else read_camera(options.camera)
    env = load_model(options)
    arm = _arm(env, options)
    robot = moving_robot(env, options.robot) if arm is None else arm.GetRobot()
    if options.start is not None:
        robot.SetDOFValues(start_values(options.start, robot), checklimits=0)
    set_accelerations(robot, options.acceleration)
    regions = [] if arm is None else goal_regions(env, arm, options)
    planned, told = _planned(robot, arm, _goal(robot, arm, regions, options), options)
    if planned.motion is not None:
        print(told)
    if options.output is not None:
        write(planned, camera, options)
    if planned.motion is None:
        raise RavemjError(f"no motion: {told}{_about_itself(told, robot, options.model)}")
    return 0


def _goal(robot: Robot, arm: Manipulator | None, regions: list[Region], options: argparse.Namespace) -> MotionGoal:
    """Return the moving DOFs and the goal: goal regions, joint values, or IK solutions of a pose."""
    if arm is not None and regions:
        dofs = [*arm.GetArmIndices().tolist(), *preshaped_dofs(arm, regions)]
        return MotionGoal(dofs, np.zeros((0, len(dofs))), regions)
    dofs, values = _values(robot, arm, options) if options.pose is None else _solutions(arm, options.pose)
    return MotionGoal(dofs, values, [])


def _about_itself(told: str, robot: Robot, model: str) -> str:
    """Return a hint if the message ``told`` is that the robot's start is in self-collision, common without an SRDF."""
    if not told.startswith("start:") or told.count(f"of '{robot.GetName()}'") != 2:
        return ""
    return f"; ravemj check {model} --self lists links that always touch, and --write-srdf lets them"


def _arm(env: Environment, options: argparse.Namespace) -> Manipulator | None:
    """Return the moving manipulator; None if the goal is joint values and the robot has no manipulator."""
    robots = chosen_robots(env, options.robot)
    has_arms = any(robot.GetManipulators() for robot in robots)
    needs_arm = options.manip or options.pose or options.near or options.region or options.upright
    return arm_of(robots, options.manip) if has_arms or needs_arm else None


def _values(robot: Robot, arm: Manipulator | None, options: argparse.Namespace) -> tuple[list[int], Floats]:
    """Return the moving DOFs, all or the arm's, and their values from ``--to``, (1, n); raise if n fits neither."""
    every = list(range(robot.GetDOF()))
    dofs = every if arm is None else arm.GetArmIndices().tolist()
    if len(options.to) == len(every):
        dofs = every
    if len(options.to) != len(dofs):
        names = ", ".join(robot.GetJointFromDOFIndex(dof).GetName() for dof in dofs)
        moved = (arm or robot).GetName()
        message = f"--to: found {len(options.to)}, expected {len(dofs)}: one for each joint of '{moved}': {names}"
        raise ArgumentError(message)
    return dofs, np.array([options.to])


def _solutions(arm: Manipulator | None, pose: Sequence[float]) -> tuple[list[int], Floats]:
    """Return the arm's DOFs and its valid IK solutions for a pose or point, nearest first; raise if there is none."""
    assert arm is not None
    if len(pose) not in {_POSE, _POINT}:
        raise ArgumentError(f"--pose: found {len(pose)}, expected x,y,z,qw,qx,qy,qz or x,y,z")
    is_point = len(pose) == _POINT
    kind = IkParameterizationType.Translation3D if is_point else IkParameterizationType.Transform6D
    goal = np.array(pose) if is_point else pose_goal(pose, "--pose")
    ways = reached(arm, goal, kind)
    if not ways:
        raise RavemjError(f"no motion: {out_of_reach(arm, goal, kind)}")
    solutions = validated(arm, ways)
    good = [solution.values for solution in solutions if not solution.trouble]
    if not good:
        nearest = "; ".join([*solutions[0].trouble, beyond_all_limits(arm, goal, kind)]).rstrip("; ")
        count = f"all {len(ways)} ways there are" if len(ways) > 1 else "the only way there is"
        raise RavemjError(f"no motion: {count} beyond limits or in collision; the nearest: {nearest}")
    return arm.GetArmIndices().tolist(), np.array(good[:_MOST_GOALS])


def _planned(robot: Robot, arm: Manipulator | None, goal: MotionGoal, options: argparse.Namespace) -> tuple[Plan, str]:
    robot.SetActiveDOFs(goal.dofs)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(goal.values.ravel())
    if arm is not None:
        robot.SetActiveManipulator(arm)
        if options.upright is not None:
            params.add_constraint(upright(arm, options.upright))
        if goal.regions:
            params.set_goal_sampler(goal.regions)
    params.SetMaxIterations(_MOST_ITERATIONS)
    params.SetMaxPlanningTime(max(1, round(options.time_limit * 1000)))
    params.SetRandomGeneratorSeed(options.seed)
    params.set_certify({"on": True, "off": False}.get(options.certify, "required"))
    planner, traj = BiRrt(robot.GetEnv(), "birrt"), Trajectory(robot.GetEnv(), "")
    begin = time.monotonic()
    planner.InitPlan(robot, params)
    with progress("planning", options.time_limit, "s") as advance:
        # The handle keeps the callback registered; it must exist while the planner runs.
        shown = planner.RegisterPlanCallback(lambda iteration: advance(time.monotonic() - begin))
        status = planner.PlanPath(traj)
        shown.Close()
    told, outcome = status.description, (None, None, None)
    if status:
        outcome = motion, _, certificate = _outcome(robot, traj, options)
        told = f"{told} in {time.monotonic() - begin:.2f} s: {motion.duration:.3g} s of motion, "
        told += f"{traj.GetNumWaypoints()} waypoints"
        if len(goal.regions) > 1:
            told = f"{told}, to region '{goal.regions[status.goal_index].name}'"
        if certificate is not None:
            told += f"\n{certificate}"
    notes = [*told.splitlines(), *_reasons(status)]
    plan = Plan(robot, arm, goal.dofs, params, goal.values, planner.search, *outcome, notes, status.examples)
    return plan, told


def _reasons(status: Planner.PlannerStatus) -> list[str]:
    """Return a text for each goal region with the numbers of its sampled poses by cause of rejection."""
    return [
        f"{sum(counts.values())} poses of region '{name}': "
        + ", ".join(f"{number} {cause}" for cause, number in counts.items())
        for name, counts in status.causes_by_region.items()
        if counts
    ]


def _outcome(
    robot: Robot, traj: Trajectory, options: argparse.Namespace
) -> tuple[Motion, JointTrajectory | None, Certificate | None]:
    """Return a trajectory's motion, points for a controller, and certificate, the last two None if not requested."""
    motion, points = _motion(robot, traj), None
    if options.output is not None and is_joint_trajectory(options.output):
        start = None if options.start is None else start_values(options.start, robot)
        points = robot.to_joint_trajectory(traj, rate=options.rate, start=start)
    if options.certify == "off":
        return motion, points, None
    certificate = _certificate(robot, motion) if points is None else robot.from_joint_trajectory(points).certify()
    return motion, points, certificate


def _certificate(robot: Robot, motion: Motion) -> Certificate:
    """Certify a motion as it is written to a file: straight joint-space lines between its rows."""
    spec = robot.GetConfigurationSpecificationIndices(range(robot.GetDOF()), "linear")
    spec.AddDeltaTimeGroup()
    traj = Trajectory(robot.GetEnv(), "")
    traj.Init(spec)
    traj.Insert(0, np.column_stack([motion.values, np.diff(motion.times, prepend=motion.times[0])]).ravel())
    return traj.certify()


def _motion(robot: Robot, traj: Trajectory) -> Motion:
    """Sample a trajectory of the active DOFs; return the motion of all DOFs of the robot."""
    times = np.append(np.arange(0.0, traj.GetDuration() - _STEP / 2, _STEP), traj.GetDuration())
    values = np.tile(robot.GetDOFValues(), (len(times), 1))
    values[:, robot.GetActiveDOFIndices()] = traj.SamplePoints2D(times, robot.GetActiveConfigurationSpecification())
    return Motion(times, values)
