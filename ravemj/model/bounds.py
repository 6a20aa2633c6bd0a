"""Axis-aligned bounding boxes of geometries and links."""

from collections.abc import Iterable

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.geometry_functions import AABB
from ravemj.model.scene import Bounds, Geometry, Link


def geometry_bounds(geometry: Geometry, T_a_link: Floats) -> Bounds:
    """Return the exact bounds of a geometry in frame a, its link at ``T_a_link``; a point for one without a shape."""
    return geometry.shape.bounds(T_a_link @ geometry.T_link_geometry.matrix())


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


def enclosing_box(bounds: Bounds | None, T_a_origin: Floats) -> AABB:
    """Return bounds as OpenRAVE's box; None is a point at the origin of a frame."""
    low, high = bounds or (T_a_origin[:3, 3], T_a_origin[:3, 3])
    return AABB((low + high) / 2, (high - low) / 2)
