"""What MuJoCo can do with a mesh: it collides with convex hulls, and makes none of flat ones."""

from typing import Literal

import numpy as np

from ravemj.meshes.parts import corners_of
from ravemj.scene import Mesh

CollisionForm = Literal["hull", "visual"]

_FLAT = 1e-4


def collision_form(mesh: Mesh) -> CollisionForm:
    """Say whether MuJoCo can let a mesh collide.

    Returns:
        ``hull`` if the mesh has a convex hull with volume; ``visual`` if it is flat, a line or a point, or has fewer
        than four vertices, so that it can only be seen.
    """
    used = np.unique(mesh.triangles)
    if len(used) < 4:
        return "visual"
    points = mesh.vertices[used]
    _, axes = np.linalg.eigh(np.cov((points - points[0]).T))
    extents = np.ptp(points @ axes, axis=0)
    return "hull" if extents.min() > _FLAT * extents.max() else "visual"


def volume(mesh: Mesh) -> float:
    """Return the volume inside a closed mesh [m^3]; negative if its triangles are turned inside out."""
    a, b, c = np.moveaxis(corners_of(mesh), 1, 0)
    return float((a * np.cross(b - a, c - a)).sum() / 6)


def area(mesh: Mesh) -> float:
    """Return the area of a mesh's triangles [m^2]."""
    a, b, c = np.moveaxis(corners_of(mesh), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
