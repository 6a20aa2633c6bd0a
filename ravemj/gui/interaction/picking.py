"""What the pointer points at: the nearest surface that pictures show, by ray casting."""

from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.graphics.rendering import bounding_sphere, drawn_geoms, geom_corners
from ravemj.gui.interaction.viewpoint import Ray


@dataclass(frozen=True, eq=False)
class Hit:
    """A point on a link.

    Attributes:
        body: The body.
        link: Index of its link.
        position: The point, in the world [m], shape (3,).
        normal: Unit normal of the surface, outwards, shape (3,).
        distance: How far it is from the eye [m].
    """

    body: BodyState
    link: int
    position: Floats
    normal: Floats
    distance: float


def pick(simulation: Simulation, ray: Ray) -> Hit | None:
    """Return the nearest point on a link that a ray meets, or None."""
    compiled = simulation.compiled()
    model, data = compiled.model, compiled.data
    center, radius = bounding_sphere(model, data)
    reach = 2 * (float(np.linalg.norm(center - ray.start)) + radius)
    drawn = np.flatnonzero(drawn_geoms(model))
    hit = simulation.collisions().rays.first_hit(ray.start, reach * ray.direction, drawn)
    if hit is None:
        return None
    body_id = model.geom_bodyid[hit.geom]
    for body in simulation.bodies:
        links = np.flatnonzero(compiled.part(body).body_ids == body_id)
        if len(links):
            return Hit(body, int(links[0]), hit.position, hit.normal, hit.fraction * reach)
    return None


@dataclass(frozen=True, eq=False)
class VisibleBox:
    """A box along the axes of a frame around what pictures show of some links: centre and half sides [m], (3,)."""

    center: Floats
    half: Floats


def visible_box(body: BodyState, links: "list[int] | None", T_world_frame: Floats) -> VisibleBox | None:
    """Return the box along the axes of a frame (4x4) around links of a body (None: all); None where none is seen."""
    compiled = body.simulation.compiled()
    model, data, body_ids = compiled.model, compiled.data, compiled.part(body).body_ids
    if links is not None:
        body_ids = body_ids[links]
    geoms = np.flatnonzero(drawn_geoms(model) & np.isin(model.geom_bodyid, body_ids))
    if not len(geoms):
        return None
    corners = geom_corners(model, data, geoms).reshape(-1, 3)
    T_frame_world = inverse(T_world_frame)
    inside = corners @ T_frame_world[:3, :3].T + T_frame_world[:3, 3]
    low, high = inside.min(axis=0), inside.max(axis=0)
    return VisibleBox(0.5 * (low + high), 0.5 * (high - low))
