"""Motions for robot controllers, written by ``plan`` and ``play``."""

import argparse
from collections.abc import Sequence
from typing import cast

import numpy as np

from ravemj.cli.argument_parser import did_you_mean
from ravemj.cli.arms import start_values
from ravemj.cli.models import moving_robot, named_robot
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.manipulation.joint_trajectories import Joints, assumed_accelerations
from ravemj.rave import Environment, Robot, Trajectory
from ravemj.trajectories.joint_trajectory import JointTrajectory
from ravemj.trajectories.joint_trajectory_files import (
    fields_of,
    load_structured,
    write_joint_trajectory,
)
from ravemj.trajectories.motion import Motion
from ravemj.trajectories.motion_arguments import MotionFile, followed_file, read_motion_file
from ravemj.trajectories.motion_reading import problems_in


def robot_names(path: str | None, robot: Robot) -> dict[str, str]:
    """Read the robot's joint names by model joint name from the file of ``--rename``; empty without a file.

    Raises:
        SourceError: the file cannot be read.
    """
    if path is None:
        return {}
    with problems_in(path):
        names = fields_of(load_structured(path))
    known = robot.simulation_state.scene.dof_names
    for name, new in names.items():
        if name not in known:
            hint = f"the joints are {', '.join(known)}{did_you_mean(str(name), known)}"
            raise SourceError(f"there is no joint '{name}'", Source(path), hint)
        if not isinstance(new, str) or not new:
            raise SourceError(f"'{name}': found {new!r:.40}, expected a name", Source(path))
    if not names or len(set(names.values())) < len(names):
        expected = "an object with a different name of the robot for each name of the model"
        raise SourceError("found " + ("a name twice" if names else "no names") + f", expected {expected}", Source(path))
    return {name: str(new) for name, new in names.items()}


def set_accelerations(robot: Robot, limits: Sequence[float] | None) -> None:
    """Set the acceleration limits of ``--acceleration``.

    Raises:
        ArgumentError: the number of limits is neither 1 nor the number of joints, or a limit is not above 0.
    """
    if limits is None:
        return
    dof = robot.GetDOF()
    if len(limits) not in {1, dof} or min(limits) <= 0:
        names = ", ".join(robot.simulation_state.scene.dof_names)
        given = f"found {', '.join(f'{limit:g}' for limit in limits) or 'none'}"
        raise ArgumentError(f"--acceleration: {given}; expected one above 0, or {dof}: one for each joint: {names}")
    robot.SetDOFAccelerationLimits(np.broadcast_to(limits, dof))


def write_points(robot: Robot, points: JointTrajectory, options: argparse.Namespace, notes: Sequence[str] = ()) -> None:
    """Write checked trajectory points with the robot's joint names; print the acceleration limits that were assumed."""
    dof_names = robot.simulation_state.scene.dof_names
    moved = Joints(robot.simulation_state, [dof_names.index(name) for name in points.joint_names])
    write_joint_trajectory(options.output, points.renamed(robot_names(options.rename, robot)), notes)
    print(f"wrote {options.output} ({len(points.times)} points in {points.duration:.3g} s, limits kept)")
    assumed = assumed_accelerations(moved)
    if assumed and points.accelerations is not None:
        print(f"{assumed}; --acceleration sets them")


def motion_file(env: Environment, options: argparse.Namespace) -> MotionFile:
    """Return the motion of ``--trajectory``, with joints renamed by ``--rename``."""
    robot = named_robot(env, options.robot) if options.rename is None else moving_robot(env, options.robot)
    if robot is None:
        return read_motion_file(env.simulation, options.trajectory, None)
    names = {new: old for old, new in robot_names(options.rename, robot).items()}
    return read_motion_file(env.simulation, options.trajectory, robot.simulation_state, names)


def export(env: Environment, motion: MotionFile, options: argparse.Namespace) -> None:
    """Write a motion for a robot controller. A table of joint values moves only the joints that it names.

    Raises:
        ArgumentError: the motion fails a check.
    """
    if options.duration is not None:
        raise ArgumentError("--duration: goes with pictures; --acceleration makes a motion for a robot slower")
    body = motion.body or followed_file(env.simulation, motion).bodies[0]
    robot, given = cast("Robot", env.wrap(body)), motion.motion
    set_accelerations(robot, options.acceleration)
    if isinstance(given, Motion):
        robot.SetActiveDOFs(motion.dofs)
    else:
        trajectory = Trajectory(env, "")
        trajectory.set_waypoints(given)
        given = trajectory
    start = None if options.start is None else start_values(options.start, robot)
    write_points(
        robot, robot.to_joint_trajectory(given, rate=options.rate, moving=options.moving, start=start), options
    )
