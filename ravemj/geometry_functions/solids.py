"""Meshes of simple solids, and a nearest-neighbour order of points."""

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Ints
from ravemj.errors import ArgumentError
from ravemj.geometry_functions import arguments

_BOX_TRIANGLES = (
    (0, 1, 2), (1, 2, 3), (4, 5, 6), (5, 6, 7), (0, 1, 4), (1, 4, 5),
    (2, 3, 6), (3, 6, 7), (0, 2, 4), (2, 4, 6), (1, 3, 5), (3, 5, 7),
)  # fmt: skip

_FINEST = 10
"""Maximum number of subdivisions of a sphere's triangles, which gives 20 million triangles."""

_GOLDEN = (1 + 5**0.5) / 2
_ICOSAHEDRON = [
    corner[shift:] + corner[:shift]
    for shift in range(3)
    for corner in ([0.0, y, z * _GOLDEN] for y in (1.0, -1.0) for z in (1.0, -1.0))
]


def ComputeBoxMesh(extents: ArrayLike) -> tuple[Floats, Ints]:
    """Return the vertices, shape (8, 3), and triangles, shape (12, 3), of a box of half extents ``extents`` [m]."""
    signs = np.array(list(itertools.product((1.0, -1.0), repeat=3)))
    return signs * arguments.numbers(extents, 3, "extents"), np.array(_BOX_TRIANGLES)


def ComputeCylinderYMesh(radius: float, height: float, angledelta: float = 0.1) -> tuple[Floats, Ints]:
    """Return the mesh of the side of a cylinder along the y axis.

    Args:
        radius: Radius [m].
        height: Height [m].
        angledelta: Angle between edges [rad].

    Returns:
        Points, the upper circle first, shape (2 n, 3), and triangles, shape (2 n, 3).
    """
    angles = np.arange(0, 2 * np.pi, angledelta)
    count = len(angles)
    circle = np.column_stack([radius * np.cos(angles), np.full(count, height / 2), radius * np.sin(angles)])
    here = np.arange(count)
    before = np.roll(here, 1)
    upper = np.column_stack([before, here, before + count])
    lower = np.column_stack([here, here + count, before + count])
    return np.vstack([circle, circle * (1, -1, 1)]), np.stack([upper, lower], axis=1).reshape(-1, 3)


def ComputeGeodesicSphereMesh(radius: float = 1.0, level: int = 2) -> tuple[Floats, Ints]:
    """Return the mesh of a sphere of nearly equal triangles.

    Args:
        radius: Radius [m].
        level: Number of subdivisions of an icosahedron's triangles into four, 10 at most.

    Returns:
        Points, shape (2 + 10 * 4**level, 3), and triangles, shape (20 * 4**level, 3).
    """
    if level > _FINEST:
        raise ArgumentError(f"level: is {level}, and should be {_FINEST} at most")
    points = np.array(_ICOSAHEDRON)
    points /= np.linalg.norm(points[0])
    triangles = np.array(_faces(points))
    for _ in range(level):
        points, triangles = refined(points, triangles)
    return radius * points, triangles


def _faces(corners: Floats) -> list[tuple[int, int, int]]:
    """Return an icosahedron's triangles as indices of its corners, counter-clockwise seen from outside."""
    near = corners @ corners.T > 0.4
    faces: list[tuple[int, int, int]] = []
    for a, b, c in itertools.combinations(range(len(corners)), 3):
        if near[a, b] and near[b, c] and near[c, a]:
            outside = np.cross(corners[b] - corners[a], corners[c] - corners[a]) @ corners[a] > 0
            faces.append((a, b, c) if outside else (a, c, b))
    return faces


def refined(corners: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    """Subdivide each triangle of a mesh into four; the new vertices, in the order of edges, are on the unit sphere."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, first, places = np.unique(edges, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    middles = corners[unique[order]].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    ab, bc, ca = (np.argsort(order)[places].reshape(-1, 3) + len(corners)).T
    a, b, c = triangles.T
    four = [(a, ab, ca), (ab, b, bc), (ca, ab, bc), (ca, bc, c)]
    return np.concatenate([corners, middles]), np.stack([np.column_stack(three) for three in four], 1).reshape(-1, 3)


def TSP(solutions: ArrayLike, distfn: Callable[[Floats, Floats], float]) -> Floats:
    """Return points in a greedy order: each is followed by the nearest of the remaining points.

    Args:
        solutions: The points, shape (n, k); the first one stays first.
        distfn: Distance of two points.

    Returns:
        The same points, shape (n, k).
    """
    ordered = checked_numbers(solutions, "solutions")
    for place in range(1, len(ordered) - 1):
        distances = [distfn(ordered[place - 1], point) for point in ordered[place:]]
        nearest = place + int(np.argmin(distances))
        ordered[[place, nearest]] = ordered[[nearest, place]]
    return ordered
