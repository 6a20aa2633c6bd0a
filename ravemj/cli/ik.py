"""The command ``ik``."""

import argparse
import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np

from ravemj.cli.console import console, table
from ravemj.cli.models import load_model
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.geometry_functions import matrixFromPose
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType, goal_size
from ravemj.graphics.video import check_picture, write_picture
from ravemj.rave import CollisionReport, Environment, RaveCreateRobot, Robot
from ravemj.rave.manipulator import Manipulator

_MOST_ROWS = 16
_GHOST = 0.75  # transparency
_POSE, _POINT = 7, 3

TYPE_NAMES = sorted(kind.name for kind in GOAL_TYPES)
"""What ``--type`` takes."""


class _Solution(NamedTuple):
    """Joint values that reach the goal.

    Attributes:
        values: Joint values of the arm [rad or m], shape (n,).
        branch: The name of the way to reach it.
        trouble: What speaks against it: limits and collisions.
    """

    values: Floats
    branch: str
    trouble: tuple[str, ...]


def ik(options: argparse.Namespace) -> int:
    """Show the joint values that take the tool of an arm to a goal; return 1 where none are good."""
    if options.output is not None:
        check_picture(options.output)
    env = load_model(options)
    arm = _arm(env, options.manip)
    robot = cast("Robot", arm.GetRobot())
    if options.start is not None:
        robot.SetDOFValues(_start(options.start, robot))
    if options.describe:
        print(arm.ik_solver(_kind(options)).describe())
        return 0
    reached = _reached(arm, options)
    found = _judged(arm, reached if options.json else reached[:_MOST_ROWS])
    if options.json:
        print(json.dumps([_entry(solution) for solution in found], indent=1))
    elif found:
        _print_table(arm, found, len(reached))
    else:
        print(f"no joint values take '{arm.GetName()}' of '{robot.GetName()}' there: it is out of reach")
    if options.output is not None:
        _draw(env, arm, found, options)
        print(f"wrote {options.output}")
    return 0 if any(not solution.trouble for solution in found) else 1


def _arm(env: Environment, name: str | None) -> Manipulator:
    """Return the manipulator of a name, or the active one of the first robot that has one.

    Raises:
        ArgumentError: there is none.
    """
    arms = [arm for robot in env.GetRobots() for arm in robot.GetManipulators()]
    if name is None:
        active = (robot.GetActiveManipulator() for robot in env.GetRobots())
        chosen = next((arm for arm in active if arm is not None), None)
    else:
        chosen = next((arm for arm in arms if arm.GetName() == name), None)
    if chosen is None:
        names = ", ".join(arm.GetName() for arm in arms) or "none"
        raise ArgumentError(f"there is no manipulator{'' if name is None else f' {name!r}'}; the model has {names}")
    return chosen


def _kind(options: argparse.Namespace) -> IkParameterizationType:
    """Return the type of the goal: the one that is named, or what its numbers look like."""
    if options.type is not None:
        return IkParameterizationType[options.type]
    is_point = options.to is not None and len(options.to) == _POINT
    return IkParameterizationType.Translation3D if is_point else IkParameterizationType.Transform6D


def _goal(options: argparse.Namespace) -> Floats:
    """Return the goal as ``Manipulator.ik`` takes it.

    Raises:
        ArgumentError: its type has another number of values.
    """
    kind, numbers = _kind(options), options.to
    size = _POSE if kind == IkParameterizationType.Transform6D else goal_size(kind)
    if len(numbers) != size:
        order = "x,y,z,qw,qx,qy,qz" if size == _POSE else f"{size} values"
        raise ArgumentError(f"--to has {len(numbers)} values, and a goal of type {kind.name} is {order}")
    if kind != IkParameterizationType.Transform6D:
        return np.array(numbers)
    length = math.sqrt(sum(part * part for part in numbers[3:]))
    if not length:
        raise ArgumentError("--to: the quaternion is 0 0 0 0, which is no rotation")
    return matrixFromPose([*(part / length for part in numbers[3:]), *numbers[:3]])


def _start(path: str, robot: Robot) -> list[float]:
    """Return the joint values of a file: a list, or an object with some of the joints' names.

    Raises:
        SourceError: the file cannot be read as such.
    """
    hint = "a list with a value for each DOF, or an object with names of joints and their values"
    try:
        content: Any = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise SourceError(f"cannot read the file: {(error.strerror or str(error)).lower()}", Source(path)) from None
    except (RecursionError, ValueError) as error:
        raise SourceError(f"not JSON: {error}", Source(path), hint) from None
    values = robot.GetDOFValues().tolist()
    if isinstance(content, dict):
        names = [joint.GetName() for joint in robot.GetJoints()]
        items = cast("dict[str, Any]", content)
        unknown = items.keys() - set(names)
        if unknown:
            raise SourceError(f"there is no joint '{min(unknown)}'", Source(path), f"the joints are {', '.join(names)}")
        content = [items.get(name, value) for name, value in zip(names, values, strict=True)]
    numbers = cast("list[object]", content) if isinstance(content, list) else []
    if len(numbers) != len(values) or not all(isinstance(number, int | float) for number in numbers):
        raise SourceError(f"these are no {len(values)} joint values", Source(path), hint)
    return [float(cast("float", number)) for number in numbers]


def _reached(arm: Manipulator, options: argparse.Namespace) -> list[tuple[Floats, str]]:
    """Return the joint values that reach the goal and their branches, those nearest to the present values first.

    Of each angle the turn comes that is within the limits, if one is.
    """
    from ravemj.ik.limits import nearest_turns  # noqa: PLC0415 - slow to import

    found = arm.ik(_goal(options), _kind(options), limits=False)
    valid = found.valid[0]
    rows, here = found.solutions[0][valid], arm.GetArmDOFValues()
    chain = arm.ik_solver(_kind(options)).chain
    moved, _ = nearest_turns(chain, rows, here)  # which also puts what is beyond a limit onto it
    rows = rows + 2 * np.pi * chain.turning * np.round((moved - rows) / (2 * np.pi))
    order = np.argsort(np.linalg.norm(rows - here, axis=1), kind="stable")
    names = np.array(found.branches)[valid]
    return [(rows[index], str(names[index])) for index in order]


def _judged(arm: Manipulator, reached: Sequence[tuple[Floats, str]]) -> list[_Solution]:
    """Return solutions with what speaks against them; the robot ends where it is."""
    robot = cast("Robot", arm.GetRobot())
    dofs, start = arm.GetArmIndices().tolist(), robot.GetDOFValues()
    solutions: list[_Solution] = []
    for values, branch in reached:
        robot.SetDOFValues(values, dofs, checklimits=0)
        solutions.append(_Solution(values, branch, (*_beyond_limits(robot, dofs, values), *_collisions(robot))))
    robot.SetDOFValues(start)
    return solutions


def _beyond_limits(robot: Robot, dofs: Sequence[int], values: Floats) -> Iterator[str]:
    lower, upper = robot.GetDOFLimits(dofs)
    joints = [robot.GetJointFromDOFIndex(dof) for dof in dofs]
    ranges = zip(joints, values, lower, upper, strict=True)
    beyond = [one.GetName() for one, value, low, high in ranges if not (one.IsCircular(0) or low <= value <= high)]
    if beyond:
        yield f"beyond limits: {', '.join(beyond)}"


def _collisions(robot: Robot) -> Iterator[str]:
    report, env = CollisionReport(), robot.GetEnv()
    for hits in (lambda: robot.CheckSelfCollision(report), lambda: env.CheckCollision(robot, report)):
        if hits() and report.plink1 is not None and report.plink2 is not None:
            yield f"{report.plink1.GetName()} hits {report.plink2.GetName()}"


def _entry(solution: _Solution) -> dict[str, object]:
    """Return a solution as JSON has it; these keys stay."""
    return {
        "values": solution.values.tolist(),
        "branch": solution.branch,
        "valid": not solution.trouble,
        "trouble": list(solution.trouble),
    }


def _print_table(arm: Manipulator, found: Sequence[_Solution], count: int) -> None:
    robot = cast("Robot", arm.GetRobot())
    joints = [robot.GetJointFromDOFIndex(dof) for dof in arm.GetArmIndices()]
    turns = [joint.IsRevolute(0) for joint in joints]
    title = f"Joint values of '{arm.GetName()}' of '{robot.GetName()}', the nearest to the present ones first"
    rows = table(title, "branch", *(f"{joint.GetName()}>" for joint in joints), "")
    for solution in found:
        cells = [_value(value, turn) for value, turn in zip(solution.values, turns, strict=True)]
        rows.add_row(solution.branch, *cells, "; ".join(solution.trouble) or "ok")
    console().print(rows)
    print("in rad and degrees, slides in m" + (f"; --json has all {count}" if count > len(found) else ""))


def _value(value: float, turns: bool) -> str:
    return f"{value:.4f}\n{math.degrees(value):.1f}°" if turns else f"{value:.4f}"


def _draw(env: Environment, arm: Manipulator, found: Sequence[_Solution], options: argparse.Namespace) -> None:
    """Draw the robot at the first solution, and a transparent copy of it at each other one."""
    robot, dofs = cast("Robot", arm.GetRobot()), arm.GetArmIndices()
    if found:
        robot.SetDOFValues(found[0].values, dofs, checklimits=0)
    for number, solution in enumerate(found[1:], 2):
        ghost = cast("Robot", RaveCreateRobot(env, ""))
        ghost.Clone(robot, 0)
        ghost.SetName(f"{robot.GetName()} {number}")
        env.Add(ghost, True)
        ghost.SetTransform(robot.GetTransform())
        ghost.SetDOFValues(solution.values, dofs, checklimits=0)
        for link in ghost.GetLinks():
            for geometry in link.GetGeometries():
                geometry.SetTransparency(_GHOST)
    write_picture(options.output, env.render(*options.size))
