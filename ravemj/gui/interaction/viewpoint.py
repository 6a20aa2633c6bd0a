"""A point of view that the mouse changes: a camera and the distance of what it turns about."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, rows_from_wxyz, wxyz_from_axis_angle, wxyz_from_rows
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction.events import Fingers
from ravemj.gui.interaction.mode_buttons import Tool

_NEAREST, _FARTHEST = 1e-3, 1e6
"""How near and how far zooming brings the focus [m]."""

_STRONGEST = 10.0
"""Largest power of e by which one step of zooming changes the distance."""

_STRAIGHT = 1e-6
"""Sine of the angle between the viewing direction and the world's z axis below which there is no upright."""

_ZOOM = 4.0
"""Powers of e by which the distance changes over the height of the view."""


class Ray(NamedTuple):
    """Where a point of the screen looks at: the eye in the world [m] and a unit vector, both of shape (3,)."""

    start: Floats
    direction: Floats


@dataclass(frozen=True, eq=False)
class View:
    """A camera that looks at a focus.

    Attributes:
        camera: The camera.
        distance: How far along its viewing direction the focus is [m].
        size: Width and height of the view [points].
        is_upright: Whether turning keeps the world's z axis upright in the picture, as on a turntable.
    """

    camera: Camera
    distance: float
    size: tuple[int, int]
    is_upright: bool = False

    @property
    def focus(self) -> Floats:
        """The point that the camera turns about, in the world [m], shape (3,)."""
        return self.camera.position + self.distance * self.camera.rotation[:, 2]

    def ray(self, x: float, y: float) -> Ray:
        """Return the ray through a point of the screen [points]."""
        fx, fy, cx, cy = self.camera.pinhole(*self.size)
        direction = self.camera.rotation @ [(x - cx) / fx, (y - cy) / fy, 1.0]
        return Ray(self.camera.position, direction / np.linalg.norm(direction))

    def turned(self, right: float, down: float) -> "View":
        """Turn about the focus, which the pointer drags [points]; the height of the view is half a turn."""
        if self.is_upright:
            return self._turned_upright(math.pi * right / self.size[1], math.pi * down / self.size[1])
        angle = math.pi * math.hypot(right, down) / self.size[1]
        rotation = self.camera.rotation @ rows_from_wxyz(wxyz_from_axis_angle((-down, right, 0.0), angle))
        return self._placed(rotation, self.focus, self.distance)

    def _turned_upright(self, azimuth: float, elevation: float) -> "View":
        """Turn about the world's z axis, and up or down as far as the poles [rad]."""
        rotation = _level(self.camera.rotation)
        height = math.asin(min(max(-float(rotation[2, 2]), -1.0), 1.0))  # of the eye above the focus
        tilt = min(max(height + elevation, -math.pi / 2), math.pi / 2) - height
        turned = np.array(rows_from_wxyz(wxyz_from_axis_angle((0.0, 0.0, 1.0), -azimuth))) @ rotation
        return self._placed(turned @ rows_from_wxyz(wxyz_from_axis_angle((1.0, 0.0, 0.0), -tilt)), self.focus)

    def levelled(self) -> "View":
        """Return the view with the world's z axis upright in the picture; straight up or down, there is none."""
        return self._placed(_level(self.camera.rotation), self.focus)

    def fitted(self, center: Floats, radius: float) -> "View":
        """Return the view from the same side that a sphere [m] fits into, which it then turns about."""
        fx, fy, _, _ = self.camera.pinhole(*self.size)
        half = min(math.atan(0.5 * self.size[0] / fx), math.atan(0.5 * self.size[1] / fy))
        distance = min(max(radius / math.sin(half), _NEAREST), _FARTHEST)
        return self._placed(self.camera.rotation, center, distance)

    def along(self, direction: tuple[float, float, float]) -> "View":
        """Look at the focus along an axis of the world; z is upright, and along z, y is."""
        z = np.array(direction)
        up = np.array((0.0, 1.0, 0.0) if direction[2] else (0.0, 0.0, 1.0))
        x = np.cross(z, up)
        return self._placed(np.stack([x, np.cross(z, x), z], axis=1), self.focus)

    def on_the_way(self, other: "View", part: float) -> "View":
        """Return a view between this one (``part`` is 0) and another (1)."""
        change = self.camera.rotation.T @ other.camera.rotation
        w, x, y, z = wxyz_from_rows(change.tolist())
        angle = 2 * math.atan2(math.sqrt(x * x + y * y + z * z), w)
        between = wxyz_from_axis_angle((x, y, z), part * angle) if angle else (1.0, 0.0, 0.0, 0.0)
        rotation = self.camera.rotation @ rows_from_wxyz(between)
        focus = self.focus + part * (other.focus - self.focus)
        return other._placed(rotation, focus, self.distance + part * (other.distance - self.distance))

    def shifted(self, right: float, down: float) -> "View":
        """Move across the viewing direction, so that the focus follows the pointer, which went so far [points]."""
        fx, fy, _, _ = self.camera.pinhole(*self.size)
        x, y, _ = self.camera.rotation.T
        focus = self.focus - self.distance * (right / fx * x + down / fy * y)
        return self._placed(self.camera.rotation, focus, self.distance)

    def zoomed(self, power: float) -> "View":
        """Bring the eye nearer to the focus, or farther away: its distance is multiplied by e to a power."""
        factor = math.exp(min(max(power, -_STRONGEST), _STRONGEST))
        distance = min(max(self.distance * factor, _NEAREST), _FARTHEST)
        return self._placed(self.camera.rotation, self.focus, distance)

    def rolled(self, wheel: Tool, amount: float) -> "View":
        """Return the view after one of its wheels was moved to the right or down [points]."""
        if wheel is Tool.ROT_X:
            return self.turned(0.0, amount)
        if wheel is Tool.ROT_Y:
            return self.turned(amount, 0.0)
        return self.zoomed(-_ZOOM * amount / self.size[1])

    def pinched(self, fingers: Fingers) -> "View":
        """Shift and zoom, so that what is under two fingers stays there, as deep as the focus."""
        _, _, cx, cy = self.camera.pinhole(*self.size)
        x, y = fingers.x - cx, fingers.y - cy
        right = x - fingers.spread * (x - fingers.right)
        down = y - fingers.spread * (y - fingers.down)
        return self.zoomed(-math.log(fingers.spread)).shifted(right, down)

    def centred(self, point: Floats) -> "View":
        """Look at a point from half the distance; it becomes the focus. The camera does not roll."""
        towards = point - self.camera.position
        length = float(np.linalg.norm(towards))
        forward = self.camera.rotation[:, 2]
        x, y, z = np.cross(forward, towards).tolist()
        angle = math.atan2(math.sqrt(x * x + y * y + z * z), float(forward @ towards))
        rotation = np.array(rows_from_wxyz(wxyz_from_axis_angle((x, y, z), angle))) @ self.camera.rotation
        centred = self._placed(rotation, point, max(length / 2, _NEAREST))
        return centred.levelled() if self.is_upright else centred

    def _placed(self, rotation: Floats, focus: Floats, distance: float | None = None) -> "View":
        distance = self.distance if distance is None else distance
        T_world_camera = np.eye(4)
        T_world_camera[:3, :3] = rotation
        T_world_camera[:3, 3] = focus - distance * rotation[:, 2]
        return replace(self, camera=replace(self.camera, T_world_camera=T_world_camera), distance=distance)


def camera_line(camera: Camera) -> str:
    """Return the line of a script that sets a viewer's camera."""
    rows = ", ".join(str([round(number, 8) + 0.0 for number in row]) for row in camera.T_world_camera.tolist())
    return f"viewer.SetCamera([{rows}])"


def _level(rotation: Floats) -> Floats:
    """Return a camera's rotation rolled about its viewing direction, so that image right is level and z is up."""
    z = rotation[:, 2]
    right = np.array([z[1], -z[0], 0.0])  # the cross product with the world's z axis
    length = float(np.linalg.norm(right))
    if length < _STRAIGHT:
        return rotation
    right /= length
    return np.stack([right, np.cross(z, right), z], axis=1)
