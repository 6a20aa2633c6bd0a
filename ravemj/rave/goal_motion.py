"""How goals of arms move, as the numbers of an ``IkParameterization``."""

import math

import numpy as np

from ravemj.errors import RavemjError, UnsupportedError
from ravemj.geometry_functions import quatRotateDirection, rotationMatrixFromQuat
from ravemj.rave.enums import IkParameterizationType
from ravemj.transforms import Floats, Pose, Wxyz, multiply, normalize

_Type = IkParameterizationType
RAYS = {_Type.Ray4D, _Type.TranslationDirection5D}
POINTS = {_Type.Translation3D, _Type.Lookat3D}
_WITH_DIRECTION = {_Type.Direction3D, *RAYS}
"""Types whose first three numbers are a direction."""
_WITH_POINT = {*POINTS, *RAYS, _Type.TranslationLocalGlobal6D}
"""Types whose last three numbers are a point that moves."""
_PLANAR = {_Type.TranslationXY2D, _Type.TranslationXYOrientation3D}


def moved(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the numbers of a goal that is moved by a pose."""
    rotation, translation = pose.matrix()[:3, :3], np.array(pose.position)
    if kind == _Type.Transform6D:
        return (pose @ pose_of_goal(values)).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(pose.wxyz, _wxyz(values)))
    if kind in _PLANAR:
        return np.append(rotation[:2, :2] @ values[:2] + translation[:2], values[2:] + _turn_about_z(pose))
    if kind not in _WITH_DIRECTION | _WITH_POINT:
        raise UnsupportedError(f"moving a goal of type {kind.name}", "inverse kinematics of that type")
    result = values.copy()
    if kind in _WITH_DIRECTION:
        result[:3] = rotation @ values[:3]
    if kind in _WITH_POINT:
        result[-3:] = rotation @ values[-3:] + translation
    return result


def moved_inside(kind: IkParameterizationType, values: Floats, pose: Pose) -> Floats:
    """Return the numbers of a goal that is moved by a pose in its own frame."""
    rotation, translation = pose.matrix()[:3, :3], np.array(pose.position)
    if kind == _Type.Transform6D:
        return (pose_of_goal(values) @ pose).numbers()
    if kind == _Type.Rotation3D:
        return np.array(multiply(_wxyz(values), pose.wxyz))
    if kind in _PLANAR:
        return np.append(values[:2] + translation[:2], values[2:] + _turn_about_z(pose))
    if kind not in (_WITH_DIRECTION | _WITH_POINT) - {_Type.Ray4D}:
        raise RavemjError(f"a goal of type {kind.name} cannot be moved in its own frame")
    result, frame = values.copy(), np.eye(3)
    if kind in _WITH_DIRECTION:
        frame = rotationMatrixFromQuat(quatRotateDirection([0, 0, 1], values[:3]))
        result[:3] = frame @ rotation[:, 2]
    if kind in _WITH_POINT:
        result[-3:] += frame @ translation
    return result


def _turn_about_z(pose: Pose) -> float:
    """Return the part of a rotation that turns about z [rad]."""
    return 2 * math.atan2(pose.wxyz[3], pose.wxyz[0])


def _wxyz(values: Floats) -> Wxyz:
    w, x, y, z = values[:4].tolist()
    return normalize((w, x, y, z))


def pose_of_goal(values: Floats) -> Pose:
    """Return the pose that the numbers of a ``Transform6D`` goal stand for."""
    x, y, z = values[4:].tolist()
    return Pose((x, y, z), _wxyz(values))
