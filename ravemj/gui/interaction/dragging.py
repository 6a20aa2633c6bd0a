"""What follows the pointer's ray: bodies that are moved and turned, joints."""

import math
from collections.abc import Callable

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.geometry_functions import matrixFromAxisAngle
from ravemj.gui.interaction.cube import Cube, Grip, nearest_on_line
from ravemj.gui.interaction.joint_handle import JointHandle, joint_and_axis
from ravemj.gui.interaction.viewpoint import Ray
from ravemj.model.limits import clamp

Follow = Callable[[Ray], None]
"""Takes the pointer's ray as it is now."""

_FLATTEST = 0.02
"""Sine of the angle from which on a ray counts as along a plane, and tells nothing about a point in it."""

_ASLANT = 0.3
"""The same for planes in which things turn: the pointer turns them by its way along the rim instead."""


def move_by_face(body: BodyState, cube: Cube, grip: Grip) -> Follow:
    """Let a body follow the pointer in the plane of a face."""
    T_start, normal = body.link_transform(0), cube.T_world_cube[:3, grip.axis]

    def follow(ray: Ray) -> None:
        point = in_plane(ray, grip.point, normal)
        if point is not None:
            T_world_link0 = T_start.copy()
            T_world_link0[:3, 3] += point - grip.point
            body.set_transform(T_world_link0)

    return follow


def turn_by_edge(body: BodyState, cube: Cube, grip: Grip, ray: Ray) -> Follow:
    """Let a body turn with the pointer about the axis that is parallel to an edge, through the cube's centre."""
    T_start, axis, center = body.link_transform(0), cube.T_world_cube[:3, grip.axis], cube.T_world_cube[:3, 3]
    turn = Turn(center, axis, grip.point, ray)

    def follow(ray: Ray) -> None:
        motion = matrixFromAxisAngle(axis, turn.angle(ray))
        motion[:3, 3] = center - motion[:3, :3] @ center
        body.set_transform(motion @ T_start)

    return follow


def move_joint(body: BodyState, dof: int, handle: JointHandle, point: Floats, ray: Ray) -> Follow:
    """Let a joint follow the pointer, which holds a point of its handle, as far as its limits go."""
    start = float(body.kinematics.values()[dof])
    joint, axis = joint_and_axis(body, dof)
    measure = (
        Slide(handle.axis, point).way if joint.slides(axis) else Turn(handle.center, handle.axis, point, ray).angle
    )

    return lambda ray: set_dof(body, dof, start + measure(ray))


def set_dof(body: BodyState, dof: int, value: float) -> None:
    """Give a joint another value [rad or m], as far as its limits go."""
    values = body.kinematics.values()
    values[dof] = clamp(body.scene.dof_axes[dof], value)
    body.set_values(values)


class Turn:
    """Measures how far the pointer has turned something about an axis; also by more than one turn."""

    def __init__(self, center: Floats, axis: Floats, grip: Floats, ray: Ray) -> None:
        """Begin at a grip about an axis (unit vector) through a centre; all in the world, of shape (3,) [m]."""
        self._center, self._axis, self._grip = center, axis, grip
        self._arm = _across(grip - center, axis)
        self._tangent = np.cross(axis, self._arm)  # the way of the grip for each radian
        self._is_aslant = abs(float(ray.direction @ axis)) < _ASLANT
        self._last = 0.0

    def angle(self, ray: Ray) -> float:
        """Return the angle [rad] from the start to where the pointer is now; the last one where it cannot be told."""
        found = self._along_rim(ray) if self._is_aslant else self._around(ray)
        if found is not None:
            self._last = found
        return self._last

    def _along_rim(self, ray: Ray) -> float | None:
        return nearest_on_line(self._grip, self._tangent, ray) if self._tangent.any() else None

    def _around(self, ray: Ray) -> float | None:
        point = in_plane(ray, self._grip, self._axis)
        if point is None:
            return None
        arm = _across(point - self._center, self._axis)
        angle = math.atan2(float(self._tangent @ arm), float(self._arm @ arm))
        return angle + math.tau * round((self._last - angle) / math.tau)


class Slide:
    """Measures how far the pointer has pulled something along an axis."""

    def __init__(self, axis: Floats, grip: Floats) -> None:
        self._axis, self._grip = axis, grip
        self._last = 0.0

    def way(self, ray: Ray) -> float:
        """Return the way [m] from the start to where the pointer is now; the last one where it cannot be told."""
        found = nearest_on_line(self._grip, self._axis, ray)
        if found is not None:
            self._last = found
        return self._last


def _across(vector: Floats, axis: Floats) -> Floats:
    """Return the part of a vector that is across a unit vector."""
    return vector - float(vector @ axis) * axis


def in_plane(ray: Ray, point: Floats, normal: Floats) -> Floats | None:
    """Return where a ray meets a plane before the eye; None where it does not, or hardly."""
    slope = float(ray.direction @ normal)
    distance = float((point - ray.start) @ normal) / slope if abs(slope) > _FLATTEST else -1.0
    return ray.start + distance * ray.direction if distance > 0 else None
