"""Whether two geoms touch, how far they are apart, how deep they are in each other."""

from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats

if TYPE_CHECKING:
    from ravemj.engine.collision.triangles import TriangleTests

TOUCHING = 1e-10
"""Shapes this near [m] touch, and count as colliding."""

_RANGE = 1e-8  # m; MuJoCo looks no farther when only touching is asked for
_GRAZING = 1e-6  # m; hulls that are less deep in each other may just touch
_FAR = 1e10  # m


class Contact(NamedTuple):
    """Where two geoms are in each other."""

    position: Floats  # the middle between the deepest point of each, in the world [m], shape (3,)
    normal: Floats  # unit vector out of the second geom towards the first, shape (3,)
    depth: float  # how far they are in each other [m]; 0 where they just touch


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
        """Return whether a geom is a mesh that does not fill its hull."""
        return self._triangles is not None and self._triangles.is_concave(geom)

    def touch(self, first: int, second: int) -> bool:
        """Return whether two geoms overlap or touch."""
        hulls = mujoco.mj_geomDistance(self._model, self._data, first, second, _RANGE, None)
        triangles = self._triangles
        if hulls > TOUCHING or triangles is None:
            return hulls <= TOUCHING
        if hulls > -_GRAZING:  # whether triangles overlap that just touch is up to rounding; distances are not
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

    def contact(self, first: int, second: int) -> Contact:
        """Return the deepest contact of two geoms that touch."""
        depth = max(-self.distance(first, second), 0.0)
        start, end = self._segment[:3].copy(), self._segment[3:].copy()
        normal = end - start
        if depth <= TOUCHING:  # no direction in the two points
            normal = self._data.geom_xpos[first] - self._data.geom_xpos[second]
        length = float(np.linalg.norm(normal))
        return Contact((start + end) / 2, normal / length if length else np.array([0.0, 0.0, 1.0]), depth)
