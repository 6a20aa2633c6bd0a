"""Affine DOFs: movable components of a body's pose, and their values."""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.enumerations import NamedFlag
from ravemj.core.transforms import Floats, Pose, Vec3, normalize, wxyz_from_axis_angle
from ravemj.errors import ArgumentError, ErrorCode
from ravemj.geometry_functions import arguments
from ravemj.geometry_functions.rotations import normalizeAxisRotation

Z_AXIS: Vec3 = (0.0, 0.0, 1.0)


class DOFAffine(NamedFlag):
    """Components of a pose; combine them with ``|``. At most one rotation type is allowed."""

    NoTransform = 0
    X = 1
    Y = 2
    Z = 4
    RotationAxis = 8
    """Rotation about a given axis: one angle [rad]."""
    Rotation3D = 16
    """Any rotation: a rotation vector (axis times angle [rad]), three values."""
    RotationQuat = 32
    """Any rotation: a quaternion, four values."""
    XYZ = 7
    RotationMask = 56
    Transform = 39


_SIZES = {
    DOFAffine.X: 1,
    DOFAffine.Y: 1,
    DOFAffine.Z: 1,
    DOFAffine.RotationAxis: 1,
    DOFAffine.Rotation3D: 3,
    DOFAffine.RotationQuat: 4,
}


_AXES = {DOFAffine.X: 0, DOFAffine.Y: 1, DOFAffine.Z: 2}


@lru_cache(maxsize=64)  # planners set the pose of a base thousands of times
def _parts(affinedofs: int) -> tuple[DOFAffine, ...]:
    """Return the components in ``affinedofs``, in the order of their values; raise if two are rotation types."""
    parts = tuple(part for part in _SIZES if part & affinedofs)
    if sum(bool(part & DOFAffine.RotationMask) for part in parts) > 1:
        raise ArgumentError(f"affinedofs: {affinedofs} has more than one kind of rotation", ErrorCode.Assert)
    return parts


def RaveGetAffineDOF(affinedofs: int) -> int:
    """Return the number of values of the pose components ``affinedofs``, ``DOFAffine`` values combined with ``|``.

    Raises:
        ArgumentError: there are two rotation types.

    Example:
        >>> RaveGetAffineDOF(DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis)
        3
    """
    return sum(_SIZES[part] for part in _parts(affinedofs))


def RaveGetAffineDOFFromIndex(affinedofs: int, index: int) -> DOFAffine:
    """Return the component that a value belongs to.

    Args:
        affinedofs: ``DOFAffine`` combined with ``|``.
        index: An index among the affine values.

    Raises:
        ArgumentError: the index is out of range.
    """
    owners = [part for part in _parts(affinedofs) for _ in range(_SIZES[part])]
    if not 0 <= index < len(owners):
        raise ArgumentError(f"index: is {index}, and affinedofs {int(affinedofs)} has {len(owners)} values")
    return owners[index]


def RaveGetIndexFromAffineDOF(affinedofs: int, dof: int) -> int:
    """Return the index of the first value of a component.

    Args:
        affinedofs: ``DOFAffine`` combined with ``|``.
        dof: One of the ``DOFAffine``.

    Raises:
        ArgumentError: the component is not among ``affinedofs``.
    """
    index = 0
    for part in _parts(affinedofs):
        if part & dof:
            return index
        index += _SIZES[part]
    raise ArgumentError(f"dof: {int(dof)} is not among affinedofs {int(affinedofs)}")


def RaveGetAffineDOFValuesFromTransform(
    transform: ArrayLike, affinedofs: int, rotationaxis: ArrayLike | None = None
) -> Floats:
    """Return the values of pose components.

    Args:
        transform: A matrix of 4x4 or a pose of 7 numbers.
        affinedofs: ``DOFAffine`` values, combined.
        rotationaxis: The axis of ``RotationAxis``; by default z.

    Returns:
        X, Y, Z [m], then the rotation, restricted to ``affinedofs``; shape (n,).
    """
    return affine_values(arguments.pose(transform, "transform"), affinedofs, _axis(rotationaxis))


def RaveGetTransformFromAffineDOFValues(
    values: ArrayLike, affinedofs: int, rotationaxis: ArrayLike | None = None, transform: ArrayLike | None = None
) -> Floats:
    """Return a transform with replaced components.

    Args:
        values: The affine values, in the order of ``RaveGetAffineDOFValuesFromTransform``.
        affinedofs: ``DOFAffine`` values, combined.
        rotationaxis: The axis of ``RotationAxis``; by default z.
        transform: The initial transform, a 4x4 matrix or a pose of 7 numbers; by default the identity.

    Returns:
        Shape (4, 4).
    """
    start = Pose() if transform is None else arguments.pose(transform, "transform")
    given = arguments.numbers(values, RaveGetAffineDOF(affinedofs), "values")
    return pose_with_values(start, given, affinedofs, _axis(rotationaxis)).matrix()


def _axis(rotationaxis: ArrayLike | None) -> Vec3:
    return Z_AXIS if rotationaxis is None else arguments.vec3(rotationaxis, "rotationaxis")


def affine_values(pose: Pose, affinedofs: int, axis: Vec3 = Z_AXIS) -> Floats:
    """Return the values of pose components: X, Y, Z, then the rotation."""
    values: list[float] = []
    for part in _parts(affinedofs):
        if part in _AXES:
            values.append(pose.position[_AXES[part]])
        else:
            values.extend(rotation_values(pose, part, axis))
    return np.array(values)


def rotation_values(pose: Pose, part: DOFAffine, axis: Vec3 = Z_AXIS) -> list[float]:
    """Return the rotation of a pose as numbers: a quaternion, an angle about ``axis``, or a rotation vector."""
    if part == DOFAffine.RotationQuat:
        return list(pose.wxyz)
    if part == DOFAffine.RotationAxis:
        return [-normalizeAxisRotation(axis, pose.wxyz)[0]]
    w, x, y, z = pose.wxyz
    sine = math.sqrt(x * x + y * y + z * z)
    factor = 2 * math.atan2(sine, w) / sine if sine else 0.0
    return [factor * x, factor * y, factor * z]


def pose_with_values(pose: Pose, values: Floats, affinedofs: int, axis: Vec3 = Z_AXIS) -> Pose:
    """Return the pose with the components ``affinedofs`` replaced."""
    position, quaternion = list(pose.position), pose.wxyz
    numbers = iter(values.tolist())
    for part in _parts(affinedofs):
        given = [next(numbers) for _ in range(_SIZES[part])]
        if part in _AXES:
            position[_AXES[part]] = given[0]
        elif part == DOFAffine.RotationAxis:
            quaternion = wxyz_from_axis_angle(axis, given[0])
        elif part == DOFAffine.Rotation3D:
            turn = arguments.vec3(given, "values")
            quaternion = wxyz_from_axis_angle(turn, float(np.linalg.norm(turn)))
        else:
            if not any(given):
                raise ArgumentError("values: the quaternion is 0 0 0 0, which is not a rotation")
            quaternion = normalize(arguments.wxyz(given, "values"))
    x, y, z = position
    return Pose((x, y, z), quaternion)
