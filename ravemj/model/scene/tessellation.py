"""Tessellation of MuJoCo's solids: boxes, spheres, cylinders and capsules as triangles."""

import functools

import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.geometry_functions.solids import refined
from ravemj.model.scene.mesh import Mesh

SUBDIVISIONS = 3
"""Number of subdivisions of an icosahedron to approximate a sphere."""

# Vertices and faces in OpenRAVE's order, which scripts see in meshes (random api-5000-118); 2: the golden ratio.
_ICOSAHEDRON = np.array(
    [
        *((0, 2, -1), (2, 1, 0), (1, 0, -2), (1, 0, 2), (2, -1, 0), (0, 2, 1)),
        *((-1, 0, 2), (0, -2, -1), (-2, 1, 0), (-1, 0, -2), (-2, -1, 0), (0, -2, 1)),
    ]
)
_FACES = (
    *((0, 1, 2), (1, 3, 4), (3, 5, 6), (2, 4, 7), (6, 5, 8), (2, 7, 9), (5, 0, 8), (9, 7, 10), (1, 0, 5), (10, 7, 11)),
    *((3, 1, 5), (6, 10, 11), (3, 6, 11), (9, 10, 8), (4, 3, 11), (6, 8, 10), (7, 4, 11), (2, 1, 4), (8, 0, 9)),
    (0, 2, 9),
)
SIDES = 51
"""Number of sides of a cylinder."""


def solid_mesh(kind: str, size: tuple[float, ...]) -> Mesh:
    """Return a solid as triangles, centred on the origin.

    Args:
        kind: ``box``, ``sphere``, ``cylinder`` or ``capsule``; round ones have their vertices on the surface.
        size: MuJoCo's sizes: half extents of a box, else the radius and, along z, half the height.
    """
    if kind == "box":
        corners, triangles = _cube()
        return Mesh(corners * size, triangles)
    if kind == "cylinder":
        corners, triangles = _unit_cylinder()
        return Mesh(corners * [size[0], size[0], size[1]], triangles)
    corners, triangles = _unit_sphere()
    if kind == "capsule":  # two hemispheres, each moved by half the height
        ends = np.where(corners[:, 2] >= 0, size[1], -size[1])
        return Mesh(corners * size[0] + np.outer(ends, [0.0, 0.0, 1.0]), triangles)
    return Mesh(corners * size[0], triangles)


@functools.cache
def _cube() -> tuple[Floats, Ints]:
    """Return corners and triangles of the cube [-1, 1]^3 in OpenRAVE's order.

    The source of the order are the random conformance tests api-91001-79 and api-5000-95.
    """
    corners = np.array([[x, y, z] for x in (1.0, -1.0) for y in (1.0, -1.0) for z in (1.0, -1.0)])
    triangles = "021 123 456 576 014 154 263 367 042 246 135 375"
    return corners, np.array([[int(corner) for corner in three] for three in triangles.split()])


@functools.cache
def _unit_cylinder() -> tuple[Floats, Ints]:
    """Return vertices and triangles of a cylinder, radius 1 and height 2, as in OpenRAVE: end centres first."""
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = np.repeat(np.column_stack([np.cos(angles), np.sin(angles), np.ones(SIDES)]), 2, axis=0)
    ring[1::2, 2] = -1.0
    high = 2 + 2 * np.arange(SIDES)
    low, top, bottom = high + 1, np.zeros_like(high), np.ones_like(high)
    high_after, low_after = np.roll(high, -1), np.roll(low, -1)
    triangles = [(top, high, high_after), (bottom, low_after, low), (high, low, high_after)]
    triangles.append((high_after, low, low_after))
    corners = np.concatenate([[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], ring])
    return corners, np.stack([np.column_stack(three) for three in triangles], axis=1).reshape(-1, 3)


@functools.cache
def _unit_sphere() -> tuple[Floats, Ints]:
    golden = (1 + 5**0.5) / 2
    corners = np.sign(_ICOSAHEDRON) * np.where(np.abs(_ICOSAHEDRON) == 2, golden, 1.0)
    corners /= np.linalg.norm(corners[0])
    triangles = np.array(_FACES)
    for _ in range(SUBDIVISIONS):
        corners, triangles = refined(corners, triangles)
    return corners, triangles
