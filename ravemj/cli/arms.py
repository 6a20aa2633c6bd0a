"""Selection of manipulators by commands, and their IK solutions."""

import json
import math
from collections.abc import Sequence
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.cli.argument_parser import did_you_mean
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, Source, SourceError
from ravemj.formats.limits import json_bytes
from ravemj.geometry_functions import matrixFromPose
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.manipulation.bodies import Bodies
from ravemj.manipulation.joint_trajectories import Joints, largest_excess
from ravemj.manipulation.refusals import troubles
from ravemj.rave import RaveCreateRobot, Robot
from ravemj.rave.manipulator import Manipulator
from ravemj.trajectories.bodies import body_groups
from ravemj.trajectories.joint_trajectory_files import LARGEST_NUMBER

_POSE_DOFS = 6
_GHOST = 0.75  # transparency


class Solution(NamedTuple):
    """Joint values that reach a goal.

    Attributes:
        values: Joint values of the arm [rad or m], shape (n,).
        branch: Name of its IK branch.
        trouble: Description of violated limits and collisions; empty if there are none.
    """

    values: Floats
    branch: str
    trouble: tuple[str, ...]


def out_of_reach(arm: Manipulator, goal: ArrayLike, kind: IkParameterizationType) -> str:
    """Describe how far a goal is out of reach; for arms with fewer than six joints, suggest other goal types."""
    text = f"no joint values take '{arm.GetName()}' of '{arm.GetRobot().GetName()}' there: it is out of reach"
    text += f"; {_shortfall(arm, goal, kind)}"
    if kind != IkParameterizationType.Transform6D or arm.GetArmDOF() >= _POSE_DOFS:
        return text
    hint = "ravemj ik --type TranslationDirection5D asks for the direction of the tool and its point, dx,dy,dz,x,y,z"
    return f"{text}; a pose has six parts, and the arm {arm.GetArmDOF()} joints: {hint}"


def beyond_all_limits(arm: Manipulator, goal: ArrayLike, kind: IkParameterizationType) -> str:
    """Describe how far a goal is out of reach; empty if joint values within the limits reach it."""
    if len(arm.ik_solver(kind).solve_one(arm.goals_in_base(goal, kind)[0])):
        return ""
    return f"no joint values within the limits reach it; {_shortfall(arm, goal, kind)}"


def _shortfall(arm: Manipulator, goal: ArrayLike, kind: IkParameterizationType) -> str:
    local = arm.goals_in_base(goal, kind)[0]
    return str(arm.ik_solver(kind).nearest_reachable(local, arm.GetArmDOFValues()))


def arm_of(robots: Sequence[Robot], name: str | None) -> Manipulator:
    """Return the manipulator with a name, by default the active one of the first robot that has a manipulator.

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
        raise ArgumentError(f"--manip: there is no manipulator '{name}'; {known}")
    return chosen


def pose_goal(numbers: Sequence[float], option: str) -> Floats:
    """Return an option's pose x, y, z, qw, qx, qy, qz as a matrix, shape (4, 4).

    Raises:
        ArgumentError: the quaternion is 0.
    """
    length = math.sqrt(sum(part * part for part in numbers[3:]))
    if not length:
        raise ArgumentError(f"{option}: the quaternion is 0 0 0 0, which is not a rotation")
    return matrixFromPose([*(part / length for part in numbers[3:]), *numbers[:3]])


def start_values(path: str, robot: Robot) -> list[float]:
    """Read joint values from a JSON file: a list, or an object of values by joint name.

    Raises:
        SourceError: the file cannot be read, or a value is outside the limits of its joint.
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
        names = robot.simulation_state.scene.dof_names
        items = cast("dict[str, Any]", content)
        unknown = items.keys() - set(names)
        if unknown:
            raise SourceError(f"there is no joint '{min(unknown)}'", Source(path), f"the joints are {', '.join(names)}")
        content = [items.get(name, value) for name, value in zip(names, values, strict=True)]
    numbers = cast("list[object]", content) if isinstance(content, list) else []
    checked = [float(number) for number in numbers if isinstance(number, int | float) and abs(number) < LARGEST_NUMBER]
    if len(numbers) != len(values) or len(checked) < len(values):
        given = f"{len(numbers)} values" if isinstance(content, list) else "something other than a list"
        raise SourceError(f"found {given}, expected {len(values)} joint values", Source(path), hint)
    state = robot.simulation_state
    beyond = largest_excess(Joints(state, range(state.dof)), np.array([checked]))
    if beyond is not None:
        raise SourceError(beyond.text, Source(path))
    return checked


def reached(arm: Manipulator, goal: ArrayLike, kind: IkParameterizationType) -> list[tuple[Floats, str]]:
    """Return each IK solution of a goal with the name of its IK branch, nearest to the present joint values first."""
    from ravemj.ik.candidates import ranked  # noqa: PLC0415 - slow to import

    return ranked(arm.ik_solver(kind), arm.goals_in_base(goal, kind)[0], arm.GetArmDOFValues())


def validated(arm: Manipulator, ways: Sequence[tuple[Floats, str]]) -> list[Solution]:
    """Check IK solutions, with the names of their branches, for joint limits and collisions of the arm.

    Contacts that do not involve the arm are ignored.
    """
    env, groups = arm.GetRobot().GetEnv(), body_groups(arm.GetRobot().GetName(), arm.description.arm_dofs, 0, "")
    bodies = Bodies(env.simulation, groups, env.GetCollisionChecker)
    with bodies.kept():
        return [Solution(values, branch, tuple(troubles(bodies, values))) for values, branch in ways]


def add_ghost(robot: Robot, label: int | str, values: Floats, dofs: Sequence[int]) -> None:
    """Add a transparent copy of a robot.

    Args:
        robot: The robot.
        label: Suffix of the copy's name.
        values: Values of the joints ``dofs`` of the copy [rad or m].
        dofs: DOF indices; other joints have the robot's values.
    """
    env = robot.GetEnv()
    ghost = cast("Robot", RaveCreateRobot(env, ""))
    ghost.Clone(robot, 0)
    ghost.SetName(f"{robot.GetName()} {label}")
    env.Add(ghost, True)
    ghost.SetTransform(robot.GetTransform())
    ghost.SetDOFValues(values, dofs, checklimits=0)
    for link in ghost.GetLinks():
        for geometry in link.GetGeometries():
            geometry.SetTransparency(_GHOST)
