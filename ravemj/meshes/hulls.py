"""What MuJoCo can do with a mesh: it collides with convex hulls, and makes none of flat ones."""

from typing import Literal

import numpy as np

from ravemj.meshes.parts import corners_of
from ravemj.scene import Mesh

CollisionForm = Literal["hull", "visual", "none"]

_FLAT = 1e-6  # thickness by width; paper is 100 times thicker
_ROUNDING = 4 * float(np.finfo(np.float32).eps)
_MIN_AREA = 1e-12  # m^2


def collision_form(mesh: Mesh) -> CollisionForm:
    """Say what MuJoCo can make of a mesh.

    Returns:
        ``hull`` if the mesh has a convex hull with volume, and so can collide; ``visual`` if it is flat, so that it
        can only be seen; ``none`` if it has no area either, and MuJoCo would not load it. With ``inertia="shell"``
        MuJoCo loads the first two, with other settings not all of them.
    """
    if area(mesh) <= _MIN_AREA:
        return "none"
    points = mesh.vertices[np.unique(mesh.triangles)]
    _, axes = np.linalg.eigh(np.cov((points - points[0]).T))
    extents = np.ptp(points @ axes, axis=0)
    noise = _ROUNDING * float(np.abs(points).max())
    return "hull" if len(points) >= 4 and extents.min() > max(_FLAT * extents.max(), noise) else "visual"


def volume(mesh: Mesh) -> float:
    """Return the volume inside a closed mesh [m^3]; negative if its triangles are turned inside out."""
    a, b, c = np.moveaxis(corners_of(mesh), 1, 0)
    return float((a * np.cross(b - a, c - a)).sum() / 6)


def area(mesh: Mesh) -> float:
    """Return the area of a mesh's triangles [m^2]."""
    a, b, c = np.moveaxis(corners_of(mesh), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
