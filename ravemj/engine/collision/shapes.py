"""Exact pair tests of geoms: contact, distance, penetration depth."""

import math
from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats

if TYPE_CHECKING:
    from ravemj.engine.collision.triangles import TriangleTests

TOUCHING = 1e-10
"""Maximum distance of shapes in contact [m]."""

_RANGE = 1e-8  # [m]; MuJoCo's search distance if only contact is tested
_GRAZING = 1e-6  # [m]; penetration depth up to which hulls may merely touch
_FAR = 1e10  # m


class Contact(NamedTuple):
    """Contact between two geoms: position, normal, depth."""

    position: Floats  # the middle between the deepest point of each, in the world [m], shape (3,)
    normal: Floats  # unit vector out of the second geom towards the first, shape (3,)
    depth: float  # penetration depth [m]; 0 if they merely touch


def _triangle_tests(model: mujoco.MjModel, data: mujoco.MjData) -> "TriangleTests":
    from ravemj.engine.collision.triangles import TriangleTests  # noqa: PLC0415 - most models have no meshes

    return TriangleTests(model, data)


class ShapeTests:
    """Exact tests of pairs of geoms of one compiled model, in its present state."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._triangles = _triangle_tests(model, data) if model.nmesh else None
        self._segment = np.zeros(6)

    def is_concave(self, geom: int) -> bool:
        """Return whether a geom is a non-convex mesh."""
        return self._triangles is not None and self._triangles.is_concave(geom)

    def touch(self, first: int, second: int) -> bool:
        """Return whether two geoms overlap or touch."""
        hulls = mujoco.mj_geomDistance(self._model, self._data, first, second, _RANGE, None)
        triangles = self._triangles
        if hulls > TOUCHING or triangles is None:
            return hulls <= TOUCHING
        if hulls > -_GRAZING:  # contact of triangles that merely touch is a matter of rounding; distances are not
            return self.distance(first, second, _RANGE) <= TOUCHING
        if triangles.is_concave(first):
            return triangles.touch(first, second, TOUCHING)
        return not triangles.is_concave(second) or triangles.touch(second, first, TOUCHING)

    def distance(self, first: int, second: int, limit: float = _FAR) -> float:
        """Return the signed distance of two geoms [m], negative if they overlap; at most ``limit``."""
        hulls = mujoco.mj_geomDistance(self._model, self._data, first, second, limit, self._segment)
        triangles = self._triangles
        if triangles is None or hulls >= limit:
            return hulls
        if triangles.is_concave(first):
            return triangles.distance(first, second, limit, self._segment)
        if triangles.is_concave(second):
            hulls = triangles.distance(second, first, limit, self._segment)
            self._segment[:] = np.roll(self._segment, 3)
        return hulls

    def closest(self, first: int, second: int, limit: float) -> tuple[float, Floats]:
        """Return ``distance``, and the nearest (or deepest) points of both geoms as one vector [m], shape (6,)."""
        distance = self.distance(first, second, limit)
        return distance, self._segment.copy()

    def contact(self, first: int, second: int) -> Contact:
        """Return the deepest contact of two geoms that touch."""
        return self._contact(first, second, max(-self.distance(first, second), 0.0), self._segment)

    def contacts_of_triangles(self, first: int, second: int) -> list[Contact]:
        """Return a contact for each touching pair of triangles of two geoms, one of which is concave."""
        triangles = self._triangles
        assert triangles is not None, "one of them is a mesh"
        ours, theirs = (first, second) if triangles.is_concave(first) else (second, first)
        pairs = list(triangles.overlaps(ours, theirs, TOUCHING))
        points = [(distance, segment if ours == first else np.roll(segment, 3)) for distance, segment in pairs]
        contacts = [self._contact(first, second, max(-distance, 0.0), segment) for distance, segment in points]
        return contacts or [self.contact(first, second)]

    def _contact(self, first: int, second: int, depth: float, segment: Floats) -> Contact:
        """Return the contact of two geoms, given its depth and their deepest points, ``segment``, shape (6,) [m]."""
        x, y, z, u, v, w = segment.tolist()  # plain floats: numpy takes ten times as long for so few
        normal = u - x, v - y, w - z
        if depth <= TOUCHING:  # no direction in the two points
            normal = (self._data.geom_xpos[first] - self._data.geom_xpos[second]).tolist()
        length = math.hypot(*normal)
        direction = [part / length for part in normal] if length else [0.0, 0.0, 1.0]
        return Contact(np.array([(x + u) / 2, (y + v) / 2, (z + w) / 2]), np.array(direction), depth)
