"""Validation of array arguments."""

import math
from collections.abc import Sequence
from enum import Enum
from types import EllipsisType

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import (
    Floats,
    Ints,
    Vec3,
    cross,
    cross_rows,
    dot,
    normalize,
    rows_from_wxyz,
    scale,
    wxyz_from_rows,
)
from ravemj.errors import ArgumentError

NOT_RIGID = 1e-3
"""Tolerance of a rotation matrix: the largest entry of R R^T - I."""

FLOAT, INT = np.dtype(np.float64), np.dtype(np.int_)
"""Array types; numpy has a single object of each."""

_IDENTITY = np.eye(4)

ROUNDING = 1e-12
"""Deviation below which a rotation matrix is not orthonormalized, so that exact input stays exact."""


def checked_numbers(values: ArrayLike, name: str) -> Floats:
    """Return a copy as an array of floats, at least one-dimensional.

    Raises:
        ArgumentError: the values are not numbers.
    """
    if values is None:  # pyright: ignore[reportUnnecessaryComparison] - users give it; numpy takes it for NaN
        raise ArgumentError(f"{name}: is None, and should be numbers")
    try:
        return np.array(values, dtype=np.float64, ndmin=1)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name}: {values!r} should be numbers") from None
    except OverflowError:  # whole numbers of hundreds of digits
        raise ArgumentError(f"{name}: has a number that is too large") from None


def _floats(values: ArrayLike, name: str) -> Floats:
    """Return the result of ``checked_numbers``, or the array itself if it already has floats."""
    if type(values) is np.ndarray and values.dtype is FLOAT and values.ndim:
        return values
    return checked_numbers(values, name)


def checked_vector(values: ArrayLike, length: int, name: str) -> Floats:
    """Return a copy of a finite vector.

    Raises:
        ArgumentError: it has another length, or a number is not finite.
    """
    if type(values) is np.ndarray and values.dtype is FLOAT and values.ndim:
        vector: Floats = values.copy()
    else:
        vector = checked_numbers(values, name)
    if vector.shape != (length,):
        if length or vector.size:
            raise ArgumentError(f"{name}: has shape {vector.shape}, and should have shape ({length},)")
        return np.zeros(0)
    # The sum of plain floats is the fastest look at a few; where it is infinite or NaN, each one is looked at.
    if not math.isfinite(sum(vector.tolist())) and not np.isfinite(vector).all():
        raise ArgumentError(f"{name}: is {vector.tolist()}, and should be finite")
    return vector


def checked_number(value: float, name: str, least: float = -math.inf, unit: str = "") -> float:
    """Return a finite number.

    Raises:
        ArgumentError: it is not a number, not finite, or below ``least``.
    """
    (number,) = checked_vector([value], 1, name).tolist()
    if number < least:
        raise ArgumentError(f"{name} is {value}, and should be a finite number, {least:g}{unit} or more")
    return number


def finite_vector(values: ArrayLike, length: int, name: str) -> Floats:
    """Return the result of ``checked_vector``, or the array itself if it is valid, for read-only use."""
    if (
        type(values) is np.ndarray
        and values.dtype is FLOAT
        and values.shape == (length,)
        and math.isfinite(sum(values.tolist()))
    ):
        return values
    return checked_vector(values, length, name)


def checked_first(values: ArrayLike, length: int, name: str) -> Floats:
    """Return the first ``length`` numbers of a vector, as OpenRAVE takes velocities and accelerations.

    Raises:
        ArgumentError: there are fewer numbers, or one is not finite.
    """
    given = _floats(values, name)
    return checked_vector(given[:length] if given.ndim == 1 and len(given) > length else given, length, name)


def checked_rows(numbers: ArrayLike, width: int, name: str) -> Floats:
    """Return a finite array of shape (N, width); the array itself if its type is right.

    Raises:
        ArgumentError: it has another shape, or an entry is not a finite number.
    """
    try:
        checked = np.asarray(numbers, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{name}: should be numbers of shape (N, {width})") from None
    if checked.ndim != 2 or checked.shape[1] != width:
        raise ArgumentError(f"{name}: has shape {checked.shape}, and should have (N, {width})")
    if not np.isfinite(checked.sum()) and not all(np.isfinite(row).all() for row in checked):
        raise ArgumentError(f"{name}: should be finite")
    return checked


def checked_point(values: ArrayLike, name: str) -> Floats:
    """Return a point, shape (3,), for read-only use: the array itself if it is valid.

    Raises:
        ValueError: it has another shape; OpenRAVE's bindings raise this error, too.
        ArgumentError: a number is not finite.
    """
    given = values if type(values) is np.ndarray else checked_numbers(values, name)
    if given.shape != (3,):
        raise ValueError(f"{name}: has shape {given.shape}, and should have shape (3,)")
    x, y, z = given.tolist()
    if given.dtype is FLOAT and math.isfinite(x + y + z):
        return given
    return checked_vector(given, 3, name)


def checked_indices(indices: "ArrayLike | EllipsisType | None", count: int, name: str = "indices") -> Ints:
    """Return indices as an array; None means no index, ``...`` all.

    Raises:
        ArgumentError: the indices are not whole numbers.
        TypeError: they are members of an enumeration.
        IndexError: an index is not from 0 to ``count - 1``.
    """
    if indices is ...:
        return np.arange(count)
    if isinstance(indices, Enum):  # random api-91001-120: an option in the place of indices
        raise TypeError(f"{name} are {indices!r}, and should be whole numbers; give options by their name")
    checked = checked_whole_numbers(indices, name)
    plain = checked.tolist()
    if plain and not (min(plain) >= 0 and max(plain) < count):
        raise IndexError(f"{name} are {plain}, and should be from 0 to {count - 1}")
    return checked


def checked_whole_numbers(numbers: "ArrayLike | None", name: str) -> Ints:
    """Return a copy as a one-dimensional array of whole numbers; None gives an empty one.

    Raises:
        ArgumentError: they are not whole numbers.
    """
    try:
        whole = np.array(numbers)  # without a type: 1.5 would become 1
    except (TypeError, ValueError):
        whole = None
    if whole is not None and whole.dtype is INT:
        return whole.reshape(-1)
    given = checked_numbers([] if numbers is None else numbers, name).reshape(-1)
    if not np.all(given == np.round(given)) or not (np.abs(given) < 2.0**63).all():
        raise ArgumentError(f"{name} are {given.tolist()}, and should be whole numbers")
    return given.astype(np.int_)


def checked_transform(transform: ArrayLike, name: str) -> Floats:
    """Return a rigid transform as a 4x4 matrix; the input is 4x4, 3x4, or a pose [w, x, y, z, tx, ty, tz].

    As in OpenRAVE, quaternions are normalized, and a scaled rotation matrix is converted to a quaternion and back,
    which may give another rotation.

    Raises:
        ValueError: it has another shape; OpenRAVE raises this error, too.
        ArgumentError: a number is not finite, or the rotation matrix is not orthonormal.
    """
    given = checked_numbers(transform, name)
    if not math.isfinite(sum(given.ravel().tolist())) and not np.isfinite(given).all():
        raise ArgumentError(f"{name}: is {given.tolist()}, and should be finite")
    matrix = _IDENTITY.copy()  # faster than making one
    if given.shape == (7,):
        if not given[:4].any():
            raise ArgumentError(f"{name}: the quaternion is zero, and should be [w, x, y, z]")
        matrix[:3, :3] = rows_from_wxyz(normalize((given[0], given[1], given[2], given[3])))
        matrix[:3, 3] = given[4:]
    elif given.shape in {(4, 4), (3, 4)}:
        matrix[:3] = given[:3]
        rows = given[:3, :3].tolist()
        if not _is_exact(rows, name):
            matrix[:3, :3] = rows_from_wxyz(wxyz_from_rows(rows))  # with the scale, as OpenRAVE does
    else:
        raise ValueError(f"{name}: has shape {given.shape}, and should have (4, 4), (3, 4) or (7,)")
    return matrix


def checked_transforms(transforms: Sequence[ArrayLike], name: str) -> Floats:
    """Return rigid transforms, shape (n, 4, 4); see ``checked_transform`` for accepted forms and errors."""
    try:
        given = np.array(transforms, dtype=np.float64)
    except (TypeError, ValueError):
        given = np.empty(0)
    if given.ndim == 3 and given.shape[1:] == (4, 4) and np.isfinite(given.sum()):
        rotations = given[:, :3, :3]
        off = np.abs(rotations @ rotations.transpose(0, 2, 1) - _IDENTITY[:3, :3]).max(initial=0.0)
        x, y, z = rotations.transpose(1, 0, 2)
        if off < ROUNDING / 4 and ((x * cross_rows(y, z)).sum(axis=1) > 0).all():  # so each one is exact by itself
            given[:, 3] = _IDENTITY[3]
            return given
    return np.array([checked_transform(transform, name) for transform in transforms]).reshape(-1, 4, 4)


def _is_exact(rows: Sequence[Vec3], name: str) -> bool:
    """Return True if a rotation matrix is orthonormal up to rounding, False if it is scaled or slightly off.

    It uses Python floats, which are several times faster than numpy for nine numbers.

    Raises:
        ArgumentError: The matrix is not orthonormal even after removing a scale factor.
    """
    x, y, z = rows
    determinant = dot(x, cross(y, z))
    off = math.inf
    if determinant > 0:
        if _off_orthonormal(x, y, z) < ROUNDING / 4:  # so its scale is exact, too
            return True
        unscale = 1 / math.cbrt(determinant)
        off = _off_orthonormal(scale(x, unscale), scale(y, unscale), scale(z, unscale))
    if not off <= NOT_RIGID:
        raise ArgumentError(f"{name}: the rotation {rows} is not one: its rows should be orthonormal")
    return off < ROUNDING and abs(determinant - 1) < ROUNDING


def _off_orthonormal(x: Vec3, y: Vec3, z: Vec3) -> float:
    """Return the largest absolute entry of R R^T - I, for the matrix R with these rows."""
    squares = max(abs(dot(x, x) - 1), abs(dot(y, y) - 1), abs(dot(z, z) - 1))
    return max(squares, abs(dot(x, y)), abs(dot(y, z)), abs(dot(z, x)))
