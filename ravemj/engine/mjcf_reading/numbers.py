"""Values of a compiled model, restored to those written in the file.

MuJoCo normalizes quaternions and axes and turns inertias into principal axes. Written values that differ from compiled
ones only by rounding are used, so that files written by ravemj are restored exactly.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import UNIT_WXYZ, Floats, Pose, Rows, Vec3, Wxyz, rows_from_wxyz

_ROUNDING = 1e-12


def as_written(written: ArrayLike, compiled: ArrayLike) -> list[float]:
    """Return written values if they equal the compiled ones up to rounding, else the compiled ones."""
    given, exact = np.asarray(written, np.float64), np.asarray(compiled, np.float64)
    scale = max(1.0, float(np.abs(exact).max(initial=0.0)))
    is_same = given.shape == exact.shape and bool((np.abs(given - exact) <= _ROUNDING * scale).all())
    return [float(part) + 0.0 for part in (given if is_same else exact)]


def vector(numbers: Iterable[float]) -> Vec3:
    """Return three numbers as a vector."""
    x, y, z = (float(part) for part in numbers)
    return x, y, z


def quaternion(numbers: Iterable[float]) -> Wxyz:
    """Return four numbers as a quaternion."""
    w, x, y, z = (float(part) for part in numbers)
    return w, x, y, z


def pose(written: tuple[ArrayLike, ArrayLike], compiled: tuple[ArrayLike, ArrayLike]) -> Pose:
    """Return a pose, given as position and quaternion: ``written`` if it equals ``compiled`` up to rounding.

    The comparison is separate for position and quaternion; see ``as_written``.
    """
    return Pose(vector(as_written(written[0], compiled[0])), quaternion(as_written(written[1], compiled[1])))


def tensor(moments: Floats, wxyz: Wxyz) -> Rows:
    """Return the inertia tensor with principal ``moments``, shape (3,), along axes rotated by ``wxyz``."""
    if wxyz == UNIT_WXYZ:
        xx, yy, zz = (float(part) for part in moments)
        return ((xx, 0.0, 0.0), (0.0, yy, 0.0), (0.0, 0.0, zz))
    rotation = np.array(rows_from_wxyz(wxyz))
    turned = (rotation * moments) @ rotation.T
    return symmetric(turned)


def symmetric(matrix: Floats) -> Rows:
    """Return the rows of a nearly symmetric 3x3 matrix, made exactly symmetric."""
    first, second, third = ((matrix + matrix.T) / 2).tolist()
    return vector(first), vector(second), vector(third)
