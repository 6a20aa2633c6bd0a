"""Polar decomposition of 4x4 matrices, which may scale, into poses, which may not."""

import numpy as np

from ravemj.core.transforms import Floats, Pose, pose_of
from ravemj.errors import Source, SourceError


def polar_decomposition(matrix: Floats, source: Source) -> tuple[Pose, Floats | None]:
    """Decompose a matrix into a pose and a stretch: ``matrix = pose @ stretch``.

    Args:
        matrix: Shape (4, 4).
        source: Where it comes from.

    Returns:
        The pose, and the stretch, shape (3, 3); None for a matrix that is rigid.

    Raises:
        SourceError: A number in it is not finite.
    """
    linear = matrix[:3, :3]
    if not np.isfinite(matrix).all() or np.abs(matrix).max() > 1e100:
        raise SourceError("a transform has a number that is not finite", source)
    if np.abs(linear.T @ linear - np.eye(3)).max() < 1e-7 and np.linalg.det(linear) > 0:
        return pose_of(matrix), None
    u, _, vt = np.linalg.svd(linear)
    rigid = matrix.copy()
    rigid[:3, :3] = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    return pose_of(rigid), rigid[:3, :3].T @ linear


def rigid_part(matrix: Floats, source: Source) -> Pose:
    """Return the pose of a matrix, without its stretch.

    Raises:
        SourceError: A number in it is not finite.
    """
    return polar_decomposition(matrix, source)[0]
