"""Links as triangles."""

from collections.abc import Iterable

from ravemj.core.transforms import Floats
from ravemj.model.scene import Link, Mesh


def links_triangles(links: Iterable[Link], T_a_links: Iterable[Floats]) -> Mesh:
    """Return the geometries of links, each link at its pose, as triangles in frame a."""
    return Mesh.merged(
        geometry.triangulated().moved(T_a_link @ geometry.T_link_geometry.matrix())
        for link, T_a_link in zip(links, T_a_links, strict=True)
        for geometry in link.geometries
    )
