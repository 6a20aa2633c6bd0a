"""Convex hulls in any dimension, without qhull.

A hull grows by the farthest point of one facet at a time. If only the facet nearest to the origin is extended, the
distance of the origin from the boundary is known long before the hull is complete.
"""

from dataclasses import dataclass
from importlib import import_module
from math import factorial

import numpy as np

from ravemj.core.arrays import Floats, Ints

_TOLERANCE = 1e-10  # of the largest coordinate; points this far above a facet count as on it
_SMALL = 100  # points up to which Qhull is not faster enough to be worth its import
_NOISE = (1e-8, 1e-6, 1e-5)  # of the largest coordinate, where facets are nearly coplanar, as Qhull joggles points
_CHUNK = 256  # facets that are compared with all points at once


@dataclass(frozen=True)
class Hull:
    """Convex hull of points.

    Attributes:
        planes: Outward unit normals and offsets, shape (F, dim + 1); ``n.x + d <= 0`` inside.
        faces: For each plane, the indices of the vertices on it, ascending.
        triangles: Indices of the vertices of simplices that cover the faces, shape (S, dim); in 3D the triangles turn
            counterclockwise seen from outside.
        volume: Volume [units^dim]; in 2D, the area.
    """

    planes: Floats
    faces: tuple[tuple[int, ...], ...]
    triangles: Ints
    volume: float


@dataclass(frozen=True)
class Facet:
    """The facet of a hull nearest to the origin.

    Attributes:
        offset: Signed distance of its plane from the origin; negative if the origin is outside.
        normal: Outward unit normal, shape (dim,).
        points: Indices of all points on its plane.
    """

    offset: float
    normal: Floats
    points: Ints


def hull(points: Floats) -> Hull | None:
    """Return the convex hull of points, or None if they are flat.

    Args:
        points: Shape (n, dim), finite.

    >>> square = hull(np.array([[0.0, 0], [1, 0], [0, 1], [1, 1], [0.5, 0.5]]))
    >>> square.volume, len(square.planes), square.faces[0]
    (1.0, 4, (0, 1))
    """
    points, order = _sorted(points)
    growth = _complete(points)
    return None if growth is None else growth.result(order)


def hull_volume(points: Floats) -> float:
    """Return the volume of the convex hull of points; 0 if they are flat. It is twice as fast as ``hull``.

    Args:
        points: Shape (n, dim), finite.
    """
    growth = _complete(_sorted(points)[0])
    return 0.0 if growth is None else growth.volume()


def _complete(points: Floats) -> "_HullGrowth | None":
    for noise in (0.0, *_NOISE):
        growth = _HullGrowth.start(_joggled(points, noise))
        if growth is None:
            return None
        try:
            if len(points) <= _SMALL or not growth.use_qhull():
                growth.complete()
        except (_CycleError, np.linalg.LinAlgError):
            continue
        return growth
    return None


def nearest_facet(points: Floats) -> Facet | None:
    """Return the facet of the convex hull that is nearest to the origin, or None if the points are flat.

    If the origin is outside, the plane of the facet separates it from the points.

    Args:
        points: Shape (n, dim), finite.
    """
    for noise in (0.0, *_NOISE):
        try:
            return _nearest(_joggled(points, noise), noise)
        except (_CycleError, np.linalg.LinAlgError):
            continue
    return None


def _nearest(points: Floats, noise: float) -> Facet | None:
    growth = _HullGrowth.start(points)
    if growth is None:
        return None
    while True:
        index = int(growth.offsets.argmin())
        normal, offset = growth.normals[index], growth.offsets[index]
        heights = points @ normal - offset
        farthest = int(heights.argmax())
        if heights[farthest] <= growth.tolerance:
            slack = growth.tolerance + 10 * noise * float(np.abs(points).max())
            exact = 0.0 if noise and 0 < offset <= slack else float(offset)
            return Facet(exact, normal, np.flatnonzero(heights > -slack))
        growth.add(farthest)


class _CycleError(ArithmeticError):
    """A point was added twice, since rounding errors make nearly coplanar facets inconsistent."""


def _joggled(points: Floats, noise: float) -> Floats:
    """Return points with random displacements, ``noise`` times the largest coordinate, which avoid coplanar facets."""
    if not noise:
        return points
    return points + noise * np.abs(points).max() * np.random.default_rng(2).uniform(-1, 1, points.shape)


def missing_direction(points: Floats) -> Floats:
    """Return the unit direction in which points have the least variance, shape (dim,)."""
    return np.linalg.svd(points - points.mean(axis=0))[2][-1]


def _sorted(points: Floats) -> tuple[Floats, Ints]:
    """Return the points in lexicographic order, and their former indices.

    The hull prefers the first of equally far points, so it does not depend on the given order.
    """
    order = np.lexsort(points.T[::-1])
    return points[order], order


class _HullGrowth:
    """Convex hull of a growing set of points, as simplices."""

    def __init__(self, points: Floats, simplex: Ints, tolerance: float) -> None:
        self.points = points
        self.tolerance = tolerance
        self.center = points[simplex].mean(axis=0)
        dimension = points.shape[1]
        self._codes = np.random.default_rng(1).integers(1, 2**62, len(points))  # their sum identifies a ridge
        self.facets = np.array([np.delete(simplex, i) for i in range(dimension + 1)])
        self.normals, self.offsets = self._planes(self.facets)
        self._final = np.zeros(len(self.facets), bool)  # no point is outside
        self._taken = set(simplex.tolist())

    @classmethod
    def start(cls, points: Floats) -> "_HullGrowth | None":
        """Start with a large simplex of the points; return None if the points are flat."""
        if len(points) <= points.shape[1]:
            return None
        tolerance = _TOLERANCE * max(float(np.abs(points).max()), np.finfo(float).tiny)
        simplex, rest = [0], points - points[0]
        for _ in range(points.shape[1]):
            lengths = np.linalg.norm(rest, axis=1)
            farthest = int(np.argmax(lengths >= lengths.max() - tolerance))
            if lengths[farthest] <= 10 * tolerance:
                return None
            simplex.append(farthest)
            axis = rest[farthest] / lengths[farthest]
            rest = rest - np.outer(rest @ axis, axis)
        return cls(points, np.array(simplex), tolerance)

    def add(self, index: int) -> None:
        """Add a point: replace the facets visible from it by facets between the point and their border."""
        if index in self._taken:
            raise _CycleError
        self._taken.add(index)
        seen = self.normals @ self.points[index] - self.offsets > self.tolerance
        visible = self.facets[seen]
        codes = self._codes[visible]
        ridges = codes.sum(axis=1, keepdims=True) - codes
        _, first, count = np.unique(ridges.ravel(), return_index=True, return_counts=True)
        border = first[count == 1]
        facets = visible[border // visible.shape[1]]
        facets[np.arange(len(border)), border % visible.shape[1]] = index
        normals, offsets = self._planes(facets)
        kept = ~seen
        self.facets = np.concatenate([self.facets[kept], facets])
        self.normals = np.concatenate([self.normals[kept], normals])
        self.offsets = np.concatenate([self.offsets[kept], offsets])
        self._final = np.concatenate([self._final[kept], np.zeros(len(facets), bool)])

    def complete(self) -> None:
        """Add points until the hull contains all of them."""
        while len(pending := np.flatnonzero(~self._final)[:_CHUNK]):
            heights = self.points @ self.normals[pending].T - self.offsets[pending]
            highest = heights.max(axis=0)
            facet = int(highest.argmax())
            self._final[pending[highest <= self.tolerance]] = True
            if highest[facet] > self.tolerance:
                self.add(int(np.argmax(heights[:, facet] >= highest[facet] - self.tolerance)))

    def use_qhull(self) -> bool:
        """Compute the facets with Qhull; return False if SciPy, the extra ``hulls``, is not installed."""
        try:
            spatial = import_module("scipy.spatial")
        except ImportError:
            return False
        qhull = spatial.ConvexHull(self.points)
        self.facets, equations = np.asarray(qhull.simplices, int), np.asarray(qhull.equations, float)
        self.normals, self.offsets = equations[:, :-1], -equations[:, -1]
        return True

    def _planes(self, facets: Ints) -> tuple[Floats, Floats]:
        """Return outward unit normals and offsets; the center is inside, so each plane is ``n.(x - center) = 1``."""
        corners = self.points[facets] - self.center
        ones = np.ones((len(facets), corners.shape[2], 1))
        scaled: Floats = np.asarray(np.linalg.solve(corners, ones), float)[:, :, 0]
        lengths = np.linalg.norm(scaled, axis=1)
        normals = scaled / lengths[:, None]
        return normals, 1 / lengths + normals @ self.center

    def volume(self) -> float:
        return float(np.abs(np.linalg.det(self.points[self.facets] - self.center)).sum()) / factorial(
            self.points.shape[1]
        )

    def result(self, order: Ints) -> Hull:
        """Return the hull with merged coplanar facets; ``order`` gives the original index of each sorted point."""
        corners = self.points[self.facets] - self.center
        volumes = np.linalg.det(corners)
        facets = self.facets.copy()
        turned = volumes < 0
        facets[turned, :2] = facets[turned, 1::-1]
        heights = self.normals @ self.points.T - self.offsets[:, None] > -self.tolerance
        planes: list[Floats] = []
        faces: dict[tuple[int, ...], None] = {}
        vertices = np.isin(np.arange(len(self.points)), self.facets)
        for i, on in enumerate(heights & vertices):
            face = tuple(sorted(order[on].tolist()))
            if face not in faces:
                faces[face] = None
                planes.append(np.append(self.normals[i], -self.offsets[i]))
        volume = float(np.abs(volumes).sum()) / factorial(self.points.shape[1])
        return Hull(np.array(planes), tuple(faces), order[facets], volume)
