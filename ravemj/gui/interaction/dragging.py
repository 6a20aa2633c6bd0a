"""Drags: bodies and joints that follow the pointer's ray."""

import math
from collections.abc import Callable

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.geometry_functions import matrixFromAxisAngle
from ravemj.gui.interaction.cube import Cube, Grip, nearest_on_line
from ravemj.gui.interaction.joint_handle import JointHandle, joint_and_axis
from ravemj.gui.interaction.viewpoint import ViewRay
from ravemj.model.limits import clamp

Follow = Callable[[ViewRay], None]
"""Callback of a drag; its argument is the current ray of the pointer."""

_FLATTEST = 0.02
"""Sine of the angle between ray and plane below which their intersection is ill-conditioned."""

_ASLANT = 0.3
"""Sine of the angle between ray and rotation plane below which the angle follows the pointer's motion along the rim."""


def move_by_face(body: BodyState, cube: Cube, grip: Grip) -> Follow:
    """Start a drag that moves a body in the plane of a face."""
    T_start, normal = body.link_transform(0), cube.T_world_cube[:3, grip.axis]

    def follow(ray: ViewRay) -> None:
        point = in_plane(ray, grip.point, normal)
        if point is not None:
            T_world_link0 = T_start.copy()
            T_world_link0[:3, 3] += point - grip.point
            body.set_transform(T_world_link0)

    return follow


def turn_by_edge(body: BodyState, cube: Cube, grip: Grip, ray: ViewRay) -> Follow:
    """Start a drag that rotates a body about the axis through the box centre and parallel to an edge."""
    T_start, axis, center = body.link_transform(0), cube.T_world_cube[:3, grip.axis], cube.T_world_cube[:3, 3]
    turn = Turn(center, axis, grip.point, ray)

    def follow(ray: ViewRay) -> None:
        motion = matrixFromAxisAngle(axis, turn.angle(ray))
        motion[:3, 3] = center - motion[:3, :3] @ center
        body.set_transform(motion @ T_start)

    return follow


def move_joint(body: BodyState, dof: int, handle: JointHandle, point: Floats, ray: ViewRay) -> Follow:
    """Start a drag of a joint by a point of its handle, within the joint limits."""
    start = float(body.kinematics.values()[dof])
    joint, axis = joint_and_axis(body, dof)
    if joint.slides(axis):
        measure = Slide(handle.axis, point).displacement
    else:
        measure = Turn(handle.center, handle.axis, point, ray).angle

    return lambda ray: set_dof(body, dof, start + measure(ray))


def set_dof(body: BodyState, dof: int, value: float) -> None:
    """Set a joint value [rad or m], clamped to its limits."""
    values = body.kinematics.values()
    values[dof] = clamp(body.scene.dof_axes[dof], value)
    body.set_values(values)


class Turn:
    """Measures the angle by which the pointer has turned about an axis, over any number of turns."""

    def __init__(self, center: Floats, axis: Floats, grip: Floats, ray: ViewRay) -> None:
        """Start at a grabbed point ``grip``; axis (unit vector), centre and grip are in the world, shape (3,) [m]."""
        self._center, self._axis, self._grip = center, axis, grip
        self._arm = _across(grip - center, axis)
        self._tangent = np.cross(axis, self._arm)  # displacement of the grip per radian
        self._is_aslant = abs(float(ray.direction @ axis)) < _ASLANT
        self._last = 0.0

    def angle(self, ray: ViewRay) -> float:
        """Return the angle since the start [rad]; the previous one if the ray does not determine it."""
        angle = self._along_rim(ray) if self._is_aslant else self._around(ray)
        if angle is not None:
            self._last = angle
        return self._last

    def _along_rim(self, ray: ViewRay) -> float | None:
        return nearest_on_line(self._grip, self._tangent, ray) if self._tangent.any() else None

    def _around(self, ray: ViewRay) -> float | None:
        point = in_plane(ray, self._grip, self._axis)
        if point is None:
            return None
        arm = _across(point - self._center, self._axis)
        angle = math.atan2(float(self._tangent @ arm), float(self._arm @ arm))
        return angle + math.tau * round((self._last - angle) / math.tau)


class Slide:
    """Measures the displacement of the pointer along an axis."""

    def __init__(self, axis: Floats, grip: Floats) -> None:
        self._axis, self._grip = axis, grip
        self._last = 0.0

    def displacement(self, ray: ViewRay) -> float:
        """Return the displacement since the start [m]; the previous one if the ray does not determine it."""
        displacement = nearest_on_line(self._grip, self._axis, ray)
        if displacement is not None:
            self._last = displacement
        return self._last


def _across(vector: Floats, axis: Floats) -> Floats:
    """Return the component of a vector normal to a unit vector."""
    return vector - float(vector @ axis) * axis


def in_plane(ray: ViewRay, point: Floats, normal: Floats) -> Floats | None:
    """Return the intersection of a ray with a plane in front of the camera; None if there is none or it is unstable."""
    slope = float(ray.direction @ normal)
    distance = float((point - ray.start) @ normal) / slope if abs(slope) > _FLATTEST else -1.0
    return ray.start + distance * ray.direction if distance > 0 else None
