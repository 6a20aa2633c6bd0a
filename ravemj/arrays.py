"""Arrays that users hand in, checked once."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import ArgumentError
from ravemj.transforms import Floats


def checked_numbers(values: ArrayLike, name: str) -> Floats:
    """Return a copy as floats, at least one-dimensional.

    Raises:
        ArgumentError: they are no numbers.
    """
    try:
        return np.array(values, dtype=np.float64, ndmin=1)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name}: {values!r} should be numbers") from None


def checked_vector(values: ArrayLike, length: int, name: str) -> Floats:
    """Return a copy of a finite vector.

    Raises:
        ArgumentError: it has another length, or something in it is no finite number.
    """
    vector = checked_numbers(values, name)
    if vector.shape != (length,) and not (length == 0 and vector.size == 0):
        raise ArgumentError(f"{name}: has shape {vector.shape}, and should have shape ({length},)")
    if not np.isfinite(vector).all():
        raise ArgumentError(f"{name}: is {vector.tolist()}, and should be finite")
    return vector.reshape(length)
