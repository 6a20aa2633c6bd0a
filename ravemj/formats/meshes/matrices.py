"""Affine transforms as 4x4 matrices, since a ``Pose`` cannot scale."""

import numpy as np

from ravemj.core.transforms import Floats


def translation(offset: Floats) -> Floats:
    """Return the 4x4 matrix of a translation."""
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def rotation(axis_angle: Floats) -> Floats:
    """Return the 4x4 matrix of a rotation, an axis (x, y, z) and an angle [rad]; the identity for a zero axis."""
    axis, angle = axis_angle[:3], float(axis_angle[3])
    length = float(np.linalg.norm(axis))
    matrix = np.eye(4)
    if length > 0 and np.isfinite([length, angle]).all():
        x, y, z = axis / length
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix
