"""Triangulation of polygons: quadrilaterals are halved, convex polygons become fans, others need ear clipping.

Conformance tests prescribe the order of the triangles, so no package is used.
"""

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints

_MAX_CLIPPED = 500  # corners of a polygon; larger ones become fans, whatever their shape
_TESTS_PER_CORNER = 10  # bounds the work, which is quadratic else; what is left then becomes a fan
_STRAIGHT = 1e-7  # sine of a turn that counts as none: single precision


def fans(starts: Ints, sizes: Ints) -> Ints:
    """Triangulate convex polygons as fans about their first corners.

    Args:
        starts: For each polygon the position of its first corner in a list of corners.
        sizes: For each polygon the number of its corners; polygons with fewer than three are dropped.

    Returns:
        Positions in the list of corners, shape (n, 3).
    """
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def clipped(points: Floats, starts: Ints, sizes: Ints) -> Ints:
    """Triangulate polygons that may be concave; ``points`` is the list of corners, (n, 3), the rest as for ``fans``."""
    quads, large = sizes == 4, sizes > 4
    concave = _concave(points, starts, sizes) & large
    convex = large & ~concave
    pieces = [
        fans(starts[sizes < 4], sizes[sizes < 4]),
        _fans_about_the_last(starts[convex], sizes[convex]),
        _halves(points, starts[quads]),
    ]
    for start, size in zip(starts[concave].tolist(), sizes[concave].tolist(), strict=True):
        pieces.append(start + clip_ears(points[start : start + size]))
    return np.concatenate(pieces)


def triangles(points: Floats, sizes: Ints, index: Ints, concave: bool) -> Floats:
    """Return the triangles of polygons that refer to points.

    Args:
        points: The points, shape (n, 3).
        sizes: For each polygon the number of its corners; polygons with fewer than three are dropped.
        index: For each corner the index of its point; polygons with an invalid index are dropped.
        concave: Whether polygons may be concave; otherwise they become fans.

    Returns:
        Three points for each triangle, shape (m, 3, 3).
    """
    ends = np.cumsum(sizes)
    starts = ends - sizes
    wrong = (index < 0) | (index >= len(points))
    before = np.concatenate([[0], np.cumsum(wrong)])
    good = (sizes >= 3) & (before[ends] == before[starts])
    if not good.any():
        return np.zeros((0, 3, 3))
    corners = points[np.where(wrong, 0, index)]
    starts, sizes = starts[good], sizes[good]
    return corners[clipped(corners, starts, sizes) if concave else fans(starts, sizes)]


def _fans_about_the_last(starts: Ints, sizes: Ints) -> Ints:
    """Triangulate convex polygons as fans about their last corner, with the triangles in the order of ear clipping."""
    triangles = fans(starts, sizes)
    first = np.repeat(starts + sizes - 1, np.maximum(sizes - 2, 0))
    return np.stack([first, triangles[:, 1] - 1, triangles[:, 2] - 1], axis=1)


def _halves(points: Floats, starts: Ints) -> Ints:
    """Split quadrilaterals, which may be bent, along a diagonal; return triangles as corner indices.

    As in OpenRAVE, the diagonal starts at the first reflex corner (more than pi between its edges), else at the first.
    """
    around = (np.arange(4)[:, np.newaxis] + np.arange(1, 4)) % 4  # for each corner the three others
    corners = points[starts[:, np.newaxis] + np.arange(4)]
    arms = corners[:, around] - corners[:, :, np.newaxis]
    lengths = np.linalg.norm(arms, axis=3, keepdims=True)
    arms = arms / np.where(lengths > 0, lengths, 1.0)
    cosines = np.einsum("qcik,qck->qci", arms[:, :, ::2], arms[:, :, 1])
    angles = np.arccos(np.clip(cosines, -1.0, 1.0)).sum(axis=2)
    first = np.argmax(angles > np.pi + _STRAIGHT, axis=1)
    turned = (first[:, np.newaxis] + [0, 1, 2, 0, 2, 3]) % 4
    return (starts[:, np.newaxis] + turned).reshape(-1, 3)


def clip_ears(polygon: Floats) -> Ints:
    """Triangulate one polygon by ear clipping; repeated consecutive corners are ignored.

    The search for the next ear continues after the last one, as in OpenRAVE's importer (conformance test gap-74).

    Args:
        polygon: Its corners in order, shape (n, 3).

    Returns:
        Positions of corners, shape (m, 3), in the polygon's orientation.
    """
    left: list[int] = np.flatnonzero((polygon != np.roll(polygon, 1, axis=0)).any(1)).tolist()
    flat = _flattened(polygon)
    tests = _TESTS_PER_CORNER * len(left)
    triangles: list[tuple[int, int, int]] = []
    while len(left) > 3 and tests > 0:
        position, needed = _ear(flat[left])
        tests -= needed
        triangles.append((left[position - 1], left[position], left[(position + 1) % len(left)]))
        left = left[position + 1 :] + left[:position]
    triangles += [(left[0], left[i], left[i + 1]) for i in range(1, len(left) - 1)]
    return np.array(triangles, np.int_).reshape(-1, 3)


def split(index: Ints) -> tuple[Ints, Ints]:
    """Split a list of indices at its negative numbers.

    Returns:
        The lengths of the pieces, and the indices without the negative numbers.
    """
    ends = np.append(np.flatnonzero(index < 0), len(index))
    sizes = np.diff(ends, prepend=-1) - 1
    return sizes, index[index >= 0]


def strips(sizes: Ints, index: Ints) -> Ints:
    """Return the triangles of strips, every second one reversed so that all face the same side."""
    starts = np.cumsum(sizes) - sizes
    counts = np.maximum(sizes - 2, 0)
    step = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)
    first = np.repeat(starts, counts) + step
    odd = step % 2
    return index[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]


def _concave(points: Floats, starts: Ints, sizes: Ints) -> NDArray[np.bool_]:
    """Return a mask of the polygons that have a reflex corner and few enough corners for ear clipping."""
    concave = np.zeros(len(sizes), np.bool_)
    for size in np.unique(sizes[(sizes > 3) & (sizes <= _MAX_CLIPPED)]).tolist():
        same = np.flatnonzero(sizes == size)
        corners = points[starts[same, np.newaxis] + np.arange(size)]
        corners = corners - corners[:, :1]
        normals = np.cross(corners, np.roll(corners, -1, axis=1)).sum(axis=1)
        edges = np.roll(corners, -1, axis=1) - corners
        turns = np.einsum("ijk,ik->ij", np.cross(edges, np.roll(edges, -1, axis=1)), normals)
        concave[same] = turns.min(axis=1) < -_STRAIGHT * (normals**2).sum(axis=1)
    return concave


def _flattened(polygon: Floats) -> Floats:
    """Return the 2D corners of a 3D polygon, projected along a coordinate axis, in counter-clockwise order."""
    corners = polygon - polygon[0]
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    keep = [(drop + 1) % 3, (drop + 2) % 3]
    return corners[:, keep] * np.array([1.0, -1.0 if normal[drop] < 0 else 1.0])


def _ear(points: Floats) -> tuple[int, int]:
    """Find an ear: a convex corner without any other corner inside its triangle.

    Returns:
        Index of the ear's corner, or an arbitrary index if there is no ear; and the number of corners examined.
    """
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    convex: list[int] = np.flatnonzero(_turn(before, points, after) > 0).tolist()
    for count, position in enumerate(convex, start=1):
        a, b, c = before[position], points[position], after[position]
        inside = (_turn(a, b, points) >= 0) & (_turn(b, c, points) >= 0) & (_turn(c, a, points) >= 0)
        own = (points == a).all(1) | (points == b).all(1) | (points == c).all(1)
        if not (inside & ~own).any():
            return position, count
    return 1, max(len(convex), 1)


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return twice the signed areas of the 2D triangles a, b, c, positive if counter-clockwise."""
    return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
