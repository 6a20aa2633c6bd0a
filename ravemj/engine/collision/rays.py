"""Ray casting: first hits of rays with geoms. Meshes are their triangles."""

import math
from copy import copy
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints

_TARGET, _LEFT_OUT = 0, 5
_GROUPS = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)
_FAR = 1e10

_SHORTEST = 1e-14
"""Minimum length of a ray's direction [m]; MuJoCo treats shorter ones as zero."""


class RayHit(NamedTuple):
    """Hit of a ray on a geom."""

    geom: int
    fraction: float  # fraction of the ray, from 0 to 1
    position: Floats  # in the world [m], shape (3,)
    normal: Floats  # of the surface, outwards, of length 1, shape (3,)


class RayCaster:
    """Casts rays against geoms of a model: a single ray by ``mj_ray``, several by one call of ``mj_multiRay``.

    MuJoCo tests geoms of selected groups that are not fully transparent. A copy of the model has all of them visible
    and in the selected group, so that concurrent drawing of the model is not affected.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, geoms: Ints) -> None:
        """Store a model, its state, and the default target geoms."""
        self._model, self._data, self._geoms = copy(model), data, geoms
        self._model.geom_rgba[:, 3] = 1.0
        self._targets: Ints | None = None

    def _aim_at(self, geoms: Ints | None) -> None:
        geoms = self._geoms if geoms is None else geoms
        if self._targets is not geoms and (self._targets is None or not np.array_equal(self._targets, geoms)):
            self._model.geom_group[:] = _LEFT_OUT
            self._model.geom_group[geoms] = _TARGET
        self._targets = geoms

    def first_hit(self, start: Floats, direction: Floats, geoms: Ints | None = None) -> RayHit | None:
        """Return the first hit of a ray. A ray that starts inside a solid reports its exit point.

        The ray starts at ``start`` in the world [m], shape (3,); its range is the length of ``direction`` [m], shape
        (3,).
        """
        if math.hypot(*direction.tolist()) <= _SHORTEST:
            return None
        self._aim_at(geoms)
        geom, normal = np.empty(1, dtype=np.int32), np.empty(3)
        fraction = mujoco.mj_ray(self._model, self._data, start, direction, _GROUPS, True, -1, geom, normal)
        if not 0 <= fraction <= 1:
            return None
        return RayHit(int(geom[0]), fraction, start + fraction * direction, normal)

    def cast(
        self,
        start: Floats,
        directions: Floats,
        reach: float = _FAR,
        geoms: Ints | None = None,
        normals: Floats | None = None,
    ) -> tuple[Floats, NDArray[np.int32]]:
        """Return the first hit of each ray from a common origin; inside a solid, it is the exit point.

        Geoms beyond ``reach`` [m] may be ignored. ``normals`` receives the outward unit normals at the hits, (n, 3).

        Returns:
            The distance of each hit as a multiple of its direction's length, and the geom, each (n,); -1 without a hit.
        """
        self._aim_at(geoms)
        count = len(directions)
        hit_geoms, distances = np.empty(count, dtype=np.int32), np.empty(count)
        rays, flat = np.ascontiguousarray(directions).reshape(-1), None if normals is None else normals.reshape(-1)
        mujoco.mj_multiRay(
            self._model, self._data, start, rays, _GROUPS, True, -1, hit_geoms, distances, flat, count, reach
        )
        return distances, hit_geoms

    def first_hits(
        self, rays: Floats, geoms: Ints | None = None, *, front_facing_only: bool = False
    ) -> tuple[NDArray[np.bool_], Floats]:
        """Return the first hits of rays; rays with the same start are cast together, in one call of MuJoCo.

        Args:
            rays: Start and direction of each ray; the length of the direction is the range [m], shape (n, 6).
            geoms: The target geoms.
            front_facing_only: Whether to ignore hits from behind, on the inside of a surface.

        Returns:
            Whether each ray hits, shape (n,); and position and outward normal of each hit, shape (n, 6), zeros without
            a hit.
        """
        hits, points = np.zeros(len(rays), dtype=np.bool_), np.zeros((len(rays), 6))
        if len(rays) == 1:
            hit = self.first_hit(rays[0, :3], rays[0, 3:], geoms)
            if hit is not None and not (front_facing_only and hit.normal @ rays[0, 3:] >= 0):
                hits[0], points[0, :3], points[0, 3:] = True, hit.position, hit.normal
            return hits, points
        long = np.flatnonzero(np.linalg.norm(rays[:, 3:], axis=1) > _SHORTEST)
        for some in _of_one_start(rays, long) if len(long) else ():
            start, directions, normals = rays[some[0], :3], rays[some, 3:], np.zeros((len(some), 3))
            distances, _ = self.cast(start, directions, geoms=geoms, normals=normals)
            is_hit = (distances >= 0) & (distances <= 1)
            if front_facing_only:
                is_hit &= (normals * directions).sum(axis=1) < 0
            chosen = some[is_hit]
            hits[chosen] = True
            points[chosen, :3] = start + distances[is_hit, None] * directions[is_hit]
            points[chosen, 3:] = normals[is_hit]
        return hits, points


def _of_one_start(rays: Floats, chosen: Ints) -> list[Ints]:
    """Group the chosen rays by start; return their indices."""
    order = chosen[np.lexsort(rays[chosen, :3].T)]
    ends = np.flatnonzero((rays[order[1:], :3] != rays[order[:-1], :3]).any(axis=1)) + 1
    return np.split(order, ends)
