"""Numbers that scripts put into the fields of infos, checked."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_transform
from ravemj.core.transforms import Floats, Pose, Vec3, pose_of
from ravemj.errors import ArgumentError


def identity() -> Floats:
    """Return a new 4x4 identity."""
    return np.eye(4)


def filled(value: float, count: int = 3) -> Callable[[], Floats]:
    """Return what makes a new array of equal numbers."""
    return lambda: np.full(count, float(value))


def vector(values: ArrayLike, name: str) -> Vec3:
    """Return the first three numbers of a field."""
    numbers = checked_numbers(values, name).ravel()
    if len(numbers) < 3 or not np.isfinite(numbers[:3]).all():
        raise ArgumentError(f"{name}: is {numbers.tolist()}, and should be three finite numbers")
    x, y, z = numbers[:3].tolist()
    return (x, y, z)


def pose(values: ArrayLike, name: str) -> Pose:
    """Return the pose of a field: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]."""
    return pose_of(checked_transform(values, name))


def per_axis(values: ArrayLike | None, count: int, default: float, name: str) -> list[float]:
    """Return a number for each axis of a joint; where the field has too few, the default."""
    numbers = np.zeros(0) if values is None else checked_numbers(values, name).ravel()
    if np.isnan(numbers).any():
        raise ArgumentError(f"{name}: is {numbers.tolist()}, and should be numbers")
    return [*numbers[:count].tolist(), *[default] * (count - len(numbers))]
