"""Boxes along the axes around shapes."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import ZERO, Floats
from ravemj.model.scene import Box, Capsule, Container, Cylinder, Geometry, Link, NoShape, Prism, Sphere, TriMesh


class Bounds(NamedTuple):
    """The corners of a box along the axes: the least and the greatest x, y and z [m], each of shape (3,)."""

    low: Floats
    high: Floats


def geometry_bounds(geometry: Geometry, T_a_link: Floats) -> Bounds:
    """Return the exact bounds of a geometry in frame a, its link at ``T_a_link``; a point for one without a shape."""
    T_a_geometry = T_a_link @ geometry.T_link_geometry.matrix()
    match geometry.shape:
        case TriMesh(mesh):
            return _points_bounds(mesh.vertices, T_a_geometry)
        case Prism() as prism:
            return _points_bounds(prism.walls().vertices, T_a_geometry)
        case solid:
            centre = (0.0, 0.0, solid.outer_extents[2] / 2) if isinstance(solid, Container) else ZERO
            position = T_a_geometry[:3, :3] @ centre + T_a_geometry[:3, 3]
            half = _half_extents(solid, T_a_geometry[:3, :3])
            return Bounds(position - half, position + half)


def _half_extents(solid: Box | Sphere | Cylinder | Capsule | Container | NoShape, rotation: Floats) -> Floats:
    """Return half the edge lengths of the box along the axes around a turned solid."""
    along = np.abs(rotation[:, 2])
    match solid:
        case Box(half_extents):
            return np.abs(rotation) @ half_extents
        case Sphere(radius):
            return np.full(3, radius)
        case Cylinder(radius, height):
            return along * height / 2 + np.hypot(rotation[:, 0], rotation[:, 1]) * radius
        case Capsule(radius, height):
            return along * height / 2 + radius
        case Container(outer_extents):
            return np.abs(rotation) @ outer_extents / 2
        case NoShape():
            return np.zeros(3)


def _points_bounds(points: Floats, T_a_points: Floats) -> Bounds:
    if not len(points):
        return Bounds(T_a_points[:3, 3], T_a_points[:3, 3])
    turned = points @ T_a_points[:3, :3].T + T_a_points[:3, 3]
    return Bounds(turned.min(axis=0), turned.max(axis=0))


def link_bounds(link: Link, T_a_link: Floats) -> Bounds | None:
    """Return the bounds of a link's geometries in frame a; None if there is none with an extent."""
    return _enclosing(geometry_bounds(geometry, T_a_link) for geometry in link.geometries)


def links_bounds(links: Iterable[Link], T_a_links: Iterable[Floats]) -> Bounds | None:
    """Return the bounds of several links, each at its pose; None if none has an extent."""
    found = (link_bounds(link, T_a_link) for link, T_a_link in zip(links, T_a_links, strict=True))
    return _enclosing(bounds for bounds in found if bounds is not None)


def _enclosing(parts: Iterable[Bounds]) -> Bounds | None:
    extended = [part for part in parts if (part.high > part.low).any()]
    if not extended:
        return None
    return Bounds(np.min([part.low for part in extended], axis=0), np.max([part.high for part in extended], axis=0))
