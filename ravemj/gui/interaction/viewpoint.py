"""A viewpoint: a camera, and the focus that it orbits."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, rows_from_wxyz, wxyz_from_axis_angle, wxyz_from_rows
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction.events import Fingers
from ravemj.gui.interaction.mode_buttons import ViewButton

_NEAREST, _FARTHEST = 1e-3, 1e6
"""Bounds of the focus distance under zooming [m]."""

_STRONGEST = 10.0
"""Maximum absolute natural logarithm of a zoom factor."""

_STRAIGHT = 1e-6
"""Sine of the angle between viewing direction and world z below which the upright direction is undefined."""

_ZOOM = 4.0
"""Natural logarithm of the zoom factor for a drag over the height of the view."""


class ViewRay(NamedTuple):
    """Viewing ray of a point of the screen: eye in the world [m], and unit direction, both of shape (3,)."""

    start: Floats
    direction: Floats


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A camera that looks at a focus.

    Attributes:
        camera: The camera.
        distance: Distance of the focus along the viewing direction [m].
        size: Width and height of the view [points].
        is_upright: Whether rotations keep the world's z axis upright in the picture (turntable mode).
    """

    camera: Camera
    distance: float
    size: tuple[int, int]
    is_upright: bool = False

    @property
    def focus(self) -> Floats:
        """The point that the camera orbits, in the world [m], shape (3,)."""
        return self.camera.position + self.distance * self.camera.rotation[:, 2]

    def ray(self, x: float, y: float) -> ViewRay:
        """Return the viewing ray of a point of the screen [points]."""
        fx, fy, cx, cy = self.camera.pinhole(*self.size)
        direction = self.camera.rotation @ [(x - cx) / fx, (y - cy) / fy, 1.0]
        return ViewRay(self.camera.position, direction / np.linalg.norm(direction))

    def turned(self, right: float, down: float) -> "Viewpoint":
        """Orbit the focus by a drag [points]; a drag over the height of the view is half a turn."""
        if self.is_upright:
            return self._turned_upright(math.pi * right / self.size[1], math.pi * down / self.size[1])
        angle = math.pi * math.hypot(right, down) / self.size[1]
        rotation = self.camera.rotation @ rows_from_wxyz(wxyz_from_axis_angle((-down, right, 0.0), angle))
        return self._placed(rotation, self.focus, self.distance)

    def _turned_upright(self, azimuth: float, elevation: float) -> "Viewpoint":
        """Orbit about the world's z axis by ``azimuth``, and up by ``elevation``, at most to the poles [rad]."""
        rotation = _level(self.camera.rotation)
        height = math.asin(min(max(-float(rotation[2, 2]), -1.0), 1.0))  # elevation of the eye above the focus
        tilt = min(max(height + elevation, -math.pi / 2), math.pi / 2) - height
        turned = np.array(rows_from_wxyz(wxyz_from_axis_angle((0.0, 0.0, 1.0), -azimuth))) @ rotation
        return self._placed(turned @ rows_from_wxyz(wxyz_from_axis_angle((1.0, 0.0, 0.0), -tilt)), self.focus)

    def levelled(self) -> "Viewpoint":
        """Roll the camera so that the world's z axis is upright; no change for vertical viewing directions."""
        return self._placed(_level(self.camera.rotation), self.focus)

    def fitted(self, center: Floats, radius: float) -> "Viewpoint":
        """Move along the viewing direction until a sphere [m] just fits into the view; its centre becomes the focus."""
        fx, fy, _, _ = self.camera.pinhole(*self.size)
        half = min(math.atan(0.5 * self.size[0] / fx), math.atan(0.5 * self.size[1] / fy))
        distance = min(max(radius / math.sin(half), _NEAREST), _FARTHEST)
        return self._placed(self.camera.rotation, center, distance)

    def along(self, direction: tuple[float, float, float]) -> "Viewpoint":
        """Return the viewpoint along a direction of the world with z upright, or y for vertical directions."""
        z = np.array(direction)
        up = np.array((0.0, 1.0, 0.0) if direction[2] else (0.0, 0.0, 1.0))
        x = np.cross(z, up)
        return self._placed(np.stack([x, np.cross(z, x), z], axis=1), self.focus)

    def interpolated(self, other: "Viewpoint", part: float) -> "Viewpoint":
        """Interpolate between this viewpoint (``part`` 0) and another (1)."""
        change = self.camera.rotation.T @ other.camera.rotation
        w, x, y, z = wxyz_from_rows(change.tolist())
        angle = 2 * math.atan2(math.sqrt(x * x + y * y + z * z), w)
        between = wxyz_from_axis_angle((x, y, z), part * angle) if angle else (1.0, 0.0, 0.0, 0.0)
        rotation = self.camera.rotation @ rows_from_wxyz(between)
        focus = self.focus + part * (other.focus - self.focus)
        return other._placed(rotation, focus, self.distance + part * (other.distance - self.distance))

    def shifted(self, right: float, down: float) -> "Viewpoint":
        """Pan so that the focus follows a drag [points]."""
        fx, fy, _, _ = self.camera.pinhole(*self.size)
        x, y, _ = self.camera.rotation.T
        focus = self.focus - self.distance * (right / fx * x + down / fy * y)
        return self._placed(self.camera.rotation, focus, self.distance)

    def zoomed(self, power: float) -> "Viewpoint":
        """Multiply the focus distance by ``exp(power)``."""
        factor = math.exp(min(max(power, -_STRONGEST), _STRONGEST))
        distance = min(max(self.distance * factor, _NEAREST), _FARTHEST)
        return self._placed(self.camera.rotation, self.focus, distance)

    def rolled(self, wheel: ViewButton, amount: float) -> "Viewpoint":
        """Return the viewpoint after a drag of a camera wheel, to the right or down [points]."""
        if wheel is ViewButton.ROT_X:
            return self.turned(0.0, amount)
        if wheel is ViewButton.ROT_Y:
            return self.turned(amount, 0.0)
        return self.zoomed(-_ZOOM * amount / self.size[1])

    def pinched(self, fingers: Fingers) -> "Viewpoint":
        """Pan and zoom so that the points at focus depth under two fingers stay under them."""
        _, _, cx, cy = self.camera.pinhole(*self.size)
        x, y = fingers.x - cx, fingers.y - cy
        right = x - fingers.spread * (x - fingers.right)
        down = y - fingers.spread * (y - fingers.down)
        return self.zoomed(-math.log(fingers.spread)).shifted(right, down)

    def centred(self, point: Floats) -> "Viewpoint":
        """Make a point the focus, and halve its distance; the camera does not roll."""
        towards = point - self.camera.position
        length = float(np.linalg.norm(towards))
        forward = self.camera.rotation[:, 2]
        x, y, z = np.cross(forward, towards).tolist()
        angle = math.atan2(math.sqrt(x * x + y * y + z * z), float(forward @ towards))
        rotation = np.array(rows_from_wxyz(wxyz_from_axis_angle((x, y, z), angle))) @ self.camera.rotation
        centred = self._placed(rotation, point, max(length / 2, _NEAREST))
        return centred.levelled() if self.is_upright else centred

    def _placed(self, rotation: Floats, focus: Floats, distance: float | None = None) -> "Viewpoint":
        distance = self.distance if distance is None else distance
        T_world_camera = np.eye(4)
        T_world_camera[:3, :3] = rotation
        T_world_camera[:3, 3] = focus - distance * rotation[:, 2]
        return replace(self, camera=replace(self.camera, T_world_camera=T_world_camera), distance=distance)


def camera_line(camera: Camera) -> str:
    """Return a line of Python that sets a viewer's camera."""
    rows = ", ".join(str([round(number, 8) + 0.0 for number in row]) for row in camera.T_world_camera.tolist())
    return f"viewer.SetCamera([{rows}])"


def _level(rotation: Floats) -> Floats:
    """Return a camera rotation rolled about the viewing direction, so that image right is level and z is up."""
    z = rotation[:, 2]
    right = np.array([z[1], -z[0], 0.0])  # the cross product with the world's z axis
    length = float(np.linalg.norm(right))
    if length < _STRAIGHT:
        return rotation
    right /= length
    return np.stack([right, np.cross(z, right), z], axis=1)
