"""Rays: where they meet the surface of a geom first. Meshes are their triangles."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints

_MESH = int(mujoco.mjtGeom.mjGEOM_MESH)


class RayHit(NamedTuple):
    """Where a ray meets a geom.

    Attributes:
        geom: The geom.
        fraction: How far along the ray, from 0 to 1.
        position: The point, in the world [m], shape (3,).
        normal: Unit normal of the surface, outwards, shape (3,).
    """

    geom: int
    fraction: float
    position: Floats
    normal: Floats


def first_hit(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: Ints, start: Floats, direction: Floats
) -> RayHit | None:
    """Return where a ray first meets a surface; one that starts inside a solid meets it where it comes out.

    Args:
        model: The model.
        data: Its state.
        geoms: The geoms that it can meet.
        start: Where it begins, in the world [m], shape (3,).
        direction: Its direction and length [m], shape (3,).
    """
    best: RayHit | None = None
    reach, normal = 1.0, np.zeros(3)
    for geom in _near(model, data, geoms, start, direction):
        kind = int(model.geom_type[geom])
        if kind == _MESH:
            fraction = mujoco.mj_rayMesh(model, data, geom, start, direction, normal)
        else:
            pose = data.geom_xpos[geom], data.geom_xmat[geom]
            fraction = mujoco.mju_rayGeom(*pose, model.geom_size[geom], start, direction, kind, normal)
        if 0 <= fraction <= reach:
            reach = fraction
            best = RayHit(geom, fraction, start + fraction * direction, normal.copy())
    return best


def first_hits(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: Ints, rays: Floats, *, front_facing_only: bool
) -> tuple[NDArray[np.bool_], Floats]:
    """Return where many rays first meet a surface; see ``first_hit``.

    Args:
        model: The model.
        data: Its state.
        geoms: The geoms that they can meet.
        rays: Start and direction of each [m], shape (n, 6).
        front_facing_only: Whether hits from behind, on the inside of a surface, are left out.

    Returns:
        Which rays meet something, shape (n,); and position and outward normal of each hit, shape (n, 6), else zeros.
    """
    found, points = np.zeros(len(rays), dtype=np.bool_), np.zeros((len(rays), 6))
    for number, ray in enumerate(rays):
        hit = first_hit(model, data, geoms, ray[:3], ray[3:])
        if hit is not None and not (front_facing_only and hit.normal @ ray[3:] >= 0):
            found[number] = True
            points[number] = (*hit.position, *hit.normal)
    return found, points


def _near(model: mujoco.MjModel, data: mujoco.MjData, geoms: Ints, start: Floats, direction: Floats) -> list[int]:
    """Return the geoms whose spheres a ray meets."""
    to_centre = data.geom_xpos[geoms] - start
    square = float(direction @ direction)
    along = np.clip(to_centre @ direction / square, 0.0, 1.0) if square else np.zeros(len(geoms))
    beside = to_centre - along[:, None] * direction
    radii = model.geom_rbound[geoms] * (1 + 1e-9)
    return geoms[(beside * beside).sum(axis=1) <= radii * radii].tolist()
