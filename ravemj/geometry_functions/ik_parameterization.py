"""Values of IK goals: extraction from poses, transforms, distances.

By type, the values are: ``Transform6D``: the pose [w, x, y, z, tx, ty, tz]; ``Rotation3D``: the quaternion;
``Translation3D`` and ``Lookat3D``: the point; ``Direction3D``: the direction; ``Ray4D`` and ``TranslationDirection5D``:
direction and point; ``TranslationXY2D``: x and y; ``TranslationXYOrientation3D``: x, y and the angle;
``TranslationLocalGlobal6D``: a point of the tool and its desired position; types with ``AxisAngle``: angle and point.
This angle is relative to the arm's base, and transforms of goals do not change it.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import NOT_RIGID, checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, Pose, Wxyz, multiply, normalize, pose_of
from ravemj.errors import ArgumentError, Diagnostic, ErrorCode, RavemjError, Source, send_warning
from ravemj.geometry_functions.boxes import Ray
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType, goal_size
from ravemj.geometry_functions.rotations import quatRotateDirection, rotationMatrixFromQuat

_Type = IkParameterizationType
_IDENTITY = np.eye(3)
_RAYS = {_Type.Ray4D, _Type.TranslationDirection5D}
_PLACES = {_Type.Translation3D, _Type.Lookat3D}
_PLANAR = {_Type.TranslationXY2D, _Type.TranslationXYOrientation3D}
_WITH_ANGLE = frozenset(kind for kind in GOAL_TYPES if "AxisAngle" in kind.name)
"""Types whose first value is an angle to or about an axis of the arm's base frame."""
_ABOUT_AXIS = frozenset(kind for kind in _WITH_ANGLE if "Norm" in kind.name)
_WITH_DIRECTION = {_Type.Direction3D, *_RAYS}
"""Types whose first three values are a direction."""
_WITH_POINT = {*_PLACES, *_RAYS, *_WITH_ANGLE, _Type.TranslationLocalGlobal6D}
"""Types whose last three values are a point, which transforms move."""
_ANGLE_WEIGHT = 0.4
"""OpenRAVE's weight of a squared angle [rad^2] relative to a squared distance [m^2] in distances between goals."""
_UNIT = 0.01
"""Tolerance of the squared length of a unit vector."""


def goal_transform(value: ArrayLike, name: str) -> Floats:
    """Return the pose of a goal, shape (4, 4), as ``checked_transform`` does; warn if its rotation is scaled.

    As in OpenRAVE, a scaled rotation matrix gives another rotation than the same matrix without the scale.

    Raises:
        ValueError: ``value`` is neither a 4x4 or 3x4 matrix nor 7 numbers.
        ArgumentError: a number is not finite, or the rotation matrix is not orthonormal up to a scale.
    """
    matrix = checked_transform(value, name)
    given = np.asarray(value, dtype=np.float64)
    if given.ndim == 2:
        rotation = given[:3, :3]
        off = float(np.abs(rotation.T @ rotation - _IDENTITY).max())
        if off > NOT_RIGID:
            told = f"the rotation is scaled by {np.cbrt(np.linalg.det(rotation)):.4g}"
            message = f"{told}; the goal has the rotation that OpenRAVE makes of it, not the one without the scale"
            send_warning(Diagnostic("warning", "scaled-rotation", message, Source(name)))
    return matrix


def checked_goal(kind: IkParameterizationType, value: Any) -> Floats:  # noqa: ANN401 - as the type asks for
    """Return the values of a user's goal, given as a matrix, a ray or a vector, shape (n,).

    Raises:
        ArgumentError: they do not match the type; or a direction is not a unit vector (code ``Assert``).
    """
    if kind not in GOAL_TYPES:
        known = ", ".join(sorted(goal_type.name for goal_type in GOAL_TYPES))
        raise ArgumentError(f"type: is {kind.name}, and should be one of {known}")
    if kind == _Type.Transform6D:
        return pose_of(goal_transform(value, "value")).numbers()
    if kind in _RAYS:
        ray = checked_kind(value, Ray, "value")
        return np.concatenate([_checked_direction(ray.dir()), ray.pos()])
    if kind == _Type.TranslationLocalGlobal6D:
        value = np.ravel(checked_numbers(value, "value"))
    match value:
        case [point, angle] if kind in _WITH_ANGLE:
            return checked_vector([angle, *checked_vector(point, 3, "value: point")], goal_size(kind), "value")
        case _:
            values = checked_vector(value, goal_size(kind), "value")
            return _checked_direction(values) if kind == _Type.Direction3D else values


def length_scales(kind: IkParameterizationType, factor: float) -> Floats:
    """Return the factor of each value of a goal for a change of the unit of length: ``factor`` for lengths, else 1."""
    scales = np.full(goal_size(kind), factor)
    if kind == _Type.TranslationXYOrientation3D:
        scales[2:] = 1
    elif kind in _WITH_ANGLE:
        scales[:1] = 1
    elif kind in _WITH_DIRECTION:
        scales[:3] = 1
    elif kind in {_Type.Transform6D, _Type.Rotation3D}:
        scales[:4] = 1
    return scales


def _checked_direction(direction: Floats) -> Floats:
    square = float(direction @ direction)
    if not abs(square - 1) < _UNIT:
        message = f"value: the direction {direction.tolist()} has the length {math.sqrt(square):g}, and should have 1"
        raise ArgumentError(message, ErrorCode.Assert)
    return direction / math.sqrt(square)


def goal_of_tool(
    kind: IkParameterizationType, T_frame_tool: Floats, direction: Floats, like: Floats | None = None
) -> Floats:
    """Return the values of the goal that a tool reaches at a pose, shape (n,).

    Args:
        kind: The type of goal.
        T_frame_tool: The tool's pose, shape (4, 4).
        direction: The tool direction in its own frame, shape (3,).
        like: A goal of this type, which supplies the tool point or the look-at point.
    """
    position, pointing = T_frame_tool[:3, 3], T_frame_tool[:3, :3] @ direction
    x, y, z = pointing.tolist()
    if kind in {_Type.Transform6D, _Type.Rotation3D}:
        return pose_of(T_frame_tool).numbers()[: goal_size(kind)]
    if kind == _Type.Lookat3D:
        distance = 1.0 if like is None else float(pointing @ (like - position))
        return position + distance * pointing
    if kind == _Type.TranslationLocalGlobal6D:
        local = np.zeros(3) if like is None else like[:3]
        return np.append(local, T_frame_tool[:3, :3] @ local + position)
    if kind in _WITH_ANGLE:
        angle = {
            _Type.TranslationXAxisAngle4D: math.acos(max(-1.0, min(1.0, x))),
            _Type.TranslationYAxisAngle4D: math.acos(max(-1.0, min(1.0, y))),
            _Type.TranslationZAxisAngle4D: math.acos(max(-1.0, min(1.0, z))),
            _Type.TranslationXAxisAngleZNorm4D: math.atan2(y, x),
            _Type.TranslationYAxisAngleXNorm4D: math.atan2(z, y),
            _Type.TranslationZAxisAngleYNorm4D: math.atan2(x, z),
        }
        return np.append(angle[kind], position)
    if kind in _PLANAR:
        return np.append(position[:2], math.atan2(y, x))[: goal_size(kind)]
    parts = [pointing] * (kind in _WITH_DIRECTION) + [position] * (kind in _WITH_POINT)
    return np.concatenate(parts)


def moved_goal(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the values of a goal transformed by a pose, as ``pose * goal``."""
    if kind == _Type.Transform6D:
        return (pose @ goal_pose(values)).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(pose.wxyz, _wxyz(values)))
    T = pose.matrix()
    if kind in _PLANAR:
        place = (T @ [*values[:2], 0.0, 1.0])[:2]
        return np.append(place, values[2:] + _angle_about_z(pose))
    moved = values.copy()
    if kind in _WITH_DIRECTION:
        moved[:3] = T[:3, :3] @ values[:3]
    if kind in _WITH_POINT:
        moved[-3:] = T[:3, :3] @ values[-3:] + T[:3, 3]
    return moved


def goal_moved_in_its_frame(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the values of a goal transformed by a pose in its own frame, as ``goal * pose``."""
    rotation, translation = pose.matrix()[:3, :3], np.array(pose.position)
    if kind == _Type.Transform6D:
        return (goal_pose(values) @ pose).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(_wxyz(values), pose.wxyz))
    if kind in _PLANAR:
        return np.append(values[:2] + translation[:2], values[2:] + _angle_about_z(pose))
    if kind == _Type.Ray4D:
        raise RavemjError("a goal of type Ray4D cannot be moved in its own frame")
    moved, frame = values.copy(), np.eye(3)
    if kind in _WITH_DIRECTION:
        frame = rotationMatrixFromQuat(quatRotateDirection([0, 0, 1], values[:3]))
        moved[:3] = frame @ rotation[:, 2]
    if kind in _WITH_POINT:
        moved[-3:] += frame @ translation
    return moved


_FOLLOW = "_transform="


def moved_custom_values(name: str, values: Floats, pose: Pose) -> Floats:
    """Return custom values of a goal after a transform by a pose.

    The word after ``_transform=`` in their name determines their type; without it, they are unchanged.

    Raises:
        ArgumentError: the word after ``_transform=`` is not ``point``, ``direction``, ``quat`` or ``ikparam``
            (``InvalidState``), or there are too few values.
    """
    if _FOLLOW not in name:
        return values
    word = name.partition(_FOLLOW)[2].partition("_")[0]
    kind = {"point": _Type.Translation3D, "direction": _Type.Direction3D, "quat": _Type.Rotation3D}.get(word)
    first = 0
    if word == "ikparam" and len(values):
        kind, first = _Type(int(values[0])), 1
    if kind is None and word != "ikparam":
        message = f"custom values '{name}': '{word}' should be point, direction, quat or ikparam"
        raise ArgumentError(message, ErrorCode.InvalidState)
    size = first + 1 if kind is None else first + goal_size(kind)
    if kind is None or len(values) < size:
        raise ArgumentError(f"custom values '{name}' are {len(values)} numbers, and should be at least {size}")
    return np.concatenate([values[:first], moved_goal(kind, values[first:size], pose), values[size:]])


def goal_distance_squared(kind: IkParameterizationType, first: Floats, second: Floats) -> float:
    """Return the squared distance between two goals of one type [m^2 and rad^2]; angles have a smaller weight."""
    if kind in {_Type.Transform6D, _Type.Rotation3D}:
        square = _half_turn(first, second) ** 2
        return _squared_length(first[4:] - second[4:]) + _ANGLE_WEIGHT * square if len(first) > 4 else square
    if kind == _Type.Direction3D:
        return _angle(first, second) ** 2
    if kind in _RAYS:
        a, b = (_nearest_point(ray) if kind == _Type.Ray4D else ray[3:] for ray in (first, second))
        return _squared_length(a - b) + _ANGLE_WEIGHT * _angle(first[:3], second[:3]) ** 2
    if kind == _Type.TranslationXYOrientation3D:
        turn = _wrapped(float(first[2] - second[2]))
        return _squared_length(first[:2] - second[:2]) + _ANGLE_WEIGHT * turn**2
    if kind in _WITH_ANGLE:
        a, b = float(first[0]), float(second[0])
        turn = _wrapped(a - b) if kind in _ABOUT_AXIS else abs(a) - abs(b)
        return _squared_length(first[1:] - second[1:]) + turn**2
    return _squared_length(first - second)


def goal_pose(values: Floats) -> Pose:
    """Convert values of a goal to a pose."""
    x, y, z = values[4:].tolist()
    return Pose((x, y, z), _wxyz(values))


def goal_ray(values: Floats) -> Ray:
    """Convert values of a goal to a ray."""
    return Ray(values[3:], values[:3])


def _wxyz(values: Floats) -> Wxyz:
    w, x, y, z = values[:4].tolist()
    return normalize((w, x, y, z))


def _angle_about_z(pose: Pose) -> float:
    """Return the rotation angle about z of a pose (the twist of its rotation) [rad]."""
    return 2 * math.atan2(pose.wxyz[3], pose.wxyz[0])


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2 * math.pi)


def _nearest_point(ray: Floats) -> Floats:
    """Return the point of a line nearest to the origin; ``ray`` is direction and point."""
    direction, point = ray[:3], ray[3:]
    return point - direction * (direction @ point)


def _squared_length(vector: Floats) -> float:
    return float(vector @ vector)


def _angle(a: Floats, b: Floats) -> float:
    """Return the angle between two unit vectors [rad] (W. Kahan's formula, exact for small angles)."""
    return 2 * math.atan2(float(np.linalg.norm(a - b)), float(np.linalg.norm(a + b)))


def _half_turn(a: Floats, b: Floats) -> float:
    """Return half the rotation angle between two poses [rad]; the first four values of each are a unit quaternion."""
    return _angle(a[:4], b[:4] if a[:4] @ b[:4] >= 0 else -b[:4])
