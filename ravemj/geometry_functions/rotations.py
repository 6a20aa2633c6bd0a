"""Rotations: quaternions (w, x, y, z), matrices, and axis-angle vectors [rad]."""

import math

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import (
    Floats,
    Wxyz,
    conjugate,
    multiply,
    rotate,
    rows_from_wxyz,
    wxyz_from_axis_angle,
    wxyz_from_rows,
)
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import arguments

FEW_DIGITS = 0.1
"""Sine of the angle between two quaternions below which the cosine is too inaccurate for interpolation."""


def quatFromAxisAngle(
    axisangle: ArrayLike | None = None, angle: float | None = None, *, axis: ArrayLike | None = None
) -> Floats:
    """Return the quaternion (w, x, y, z) of a rotation about an axis, shape (4,).

    Args:
        axisangle: The axis times the angle [rad]; with ``angle``, the axis, of any length. Zero is the identity.
        angle: The angle [rad].
        axis: The axis, by OpenRAVE's other name of the first argument.

    Example:
        >>> quatFromAxisAngle([0, 0, 1], numpy.pi / 2)
        array([0.70710678, 0.        , 0.        , 0.70710678])
    """
    return np.array(_turn(axisangle, angle, axis))


def rotationMatrixFromAxisAngle(
    axisangle: ArrayLike | None = None, angle: float | None = None, *, axis: ArrayLike | None = None
) -> Floats:
    """Return the matrix of a rotation about an axis, shape (3, 3).

    The arguments ``axisangle``, ``angle`` and ``axis`` are as for ``quatFromAxisAngle``.
    """
    return np.array(rows_from_wxyz(_turn(axisangle, angle, axis)))


def matrixFromAxisAngle(
    axisangle: ArrayLike | None = None, angle: float | None = None, *, axis: ArrayLike | None = None
) -> Floats:
    """Return the transform of a rotation about an axis, shape (4, 4).

    The arguments ``axisangle``, ``angle`` and ``axis`` are as for ``quatFromAxisAngle``.

    Example:
        >>> T = matrixFromAxisAngle([0, 0, numpy.pi / 2])
        >>> T[0:3, 3] = [1, 2, 3]
    """
    return _transform(_turn(axisangle, angle, axis))


def _turn(axisangle: ArrayLike | None, angle: float | None, axis: ArrayLike | None) -> Wxyz:
    given, name = (axisangle, "axisangle") if axis is None else (axis, "axis")
    if given is None:
        raise ArgumentError("axisangle: is missing, and should have shape (3,)")
    vector = arguments.vec3(given, name)
    return wxyz_from_axis_angle(vector, math.hypot(*vector) if angle is None else float(angle))


def quatFromRotationMatrix(rotation: ArrayLike) -> Floats:
    """Return the quaternion (w, x, y, z), shape (4,), of the matrix ``rotation``, shape (3, 3), (3, 4) or (4, 4).

    The sign is OpenRAVE's: if the trace is not negative, w is positive; else the component of the largest diagonal
    element is positive.
    """
    return np.array(_of_matrix(rotation))


def _of_matrix(rotation: ArrayLike) -> Wxyz:
    return wxyz_from_rows(arguments.matrix(rotation, 3, "rotation").tolist())


def axisAngleFromRotationMatrix(rotation: ArrayLike) -> Floats:
    """Return the axis times the angle [rad], up to pi, of a rotation matrix, shape (3,)."""
    return _axis_angle(_of_matrix(rotation))


def axisAngleFromQuat(quat: ArrayLike) -> Floats:
    """Return the rotation vector (axis times angle, 0 to pi [rad]), shape (3,), of ``quat``, of any length."""
    return _axis_angle(arguments.wxyz(quat, "quat"))


def _axis_angle(quaternion: Wxyz) -> Floats:
    w, *vector = quaternion
    sine = math.hypot(*vector)
    if sine == 0.0:
        return np.zeros(3)
    sign = -1.0 if w < 0 else 1.0
    return np.array(vector) * (sign * 2 * math.atan2(sine, sign * w) / sine)


def rotationMatrixFromQuat(quat: ArrayLike) -> Floats:
    """Return the rotation matrix, shape (3, 3), of the quaternion ``quat``.

    Raises:
        ArgumentError: the quaternion is far from unit length.
    """
    return np.array(rows_from_wxyz(arguments.unit_wxyz(quat, "quat")))


def rotationMatrixFromQArray(quatarray: ArrayLike) -> list[Floats]:
    """Return the rotation matrices, each of shape (3, 3), of the quaternions ``quatarray``, shape (n, 4)."""
    return [rotationMatrixFromQuat(quat) for quat in arguments.table(quatarray, 4, "quatarray")]


def matrixFromQuat(quat: ArrayLike) -> Floats:
    """Return the transform with the rotation of the quaternion ``quat``, shape (4, 4).

    Raises:
        ArgumentError: the quaternion is far from unit length.
    """
    return _transform(arguments.unit_wxyz(quat, "quat"))


def _transform(quaternion: Wxyz) -> Floats:
    matrix = np.eye(4)
    matrix[:3, :3] = rows_from_wxyz(quaternion)
    return matrix


def quatMultiply(quat0: ArrayLike, quat1: ArrayLike) -> Floats:
    """Return the product of two quaternions, shape (4,): the rotation by ``quat1``, then by ``quat0``."""
    return np.array(multiply(arguments.wxyz(quat0, "quat0"), arguments.wxyz(quat1, "quat1")))


MultiplyQuat = quatMult = quatMultiply


def quatInverse(quat: ArrayLike) -> Floats:
    """Return the inverse rotation: the conjugate of ``quat``, shape (4,)."""
    return np.array(conjugate(arguments.wxyz(quat, "quat")))


InvertQuat = quatInverse


def quatRotate(q: ArrayLike, trans: ArrayLike) -> Floats:
    """Return the vector ``trans`` rotated by the unit quaternion ``q``, shape (3,)."""
    return np.array(rotate(arguments.wxyz(q, "q"), arguments.vec3(trans, "trans")))


def ExtractAxisFromQuat(quat: ArrayLike, iaxis: int) -> Floats:
    """Return the x, y or z axis (``iaxis`` 0, 1, 2) rotated by a unit quaternion, shape (3,).

    Args:
        quat: A quaternion [w, x, y, z], shape (4,).
        iaxis: 0, 1 or 2 for x, y or z.

    Raises:
        ArgumentError: the axis does not exist.
    """
    if iaxis not in {0, 1, 2}:
        raise ArgumentError(f"iaxis: is {iaxis}, and should be 0, 1 or 2")
    return np.array(rows_from_wxyz(arguments.wxyz(quat, "quat")))[:, iaxis]


def quatRotateDirection(sourcedir: ArrayLike, targetdir: ArrayLike) -> Floats:
    """Return the smallest rotation from the direction ``sourcedir`` to ``targetdir``, a quaternion, shape (4,).

    For opposite directions, the axis is close to x.
    """
    source = np.array(arguments.vec3(sourcedir, "sourcedir"))
    target = np.array(arguments.vec3(targetdir, "targetdir"))
    axis, cosine = np.cross(source, target), float(source @ target)
    sine = float(np.linalg.norm(axis))
    if sine == 0.0 and cosine < 0.0:
        axis = _orthogonal(source / np.linalg.norm(source))
    return quatFromAxisAngle(axis, math.atan2(sine, cosine))


def _orthogonal(direction: Floats) -> Floats:
    """Return the component of x orthogonal to a unit vector, or of z if x is parallel to it; not normalized."""
    for axis in (np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])):
        rest = axis - direction * direction[axis.argmax()]
        if rest @ rest >= 1e-8:
            return rest
    raise AssertionError("x and z cannot both be parallel to it")


def normalizeAxisRotation(axis: ArrayLike, quat: ArrayLike) -> tuple[float, Floats]:
    """Return the rotation about an axis that brings ``quat``, a unit quaternion, closest to the identity.

    Returns:
        The angle [rad], and the quaternion of the rotation by ``quat`` followed by that about ``axis``, shape (4,).
    """
    direction, quaternion = arguments.vec3(axis, "axis"), arguments.wxyz(quat, "quat")
    along = sum(part * other for part, other in zip(direction, quaternion[1:], strict=True))
    angle = 2 * math.atan2(-along, quaternion[0] * math.hypot(*direction))
    return angle, np.array(multiply(wxyz_from_axis_angle(direction, angle), quaternion))


def InterpolateQuatSlerp(quat0: ArrayLike, quat1: ArrayLike, t: float, forceshortarc: bool = True) -> Floats:
    """Return the spherical linear interpolation between two rotations.

    Args:
        quat0: Unit quaternion at t = 0.
        quat1: Unit quaternion at t = 1.
        t: From 0 to 1.
        forceshortarc: Whether to take the shorter arc; otherwise the signs of the quaternions determine it.

    Returns:
        Unit quaternion, shape (4,). For other lengths the result is meaningless.
    """
    start, end = np.array(arguments.wxyz(quat0, "quat0")), np.array(arguments.wxyz(quat1, "quat1"))
    cosine = float(start @ end)
    if forceshortarc and cosine < 0:
        end, cosine = -end, -cosine
    if abs(cosine) >= 1.0:
        return start
    sine = math.sqrt(1 - cosine * cosine)
    if sine < 1e-7:  # equal, or opposite: the same rotation
        middle = start + math.copysign(1.0, cosine) * end
        return middle / np.linalg.norm(middle)
    half = math.acos(cosine)
    between = (start * math.sin((1 - t) * half) + end * math.sin(t * half)) / sine
    return between / np.linalg.norm(between) if sine < FEW_DIGITS else between


quatSlerp = InterpolateQuatSlerp


def InterpolateQuatSquad(
    quat0: ArrayLike, quat1: ArrayLike, quat2: ArrayLike, quat3: ArrayLike, t: float, forceshortarc: bool = True
) -> Floats:
    """Return the spherical cubic interpolation from ``quat0`` to ``quat3``, with two control quaternions.

    Args:
        quat0: Unit quaternion at t = 0.
        quat1: Control quaternion near the start.
        quat2: Control quaternion near the end.
        quat3: Unit quaternion at t = 1.
        t: From 0 to 1.
        forceshortarc: As for ``InterpolateQuatSlerp``.

    Returns:
        Unit quaternion, shape (4,).
    """
    outer = InterpolateQuatSlerp(quat0, quat3, t, forceshortarc)
    inner = InterpolateQuatSlerp(quat1, quat2, t, forceshortarc)
    return InterpolateQuatSlerp(outer, inner, 2 * t * (1 - t), forceshortarc)
