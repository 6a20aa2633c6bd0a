"""Many quaternions, poses or points at once."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats
from ravemj.geometry_functions import arguments


def quatArrayTMult(qarray: ArrayLike, q: ArrayLike) -> Floats:
    """Return each quaternion of ``qarray``, shape (n, 4), times the quaternion ``q``; shape (n, 4)."""
    return _products(arguments.table(qarray, 4, "qarray"), arguments.numbers(q, 4, "q"))


def quatMultArrayT(q: ArrayLike, qarray: ArrayLike) -> Floats:
    """Return the quaternion ``q`` times each one of ``qarray``, shape (n, 4); shape (n, 4)."""
    return _products(arguments.numbers(q, 4, "q"), arguments.table(qarray, 4, "qarray"))


def quatArrayRotate(qarray: ArrayLike, trans: ArrayLike) -> Floats:
    """Return the vector ``trans`` turned by unit quaternions, the columns of ``qarray``, shape (4, n); shape (3, n)."""
    return quatArrayTRotate(checked_numbers(qarray, "qarray").T, trans).T.copy()


def quatArrayTRotate(qarray: ArrayLike, trans: ArrayLike) -> Floats:
    """Return the vector ``trans`` turned by each unit quaternion of ``qarray``, shape (n, 4); shape (n, 3)."""
    return _rotated(arguments.table(qarray, 4, "qarray"), arguments.numbers(trans, 3, "trans"))


def quatRotateArrayT(q: ArrayLike, transarray: ArrayLike) -> Floats:
    """Return the vectors of ``transarray``, shape (n, 3), turned by the unit quaternion ``q``; shape (n, 3)."""
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
    """Take the turn about z out of the unit quaternions ``qarray``, shape (n, 4).

    Returns:
        The quaternions after a further turn about z that brings them closest to none, shape (n, 4); and the angles
        [rad] that it took out, shape (n,).
    """
    quaternions = arguments.table(qarray, 4, "qarray")
    half = np.arctan2(-quaternions[:, 3], quaternions[:, 0])
    turns = np.column_stack([np.cos(half), np.zeros_like(half), np.zeros_like(half), np.sin(half)])
    return _products(turns, quaternions), -2 * half


def _products(left: Floats, right: Floats) -> Floats:
    """Return the products of quaternions in the last axis."""
    w, v = left[..., :1], left[..., 1:]
    other_w, other_v = right[..., :1], right[..., 1:]
    scalar = w * other_w - (v * other_v).sum(axis=-1, keepdims=True)
    return np.concatenate([scalar, w * other_v + other_w * v + np.cross(v, other_v)], axis=-1)


def _rotated(quaternions: Floats, vectors: Floats) -> Floats:
    """Return vectors in the last axis turned by unit quaternions in the last axis."""
    w, v = quaternions[..., :1], quaternions[..., 1:]
    twice = 2 * np.cross(v, vectors)
    return vectors + w * twice + np.cross(v, twice)
