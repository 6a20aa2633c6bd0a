"""Goals of inverse kinematics as numbers: what they take of a pose, how they move, how far they are from each other.

The numbers are, by type: of ``Transform6D`` the pose [w, x, y, z, tx, ty, tz]; of ``Rotation3D`` the quaternion; of
``Translation3D`` and ``Lookat3D`` the point; of ``Direction3D`` the direction; of ``Ray4D`` and
``TranslationDirection5D`` direction and point; of ``TranslationXY2D`` x and y, of ``TranslationXYOrientation3D`` the
angle behind them; of ``TranslationLocalGlobal6D`` a point of the tool and where it shall be; of the types with
``AxisAngle`` angle and point.
"""

import math
from enum import IntEnum
from typing import Any

import numpy as np

from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, Pose, Wxyz, multiply, normalize, pose_of
from ravemj.errors import ArgumentError, RavemjError, UnsupportedError
from ravemj.geometry_functions.boxes import Ray
from ravemj.geometry_functions.rotations import quatFromRotationMatrix, quatRotateDirection, rotationMatrixFromQuat


class IkParameterizationType(IntEnum):
    """What of a pose the end of an arm shall reach: the numbers hold DOF, count of values, and a unique number."""

    None_ = 0
    Transform6D = 0x67000001
    Rotation3D = 0x34000002
    Translation3D = 0x33000003
    Direction3D = 0x23000004
    Ray4D = 0x46000005
    Lookat3D = 0x23000006
    TranslationDirection5D = 0x56000007
    TranslationXY2D = 0x22000008
    TranslationXYOrientation3D = 0x33000009
    TranslationLocalGlobal6D = 0x3600000A
    TranslationXAxisAngle4D = 0x4400000B
    TranslationYAxisAngle4D = 0x4400000C
    TranslationZAxisAngle4D = 0x4400000D
    TranslationXAxisAngleZNorm4D = 0x4400000E
    TranslationYAxisAngleXNorm4D = 0x4400000F
    TranslationZAxisAngleYNorm4D = 0x44000010


INVERSE_KINEMATICS = "inverse kinematics"
"""What is not there yet, in errors."""

_Type = IkParameterizationType
_RAYS = {_Type.Ray4D, _Type.TranslationDirection5D}
_POINTS = {_Type.Translation3D, _Type.Lookat3D}
_WITH_DIRECTION = {_Type.Direction3D, *_RAYS}
"""Types whose first three numbers are a direction."""
_WITH_POINT = {*_POINTS, *_RAYS, _Type.TranslationLocalGlobal6D}
"""Types whose last three numbers are a point that moves."""
_PLANAR = {_Type.TranslationXY2D, _Type.TranslationXYOrientation3D}
_ANGLES = {kind for kind in _Type if "AxisAngle" in kind.name}
_ANGLE_WEIGHT = 0.4
"""OpenRAVE's weight of a squared angle [1/rad^2] beside a squared distance [1/m^2]."""


def goal_dof(kind: int) -> int:
    """Return how many degrees of freedom a goal of a type takes away."""
    return int(kind) >> 28 & 0xF


def goal_size(kind: int) -> int:
    """Return how many numbers a goal of a type has."""
    return int(kind) >> 24 & 0xF


def checked_goal(kind: IkParameterizationType, value: Any) -> Floats:  # noqa: ANN401 - as the type asks for
    """Return the numbers of a goal that a user gave as a matrix, a ray or a vector, shape (n,)."""
    if kind == _Type.Transform6D:
        return pose_of(checked_transform(value, "value")).numbers()
    if kind in _RAYS:
        if not isinstance(value, Ray):
            raise ArgumentError(f"value: is a {type(value).__name__}, and should be a Ray")
        direction = value.dir()
        return np.concatenate([direction / (np.linalg.norm(direction) or 1.0), value.pos()])
    if kind == _Type.TranslationLocalGlobal6D:
        value = np.ravel(checked_numbers(value, "value"))
    match value:
        case [point, angle] if kind in _ANGLES:
            return checked_vector([angle, *checked_vector(point, 3, "value: point")], goal_size(kind), "value")
        case _:
            return checked_vector(value, goal_size(kind), "value")


def goal_of_tool(kind: IkParameterizationType, T_frame_tool: Floats, direction: Floats) -> object:
    """Return what a type of goal takes of a tool's pose, as ``checked_goal`` takes it.

    Args:
        kind: The type of goal.
        T_frame_tool: The tool's pose, shape (4, 4).
        direction: Where the tool points in its own frame, shape (3,).

    Raises:
        UnsupportedError: a pose does not say what goals of that type need.
    """
    position, pointing = T_frame_tool[:3, 3], T_frame_tool[:3, :3] @ direction
    angle = np.arctan2(T_frame_tool[1, 0], T_frame_tool[0, 0])
    parts: dict[IkParameterizationType, object] = {
        _Type.Transform6D: T_frame_tool,
        _Type.Rotation3D: quatFromRotationMatrix(T_frame_tool),
        _Type.Translation3D: position,
        _Type.Lookat3D: position,
        _Type.Direction3D: pointing,
        _Type.Ray4D: Ray(position, pointing),
        _Type.TranslationDirection5D: Ray(position, pointing),
        _Type.TranslationXY2D: position[:2],
        _Type.TranslationXYOrientation3D: np.array([*position[:2], angle]),
    }
    if kind not in parts:
        raise UnsupportedError(f"GetIkParameterization of {kind.name}", f"{INVERSE_KINEMATICS} of that type")
    return parts[kind]


def moved_goal(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the numbers of a goal that is moved by a pose, as ``pose * goal``."""
    rotation, translation = pose.matrix()[:3, :3], np.array(pose.position)
    if kind == _Type.Transform6D:
        return (pose @ goal_pose(values)).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(pose.wxyz, _wxyz(values)))
    if kind in _PLANAR:
        return np.append(rotation[:2, :2] @ values[:2] + translation[:2], values[2:] + _angle_about_z(pose))
    if kind not in _WITH_DIRECTION | _WITH_POINT:
        raise UnsupportedError(f"moving a goal of type {kind.name}", f"{INVERSE_KINEMATICS} of that type")
    moved = values.copy()
    if kind in _WITH_DIRECTION:
        moved[:3] = rotation @ values[:3]
    if kind in _WITH_POINT:
        moved[-3:] = rotation @ values[-3:] + translation
    return moved


def goal_moved_in_its_frame(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the numbers of a goal that is moved by a pose in its own frame, as ``goal * pose``."""
    rotation, translation = pose.matrix()[:3, :3], np.array(pose.position)
    if kind == _Type.Transform6D:
        return (goal_pose(values) @ pose).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(_wxyz(values), pose.wxyz))
    if kind in _PLANAR:
        return np.append(values[:2] + translation[:2], values[2:] + _angle_about_z(pose))
    if kind not in (_WITH_DIRECTION | _WITH_POINT) - {_Type.Ray4D}:
        raise RavemjError(f"a goal of type {kind.name} cannot be moved in its own frame")
    moved, frame = values.copy(), np.eye(3)
    if kind in _WITH_DIRECTION:
        frame = rotationMatrixFromQuat(quatRotateDirection([0, 0, 1], values[:3]))
        moved[:3] = frame @ rotation[:, 2]
    if kind in _WITH_POINT:
        moved[-3:] += frame @ translation
    return moved


def goal_distance_squared(kind: IkParameterizationType, first: Floats, second: Floats) -> float:
    """Return the squared distance between two goals of one type [m^2 and rad^2]; angles count less for poses."""
    if kind == _Type.Transform6D:
        angle = _angle_of_quaternions(first[:4], second[:4])
        return _squared_length(first[4:] - second[4:]) + _ANGLE_WEIGHT * angle**2
    if kind == _Type.Rotation3D:
        return _angle_of_quaternions(first, second) ** 2
    if kind == _Type.Direction3D:
        return _angle(first, second) ** 2
    if kind in _POINTS:
        return _squared_length(first - second)
    if kind in _RAYS:
        a, b = (_nearest_point(ray) if kind == _Type.Ray4D else ray[3:] for ray in (first, second))
        return _squared_length(a - b) + _angle(first[:3], second[:3]) ** 2
    raise UnsupportedError(f"ComputeDistanceSqr of {kind.name}", f"{INVERSE_KINEMATICS} of that type")


def goal_pose(values: Floats) -> Pose:
    """Return the pose that the numbers of a goal are."""
    x, y, z = values[4:].tolist()
    return Pose((x, y, z), _wxyz(values))


def goal_ray(values: Floats) -> Ray:
    """Return the ray that the numbers of a goal are."""
    return Ray(values[3:], values[:3])


def _wxyz(values: Floats) -> Wxyz:
    w, x, y, z = values[:4].tolist()
    return normalize((w, x, y, z))


def _angle_about_z(pose: Pose) -> float:
    """Return the part of a rotation that turns about z [rad]."""
    return 2 * math.atan2(pose.wxyz[3], pose.wxyz[0])


def _nearest_point(ray: Floats) -> Floats:
    """Return the point of a ray, given by direction and point, that is nearest to the origin."""
    direction, point = ray[:3], ray[3:]
    return point - direction * (direction @ point)


def _squared_length(vector: Floats) -> float:
    return float(vector @ vector)


def _angle(a: Floats, b: Floats) -> float:
    """Return the angle between two unit vectors [rad]."""
    return math.acos(min(1.0, max(-1.0, float(a @ b))))


def _angle_of_quaternions(a: Floats, b: Floats) -> float:
    """Return the angle between two unit quaternions, of which each stands for the same as its negative [rad]."""
    return min(_angle(a, b), _angle(a, -b))
