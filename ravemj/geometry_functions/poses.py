"""Transforms as 4x4 matrices and as poses (qw, qx, qy, qz, x, y, z)."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Pose, Vec3, normalize, wxyz_from_rows
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import arguments


def matrixFromPose(pose: ArrayLike) -> Floats:
    """Return the matrix, shape (4, 4), of a pose, shape (7,).

    Raises:
        ValueError: there are fewer than seven numbers.
        ArgumentError: the quaternion is far from unit length.
    """
    return Pose(_position(pose), arguments.unit_wxyz(pose, "pose")).matrix()


def matrixFromPoses(poses: ArrayLike) -> list[Floats]:
    """Return the matrices, each of shape (4, 4), of poses of shape (n, 7)."""
    return [matrixFromPose(pose) for pose in arguments.table(poses, 7, "poses")]


def poseFromMatrix(transform: ArrayLike) -> Floats:
    """Return the pose, shape (7,), of the matrix ``transform``, shape (4, 4) or (3, 4)."""
    matrix = arguments.matrix(transform, 4, "transform")
    return np.array([*wxyz_from_rows(matrix[:, :3].tolist()), *matrix[:, 3]])


def poseFromMatrices(transforms: ArrayLike) -> Floats:
    """Return the poses, shape (n, 7), of the matrices ``transforms``, shape (n, 4, 4) or (n, 3, 4)."""
    matrices = checked_numbers(transforms, "transforms")
    return np.array([poseFromMatrix(matrix) for matrix in matrices]).reshape(-1, 7)


def InvertPose(pose: ArrayLike) -> Floats:
    """Return the inverse of a pose, shape (7,)."""
    return _pose(pose).inverse().numbers()


def InvertPoses(poses: ArrayLike) -> Floats:
    """Return the inverses, shape (n, 7), of poses of shape (n, 7)."""
    return np.array([InvertPose(pose) for pose in arguments.table(poses, 7, "poses")]).reshape(-1, 7)


invertPoses = InvertPoses


def MultiplyPose(pose1: ArrayLike, pose2: ArrayLike) -> Floats:
    """Return the pose that applies ``pose2``, then ``pose1``, shape (7,).

    The quaternion is normalized.

    Raises:
        ArgumentError: a quaternion is zero.
    """
    product = _pose(pose1) @ _pose(pose2)
    if not any(product.wxyz):
        raise ArgumentError("pose1 * pose2: the quaternion is zero, which is not a rotation")
    return Pose(product.position, normalize(product.wxyz)).numbers()  # random-api-129


poseMult = MultiplyPose


def poseTransformPoint(pose: ArrayLike, point: ArrayLike) -> Floats:
    """Return a point transformed by a pose, shape (3,)."""
    return np.array(_pose(pose).apply(arguments.vec3(point, "point")))


def poseTransformPoints(pose: ArrayLike, points: ArrayLike) -> Floats:
    """Return points of shape (n, 3) transformed by a pose, shape (n, 3)."""
    return transformPoints(_pose(pose).matrix(), arguments.table(points, 3, "points"))


def transformPoints(T: ArrayLike, points: ArrayLike) -> Floats:
    """Return ``points``, shape (n, k), transformed by the affine matrix ``T``, shape (k + 1, k + 1) or (k, k + 1)."""
    linear, offset = _linear(T)
    return arguments.table(points, len(offset), "points") @ linear.T + offset


def transformInversePoints(T: ArrayLike, points: ArrayLike) -> Floats:
    """Return ``points``, shape (n, k), transformed by the inverse of the rigid ``T``; see ``transformPoints``."""
    linear, offset = _linear(T)
    return (arguments.table(points, len(offset), "points") - offset) @ linear


def _linear(matrix: ArrayLike) -> tuple[Floats, Floats]:
    rows = checked_numbers(matrix, "T")
    if rows.ndim != 2 or rows.shape[0] not in {rows.shape[1], rows.shape[1] - 1} or rows.shape[1] < 2:
        raise ArgumentError(f"T: has shape {rows.shape}, and should have shape (4, 4)")
    size = rows.shape[1] - 1
    return rows[:size, :size], rows[:size, size]


def transformLookat(lookat: ArrayLike, camerapos: ArrayLike, cameraup: ArrayLike) -> Floats:
    """Return the pose, shape (4, 4), of a camera whose z axis points at ``lookat``.

    If camera and point coincide, the camera's z axis is that of the world. If ``cameraup`` is parallel to the z axis,
    the world's y axis replaces it, or the x axis if y is parallel, too.

    Args:
        lookat: The point.
        camerapos: The camera position.
        cameraup: The desired y axis. Viewer cameras have y down, so give the down direction.
    """
    position = np.array(arguments.vec3(camerapos, "camerapos"))
    forward = np.array(arguments.vec3(lookat, "lookat")) - position
    distance = np.linalg.norm(forward)
    forward = forward / distance if distance > 1e-6 else np.array([0.0, 0.0, 1.0])
    for wanted in (np.array(arguments.vec3(cameraup, "cameraup")), np.array([0.0, 1, 0]), np.array([1.0, 0, 0])):
        up = wanted - forward * (forward @ wanted)
        if up @ up >= 1e-8:
            break
    up = up / np.linalg.norm(up)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([np.cross(up, forward), up, forward, position])
    return matrix


TransformLookat = transformLookat


def ComputePoseDistSqr(pose0: ArrayLike, pose1: ArrayLike, quatweight: float = 1.0) -> float:
    """Return the squared distance of positions, plus ``quatweight`` times the squared distance of quaternions.

    The sign of a quaternion is ignored.

    Args:
        pose0: A pose [w, x, y, z, tx, ty, tz], shape (7,).
        pose1: The other, shape (7,).
        quatweight: Weight of rotations relative to positions.
    """
    return float(ComputePoseArrayDistSqr(pose0, [arguments.numbers(pose1, 7, "pose1")], quatweight)[0])


def ComputePoseArrayDistSqr(pose0: ArrayLike, posearray: ArrayLike, quatweight: float = 1.0) -> Floats:
    """Return the squared distances, shape (n,), of ``pose0`` to poses of shape (n, 7); see ``ComputePoseDistSqr``.

    Args:
        pose0: A pose [w, x, y, z, tx, ty, tz], shape (7,).
        posearray: Poses, one per row, shape (n, 7).
        quatweight: Weight of rotations relative to positions.
    """
    first, others = arguments.numbers(pose0, 7, "pose0"), arguments.table(posearray, 7, "posearray")
    squares = [((others[:, :4] - sign * first[:4]) ** 2).sum(axis=1) for sign in (1, -1)]
    return ((others[:, 4:] - first[4:]) ** 2).sum(axis=1) + quatweight * np.minimum(*squares)


def poseSerialization(pose: ArrayLike) -> str:
    """Return a transform, a pose of 7 numbers or a 4x4 matrix, as the text of its 7 numbers."""
    return _text(arguments.pose(pose, "pose").numbers())


def matrixSerialization(transform: ArrayLike) -> str:
    """Return a transform, a pose of 7 numbers or a 4x4 matrix, as the text of the columns of its 3x4 matrix."""
    return _text(arguments.pose(transform, "transform").matrix()[:3].T.ravel())


def _text(numbers: Floats) -> str:
    return "".join(f"{number:.16g} " for number in numbers)


def _position(pose: ArrayLike) -> Vec3:
    return arguments.vec3(arguments.numbers(pose, 7, "pose")[4:], "pose")


def _pose(pose: ArrayLike) -> Pose:
    return Pose(_position(pose), arguments.wxyz(pose, "pose"))


def quatArrayTMult(qarray: ArrayLike, q: ArrayLike) -> Floats:
    """Return each quaternion of ``qarray``, shape (n, 4), times the quaternion ``q``; shape (n, 4)."""
    return _products(arguments.table(qarray, 4, "qarray"), arguments.numbers(q, 4, "q"))


def quatMultArrayT(q: ArrayLike, qarray: ArrayLike) -> Floats:
    """Return the quaternion ``q`` times each quaternion of ``qarray``, shape (n, 4); shape (n, 4)."""
    return _products(arguments.numbers(q, 4, "q"), arguments.table(qarray, 4, "qarray"))


def quatArrayRotate(qarray: ArrayLike, trans: ArrayLike) -> Floats:
    """Return the vector ``trans`` rotated by the columns of ``qarray``, unit quaternions, (4, n); shape (3, n)."""
    return quatArrayTRotate(checked_numbers(qarray, "qarray").T, trans).T.copy()


def quatArrayTRotate(qarray: ArrayLike, trans: ArrayLike) -> Floats:
    """Return the vector ``trans`` rotated by each unit quaternion of ``qarray``, shape (n, 4); shape (n, 3)."""
    return _rotated(arguments.table(qarray, 4, "qarray"), arguments.numbers(trans, 3, "trans"))


def quatRotateArrayT(q: ArrayLike, transarray: ArrayLike) -> Floats:
    """Return the vectors of ``transarray``, shape (n, 3), rotated by the unit quaternion ``q``; shape (n, 3)."""
    return _rotated(arguments.numbers(q, 4, "q"), arguments.table(transarray, 3, "transarray"))


def poseMultArrayT(pose: ArrayLike, posearray: ArrayLike) -> Floats:
    """Return ``pose``, seven numbers, times each pose of ``posearray``, shape (n, 7); shape (n, 7)."""
    first, others = arguments.numbers(pose, 7, "pose"), arguments.table(posearray, 7, "posearray")
    positions = _rotated(first[:4], others[:, 4:]) + first[4:]
    return np.hstack([_products(first[:4], others[:, :4]), positions])


def quatArrayTDist(q: ArrayLike, qarray: ArrayLike) -> Floats:
    """Return half the angles [rad] from the unit quaternion ``q`` to those of ``qarray``, shape (n, 4); shape (n,)."""
    cosines = np.abs(arguments.table(qarray, 4, "qarray") @ arguments.numbers(q, 4, "q"))
    return np.arccos(np.minimum(1.0, cosines))


def normalizeZRotation(qarray: ArrayLike) -> tuple[Floats, Floats]:
    """Remove the rotation about z from the unit quaternions ``qarray``, shape (n, 4).

    Returns:
        The quaternions after a rotation about z that brings each closest to the identity, shape (n, 4); and the removed
        angles [rad], shape (n,).
    """
    quaternions = arguments.table(qarray, 4, "qarray")
    half = np.arctan2(-quaternions[:, 3], quaternions[:, 0])
    turns = np.column_stack([np.cos(half), np.zeros_like(half), np.zeros_like(half), np.sin(half)])
    return _products(turns, quaternions), -2 * half


def _products(left: Floats, right: Floats) -> Floats:
    """Return the products of quaternions, which are in the last axis."""
    w, v = left[..., :1], left[..., 1:]
    other_w, other_v = right[..., :1], right[..., 1:]
    scalar = w * other_w - (v * other_v).sum(axis=-1, keepdims=True)
    return np.concatenate([scalar, w * other_v + other_w * v + np.cross(v, other_v)], axis=-1)


def _rotated(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by unit quaternions; the last axis contains their components."""
    w, v = quaternions[..., :1], quaternions[..., 1:]
    twice = 2 * np.cross(v, vectors)
    return vectors + w * twice + np.cross(v, twice)
