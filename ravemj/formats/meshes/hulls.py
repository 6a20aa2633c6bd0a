"""Classification of meshes for MuJoCo: a mesh collides as its convex hull, and a flat mesh has none."""

import math
from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.formats.meshes.parts import corners_of
from ravemj.model.scene import Mesh

CollisionForm = Literal["hull", "visual", "none"]

_FLAT = 1e-6  # thickness by width; paper is 100 times thicker
_ROUNDING = 4 * float(np.finfo(np.float32).eps)
_MIN_AREA = 1e-12  # m^2
_MAX_REACH = 1e15  # m; MuJoCo computes areas in single precision
_SAMPLE = 64  # triangles

_forms: WeakKeyDictionary[Mesh, CollisionForm] = WeakKeyDictionary()
"""Cache of collision forms by mesh, as long as the mesh exists.

A lookup hashes the mesh, whose digest all callers need anyway.
"""

_NEEDLE = 1e-7
"""Width-to-length ratio of a mesh below which rounding errors exceed the inertia about its long axis."""


def collision_form(mesh: Mesh) -> CollisionForm:
    """Classify how MuJoCo can use a mesh.

    Returns:
        ``hull`` if the mesh has a convex hull with volume, and so can collide; ``visual`` if it is flat, and so can
        only be drawn; ``none`` if it has no area, is a line, or is so large that MuJoCo would not load it. MuJoCo loads
        all meshes of the first two kinds only with ``inertia="shell"``.
    """
    form = _forms.get(mesh)
    if form is None:
        form = _forms[mesh] = _form(mesh)
    return form


def store_form(mesh: Mesh, form: CollisionForm) -> None:
    """Store the result of ``collision_form`` for a mesh."""
    _forms[mesh] = form


def _form(mesh: Mesh) -> CollisionForm:
    if len(mesh.vertices) and max(mesh.vertices.max(), -mesh.vertices.min()) > _MAX_REACH:
        return "none"
    if _is_plainly_solid(mesh):
        return "hull"
    if area(mesh) <= _MIN_AREA:
        return "none"
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.triangles] = True
    points = mesh.vertices[used]
    _, axes = np.linalg.eigh(_covariance(points))
    extents = np.ptp(points @ axes, axis=0)
    if np.median(extents) <= _NEEDLE * extents.max():
        return "none"
    noise = _ROUNDING * float(np.abs(points).max())
    return "hull" if len(points) >= 4 and extents.min() > max(_FLAT * extents.max(), noise) else "visual"


def _is_plainly_solid(mesh: Mesh) -> bool:
    """Return True if a sample of triangles proves that the mesh has a volume; False is inconclusive.

    The thickness of a mesh in any direction is at least twice the standard deviation of a sample of its points. It must
    exceed a small part of the mesh's length, which is at most the diagonal of a box around mesh and origin.
    """
    corners = mesh.vertices[mesh.triangles[:: len(mesh.triangles) // _SAMPLE + 1]]
    if not len(corners) or _area(corners) <= _MIN_AREA:
        return False
    reach = float(max(mesh.vertices.max(), -mesh.vertices.min()))
    thickness = 2 * math.sqrt(max(np.linalg.eigvalsh(_covariance(corners.reshape(-1, 3)))[0], 0.0))
    return thickness > max(_FLAT * 2 * math.sqrt(3), _ROUNDING) * reach


def _covariance(points: Floats) -> Floats:
    centred = points - points[0]
    centred -= centred.sum(axis=0) / len(points)
    return centred.T @ centred / len(points)


def volume(mesh: Mesh) -> float:
    """Return the volume inside a closed mesh [m^3]; negative if its triangles face inwards."""
    a, b, c = np.moveaxis(corners_of(mesh), 1, 0)
    return float((a * np.cross(b - a, c - a)).sum() / 6)


def area(mesh: Mesh) -> float:
    """Return the area of a mesh's triangles [m^2]."""
    return _area(corners_of(mesh))


def _area(corners: Floats) -> float:
    ux, uy, uz = (corners[:, 1] - corners[:, 0]).T
    vx, vy, vz = (corners[:, 2] - corners[:, 0]).T  # np.cross takes thrice the time
    return float(np.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2).sum() / 2)
