"""The command ``grasp``."""

import argparse
import os
from collections.abc import Sequence
from functools import partial
from typing import cast

import numpy as np

from ravemj.cli.arms import arm_of, pose_goal
from ravemj.cli.console import console, table
from ravemj.cli.grasp_page import write_grasps
from ravemj.cli.models import chosen_robots, load_model, model_file
from ravemj.core.output import check_file
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError
from ravemj.graphics.video import known_suffix
from ravemj.manipulation.grasping.search import Grasp, Grasps
from ravemj.rave import Environment, KinBody, RaveCreateKinBody, Robot, load
from ravemj.rave.grasping import grasps
from ravemj.rave.manipulator import Manipulator

_SHOWN = 10
"""Maximum number of grasps to simulate, print and show; nearly equal ones count once."""

_AHEAD = 0.5  # m, from the base to the place of a target that nobody placed
_FLOOR_GAP = 0.001  # m, below the lowest point of the robot, so that its base does not touch the floor
_FLOOR_SIDE, _FLOOR_THICKNESS = 3.0, 0.02  # m
_POSE, _POINT = 7, 3  # numbers
_PAGE = ".html"


def grasp(options: argparse.Namespace) -> int:
    """Find grasps, print the best ones and why others were rejected, and write a page; return 1 if there are none."""
    if options.output is not None:
        known_suffix(options.output, [_PAGE])
        check_file(options.output)
    env = load_model(options)
    arm = _hand_of(chosen_robots(env, options.robot), options.manip)
    robot = arm.GetRobot()
    robot.SetActiveManipulator(arm)
    target = _target(env, robot, options)
    result, note = _found(robot, target, options)
    _print(arm, target, result, note)
    if options.output is not None and result:
        shown = result.distinct(_SHOWN)
        write_grasps(options.output, arm, target, shown, [*([note] if note else []), *str(result).split("\n")])
        print(f"wrote {os.path.abspath(options.output)} ({len(shown)} grasps; any browser shows them)")
    return 0 if result else 1


def _hand_of(robots: Sequence[Robot], name: str | None) -> Manipulator:
    """Return the manipulator ``name``; by default the active one if it has a gripper, else the first that has one."""
    arm = arm_of(robots, name)
    if name is not None or arm.GetGripperDOF():
        return arm
    arms = (other for robot in robots for other in robot.GetManipulators())
    return next((other for other in arms if other.GetGripperDOF()), arm)


def _found(robot: Robot, target: KinBody, options: argparse.Namespace) -> tuple[Grasps, str]:
    """Return the grasps that the arm can reach, or if there are none, those of the hand alone with a note why."""
    find = partial(grasps, robot, target, method=options.method, friction=options.friction, proofs=_SHOWN)
    unsolvable = _unsolvable(robot)
    if unsolvable:
        return find(reach=False), f"{unsolvable}; so these are grasps of the hand alone"
    result = find()
    unreached = sum(result.counts.get(reason, 0) for reason in ("no IK", "arm in collision"))
    if result or not unreached:
        return result, ""
    why = "out of reach" if result.counts.get("no IK") else "the arm is in collision"
    note = f"{why}: the arm takes the hand to none of {unreached} grasps, so these are grasps of the hand alone"
    return find(reach=False), note


def _unsolvable(robot: Robot) -> str:
    """Return the reason why the active manipulator has no IK solver; empty if it has one."""
    arm = robot.GetActiveManipulator()
    try:
        if arm is not None and arm.GetArmDOF():
            arm.ik_solver()
    except RavemjError as error:
        return error.message
    return ""


def _target(env: Environment, robot: Robot, options: argparse.Namespace) -> KinBody:
    """Return the body to grasp, placed at ``--at`` or, if it was loaded from a file, on a floor.

    Raises:
        ArgumentError: The name is that of the robot, or the file does not contain exactly one body.
    """
    body = env.GetKinBody(options.target)
    if body is robot:
        raise ArgumentError(f"TARGET: '{options.target}' is the robot that grasps; name another body or a file")
    is_loaded = body is None
    if body is None:
        body = _loaded(env, options.target)
    if options.at is not None:
        body.SetTransform(_pose(options.at, body))
    elif is_loaded:
        _put_down(env, robot, body)
    return body


def _loaded(env: Environment, name: str) -> KinBody:
    """Load a file or shipped model that contains exactly one body; return this body."""
    path, before = model_file(name), env.GetBodies()
    if not os.path.exists(path):
        names = ", ".join(body.GetName() for body in before)
        raise ArgumentError(f"TARGET: '{name}' is no body of the model ({names}), no shipped model and no file")
    load(path, into=env)
    new = [body for body in env.GetBodies() if body not in before]
    if len(new) != 1:
        raise ArgumentError(f"TARGET: {name} has {len(new)} bodies; expected one, the body to grasp")
    return new[0]


def _pose(numbers: Sequence[float], body: KinBody) -> Floats:
    """Return the pose of ``--at``; three numbers leave the rotation unchanged."""
    if len(numbers) == _POSE:
        return pose_goal(numbers, "--at")
    if len(numbers) != _POINT:
        raise ArgumentError(f"--at: found {len(numbers)}, expected x,y,z or x,y,z,qw,qx,qy,qz")
    T = body.GetTransform()
    T[:3, 3] = numbers
    return T


def _put_down(env: Environment, robot: Robot, body: KinBody) -> None:
    """Add a floor at the height of the robot's lowest point, and place a body on it in front of the robot's base."""
    box = robot.ComputeAABB()
    height = float(box.pos()[2] - box.extents()[2]) - _FLOOR_GAP
    T_base, T = robot.GetTransform(), body.GetTransform()
    T[:2, 3] = (T_base @ [_AHEAD, 0, 0, 1])[:2]
    body.SetTransform(T)
    own = body.ComputeAABB()
    T[2, 3] += height - float(own.pos()[2] - own.extents()[2])
    body.SetTransform(T)
    floor = cast("KinBody", RaveCreateKinBody(env, ""))
    floor.SetName("floor")
    half = _FLOOR_THICKNESS / 2
    floor.InitFromBoxes([[*T_base[:2, 3], height - half, _FLOOR_SIDE, _FLOOR_SIDE, half]], False)
    env.Add(floor, True)


def _print(arm: Manipulator, target: KinBody, result: Grasps, note: str) -> None:
    if result:
        title = f"Grasps of '{target.GetName()}' by '{arm.GetName()}' of '{arm.GetRobot().GetName()}', the best first"
        rows = table(title, "#>", "quality>", "epsilon>", "contacts>", "weakest", "shaken")
        for number, listed in enumerate(result.distinct(_SHOWN), 1):
            rows.add_row(
                str(number),
                f"{listed.quality:.3f}",
                f"{listed.epsilon:.5f}",
                str(len(listed.contacts)),
                listed.weakness,
                _shaken(listed),
            )
        console().print(rows)
        proof = result[0].proof
        assert proof is not None
        forces = ", ".join(f"{force:g}" for force in proof.forces)
        print(f"shaken: {proof.mass:.3g} kg, friction {proof.friction:g}, fingers press with {forces} N or N m")
    print(result)
    if note:
        print(note)


def _shaken(grasp: Grasp) -> str:
    proof = grasp.proof
    if proof is None:
        return ""
    moved = f"{1e3 * proof.moved:.1f} mm, {np.degrees(proof.turned):.1f}°"
    return f"held, moved by {moved}" if proof.held else f"lost after {proof.seconds:.2f} s"
