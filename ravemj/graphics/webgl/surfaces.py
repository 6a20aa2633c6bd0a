"""Conversion of a compiled model's geoms to triangle meshes; geoms of equal shape share one mesh."""

import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.style import drawn_geoms, geom_rgba

Triangles = NDArray[np.uint32]

_SLICES, _STACKS = 40, 20
"""Facets around and along round shapes."""

_SHARP = 0.8
"""Minimum cosine of the angle between vertex and face normal at which MuJoCo shades a corner smoothly."""

_PLANE = 1000.0
"""Half the side [m] of the square that represents an infinite plane."""

_TWO_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
"""Two triangles that form a square, as indices of its corners."""


class TriangleMesh(NamedTuple):
    """A triangle mesh with vertex normals."""

    positions: Floats  # of the vertices, shape (N, 3)
    normals: Floats  # unit normals there, shape (N, 3)
    triangles: Triangles  # vertex indices, shape (M, 3), counterclockwise seen from outside


class MeshInstance(NamedTuple):
    """Instance of a mesh on a body, made for a geom; mesh, body and geom are given by index."""

    mesh: int
    body: int
    geom: int
    T_body_shape: Floats  # with the scale in its columns, shape (3, 4) [m]
    rgba: Floats  # colour and opacity, 0 to 1
    reach: float  # radius of a bounding sphere about the shape's origin [m]


class Surfaces(NamedTuple):
    """The drawn geometry of a model."""

    meshes: list[TriangleMesh]
    shapes: list[MeshInstance]


def surfaces(model: mujoco.MjModel, geoms: NDArray[np.bool_] | None = None, *, hulls: bool = False) -> Surfaces:
    """Return the surfaces of geoms.

    Args:
        model: The compiled model.
        geoms: Mask of geoms, shape (ngeom,); None: all visible ones.
        hulls: Whether colliding meshes are replaced by their convex hulls.
    """
    meshes: list[TriangleMesh] = []
    numbers: dict[tuple[int, ...], int] = {}
    colours = geom_rgba(model)
    shapes: list[MeshInstance] = []
    for geom in np.flatnonzero(drawn_geoms(model) if geoms is None else geoms).tolist():
        key, scale, make = _shared(model, geom, is_hull=hulls and _has_hull(model, geom))
        if key not in numbers:
            numbers[key] = len(meshes)
            meshes.append(make())
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
        is_plane = key[0] == mujoco.mjtGeom.mjGEOM_PLANE
        reach = float(np.linalg.norm(scale) if is_plane else model.geom_rbound[geom])
        placed = np.column_stack([rotation.reshape(3, 3) * scale, model.geom_pos[geom]])
        shapes.append(MeshInstance(numbers[key], int(model.geom_bodyid[geom]), geom, placed, colours[geom], reach))
    return Surfaces(meshes, shapes)


def _shared(
    model: mujoco.MjModel, geom: int, *, is_hull: bool
) -> tuple[tuple[int, ...], Floats, Callable[[], TriangleMesh]]:
    """Return a key that geoms with the same mesh share, this geom's scale, shape (3,), and the mesh's constructor."""
    kind, data, size = int(model.geom_type[geom]), int(model.geom_dataid[geom]), model.geom_size[geom]
    match mujoco.mjtGeom(kind):
        case mujoco.mjtGeom.mjGEOM_MESH:
            return (kind, data, is_hull), np.ones(3), partial(_hull if is_hull else _mesh_of_model, model, data)
        case mujoco.mjtGeom.mjGEOM_CAPSULE:  # its ends stay round only under uniform scaling
            half_length = size[1] / size[0]
            return (kind, round(1000 * half_length)), np.full(3, size[0]), partial(round_mesh, half_length)
        case mujoco.mjtGeom.mjGEOM_CYLINDER:
            return (kind,), size[[0, 0, 1]], _cylinder
        case mujoco.mjtGeom.mjGEOM_PLANE:
            return (kind,), np.array([*np.where(size[:2] > 0, size[:2], _PLANE), 1.0]), _square
        case mujoco.mjtGeom.mjGEOM_BOX:
            return (kind,), size.copy(), _box
        case _:
            is_ellipsoid = kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID
            return (kind,), size.copy() if is_ellipsoid else np.full(3, size[0]), partial(round_mesh, 0.0)


def _mesh_of_model(model: mujoco.MjModel, number: int) -> TriangleMesh:
    """Return a mesh as MuJoCo draws it; vertices with several normals are duplicated."""
    first, count = int(model.mesh_faceadr[number]), int(model.mesh_facenum[number])
    vertices = model.mesh_face[first : first + count].astype(np.int64)
    towards = model.mesh_facenormal[first : first + count].astype(np.int64)
    positions = model.mesh_vert[int(model.mesh_vertadr[number]) :][: int(vertices.max()) + 1].astype(np.float64)
    smooth = model.mesh_normal[int(model.mesh_normaladr[number]) :][: int(towards.max()) + 1].astype(np.float64)
    sides = positions[vertices]
    flat = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-12)
    is_flat = (smooth[towards] * flat[:, None]).sum(axis=2) < _SHARP
    planes, plane = np.unique(flat.round(3), axis=0, return_inverse=True)  # faces in one plane share corners
    normals = np.concatenate([smooth, planes])
    towards = np.where(is_flat, len(smooth) + plane.reshape(-1, 1), towards)
    pairs, corners = np.unique(vertices * len(normals) + towards, return_inverse=True)
    vertex, normal = np.divmod(pairs, len(normals))
    return TriangleMesh(positions[vertex], normals[normal], corners.reshape(-1, 3).astype(np.uint32))


def _has_hull(model: mujoco.MjModel, geom: int) -> bool:
    """Return whether a geom is a colliding mesh, whose convex hull can be drawn."""
    data = int(model.geom_dataid[geom])
    is_mesh = model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
    collides = bool(model.geom_contype[geom] or model.geom_conaffinity[geom])
    return bool(is_mesh and collides and model.mesh_graphadr[data] >= 0)


def _hull(model: mujoco.MjModel, number: int) -> TriangleMesh:
    """Return the convex hull of a mesh as triangles with flat shading."""
    graph = model.mesh_graph[int(model.mesh_graphadr[number]) :]
    vertices, faces = int(graph[0]), int(graph[1])
    start = 2 + 3 * vertices + 3 * faces  # behind the numbers and edges of the vertices
    corners = model.mesh_vert[int(model.mesh_vertadr[number]) + graph[start : start + 3 * faces]].astype(np.float64)
    sides = corners.reshape(-1, 3, 3)
    normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return TriangleMesh(corners, normals.repeat(3, axis=0), np.arange(3 * faces, dtype=np.uint32).reshape(-1, 3))


def _square() -> TriangleMesh:
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return TriangleMesh(corners, np.tile([0.0, 0, 1], (4, 1)), _TWO_TRIANGLES)


def _box() -> TriangleMesh:
    positions, normals = np.zeros((6, 4, 3)), np.zeros((6, 4, 3))
    for face, (axis, side) in enumerate(itertools.product(range(3), (-1.0, 1.0))):
        positions[face, :, axis] = normals[face, :, axis] = side
        positions[face, :, axis - 2], positions[face, :, axis - 1] = [-side, side, side, -side], [-1, -1, 1, 1]
    triangles = 4 * np.arange(6, dtype=np.uint32)[:, None, None] + _TWO_TRIANGLES
    return TriangleMesh(positions.reshape(-1, 3), normals.reshape(-1, 3), triangles.reshape(-1, 3))


def round_mesh(half_length: float) -> TriangleMesh:
    """Return a unit sphere or, if ``half_length`` is above 0, a capsule along z."""
    polar = np.linspace(0, math.pi, _STACKS + 1)
    rings = np.stack([np.sin(polar), np.cos(polar)], axis=1)
    shift = np.where(np.arange(_STACKS + 1) <= _STACKS // 2, half_length, -half_length)
    if half_length:  # the equator is duplicated, for both ends of the cylinder
        middle = _STACKS // 2
        rings = np.insert(rings, middle, rings[middle], axis=0)
        shift = np.insert(shift, middle + 1, -half_length)
    return _revolved(rings + np.stack([0 * shift, shift], axis=1), rings)


def _cylinder() -> TriangleMesh:
    """Return a cylinder of radius 1 along z from -1 to 1."""
    profile = np.array([[0.0, 1], [1, 1], [1, 1], [1, -1], [1, -1], [0, -1]])
    normals = np.array([[0.0, 1], [0, 1], [1, 0], [1, 0], [0, -1], [0, -1]])
    return _revolved(profile, normals)


def _revolved(profile: Floats, normals: Floats) -> TriangleMesh:
    """Return the surface of revolution about z of a profile: rows (distance from z, height), from top to bottom."""
    turn = np.linspace(0, 2 * math.pi, _SLICES + 1)
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)

    def spread(rows: Floats) -> Floats:
        flat = rows[:, None, :1] * around
        return np.concatenate([flat, np.broadcast_to(rows[:, None, 1:], (*flat.shape[:2], 1))], axis=2).reshape(-1, 3)

    number = np.arange(len(profile) * len(turn), dtype=np.uint32).reshape(len(profile), -1)
    upper, lower = number[:-1], number[1:]
    near = np.stack([upper[:, :-1], lower[:, :-1], lower[:, 1:]], axis=-1).reshape(-1, 3)
    far = np.stack([upper[:, :-1], lower[:, 1:], upper[:, 1:]], axis=-1).reshape(-1, 3)
    positions = spread(profile)
    triangles = np.concatenate([near, far])
    corners = positions[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return TriangleMesh(
        positions, spread(normals), triangles[areas > 1e-12]
    )  # without degenerate ones at the poles and at duplicated rings
