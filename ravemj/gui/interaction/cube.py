"""Box handle around a selected body: dragging a face moves the body, dragging an edge rotates it."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, inverse
from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.picking import visible_box
from ravemj.gui.interaction.viewpoint import Viewpoint, ViewRay
from ravemj.model import drawing
from ravemj.model.drawing import Primitives

_MARGIN = 0.1
"""Clearance between a body and its box handle, as a fraction of half the box's longest side."""

_REACH, _REACH_BESIDE = 8.0, 12.0
"""Pick distance of an edge, in front of a face and beside the box [points]."""

_FACES = np.array([0.1, 0.6, 0.2, 0.15])
_EDGES = np.array([[0.1, 0.6, 0.2, 1.0]])
_EDGE_WIDTH = 3.0
_MARKED_FACE = np.array([0.2, 0.9, 0.3, 0.35])
_MARKED_EDGE = np.array([[1.0, 0.75, 0.0, 1.0]])


class Grip(NamedTuple):
    """The grabbed face or edge of a box handle.

    Attributes:
        axis: Index of the box axis normal to the face or parallel to the edge.
        is_edge: Whether it is an edge and not a face.
        point: The grabbed point, in the world [m], shape (3,).
    """

    axis: int
    is_edge: bool
    point: Floats


class _CubeEdge(NamedTuple):
    axis: int
    ends: Floats  # in the cube, (2, 3)
    faces: tuple[tuple[int, int], tuple[int, int]]  # axis and sign of the two that meet in it


@dataclass(frozen=True, eq=False)
class Cube:
    """The box handle: aligned with a body's first link, around the body's visible geometry.

    Attributes:
        T_world_cube: Pose of its centre, shape (4, 4).
        half: Half extents [m], shape (3,).
    """

    T_world_cube: Floats
    half: Floats

    @classmethod
    def around(cls, body: BodyState) -> "Cube | None":
        """Return the box handle of a body at its current pose; None if the body is not visible."""
        T_world_cube = body.link_transform(0)
        box = visible_box(body, None, T_world_cube)
        if box is None:
            return None
        T_world_cube[:3, 3] += T_world_cube[:3, :3] @ box.center
        return cls(T_world_cube, box.half + _MARGIN * box.half.max())

    def grip(self, view: Viewpoint, x: float, y: float) -> Grip | None:
        """Return the visible edge, else the face, under a point of the screen; None if there is none."""
        ray = view.ray(x, y)
        T_cube_world = inverse(self.T_world_cube)
        local = ViewRay(T_cube_world[:3, :3] @ ray.start + T_cube_world[:3, 3], T_cube_world[:3, :3] @ ray.direction)
        if (np.abs(local.start) <= self.half).all():
            return None
        face = self._face_grip(local)
        return self._edge_grip(view, (x, y), local, _REACH_BESIDE if face is None else _REACH) or face

    def _face_grip(self, local: ViewRay) -> Grip | None:
        with np.errstate(divide="ignore", invalid="ignore"):
            crossings = np.stack([-self.half - local.start, self.half - local.start]) / local.direction
        near, far = np.nanmin(crossings, axis=0), np.nanmax(crossings, axis=0)
        axis = int(near.argmax())
        if not 0 <= near[axis] <= far.min():
            return None
        return Grip(axis, False, self._in_world(local.start + near[axis] * local.direction))

    def _edge_grip(self, view: Viewpoint, at: tuple[float, float], local: ViewRay, within: float) -> Grip | None:
        edges = [edge for edge in self._edges() if any(self._sees(local.start, *face) for face in edge.faces)]
        candidates = [(_distance_on_screen(view, at, self._in_world(edge.ends)), edge) for edge in edges]
        distance, edge = min(candidates, key=lambda candidate: candidate[0], default=(np.inf, None))
        if edge is None or distance > within:
            return None
        point = _nearest_on_segment(edge.ends, local)
        return Grip(edge.axis, True, self._in_world(point))

    def _sees(self, eye: Floats, axis: int, sign: int) -> bool:
        return bool(sign * eye[axis] > self.half[axis])

    def _edges(self) -> Iterator[_CubeEdge]:
        for axis in range(3):
            next_axis, other = (axis + 1) % 3, (axis + 2) % 3
            for sign, other_sign in itertools.product((-1, 1), repeat=2):
                ends = np.zeros((2, 3))
                ends[:, next_axis], ends[:, other] = sign * self.half[next_axis], other_sign * self.half[other]
                ends[:, axis] = -self.half[axis], self.half[axis]
                yield _CubeEdge(axis, ends, ((next_axis, sign), (other, other_sign)))

    def _in_world(self, points: Floats) -> Floats:
        return points @ self.T_world_cube[:3, :3].T + self.T_world_cube[:3, 3]

    def primitives(self) -> Primitives:
        """Return the drawing of the box handle, in the world."""
        ends = np.concatenate([edge.ends for edge in self._edges()])
        lines = drawing.line_list(ends, _EDGE_WIDTH, np.repeat(_EDGES, len(ends), axis=0))
        return drawing.merge([drawing.box(np.zeros(3), self.half, _FACES), lines]).placed(self.T_world_cube)

    def highlight(self, grip: Grip) -> Primitives:
        """Return the highlight of a face or an edge, in the world."""
        held = (grip.point - self.T_world_cube[:3, 3]) @ self.T_world_cube[:3, :3]
        corner = np.copysign(self.half, held)
        along = np.eye(3)[grip.axis] * self.half
        if grip.is_edge:
            ends = np.array([corner * (along == 0) - along, corner * (along == 0) + along])
            return drawing.line_list(ends, 2 * _EDGE_WIDTH, _MARKED_EDGE.repeat(2, axis=0)).placed(self.T_world_cube)
        face = drawing.box(corner * (along != 0), self.half * (along == 0), _MARKED_FACE)
        return face.placed(self.T_world_cube)


def _distance_on_screen(view: Viewpoint, at: tuple[float, float], ends: Floats) -> float:
    """Return the distance from a point of the screen to a projected segment [points]; infinite behind the camera."""
    (start, end), depths = view.camera.project(ends, *view.size)
    if (depths <= 0).any():
        return np.inf
    along, towards = end - start, at - start
    square = float(along @ along)
    part = min(max(float(along @ towards) / square, 0.0), 1.0) if square else 0.0
    return float(np.linalg.norm(towards - part * along))


def _nearest_on_segment(ends: Floats, ray: ViewRay) -> Floats:
    along = ends[1] - ends[0]
    part = nearest_on_line(ends[0], along, ray)
    return ends[0] + min(max(0.5 if part is None else part, 0.0), 1.0) * along


def nearest_on_line(start: Floats, along: Floats, ray: ViewRay) -> float | None:
    """Return the point of a line nearest to a ray, as a multiple of ``along``; None if they are parallel."""
    across = np.cross(np.cross(along, ray.direction), ray.direction)
    slope = float(along @ across)
    if abs(slope) < 1e-6 * float(along @ along):
        return None
    return float((ray.start - start) @ across) / slope
