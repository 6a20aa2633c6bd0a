"""The command ``plan``."""

import argparse
import time
from collections.abc import Sequence

import numpy as np

from ravemj.cli.arms import arm_of, out_of_reach, pose_goal, reached, start_values, validated
from ravemj.cli.console import progress
from ravemj.cli.models import chosen_robots, load_model, moving_robot
from ravemj.cli.plan_output import Plan, check_output, write
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.rave import Environment, Planner, Robot, Trajectory
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.planning.path_planners import BiRrt
from ravemj.trajectories.motion import Motion

_POSE, _POINT = 7, 3  # numbers
_MOST_GOALS = 16  # solutions of inverse kinematics
_MOST_ITERATIONS = 10**9  # it is time that limits
_STEP = 0.01  # s, between the rows of a motion


def plan(options: argparse.Namespace) -> int:
    """Find a motion without collisions, and write it."""
    if options.output is not None:
        check_output(options.output)
    camera = None if options.camera is None else read_camera(options.camera)
    env = load_model(options)
    arm = _arm(env, options)
    robot = moving_robot(env, options.robot) if arm is None else arm.GetRobot()
    if options.start is not None:
        robot.SetDOFValues(start_values(options.start, robot), checklimits=0)
    dofs, goals = _values(robot, arm, options) if options.pose is None else _solutions(arm, options.pose)
    found, told = _planned(robot, arm, dofs, goals, options)
    if found.motion is not None:
        print(told)
    if options.output is not None:
        write(found, camera, options)
    if found.motion is None:
        raise RavemjError(f"no motion: {told}{_about_itself(told, robot, options.model)}")
    return 0


def _about_itself(told: str, robot: Robot, model: str) -> str:
    """Return a hint for a start at which a robot touches itself, as many do that have no SRDF."""
    if not told.startswith("start:") or told.count(f"of '{robot.GetName()}'") != 2:
        return ""
    return f"; ravemj check {model} --self lists links that always touch, and --write-srdf lets them"


def _arm(env: Environment, options: argparse.Namespace) -> Manipulator | None:
    """Return the manipulator that moves; None: joint values are the goal of a robot that has none."""
    robots = chosen_robots(env, options.robot)
    has_arms = any(robot.GetManipulators() for robot in robots)
    return arm_of(robots, options.manip) if has_arms or options.manip or options.pose else None


def _values(robot: Robot, arm: Manipulator | None, options: argparse.Namespace) -> tuple[list[int], Floats]:
    """Return what moves, DOF indices, and the joint values of ``--to``.

    Raises:
        ArgumentError: they are neither those of the arm, nor those of all DOFs.
    """
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
    """Return the DOF indices of the arm, and joint values that take its tool to a pose or point, the nearest first.

    Raises:
        ArgumentError: it is neither a pose nor a point.
        RavemjError: there are no such values.
    """
    assert arm is not None
    if len(pose) not in {_POSE, _POINT}:
        raise ArgumentError(f"--pose: found {len(pose)}, expected x,y,z,qw,qx,qy,qz or x,y,z")
    is_point = len(pose) == _POINT
    kind = IkParameterizationType.Translation3D if is_point else IkParameterizationType.Transform6D
    ways = reached(arm, np.array(pose) if is_point else pose_goal(pose, "--pose"), kind)
    if not ways:
        raise RavemjError(f"no motion: {out_of_reach(arm, kind)}")
    solutions = validated(arm, ways)
    good = [one.values for one in solutions if not one.trouble]
    if not good:
        nearest = "; ".join(solutions[0].trouble)
        count = f"all {len(ways)} ways there are" if len(ways) > 1 else "the only way there is"
        raise RavemjError(f"no motion: {count} beyond limits or in collision; the nearest: {nearest}")
    return arm.GetArmIndices().tolist(), np.array(good[:_MOST_GOALS])


def _planned(
    robot: Robot, arm: Manipulator | None, dofs: list[int], goals: Floats, options: argparse.Namespace
) -> tuple[Plan, str]:
    """Return what was planned, and how it went in words."""
    robot.SetActiveDOFs(dofs)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(goals.ravel())
    params.SetMaxIterations(_MOST_ITERATIONS)
    params.SetMaxPlanningTime(max(1, round(options.time_limit * 1000)))
    params.SetRandomGeneratorSeed(options.seed)
    planner, traj = BiRrt(robot.GetEnv(), "birrt"), Trajectory(robot.GetEnv(), "")
    begin = time.monotonic()
    planner.InitPlan(robot, params)
    with progress("planning", options.time_limit, "s") as advance:
        # The handle keeps the function; it has to live as long as the planner works.
        shown = planner.RegisterPlanCallback(lambda iteration: advance(time.monotonic() - begin))
        status = planner.PlanPath(traj)
        shown.Close()
    motion = _motion(robot, traj) if status else None
    told = status.description
    if motion is not None:
        points = f"{traj.GetNumWaypoints()} waypoints"
        told = f"{told} in {time.monotonic() - begin:.2f} s: {motion.duration:.3g} s of motion, {points}"
    return Plan(robot, arm, dofs, params, goals, planner.search, motion), told


def _motion(robot: Robot, traj: Trajectory) -> Motion:
    """Return a trajectory as a motion of all DOFs of a robot."""
    times = np.append(np.arange(0.0, traj.GetDuration() - _STEP / 2, _STEP), traj.GetDuration())
    values = np.tile(robot.GetDOFValues(), (len(times), 1))
    values[:, robot.GetActiveDOFIndices()] = traj.SamplePoints2D(times, robot.GetActiveConfigurationSpecification())
    return Motion(times, values)
