"""Tests of non-convex meshes by their triangles; MuJoCo would use the convex hulls.

FCL's bounding volume hierarchies find overlapping triangles and distances of meshes. MuJoCo measures the depth between
two triangles, or a triangle and a solid. For MuJoCo a triangle is a mesh of three vertices, the last one repeated; a
scratch model with two such meshes and one geom of any other shape is reused for all of them.
"""

from collections.abc import Iterable, Iterator
from itertools import chain

import fcl
import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.formats.meshes import area, volume
from ravemj.model.scene import Mesh

NOT_FILLED = 1e-3
"""Maximum relative difference of area and volume between a mesh that counts as convex and its convex hull."""

_XML = """<mujoco><asset>
<mesh name="a" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><mesh name="b" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
</asset><worldbody>
<geom type="mesh" mesh="a"/><geom type="mesh" mesh="b"/><geom size="1"/>
</worldbody></mujoco>"""
_TRIANGLE, _OTHER_TRIANGLE, _SOLID = range(3)

_Candidate = tuple[float, Floats, Floats | None]
"""Pair to measure: lower bound of the distance [m], triangle, and triangle of the other mesh (None for a solid)."""

_SLACK = 1e-4  # [m]; margin of boxes, since FCL's test of a box and a triangle has errors of 1e-6

_ANY = fcl.CollisionRequest()
_ALL = fcl.CollisionRequest(num_max_contacts=2**31 - 1)
_NEAREST = fcl.DistanceRequest(enable_nearest_points=True)


class TriangleTests:
    """Tests of non-convex meshes of one compiled model.

    A shape inside a closed mesh does not collide if it touches none of the triangles.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._is_convex: dict[int, bool] = {}
        self._meshes: dict[int, _Triangles] = {}
        self._objects: dict[int, fcl.CollisionObject] = {}
        self._scratch = mujoco.MjModel.from_xml_string(_XML)
        self._scratch_data = mujoco.MjData(self._scratch)
        self._scratch_data.geom_xmat[:] = np.eye(3).ravel()
        self._corners = self._scratch.mesh_vert.reshape(2, 4, 3)

    def is_concave(self, geom: int) -> bool:
        """Return whether a geom is a non-convex mesh, or has holes."""
        mesh = int(self._model.geom_dataid[geom])
        if mesh < 0:
            return False
        if mesh not in self._is_convex:
            self._is_convex[mesh] = _fills_its_hull(self._model, mesh)
        return not self._is_convex[mesh]

    def touch(self, mesh: int, other: int, touching: float) -> bool:
        """Return whether a mesh and another geom overlap; a solid also touches within a distance ``touching`` [m]."""
        overlaps = fcl.CollisionResult()
        if not fcl.collide(self._placed(mesh), self._placed(other), _ANY, overlaps):
            return False
        if self._is_mesh(other):
            return True
        box, first = self._place_solid(mesh, other), overlaps.contacts[0].b1
        candidates = chain(self._chosen(mesh, [first]), self._near_solid(mesh, other, box, touching))
        return self._least(mesh, _SOLID, candidates, 2 * touching, np.zeros(6), enough=touching) <= touching

    def _near_solid(self, mesh: int, solid: int, box: tuple[Floats, Floats], touching: float) -> Iterator[_Candidate]:
        """Yield triangles of a mesh that may be within ``touching`` [m] of a solid with the bounding box ``box``."""
        if touching > _SLACK / 2:
            yield from self._triangles_of(mesh).near(*box, touching)
            return
        overlaps = fcl.CollisionResult()
        fcl.collide(self._placed(mesh), self._placed(solid), _ALL, overlaps)
        yield from self._chosen(mesh, sorted({overlap.b1 for overlap in overlaps.contacts}))

    def _chosen(self, mesh: int, indices: Iterable[int]) -> Iterator[_Candidate]:
        corners = self._triangles_of(mesh).corners
        return ((-np.inf, corners[index], None) for index in indices)

    def distance(self, mesh: int, other: int, limit: float, segment: Floats) -> float:
        """Return the signed distance [m] of a mesh and another geom, at most ``limit``.

        ``segment`` receives the nearest or deepest points of mesh and other, in the world, shape (6,).
        """
        if not self._is_mesh(other):
            candidates = self._triangles_of(mesh).near(*self._place_solid(mesh, other), limit)
            return self._least(mesh, _SOLID, candidates, limit, segment)
        placed = self._placed(mesh), self._placed(other)
        overlaps, nearest = fcl.CollisionResult(), fcl.DistanceResult()
        if fcl.collide(*placed, _ALL, overlaps):
            return self._least(mesh, _OTHER_TRIANGLE, self._pairs(mesh, other, overlaps.contacts), limit, segment)
        distance = fcl.distance(*placed, _NEAREST, nearest)
        if distance < limit:
            segment[:] = np.concatenate(nearest.nearest_points)
        return min(distance, limit)

    def overlaps(self, mesh: int, other: int, touching: float) -> Iterator[tuple[float, Floats]]:
        """Yield signed distance [m] and nearest points, shape (6,), of each touching pair of a mesh and another geom.

        A pair is a triangle of the mesh and the other geom or, if that is a mesh, a triangle of it.
        """
        result, place = fcl.CollisionResult(), _OTHER_TRIANGLE
        if self._is_mesh(other):
            fcl.collide(self._placed(mesh), self._placed(other), _ALL, result)
            candidates = self._pairs(mesh, other, result.contacts)
        else:
            box, place = self._place_solid(mesh, other), _SOLID
            candidates = self._near_solid(mesh, other, box, touching)
        for candidate in candidates:
            segment = np.zeros(6)
            distance = self._least(mesh, place, [candidate], 2 * touching, segment)
            if distance <= touching:
                yield distance, segment

    def _pairs(self, mesh: int, other: int, overlaps: Iterable[fcl.Contact]) -> Iterable[_Candidate]:
        """Return the intersecting pairs of triangles of two meshes, given FCL's contacts ``overlaps``."""
        pairs = np.array(sorted({(overlap.b1, overlap.b2) for overlap in overlaps}), dtype=int).reshape(-1, 2)
        rotation, position = self._pose_in(mesh, other)
        ours = self._triangles_of(mesh).corners[pairs[:, 0]]
        theirs = self._triangles_of(other).corners[pairs[:, 1]] @ rotation.T + position
        return ((-np.inf, first, two) for first, two in zip(ours, theirs, strict=True))

    def _place_solid(self, mesh: int, solid: int) -> tuple[Floats, Floats]:
        """Copy a solid to the scratch model; return centre and half extents of its bounding box in the mesh's frame."""
        rotation, position = self._pose_in(mesh, solid)
        self._scratch.geom_type[_SOLID] = self._model.geom_type[solid]
        self._scratch.geom_size[_SOLID] = self._model.geom_size[solid]
        self._scratch_data.geom_xpos[_SOLID], self._scratch_data.geom_xmat[_SOLID] = position, rotation.ravel()
        centre, half = self._model.geom_aabb[solid].reshape(2, 3)
        return rotation @ centre + position, np.abs(rotation) @ half

    def _least(
        self,
        mesh: int,
        place: int,
        candidates: Iterable[_Candidate],
        limit: float,
        segment: Floats,
        enough: float = -np.inf,
    ) -> float:
        """Return the smallest distance of the candidates [m], at most ``limit``; they are sorted by their lower bounds.

        Triangles are measured in the scratch model against its geom ``place``, until one is within ``enough`` [m].
        """
        best, nearest = limit, np.zeros(6)
        for bound, triangle, other in candidates:
            if bound > best:
                break
            self._write(_TRIANGLE, triangle)
            if other is not None:
                self._write(_OTHER_TRIANGLE, other)
            distance = mujoco.mj_geomDistance(self._scratch, self._scratch_data, _TRIANGLE, place, best, nearest)
            if distance < best:
                best, segment[:] = distance, nearest
                if best <= enough:
                    break
        if best < limit:
            rotation, position = self._pose(mesh)
            segment[:] = (segment.reshape(2, 3) @ rotation.T + position).ravel()
        return best

    def _write(self, place: int, corners: Floats) -> None:
        self._corners[place, :3] = corners
        self._corners[place, 3] = corners[2]

    def _is_mesh(self, geom: int) -> bool:
        return bool(self._model.geom_dataid[geom] >= 0)

    def _triangles_of(self, geom: int) -> "_Triangles":
        mesh = int(self._model.geom_dataid[geom])
        if mesh not in self._meshes:
            self._meshes[mesh] = _Triangles(*_mesh_arrays(self._model, mesh))
        return self._meshes[mesh]

    def _pose(self, geom: int) -> tuple[Floats, Floats]:
        return self._data.geom_xmat[geom].reshape(3, 3), self._data.geom_xpos[geom]

    def _pose_in(self, first: int, second: int) -> tuple[Floats, Floats]:
        """Return the rotation and position of geom ``second`` in the frame of geom ``first``."""
        (rotation, position), (second_rotation, second_position) = self._pose(first), self._pose(second)
        return rotation.T @ second_rotation, rotation.T @ (second_position - position)

    def _placed(self, geom: int) -> fcl.CollisionObject:
        """Return the FCL object of a geom at its present pose: a mesh, or the bounding box of another shape."""
        rotation, position = self._pose(geom)
        if not self._is_mesh(geom):
            position = position + rotation @ self._model.geom_aabb[geom, :3]
        if geom not in self._objects:
            self._objects[geom] = fcl.CollisionObject(self._shape(geom))
        self._objects[geom].setTransform(fcl.Transform(rotation, position))
        return self._objects[geom]

    def _shape(self, geom: int) -> fcl.CollisionGeometry:
        if self._is_mesh(geom):
            return self._triangles_of(geom).tree
        return fcl.Box(*(2 * (self._model.geom_aabb[geom, 3:] + _SLACK)).tolist())


class _Triangles:
    """Triangles of a mesh: their vertices, shape (n, 3, 3), and FCL's bounding volume hierarchy."""

    def __init__(self, vertices: Floats, triangles: Ints) -> None:
        self.corners = vertices[triangles]
        self._low, self._high = self.corners.min(axis=1), self.corners.max(axis=1)
        self.tree = fcl.BVHModel()
        self.tree.beginModel(len(triangles), len(vertices))
        self.tree.addSubModel(vertices, triangles)
        self.tree.endModel()

    def near(self, centre: Floats, half: Floats, limit: float) -> Iterable[_Candidate]:
        """Yield the triangles whose boxes are within ``limit`` of another box, the nearest first.

        ``centre`` and ``half`` are the other box's centre and half extents in the frame of the mesh [m], shape (3,).
        """
        apart = np.maximum(np.maximum(self._low - centre - half, centre - half - self._high), 0.0)
        bounds = np.sqrt((apart * apart).sum(axis=1))
        near = np.flatnonzero(bounds <= limit)
        bounds[bounds == 0.0] = -np.inf
        for index in near[np.argsort(bounds[near], kind="stable")].tolist():
            yield bounds[index], self.corners[index], None


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
