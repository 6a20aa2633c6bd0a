"""Meshes as the triangles that they consist of, where MuJoCo would take their convex hulls.

MuJoCo measures distances between convex shapes. A triangle is one: a mesh of three corners, the last one twice. So a
scratch model with two such meshes and one geom of any other shape takes the triangles in turn.
"""

from collections.abc import Iterator

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.formats.meshes import area, volume
from ravemj.model.scene import Mesh

NOT_FILLED = 1e-3
"""The part of its hull's area and volume that a mesh may lack and still be convex."""

_XML = """<mujoco><asset>
<mesh name="a" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><mesh name="b" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
</asset><worldbody>
<geom type="mesh" mesh="a"/><geom type="mesh" mesh="b"/><geom size="1"/>
</worldbody></mujoco>"""
_TRIANGLE, _OTHER_TRIANGLE, _SOLID = range(3)

_CHUNK = 64  # triangles

_Pair = tuple[int, int, float]
"""Two triangles, and how far the boxes around them are apart."""


class TriangleTests:
    """Distances of meshes that are not convex, in one compiled model."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._is_convex: dict[int, bool] = {}
        self._triangles: dict[int, _Triangles] = {}
        self._scratch = mujoco.MjModel.from_xml_string(_XML)
        self._scratch_data = mujoco.MjData(self._scratch)
        self._scratch_data.geom_xmat[:] = np.eye(3).ravel()
        self._corners = self._scratch.mesh_vert.reshape(2, 4, 3)
        self._segment = np.zeros(6)

    def is_concave(self, geom: int) -> bool:
        """Return whether a geom is a mesh that does not fill its hull or has holes."""
        mesh = int(self._model.geom_dataid[geom])
        if mesh < 0:
            return False
        if mesh not in self._is_convex:
            self._is_convex[mesh] = _fills_its_hull(self._model, mesh)
        return not self._is_convex[mesh]

    def distance(self, first: int, second: int, limit: float, enough: float, segment: Floats) -> float:
        """Return the signed distance [m] of two geoms, the first one a mesh, meshes taken as their triangles.

        What is inside a closed mesh and touches no triangle is apart from it.

        Args:
            first: A geom that is a mesh.
            second: Another geom.
            limit: Greater distances are of no interest [m].
            enough: The search ends at a distance like this or less [m].
            segment: Takes the points of first and second that are nearest or deepest, in the world, shape (6,).

        Returns:
            The distance, or ``limit`` if it is not less.
        """
        rotation, position = self._data.geom_xmat[first].reshape(3, 3), self._data.geom_xpos[first]
        second_rotation = self._data.geom_xmat[second].reshape(3, 3)
        T_first_second = rotation.T @ second_rotation, rotation.T @ (self._data.geom_xpos[second] - position)
        triangles = self._triangles_of(first)
        box = _turned_box(self._model.geom_aabb[second], T_first_second)
        others = self._prepare(first, second, T_first_second, limit)
        best = limit
        for chunk in triangles.chunks(*box, limit):
            if chunk[0][2] > best:
                break
            pairs = chunk if others is None else _pairs(triangles, chunk, others, best)
            best = self._nearest(triangles, others, pairs, best, enough)
            if best <= enough:
                break
        segment[:] = (self._segment.reshape(2, 3) @ rotation.T + position).ravel()
        return best

    def _nearest(
        self, triangles: "_Triangles", others: "_Triangles | None", pairs: "list[_Pair]", limit: float, enough: float
    ) -> float:
        """Return the least distance of some pairs, and keep where it is, in the frame of the first, in ``_segment``."""
        best, here = limit, np.zeros(6)
        place = _SOLID if others is None else _OTHER_TRIANGLE
        for index, other, gap in pairs:
            if gap > best or best <= enough:
                break
            self._write(_TRIANGLE, triangles.corners[index])
            if others is not None:
                self._write(_OTHER_TRIANGLE, others.corners[other])
            found = mujoco.mj_geomDistance(self._scratch, self._scratch_data, _TRIANGLE, place, best, here)
            if found < best:
                best, self._segment[:] = found, here
        return best

    def _prepare(
        self, first: int, second: int, T_first_second: tuple[Floats, Floats], limit: float
    ) -> "_Triangles | None":
        """Return the triangles of the second geom that the first may reach, in the first one's frame.

        What is no mesh goes into the scratch model, and None is returned.
        """
        rotation, position = T_first_second
        if self._model.geom_dataid[second] >= 0:
            box = _turned_box(self._model.geom_aabb[first], (rotation.T, -rotation.T @ position))
            triangles = self._triangles_of(second)
            near, _ = triangles.near(*box, limit)
            return _Triangles(triangles.corners[near] @ rotation.T + position)
        self._scratch.geom_type[_SOLID] = self._model.geom_type[second]
        self._scratch.geom_size[_SOLID] = self._model.geom_size[second]
        self._scratch_data.geom_xpos[_SOLID] = position
        self._scratch_data.geom_xmat[_SOLID] = rotation.ravel()
        return None

    def _triangles_of(self, geom: int) -> "_Triangles":
        mesh = int(self._model.geom_dataid[geom])
        if mesh not in self._triangles:
            vertices, triangles = _mesh_arrays(self._model, mesh)
            self._triangles[mesh] = _Triangles(vertices[triangles])
        return self._triangles[mesh]

    def _write(self, place: int, corners: Floats) -> None:
        self._corners[place, :3] = corners
        self._corners[place, 3] = corners[2]


class _Triangles:
    """Triangles with a box around each, all in one frame."""

    def __init__(self, corners: Floats) -> None:
        self.corners = corners
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)

    def near(self, low: Floats, high: Floats, limit: float) -> tuple[Ints, Floats]:
        """Return the triangles whose boxes are no farther than ``limit`` from a box, and how far; the nearest first."""
        gaps = _gaps(self.low, self.high, low, high)
        near = np.flatnonzero(gaps <= limit)
        near = near[np.argsort(gaps[near], kind="stable")]
        return near, gaps[near]

    def chunks(self, low: Floats, high: Floats, limit: float) -> "Iterator[list[_Pair]]":
        """Yield what ``near`` returns, some triangles at a time, as pairs with nothing."""
        near, gaps = self.near(low, high, limit)
        for start in range(0, len(near), _CHUNK):
            part = slice(start, start + _CHUNK)
            yield [(index, -1, gap) for index, gap in zip(near[part].tolist(), gaps[part].tolist(), strict=True)]


def _pairs(triangles: _Triangles, chunk: list[_Pair], others: _Triangles, limit: float) -> list[_Pair]:
    """Return the pairs of triangles whose boxes are no farther apart than ``limit``, and how far; the nearest first."""
    chosen = np.array([index for index, _, _ in chunk])
    low, high = triangles.low[chosen], triangles.high[chosen]
    near, _ = others.near(low.min(axis=0), high.max(axis=0), limit)
    gaps = _gaps(low[:, None], high[:, None], others.low[near], others.high[near])
    rows, columns = np.nonzero(gaps <= limit)
    found = gaps[rows, columns]
    order = np.argsort(found, kind="stable")
    return list(zip(chosen[rows[order]].tolist(), near[columns[order]].tolist(), found[order].tolist(), strict=True))


def _gaps(low: Floats, high: Floats, other_low: Floats, other_high: Floats) -> Floats:
    """Return how far boxes are apart; arrays of corners are broadcast, their last axis is x, y, z."""
    apart = np.maximum(np.maximum(low - other_high, other_low - high), 0.0)
    return np.sqrt((apart * apart).sum(axis=-1))


def _turned_box(aabb: Floats, T_a_b: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """Return the corners of the box in frame a around a box in frame b, given by its centre and half its edges."""
    rotation, position = T_a_b
    centre, half = rotation @ aabb[:3] + position, np.abs(rotation) @ aabb[3:]
    return centre - half, centre + half


def _mesh_arrays(model: mujoco.MjModel, mesh: int) -> tuple[Floats, Ints]:
    """Return vertices and triangles of a mesh, in the frame of its geoms."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    first_face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    return vertices, model.mesh_face[first_face : first_face + faces].astype(np.int_)


def _fills_its_hull(model: mujoco.MjModel, mesh: int) -> bool:
    vertices, triangles = _mesh_arrays(model, mesh)
    centred = vertices - vertices.mean(axis=0)
    address = int(model.mesh_graphadr[mesh])
    corner_count, face_count = model.mesh_graph[address : address + 2].tolist()
    first = address + 2 + 3 * corner_count + 3 * face_count  # behind the neighbours of each corner
    faces = model.mesh_graph[first : first + 3 * face_count].reshape(-1, 3)
    given, hull = Mesh(centred, triangles), Mesh(centred, faces.astype(np.int_))
    return abs(abs(volume(given)) - abs(volume(hull))) <= NOT_FILLED * abs(volume(hull)) and abs(
        area(given) - area(hull)
    ) <= NOT_FILLED * area(hull)
