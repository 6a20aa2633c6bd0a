"""What viewers draw of sensors: their shapes, in their own frames, and what they measure, in the world."""

import numpy as np

from ravemj.core.transforms import Floats, Vec3
from ravemj.engine.sensing.lasers import Scan
from ravemj.model.drawing import NOTHING, Primitives, line_list, merge, mesh, points
from ravemj.model.scene import Device, FlashLidar, Intrinsics, Laser

_FRUSTUM = 0.15
"""Depth of a drawn frustum [m]."""

_ICON = 0.05
"""Least radius of the fan that stands for a laser [m]."""

_POINT = 5.0  # pixels, as in OpenRAVE
_LINE = 1.5  # pixels
_ICON_RAYS = 11
_FAN_OPACITY = 0.2  # as in OpenRAVE
_EDGES = (0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 5, 6, 5, 7)
"""Ends of the lines of a frustum: from the eye to the corners, between these, and the mark over the picture's top."""


def shape_figure(device: Device, color: Vec3) -> Primitives:
    """Return what shows where a sensor is, in its own frame: frusta of cameras, fans of lasers, nothing of others."""
    match device:
        case Intrinsics() | FlashLidar() if device.problem() is None:
            return _frustum(device, color)
        case Laser() if device.problem() is None:
            angles = np.linspace(device.min_angle, device.max_angle, _ICON_RAYS)
            around = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
            return _fan(np.zeros(3), max(device.min_range, _ICON) * around, color, 0.7)
        case _:
            return NOTHING


def _frustum(camera: Intrinsics | FlashLidar, color: Vec3) -> Primitives:
    left, right = -camera.cx / camera.fx, (camera.width - camera.cx) / camera.fx
    top, bottom = -camera.cy / camera.fy, (camera.height - camera.cy) / camera.fy
    middle, above = (left + right) / 2, top - (bottom - top) / 5
    marks = [(left, top), (right, top), (right, bottom), (left, bottom), (middle, above), (left, top), (right, top)]
    corners = np.array([(0.0, 0.0, 0.0), *((x, y, 1.0) for x, y in marks)])[list(_EDGES)]
    return line_list(_FRUSTUM * corners, _LINE, _colors(len(corners), color, 1.0))


def scan_figure(device: Laser | FlashLidar, found: Scan, color: Vec3) -> Primitives:
    """Return what a laser measures, in the world: points where it meets something, and the surface that it sweeps."""
    ends = found.origin + found.distances[:, None] * found.directions
    met = ends[found.is_hit]
    dots = points(met, _POINT, _colors(len(met), color, 1.0)) if len(met) else NOTHING
    if isinstance(device, FlashLidar):
        return dots
    return merge([dots, _fan(found.origin, ends, color, _FAN_OPACITY)])


def _fan(origin: Floats, ends: Floats, color: Vec3, opacity: float) -> Primitives:
    """Return the triangles between a point and each two ends that follow one another."""
    first = np.arange(1, len(ends))
    triangles = np.column_stack([np.zeros_like(first), first, first + 1])
    return mesh(np.vstack([origin, ends]), triangles, _colors(len(ends) + 1, color, opacity))


def _colors(count: int, color: Vec3, opacity: float) -> Floats:
    return np.tile((*color, opacity), (count, 1))
