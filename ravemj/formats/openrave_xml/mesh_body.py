"""A mesh file in place of a body: one static link with the shapes of the file."""

import os
from pathlib import Path

from ravemj.core.transforms import Pose, Vec3
from ravemj.errors import Source
from ravemj.formats.meshes import MESH_SUFFIXES
from ravemj.formats.openrave_xml.context import COLLADA_SUFFIXES, Context
from ravemj.model.builder import BodyBuilder, LinkBuilder
from ravemj.model.scene import Geometry, TriMesh
from ravemj.model.shape_bodies import MASSLESS


def is_mesh(name: str) -> bool:
    """Return whether a file in place of a body is a mesh; COLLADA files are robots there."""
    lowered = name.lower()
    return lowered.endswith(MESH_SUFFIXES) and not lowered.endswith(COLLADA_SUFFIXES)


def add_mesh(body: BodyBuilder, path: str, scale: Vec3, source: Source, context: Context) -> None:
    """Fill a body with the link that OpenRAVE makes of a mesh file; it has the name of the file.

    Args:
        body: The body.
        path: The file.
        scale: Factors along x, y and z.
        source: Where the file is named.
        context: Takes findings.
    """
    geometries = [
        Geometry(
            shape=TriMesh(part.mesh),
            T_link_geometry=Pose(),
            name="",
            diffuse=part.diffuse,
            ambient=part.ambient,
            transparency=part.transparency,
            visible=True,
            source=source,
        )
        for part in context.mesh(os.path.abspath(path), source, scale=scale)
    ]
    body.links.append(LinkBuilder("base", source, geometries=geometries, inertial=MASSLESS, static=True))
    body.name = Path(path).stem
