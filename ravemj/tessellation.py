"""Shapes as triangles."""

import functools
from collections.abc import Iterable

import numpy as np

from ravemj.scene import Geometry, Mesh, Prism, Shape, TriMesh
from ravemj.transforms import Floats, Ints, Pose

SUBDIVISIONS = 3
"""How often an icosahedron is refined to a sphere."""
SIDES = 51
"""Sides of a cylinder."""


def triangles_of(geometry: Geometry) -> Mesh:
    """Return what scripts get as triangles of a geometry, in its frame: those that were set, else of its shape."""
    return triangulated(geometry.shape) if geometry.collision_mesh is None else geometry.collision_mesh


def triangulated(shape: Shape) -> Mesh:
    """Return a shape as triangles, seen from outside counter-clockwise, in the frame of its geometry.

    Round shapes have their corners on the surface. A container is the sum of its walls.
    """
    match shape:
        case TriMesh(mesh):
            return mesh
        case Prism():
            return shape.walls()
        case _:
            from ravemj.mjcf import solids  # noqa: PLC0415 - slow to import

            return merged(moved(_solid(kind, size), Pose(centre).matrix()) for kind, size, centre in solids(shape))


def merged(meshes: Iterable[Mesh]) -> Mesh:
    """Return all triangles of some meshes as one mesh."""
    vertices, triangles = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int_)]
    count = 0
    for mesh in meshes:
        vertices.append(mesh.vertices)
        triangles.append(mesh.triangles + count)
        count += len(mesh.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(triangles))


def moved(mesh: Mesh, T_a_b: Floats) -> Mesh:
    """Return a mesh of frame b in frame a."""
    return Mesh(mesh.vertices @ T_a_b[:3, :3].T + T_a_b[:3, 3], mesh.triangles)


def _solid(kind: str, size: tuple[float, ...]) -> Mesh:
    """Return a box, sphere, cylinder or capsule of MuJoCo's sizes."""
    if kind == "box":
        corners, triangles = _cube()
        return Mesh(corners * size, triangles)
    if kind == "cylinder":
        corners, triangles = _unit_cylinder()
        return Mesh(corners * [size[0], size[0], size[1]], triangles)
    corners, triangles = _unit_sphere()
    if kind == "capsule":
        ends = np.where(corners[:, 2] >= 0, size[1], -size[1])
        return Mesh(corners * size[0] + np.outer(ends, [0.0, 0.0, 1.0]), triangles)
    return Mesh(corners * size[0], triangles)


@functools.cache
def _cube() -> tuple[Floats, Ints]:
    corners = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return corners, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


@functools.cache
def _unit_cylinder() -> tuple[Floats, Ints]:
    """Return two rings of corners, the lower one first, and the middles of the two ends."""
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    low, high = (np.column_stack([np.cos(angles), np.sin(angles), np.full(SIDES, z)]) for z in (-1.0, 1.0))
    here = np.arange(SIDES)
    after = np.roll(here, -1)
    bottom, top = np.full(SIDES, 2 * SIDES), np.full(SIDES, 2 * SIDES + 1)
    sides = [(here, after, after + SIDES), (here, after + SIDES, here + SIDES)]
    ends = [(bottom, after, here), (top, here + SIDES, after + SIDES)]
    triangles = np.concatenate([np.column_stack(three) for three in (*sides, *ends)])
    return np.concatenate([low, high, [[0.0, 0, -1], [0, 0, 1]]]), triangles


@functools.cache
def _unit_sphere() -> tuple[Floats, Ints]:
    golden = (1 + 5**0.5) / 2
    corners = np.array([[0.0, y, z] for y in (-1.0, 1.0) for z in (-golden, golden)])
    corners = np.concatenate([np.roll(corners, shift, axis=1) for shift in range(3)])
    corners /= np.linalg.norm(corners[0])
    triangles = _icosahedron(corners)
    for _ in range(SUBDIVISIONS):
        corners, triangles = _refined(corners, triangles)
    return corners, triangles


def _icosahedron(corners: Floats) -> Ints:
    """Return the faces: the triples of corners that are next to each other, seen from outside."""
    near = corners @ corners.T > 0.4
    np.fill_diagonal(near, val=False)
    faces: list[tuple[int, int, int]] = []
    for a, b, c in np.argwhere(near[:, :, None] & near[:, None, :] & near[None, :, :]).tolist():
        if a < min(b, c) and np.linalg.det(corners[[a, b, c]]) > 0:
            faces.append((a, b, c))
    return np.array(faces)


def _refined(corners: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    """Return four triangles for each, with the new corners on the unit sphere."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, places = np.unique(edges, axis=0, return_inverse=True)
    middles = corners[unique].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    ab, bc, ca = (places.reshape(-1, 3) + len(corners)).T
    a, b, c = triangles.T
    four = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([corners, middles]), np.concatenate([np.column_stack(three) for three in four])
