"""Polygons to triangles."""

from collections.abc import Iterator

import numpy as np

from ravemj.transforms import Floats, Ints

_MAX_CLIPPED = 1000  # corners of a polygon; larger ones become fans, whatever their shape


def fans(starts: Ints, sizes: Ints) -> Ints:
    """Cut polygons into fans about their first corners, as is right for convex ones.

    Args:
        starts: For each polygon the position of its first corner in a list of corners.
        sizes: For each polygon the number of its corners; those with fewer than three vanish.

    Returns:
        Positions in the list of corners, shape (n, 3).
    """
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(starts, counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def clipped(points: Floats, starts: Ints, sizes: Ints) -> Ints:
    """Cut polygons that may be concave into triangles.

    Args:
        points: The list of corners, shape (n, 3).
        starts: As for ``fans``.
        sizes: As for ``fans``.

    Returns:
        As ``fans``.
    """
    simple = (sizes <= 3) | (sizes > _MAX_CLIPPED)
    pieces = [fans(starts[simple], sizes[simple])]
    for start, size in zip(starts[~simple].tolist(), sizes[~simple].tolist(), strict=True):
        pieces.append(start + clip_ears(points[start : start + size]))
    return np.concatenate(pieces)


def clip_ears(polygon: Floats) -> Ints:
    """Cut one polygon into triangles, ear by ear.

    Args:
        polygon: Its corners in order, shape (n, 3).

    Returns:
        Positions of corners, shape (n - 2, 3), in the polygon's direction of turning.
    """
    flat = _flattened(polygon)
    if _convex(flat):
        return fans(np.array([0]), np.array([len(flat)]))
    left = list(range(len(flat)))
    triangles: list[tuple[int, int, int]] = []
    while len(left) > 3:
        position = next(_ears(flat, left), 1)
        triangles.append((left[position - 1], left[position], left[(position + 1) % len(left)]))
        del left[position]
    triangles.append((left[0], left[1], left[2]))
    return np.array(triangles)


def _flattened(polygon: Floats) -> Floats:
    """Return the corners in the polygon's plane, turning counter-clockwise."""
    following = np.roll(polygon, -1, axis=0)
    normal = np.cross(polygon, following).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    keep = [(drop + 1) % 3, (drop + 2) % 3]
    return polygon[:, keep] * np.array([1.0, -1.0 if normal[drop] < 0 else 1.0])


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return twice the signed areas of triangles, positive where they turn counter-clockwise."""
    return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])


def _convex(flat: Floats) -> bool:
    return bool((_turn(np.roll(flat, 1, axis=0), flat, np.roll(flat, -1, axis=0)) >= 0).all())


def _ears(flat: Floats, left: list[int]) -> Iterator[int]:
    """Yield positions in ``left`` whose corner can be cut off: convex, and no other corner inside the triangle."""
    points = flat[left]
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    for position in np.flatnonzero(_turn(before, points, after) > 0).tolist():
        a, b, c = before[position], points[position], after[position]
        inside = (_turn(a, b, points) >= 0) & (_turn(b, c, points) >= 0) & (_turn(c, a, points) >= 0)
        own = (points == a).all(1) | (points == b).all(1) | (points == c).all(1)
        if not (inside & ~own).any():
            yield position
