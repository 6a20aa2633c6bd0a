"""Axis-aligned bounding boxes and triangles of geometries and links."""

from collections.abc import Iterable, Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.geometry_functions import AABB
from ravemj.model.scene import Bounds, Extent, Geometry, Link, Mesh


def geometry_bounds(geometry: Geometry, T_a_link: Floats) -> Bounds:
    """Return the exact bounds of a geometry in frame a, given its link's pose; a point if it is empty."""
    return geometry.shape.bounds(T_a_link @ geometry.T_link_geometry.matrix())


def link_bounds(link: Link, T_a_link: Floats) -> Bounds | None:
    """Return the bounds of a link's geometries in frame a; None if they are empty."""
    return _enclosing(geometry_bounds(geometry, T_a_link) for geometry in link.geometries)


def links_bounds(links: Iterable[Link], T_a_links: Iterable[Floats]) -> Bounds | None:
    """Return the bounds of several links at their poses; None if they are empty."""
    each_bounds = (link_bounds(link, T_a_link) for link, T_a_link in zip(links, T_a_links, strict=True))
    return _enclosing(bounds for bounds in each_bounds if bounds is not None)


class BodyBounds:
    """Bounding box of a body's geometries, prepared for many poses."""

    def __init__(self, links: Sequence[Link]) -> None:
        """Collect the geometries of links."""
        extents: list[tuple[int, Geometry, Extent]] = []
        self._corners: list[tuple[int, Floats]] = []  # by link, vertices in its frame, shape (4, n)
        for index, geometry in [(index, shape) for index, link in enumerate(links) for shape in link.geometries]:
            extent = geometry.shape.extent()
            if extent is not None:
                if max(*extent.box, extent.disk, extent.ball) > 0.0:
                    extents.append((index, geometry, extent))
            elif len(vertices := geometry.shape.triangulated().vertices) and np.ptp(vertices, axis=0).any():
                points = np.vstack((vertices.T, np.ones(len(vertices))))
                self._corners.append((index, geometry.T_link_geometry.matrix() @ points))
        self._links = np.array([index for index, _, _ in extents], dtype=int)
        self._poses = np.array([shape.T_link_geometry.matrix() for _, shape, _ in extents]).reshape(-1, 4, 4)
        self._centres = np.array([(*extent.centre, 1.0) for _, _, extent in extents]).reshape(-1, 4, 1)
        self._boxes = np.array([extent.box for _, _, extent in extents]).reshape(-1, 3, 1)
        self._radii = np.array([(extent.disk, extent.ball) for _, _, extent in extents]).reshape(-1, 2)

    def at(self, T_a_links: Floats, chosen: Sequence[bool]) -> Bounds | None:
        """Return the exact bounds in frame a of the chosen links; None if they are empty.

        ``T_a_links`` are the poses of all links, shape (links, 4, 4).
        """
        poses = T_a_links[self._links] @ self._poses
        centres, rotations = (poses @ self._centres)[:, :3, 0], poses[:, :3, :3]
        reaches = (np.abs(rotations) @ self._boxes)[:, :, 0] + self._radii[:, 1:]
        reaches += np.hypot(rotations[:, :, 0], rotations[:, :, 1]) * self._radii[:, :1]
        some = np.array(chosen, dtype=bool)[self._links]
        parts = [(centres - reaches)[some].T, (centres + reaches)[some].T]
        parts += [T_a_links[link, :3] @ corners for link, corners in self._corners if chosen[link]]
        points = np.concatenate(parts, axis=1)
        return Bounds(points.min(axis=1), points.max(axis=1)) if points.size else None


def _enclosing(parts: Iterable[Bounds]) -> Bounds | None:
    extended = [part for part in parts if (part.high > part.low).any()]
    if len(extended) < 2:
        return extended[0] if extended else None
    return Bounds(np.min([part.low for part in extended], axis=0), np.max([part.high for part in extended], axis=0))


def enclosing_box(bounds: Bounds | None, T_a_origin: Floats) -> AABB:
    """Return bounds as OpenRAVE's box; None becomes a point at the origin of the frame ``T_a_origin``."""
    low, high = bounds or (T_a_origin[:3, 3], T_a_origin[:3, 3])
    return AABB((low + high) / 2, (high - low) / 2)


def links_triangles(links: Iterable[Link], T_a_links: Iterable[Floats]) -> Mesh:
    """Return the geometries of links at their poses as triangles in frame a."""
    return Mesh.merged(
        geometry.triangulated().moved(T_a_link @ geometry.T_link_geometry.matrix())
        for link, T_a_link in zip(links, T_a_links, strict=True)
        for geometry in link.geometries
    )
