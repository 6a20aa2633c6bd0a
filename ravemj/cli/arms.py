"""Arms of a model as commands name them, and the joint values that take their tools to a goal."""

import json
import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.cli.argument_parser import did_you_mean
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.formats.limits import json_bytes
from ravemj.geometry_functions import matrixFromPose
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.rave import (
    CollisionOptions,
    CollisionOptionsStateSaver,
    CollisionReport,
    RaveCreateRobot,
    Robot,
)
from ravemj.rave.manipulator import Manipulator

_POSE_DOFS = 6
_GHOST = 0.75  # transparency


class Solution(NamedTuple):
    """Joint values that reach a goal.

    Attributes:
        values: Joint values of the arm [rad or m], shape (n,).
        branch: The name of its branch of solutions.
        trouble: The limits that it exceeds and the collisions that it has.
    """

    values: Floats
    branch: str
    trouble: tuple[str, ...]


def out_of_reach(arm: Manipulator, kind: IkParameterizationType) -> str:
    """Say that no joint values take an arm to a goal, and what an arm of fewer than six joints can be asked instead."""
    text = f"no joint values take '{arm.GetName()}' of '{arm.GetRobot().GetName()}' there: it is out of reach"
    if kind != IkParameterizationType.Transform6D or arm.GetArmDOF() >= _POSE_DOFS:
        return text
    hint = "ravemj ik --type TranslationDirection5D asks for the direction of the tool and its point, dx,dy,dz,x,y,z"
    return f"{text}; a pose has six parts, and the arm {arm.GetArmDOF()} joints: {hint}"


def arm_of(robots: Sequence[Robot], name: str | None) -> Manipulator:
    """Return the manipulator of a name, or the active one of the first robot that has one.

    Raises:
        ArgumentError: there is no such manipulator.
    """
    arms = [arm for robot in robots for arm in robot.GetManipulators()]
    if name is None:
        active = (robot.GetActiveManipulator() for robot in robots)
        chosen = next((arm for arm in active if arm is not None), None)
    else:
        chosen = next((arm for arm in arms if arm.GetName() == name), None)
    if chosen is None:
        owner = f"robot '{robots[0].GetName()}'" if len(robots) == 1 else "the model"
        if not arms:
            raise ArgumentError(f"{owner} has no manipulator, and this command needs one: a <Manipulator> of a robot")
        names = [arm.GetName() for arm in arms]
        known = f"{owner} has {', '.join(names)}{did_you_mean(name or '', names)}"
        raise ArgumentError(f"there is no manipulator '{name}'; {known}")
    return chosen


def pose_goal(numbers: Sequence[float], option: str) -> Floats:
    """Return the pose x, y, z, qw, qx, qy, qz of an option as a matrix, shape (4, 4).

    Raises:
        ArgumentError: the quaternion is 0.
    """
    length = math.sqrt(sum(part * part for part in numbers[3:]))
    if not length:
        raise ArgumentError(f"{option}: the quaternion is 0 0 0 0, which is not a rotation")
    return matrixFromPose([*(part / length for part in numbers[3:]), *numbers[:3]])


def start_values(path: str, robot: Robot) -> list[float]:
    """Return the joint values of a file: a list, or an object with some of the joints' names.

    Raises:
        SourceError: the file cannot be read as such.
    """
    hint = "a list with a value for each DOF, or an object with names of joints and their values"
    try:
        content: Any = json.loads(json_bytes(path))
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
        found = f"{len(numbers)} values" if isinstance(content, list) else "something other than a list"
        raise SourceError(f"found {found}, expected {len(values)} joint values", Source(path), hint)
    return [float(cast("float", number)) for number in numbers]


def reached(arm: Manipulator, goal: ArrayLike, kind: IkParameterizationType) -> list[tuple[Floats, str]]:
    """Return the joint values that reach a goal and their branches, those nearest to the present values first.

    Full turns are added to angles until they are within the limits, where that is possible.
    """
    from ravemj.ik.limits import nearest_turns  # noqa: PLC0415 - slow to import

    found = arm.ik(goal, kind, limits=False)
    valid = found.valid[0]
    rows: Floats = found.solutions[0][valid]
    here = arm.GetArmDOFValues()
    chain = arm.ik_solver(kind).chain
    moved, _ = nearest_turns(chain, rows, here)  # which also puts what is beyond a limit onto it
    turns: Floats = np.where(chain.turning, np.round((moved - rows) / (2 * np.pi)), 0.0)
    rows += 2 * np.pi * turns
    order = np.argsort(np.linalg.norm(rows - here, axis=1), kind="stable")
    names = np.array(found.branches)[valid]
    return [(rows[index], str(names[index])) for index in order]


def validated(arm: Manipulator, ways: Sequence[tuple[Floats, str]]) -> list[Solution]:
    """Return solutions with the limits and collisions that rule them out; contacts of other parts do not count."""
    robot, dofs = arm.GetRobot(), arm.GetArmIndices().tolist()
    checker, solutions = robot.GetEnv().GetCollisionChecker(), list[Solution]()
    with robot, CollisionOptionsStateSaver(checker, CollisionOptions.ActiveDOFs):
        robot.SetActiveDOFs(dofs)
        for values, branch in ways:
            robot.SetDOFValues(values, dofs, checklimits=0)
            solutions.append(Solution(values, branch, (*_beyond_limits(robot, dofs, values), *_collisions(robot))))
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


def add_ghost(robot: Robot, number: int, values: Floats, dofs: Sequence[int]) -> None:
    """Add a transparent copy of a robot.

    Args:
        robot: The robot.
        number: A number for the name of the copy.
        values: Joint values of the copy, of some joints [rad or m].
        dofs: Their DOF indices; the other joints are where those of the robot are.
    """
    env = robot.GetEnv()
    ghost = cast("Robot", RaveCreateRobot(env, ""))
    ghost.Clone(robot, 0)
    ghost.SetName(f"{robot.GetName()} {number}")
    env.Add(ghost, True)
    ghost.SetTransform(robot.GetTransform())
    ghost.SetDOFValues(values, dofs, checklimits=0)
    for link in ghost.GetLinks():
        for geometry in link.GetGeometries():
            geometry.SetTransparency(_GHOST)
