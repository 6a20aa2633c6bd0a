"""Checks of the arguments of the geometry functions.

As in OpenRAVE, too short vectors are errors, and longer ones are truncated. A wrong shape is a ``ValueError``, as in
OpenRAVE's bindings.
"""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Pose, Vec3, Wxyz, normalize, wxyz_from_rows
from ravemj.errors import ArgumentError, ErrorCode


def numbers(values: ArrayLike, length: int, name: str) -> Floats:
    """Return a copy of the first elements of a vector.

    Raises:
        ValueError: the vector is too short.
    """
    vector = checked_numbers(values, name)
    if vector.ndim != 1 or len(vector) < length:
        raise ValueError(f"{name}: has shape {vector.shape}, and should have shape ({length},)")
    return vector[:length]


def vec3(values: ArrayLike, name: str) -> Vec3:
    """Return a vector of three numbers."""
    x, y, z = numbers(values, 3, name).tolist()
    return x, y, z


def wxyz(values: ArrayLike, name: str) -> Wxyz:
    """Return a quaternion of any length."""
    w, x, y, z = numbers(values, 4, name).tolist()
    return w, x, y, z


def unit_wxyz(values: ArrayLike, name: str) -> Wxyz:
    """Return a quaternion of nearly unit length, normalized.

    Raises:
        ValueError: it has fewer than four numbers.
        ArgumentError: its squared length is not between 0.99 and 1.01 (error code ``Assert``).
    """
    quaternion = wxyz(values, name)
    if not 0.99 < sum(part * part for part in quaternion) < 1.01:
        message = (
            f"{name}: the quaternion {list(quaternion)} has length {np.linalg.norm(quaternion):.6g}, and should have 1"
        )
        raise ArgumentError(message, ErrorCode.Assert)
    return normalize(quaternion)


def matrix(values: ArrayLike, columns: int, name: str) -> Floats:
    """Return the upper three rows and first ``columns`` columns of a matrix."""
    given = checked_numbers(values, name)
    if given.ndim != 2 or given.shape[0] < 3 or given.shape[1] < columns:
        raise ValueError(f"{name}: has shape {given.shape}, and should have shape (4, 4)")
    return given[:3, :columns]


def table(values: ArrayLike, columns: int, name: str) -> Floats:
    """Return a copy of an array with ``columns`` columns; an empty list means no rows."""
    rows = checked_numbers(values, name)
    if rows.size == 0:
        return np.empty((0, columns))
    if rows.ndim != 2 or rows.shape[1] < columns:
        raise ValueError(f"{name}: has shape {rows.shape}, and should have shape (n, {columns})")
    return rows[:, :columns]


def pose(values: ArrayLike, name: str) -> Pose:
    """Return a transform given as a pose of 7 numbers, quaternion first, or as a 3x4 or 4x4 matrix.

    The quaternion is normalized.

    Raises:
        ArgumentError: it has another form, or the quaternion is zero.
    """
    given = checked_numbers(values, name)
    if given.ndim == 2:
        rows = matrix(given, 4, name)
        return Pose(vec3(rows[:, 3], name), wxyz_from_rows(rows[:, :3].tolist()))
    quaternion = wxyz(given, name)
    if not any(quaternion):
        raise ArgumentError(f"{name}: its quaternion is zero, which is not a rotation")
    return Pose(vec3(numbers(given, 7, name)[4:], name), normalize(quaternion))
