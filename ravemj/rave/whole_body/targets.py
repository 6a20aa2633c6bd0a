"""Frames and targets of whole-body tasks in the API, and the errors with their Jacobians."""

from collections.abc import Callable
from difflib import get_close_matches
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_transform, checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError
from ravemj.geometry_functions.ik_types import IkParameterizationType
from ravemj.ik.chain import Chain
from ravemj.ik.residuals import ToolState, residual_and_jacobian
from ravemj.ik.tasks import Task as Goal
from ravemj.ik.tasks import goal_poses
from ravemj.ik.whole_body.tasks import TaskRows, pose_rows
from ravemj.manipulation.whole_body import Moving
from ravemj.rave.kinbody import KinBody
from ravemj.rave.link import Link
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.robot import Robot
from ravemj.rave.specification import IkParameterization

FrameLike = Manipulator | Link | str
"""Manipulator (its tool frame), link, or the name of one of these."""
TargetLike = ArrayLike | IkParameterization | KinBody | Link
"""Pose, point, IK goal, or a body or link to follow."""

_UNSCALED = np.ones(6)


class Frame(NamedTuple):
    """Frame on a robot: link, pose in the link (4, 4), direction (3,) and name."""

    link: int
    T_link_frame: Floats
    direction: Floats
    name: str


def frame_of(robot: Robot, frame: FrameLike, argument: str) -> Frame:
    """Return the frame that an argument refers to.

    Raises:
        ArgumentError: the robot does not have this manipulator or link.
    """
    if isinstance(frame, str):
        frame = _named(robot, frame, argument)
    owner = frame.GetRobot() if isinstance(frame, Manipulator) else frame.GetParent()
    if owner != robot:
        raise ArgumentError(f"{argument}: is of '{owner.GetName()}', and should be of '{robot.GetName()}'")
    if isinstance(frame, Link):
        return Frame(frame.GetIndex(), np.eye(4), np.array([0.0, 0.0, 1.0]), frame.GetName())
    effector = frame.GetEndEffector()
    if effector is None:
        raise ArgumentError(f"{argument}: manipulator '{frame.GetName()}' has no end effector")
    return Frame(effector.GetIndex(), frame.GetLocalToolTransform(), frame.GetLocalToolDirection(), frame.GetName())


def _named(robot: Robot, name: str, argument: str) -> Manipulator | Link:
    for thing in (*robot.GetManipulators(), *robot.GetLinks()):
        if thing.GetName() == name:
            return thing
    arms = [arm.GetName() for arm in robot.GetManipulators()]
    links = [link.GetName() for link in robot.GetLinks()]
    close = get_close_matches(name, arms, 1) or get_close_matches(name, links, 1)
    text = f"{argument}: '{robot.GetName()}' has no manipulator or link '{name}'"
    text += f"; did you mean '{close[0]}'? Its" if close else "; its"
    text += f" manipulators: {', '.join(arms) or 'none'}"
    raise ArgumentError(text)


class Target(NamedTuple):
    """Target of a task.

    Attributes:
        goal: The type of the goal.
        numbers: Returns the values in the world: a pose (4, 4), a point (3,), or those of the type.
    """

    goal: Goal
    numbers: Callable[[], Floats]


def target_of(robot: Robot, target: TargetLike, argument: str, *, rotation: bool = True) -> Target:
    """Return the target that an argument describes; without ``rotation``, only the position of a pose or body counts.

    Raises:
        ArgumentError: it is not a valid target.
    """
    if isinstance(target, IkParameterization):
        kind = target.GetType()
        is_pose = kind == IkParameterizationType.Transform6D
        numbers = target.GetTransform6D() if is_pose else target.GetValues()
        return Target(Goal(kind.name), lambda: numbers)
    if isinstance(target, KinBody | Link):
        if target == robot or (isinstance(target, Link) and target.GetParent() == robot):
            raise ArgumentError(f"{argument}: is of '{robot.GetName()}' itself, and should be of another body")
        follow = target.GetTransform
        return Target(Goal.TRANSFORM, follow) if rotation else Target(Goal.PLACE, lambda: follow()[:3, 3])
    if np.shape(target) == (3,):
        point = checked_vector(target, 3, argument)
        return Target(Goal.PLACE, lambda: point)
    pose = checked_transform(target, argument)
    return Target(Goal.TRANSFORM, lambda: pose) if rotation else Target(Goal.PLACE, lambda: pose[:3, 3])


def frame_rows(moving: Moving, number: int, direction: Floats, target: Callable[[], Target]) -> Callable[[], TaskRows]:
    """Return a function that computes the error of a frame relative to a target, and its Jacobian."""
    pointing = Chain.of([[0.0, 0.0, 1.0]], [[0.0, 0.0, 0.0]], direction=direction)

    def measure() -> TaskRows:
        goal, numbers = target()
        T_world_frame, jacobian = moving.frame(number)
        wanted = numbers()
        if goal is Goal.TRANSFORM:
            return pose_rows(T_world_frame, jacobian, wanted)
        if goal is Goal.PLACE:
            return TaskRows(wanted - T_world_frame[:3, 3], jacobian[:3])
        tool = ToolState(T_world_frame[:3, :3], T_world_frame[:3, 3], jacobian)
        return TaskRows(*residual_and_jacobian(pointing, goal, goal_poses(pointing, goal, wanted), tool, _UNSCALED))

    return measure


def described(goal: Goal, error: Floats) -> str:
    """Describe the error of a goal in words, for instance ``is 0.2 m and 10 degrees away``."""
    if goal is Goal.TRANSFORM:
        distance, angle = (float(np.linalg.norm(part)) for part in (error[:3], error[3:]))
        parts = [f"{distance:.3g} m" * (distance > 1e-6), f"{np.degrees(angle):.3g} degrees" * (angle > 1e-6)]
        return f"is {' and '.join(part for part in parts if part) or '0 m'} away"
    size = float(np.linalg.norm(error))
    if goal in (Goal.PLACE, Goal.PLACE_XY, Goal.LOCAL_PLACE):
        return f"is {size:.3g} m away"
    if goal in (Goal.LOOK_AT, Goal.DIRECTION):
        return f"points {np.degrees(2 * np.arcsin(min(size / 2, 1.0))):.3g} degrees past its target"
    return f"misses its {goal.value} by {size:.3g} (m and rad)"
