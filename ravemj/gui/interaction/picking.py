"""Picking: the nearest visible surface on a ray, by ray casting."""

from dataclasses import dataclass

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.simulation import BodyState, Simulation
from ravemj.graphics.rendering import bounding_sphere, drawn_geoms, geom_corners
from ravemj.gui.interaction.viewpoint import ViewRay


@dataclass(frozen=True, eq=False)
class Hit:
    """A point on a link.

    Attributes:
        body: The body.
        link: Index of the link.
        position: The point, in the world [m], shape (3,).
        normal: Outward unit normal of the surface, shape (3,).
        distance: Distance of the point from the eye [m].
    """

    body: BodyState
    link: int
    position: Floats
    normal: Floats
    distance: float


def pick(simulation: Simulation, ray: ViewRay) -> Hit | None:
    """Return the first hit of a ray on a visible link, or None."""
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
    """Axis-aligned bounding box of visible geometry in some frame: centre and half extents [m], shape (3,) each."""

    center: Floats
    half: Floats


def visible_box(body: BodyState, links: "list[int] | None", T_world_frame: Floats) -> VisibleBox | None:
    """Return the bounding box of visible links (None: all), aligned with a frame (4x4); None if no link is visible."""
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
