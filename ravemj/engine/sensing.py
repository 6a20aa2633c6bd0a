"""Sensor measurements, and their drawings. Camera images are made by the renderers."""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Vec3, rows_from_wxyz, wxyz_from_axis_angle
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.physics import Physics
from ravemj.engine.simulation import BodyState
from ravemj.model.drawing import NOTHING, Primitives, line_list, merge, mesh, points
from ravemj.model.scene import Device, FlashLidar, ForceTorque, Intrinsics, Laser

_WHOLE = 1e-9
"""Rounding tolerance when counting the angle steps of a laser's range, as a fraction of a step."""

_FRUSTUM = 0.15
"""Depth of a drawn camera frustum [m]."""

_ICON = 0.05
"""Minimum radius of the fan drawn for a laser [m]."""

_POINT = 5.0  # pixels, as in OpenRAVE
_LINE = 1.5  # pixels
_ICON_RAYS = 11
_FAN_OPACITY = 0.2  # as in OpenRAVE
_EDGES = (0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 5, 6, 5, 7)
"""Edges of a frustum: from the eye to the corners, between corners, and a mark at the image's top side."""


class Scan(NamedTuple):
    """Measurement of a laser with n rays, in the world."""

    origin: Floats  # origin of the rays [m], shape (3,)
    directions: Floats  # of unit length, shape (n, 3)
    distances: Floats  # range of each ray [m], shape (n,); the maximum without a hit
    is_hit: NDArray[np.bool_]  # whether each ray has a hit, shape (n,)
    geoms: NDArray[np.int32]  # the geoms hit, shape (n,); -1 without a hit


@lru_cache(maxsize=64)
def ray_directions(device: Laser | FlashLidar) -> Floats:
    """Return the unit directions of a device's rays in its own frame, shape (n, 3); read-only.

    Rays of a laser are in the xy plane, in the order of angles. Rays of a flash lidar pass through its pixels, column
    by column, as in OpenRAVE.
    """
    if isinstance(device, Laser):
        steps = math.floor((device.max_angle - device.min_angle) / device.resolution + _WHOLE)
        directions = _around(device.min_angle + np.arange(steps + 1) * device.resolution)
    else:
        columns, rows = np.meshgrid(np.arange(device.width), np.arange(device.height), indexing="ij")
        through = ((columns - device.cx) / device.fx, (rows - device.cy) / device.fy, np.ones(columns.shape))
        directions = np.stack(through, axis=-1).reshape(-1, 3)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    directions.flags.writeable = False
    return directions


def _around(angles: NDArray[np.floating[Any]]) -> Floats:
    """Return the unit vectors in the xy plane at angles [rad], shape (n, 3)."""
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])


def spun(laser: Laser, T_world_sensor: Floats, angle: float) -> Floats:
    """Return the pose of a laser's scan plane rotated about its spin axis by an angle [rad], shape (4, 4)."""
    turn = np.eye(4)
    turn[:3, :3] = rows_from_wxyz(wxyz_from_axis_angle(laser.spin_axis, angle))
    centre = np.array(laser.spin_position)
    turn[:3, 3] = centre - turn[:3, :3] @ centre
    return T_world_sensor @ turn


def scan(world: CollisionWorld, device: Laser | FlashLidar, T_world_rays: Floats) -> Scan:
    """Return the hits of a device's rays with the bodies of a world, including its own robot.

    All rays are cast in one call of ``mj_multiRay``. Hits below the minimum range are ignored.
    """
    origin = T_world_rays[:3, 3].copy()
    directions = ray_directions(device) @ T_world_rays[:3, :3].T
    distances, geoms = world.rays.cast(origin, directions, device.max_range)
    for ray in np.flatnonzero((distances >= 0) & (distances < device.min_range)).tolist():
        start = origin + device.min_range * directions[ray]
        length = device.max_range - device.min_range
        hit = world.rays.first_hit(start, length * directions[ray])
        distances[ray] = -1.0 if hit is None else device.min_range + length * hit.fraction
        geoms[ray] = -1 if hit is None else hit.geom
    is_hit = (distances >= 0) & (distances <= device.max_range)
    distances[~is_hit], geoms[~is_hit] = device.max_range, -1
    return Scan(origin, directions, distances, is_hit, geoms)


def motion_at(state: BodyState, link: int, point: Floats) -> tuple[Floats, Floats]:
    """Return the velocity of a point on a link [m/s] and the link's angular velocity [rad/s], in the world, (3,)."""
    velocity = state.present_velocities[link]
    arm = point - state.link_transform(link)[:3, 3]
    return velocity[:3] + np.cross(velocity[3:], arm), velocity[3:].copy()


def acceleration_at(physics: Physics, state: BodyState, link: int, point: Floats) -> Floats:
    """Return the reading of an accelerometer at a point on a link: the point's acceleration minus gravity.

    Point and acceleration [m/s^2] are in world axes, shape (3,).
    """
    linear, angular = physics.link_acceleration(state, link)
    spin = state.present_velocities[link][3:]
    arm = point - state.link_transform(link)[:3, 3]
    return linear + np.cross(angular, arm) + np.cross(spin, np.cross(spin, arm))


def encoder_values(state: BodyState, resolution: tuple[float, ...]) -> tuple[Floats, Floats, Floats]:
    """Return the readings of a robot's joint encoders: values, velocities and resolutions, each of shape (dof,).

    Values [rad or m] are rounded to multiples of ``resolution``: one for each DOF, one for all, or none.
    """
    values = state.kinematics.values()
    velocities = state.dynamics.dof_velocities(state.link_velocities())
    steps = np.broadcast_to(np.array(resolution or (0.0,)), values.shape).copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.where(steps > 0, np.round(values / steps) * steps, values)
    return values, velocities, steps


def wrench(physics: Physics, state: BodyState, link: int, T_world_sensor: Floats) -> tuple[Floats, Floats]:
    """Return the force that a link receives from its parent, including the load of its descendants.

    Returns:
        Force on the link [N] and torque about the sensor's origin [N m], each of shape (3,), in the sensor's axes.
    """
    force, torque = physics.joint_wrench(state, link, T_world_sensor[:3, 3])
    axes = T_world_sensor[:3, :3]
    return force @ axes, torque @ axes


def corrected(device: ForceTorque, force: Floats, torque: Floats) -> tuple[Floats, Floats]:
    """Apply the sign and the calibration matrix of a device to force and torque."""
    both = device.polarity * np.concatenate([force, torque])
    if device.correction:
        both = np.reshape(device.correction, (6, 6)) @ both
    return both[:3], both[3:]


def touches(physics: Physics, state: BodyState, link: int, T_world_sensor: Floats) -> tuple[Floats, Floats]:
    """Return the contact points of a link [m], and the forces on it there [N], each (n, 3), in sensor axes."""
    points, forces = physics.link_contacts(state, link)
    axes, origin = T_world_sensor[:3, :3], T_world_sensor[:3, 3]
    return (points - origin) @ axes, forces @ axes


def shape_figure(device: Device, color: Vec3) -> Primitives:
    """Return the drawing of a sensor in its own frame: camera frustum, laser fan, or nothing."""
    match device:
        case Intrinsics() | FlashLidar() if device.problem() is None:
            return _frustum(device, color)
        case Laser() if device.problem() is None:
            around = _around(np.linspace(device.min_angle, device.max_angle, _ICON_RAYS))
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


def scan_figure(device: Laser | FlashLidar, measured: Scan, color: Vec3) -> Primitives:
    """Return the drawing of a laser's measurement in the world: the hits, and the scanned surface."""
    ends = measured.origin + measured.distances[:, None] * measured.directions
    met = ends[measured.is_hit]
    dots = points(met, _POINT, _colors(len(met), color, 1.0)) if len(met) else NOTHING
    if isinstance(device, FlashLidar):
        return dots
    return merge([dots, _fan(measured.origin, ends, color, _FAN_OPACITY)])


def _fan(origin: Floats, ends: Floats, color: Vec3, opacity: float) -> Primitives:
    """Return the triangles between the origin and consecutive ray ends, to draw a laser scan."""
    first = np.arange(1, len(ends))
    triangles = np.column_stack([np.zeros_like(first), first, first + 1])
    return mesh(np.vstack([origin, ends]), triangles, _colors(len(ends) + 1, color, opacity))


def _colors(count: int, color: Vec3, opacity: float) -> Floats:
    return np.tile((*color, opacity), (count, 1))
