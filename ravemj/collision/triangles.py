"""Meshes as the triangles that they consist of, where MuJoCo would take their convex hulls.

MuJoCo measures distances between convex shapes. A triangle is one: a mesh of three corners, the last one twice. So a
scratch model with two such meshes and one geom of any other shape takes the triangles in turn.
"""

import mujoco
import numpy as np

from ravemj.meshes import area, volume
from ravemj.scene import Mesh
from ravemj.transforms import Floats, Ints

NOT_FILLED = 1e-3
"""The part of its hull's area and volume that a mesh may lack and still be convex."""

_XML = """<mujoco><asset>
<mesh name="a" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><mesh name="b" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
</asset><worldbody>
<geom type="mesh" mesh="a"/><geom type="mesh" mesh="b"/><geom size="1"/>
</worldbody></mujoco>"""
_TRIANGLE, _OTHER_TRIANGLE, _SOLID = range(3)
_IDENTITY = np.eye(3)


class TriangleTests:
    """Distances of meshes that are not convex, in one compiled model."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._is_convex: dict[int, bool] = {}
        self._scratch = mujoco.MjModel.from_xml_string(_XML)
        self._scratch_data = mujoco.MjData(self._scratch)
        self._scratch_data.geom_xmat[:] = _IDENTITY.ravel()
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

    def distance(self, first: int, second: int, limit: float, enough: float, segment: Floats | None = None) -> float:
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
        T_first = _pose(self._data, first)
        T_second = _pose(self._data, second)
        to_first = T_first[0].T @ T_second[0], T_first[0].T @ (T_second[1] - T_first[1])
        triangles = _Triangles(self._corners_of(first))
        others = self._solid_or_triangles(second, to_first)
        box = _turned_box(self._model.geom_aabb[second], to_first)
        best = limit
        for index, gap in triangles.nearest_first(*box, limit):
            if gap > best:
                break
            self._write(_TRIANGLE, triangles.corners[index])
            found = self._distance_of_triangle(triangles, index, others, best)
            if found < best:
                best = found
                if segment is not None:
                    segment[:3] = T_first[0] @ self._segment[:3] + T_first[1]
                    segment[3:] = T_first[0] @ self._segment[3:] + T_first[1]
                if best <= enough:
                    break
        return best

    def _solid_or_triangles(self, geom: int, to_first: "tuple[Floats, Floats]") -> "_Triangles | None":
        """Return the triangles of a mesh; or put another geom into the scratch model and return None."""
        rotation, position = to_first
        if self._model.geom_dataid[geom] >= 0:
            return _Triangles(self._corners_of(geom) @ rotation.T + position)
        self._scratch.geom_type[_SOLID] = self._model.geom_type[geom]
        self._scratch.geom_size[_SOLID] = self._model.geom_size[geom]
        self._scratch_data.geom_xpos[_SOLID] = position
        self._scratch_data.geom_xmat[_SOLID] = rotation.ravel()
        return None

    def _distance_of_triangle(
        self, triangles: "_Triangles", index: int, others: "_Triangles | None", limit: float
    ) -> float:
        """Return the distance of the triangle in the scratch model, and keep where it is in ``_segment``."""
        if others is None:
            return mujoco.mj_geomDistance(self._scratch, self._scratch_data, _TRIANGLE, _SOLID, limit, self._segment)
        best, here = limit, np.zeros(6)
        for other, gap in others.nearest_first(triangles.low[index], triangles.high[index], limit):
            if gap > best:
                break
            self._write(_OTHER_TRIANGLE, others.corners[other])
            found = mujoco.mj_geomDistance(self._scratch, self._scratch_data, _TRIANGLE, _OTHER_TRIANGLE, best, here)
            if found < best:
                best, self._segment[:] = found, here
        return best

    def _write(self, place: int, corners: Floats) -> None:
        self._corners[place, :3] = corners
        self._corners[place, 3] = corners[2]

    def _corners_of(self, geom: int) -> Floats:
        mesh = int(self._model.geom_dataid[geom])
        vertices, triangles = _mesh_arrays(self._model, mesh)
        return vertices[triangles]


class _Triangles:
    """Triangles with a box around each, all in one frame."""

    def __init__(self, corners: Floats) -> None:
        self.corners = corners
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)

    def nearest_first(self, low: Floats, high: Floats, limit: float) -> list[tuple[int, float]]:
        """Return the triangles whose boxes are no farther than ``limit`` from a box, with that distance."""
        apart = np.maximum(np.maximum(self.low - high, low - self.high), 0.0)
        gaps = np.sqrt((apart * apart).sum(axis=1))
        near = np.flatnonzero(gaps <= limit)
        near = near[np.argsort(gaps[near], kind="stable")]
        return list(zip(near.tolist(), gaps[near].tolist(), strict=True))


def _pose(data: mujoco.MjData, geom: int) -> tuple[Floats, Floats]:
    return data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]


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
