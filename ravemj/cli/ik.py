"""The command ``ik``."""

import argparse
import json
import math
from collections.abc import Sequence

import numpy as np

from ravemj.cli.arms import (
    Solution,
    add_ghost,
    arm_of,
    beyond_all_limits,
    out_of_reach,
    pose_goal,
    reached,
    start_values,
    validated,
)
from ravemj.cli.console import console, table
from ravemj.cli.models import chosen_robots, load_model
from ravemj.cli.pictures import picture_of
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType, goal_size
from ravemj.graphics.rendering.camera_file import read_camera
from ravemj.graphics.video import check_picture, write_picture
from ravemj.rave import Environment
from ravemj.rave.manipulator import Manipulator

_MOST_ROWS = 16
_POSE, _POINT = 7, 3


def ik(options: argparse.Namespace) -> int:
    """Show the joint values with which the tool of an arm reaches a goal; return 1 if there is no valid solution."""
    if options.output is not None:
        check_picture(options.output)
    if options.reach or options.keep:
        return _reach(options)
    env = load_model(options)
    arm = arm_of(chosen_robots(env, options.robot), options.manip)
    robot = arm.GetRobot()
    if options.start is not None:
        robot.SetDOFValues(start_values(options.start, robot))
    if options.describe:
        print(arm.ik_solver(_kind(options)).describe())
        return 0
    goal, kind = _goal(options), _kind(options)
    ways = reached(arm, goal, kind)
    solutions = validated(arm, ways if options.json else ways[:_MOST_ROWS])
    _print(arm, goal, solutions, len(ways), options)
    if options.output is not None:
        _draw(env, arm, solutions, options)
        print(f"wrote {options.output}")
    return 0 if any(not solution.trouble for solution in solutions) else 1


def _print(
    arm: Manipulator, goal: Floats, solutions: Sequence[Solution], count: int, options: argparse.Namespace
) -> None:
    kind = _kind(options)
    if options.json:
        print(json.dumps([_entry(solution) for solution in solutions], indent=1))
    elif solutions:
        _print_table(arm, solutions, count)
        if all(solution.trouble for solution in solutions) and (told := beyond_all_limits(arm, goal, kind)):
            print(told)
    else:
        print(out_of_reach(arm, goal, kind))


def _reach(options: argparse.Namespace) -> int:
    from ravemj.cli.whole_body import reach  # noqa: PLC0415 - slow to import

    if not options.reach:
        raise ArgumentError("--keep: goes with --reach, and there is none")
    if options.type is not None or options.manip is not None:
        raise ArgumentError("--type and --manip go with --to; --reach NAME=GOAL names the manipulator and takes poses")
    return reach(options)


def _kind(options: argparse.Namespace) -> IkParameterizationType:
    """Return the goal type of ``--type``; by default a point for three numbers, else a pose."""
    if options.type is not None:
        return IkParameterizationType[options.type]
    is_point = options.to is not None and len(options.to) == _POINT
    return IkParameterizationType.Translation3D if is_point else IkParameterizationType.Transform6D


def _goal(options: argparse.Namespace) -> Floats:
    """Return the goal of ``--to`` as an argument of ``Manipulator.ik``.

    Raises:
        ArgumentError: The number of values does not fit the goal type.
    """
    kind, numbers = _kind(options), options.to
    size = _POSE if kind == IkParameterizationType.Transform6D else goal_size(kind)
    if len(numbers) != size:
        order = "x,y,z,qw,qx,qy,qz" if size == _POSE else f"{size} values"
        raise ArgumentError(f"--to: found {len(numbers)}, expected {order} for a goal of type {kind.name}")
    return pose_goal(numbers, "--to") if kind == IkParameterizationType.Transform6D else np.array(numbers)


def _entry(solution: Solution) -> dict[str, object]:
    """Return a solution as JSON data; the keys are stable."""
    return {
        "values": solution.values.tolist(),
        "branch": solution.branch,
        "valid": not solution.trouble,
        "trouble": list(solution.trouble),
    }


def _print_table(arm: Manipulator, solutions: Sequence[Solution], count: int) -> None:
    robot = arm.GetRobot()
    joints = [robot.GetJointFromDOFIndex(dof) for dof in arm.GetArmIndices()]
    turns = [joint.IsRevolute(0) for joint in joints]
    title = f"Joint values of '{arm.GetName()}' of '{robot.GetName()}', the nearest to the current ones first"
    rows = table(title, "branch", *(f"{joint.GetName()}>" for joint in joints), "")
    for solution in solutions:
        cells = [_value(value, turn) for value, turn in zip(solution.values, turns, strict=True)]
        rows.add_row(solution.branch, *cells, "; ".join(solution.trouble) or "ok")
    console().print(rows)
    print("in rad and degrees, slides in m" + (f"; --json has all {count}" if count > len(solutions) else ""))


def _value(value: float, turns: bool) -> str:
    return f"{value:.4f}\n{math.degrees(value):.1f}°" if turns else f"{value:.4f}"


def _draw(env: Environment, arm: Manipulator, solutions: Sequence[Solution], options: argparse.Namespace) -> None:
    """Draw the robot at the first solution, and transparent copies at the others."""
    robot, dofs = arm.GetRobot(), arm.GetArmIndices().tolist()
    if solutions:
        robot.SetDOFValues(solutions[0].values, dofs, checklimits=0)
    for number, solution in enumerate(solutions[1:], 2):
        add_ghost(robot, number, solution.values, dofs)
    camera = None if options.camera is None else read_camera(options.camera).T_world_camera
    write_picture(options.output, picture_of(options, env, camera))
