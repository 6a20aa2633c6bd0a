"""Lasers: rays of one moment from one point."""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, rows_from_wxyz, wxyz_from_axis_angle
from ravemj.engine.collision.world import CollisionWorld
from ravemj.model.scene import FlashLidar, Laser

_WHOLE = 1e-9
"""How near to one more step of the angle a range may end, in steps, and still hold its ray."""


class Scan(NamedTuple):
    """What a laser measures.

    Attributes:
        origin: Where the rays begin, in the world [m], shape (3,).
        directions: Their unit directions in the world, shape (n, 3).
        distances: How far each goes [m], shape (n,): the greatest range where it meets nothing.
        is_hit: Which meet something, shape (n,).
        geoms: What they meet, shape (n,); -1: nothing.
    """

    origin: Floats
    directions: Floats
    distances: Floats
    is_hit: NDArray[np.bool_]
    geoms: NDArray[np.int32]


@lru_cache(maxsize=64)
def ray_directions(device: Laser | FlashLidar) -> Floats:
    """Return the unit directions of a device's rays in its own frame, shape (n, 3); not to be changed.

    Those of a laser lie in the plane of x and y, in the order of their angles. Those of a flash lidar go through its
    pixels as those of a camera do, column after column, as in OpenRAVE.
    """
    if isinstance(device, Laser):
        steps = math.floor((device.max_angle - device.min_angle) / device.resolution + _WHOLE)
        angles = device.min_angle + np.arange(steps + 1) * device.resolution
        directions = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
    else:
        columns, rows = np.meshgrid(np.arange(device.width), np.arange(device.height), indexing="ij")
        through = ((columns - device.cx) / device.fx, (rows - device.cy) / device.fy, np.ones(columns.shape))
        directions = np.stack(through, axis=-1).reshape(-1, 3)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    directions.flags.writeable = False
    return directions


def spun(laser: Laser, T_world_sensor: Floats, angle: float) -> Floats:
    """Return the pose of a laser's plane that has turned about its spin axis by an angle [rad], shape (4, 4)."""
    turn = np.eye(4)
    turn[:3, :3] = rows_from_wxyz(wxyz_from_axis_angle(laser.spin_axis, angle))
    centre = np.array(laser.spin_position)
    turn[:3, 3] = centre - turn[:3, :3] @ centre
    return T_world_sensor @ turn


def scan(world: CollisionWorld, device: Laser | FlashLidar, T_world_rays: Floats) -> Scan:
    """Return where the rays of a device meet the bodies of a world, the robot that carries it included.

    All rays are one call of ``mj_multiRay``. One that meets something nearer than the least range goes on from there.

    Args:
        world: The bodies.
        device: The device.
        T_world_rays: Pose of the frame of its rays, shape (4, 4).
    """
    origin = T_world_rays[:3, 3].copy()
    directions = ray_directions(device) @ T_world_rays[:3, :3].T
    hits = world.fan(origin, directions, device.max_range)
    distances, geoms = hits.distances, hits.geoms
    for ray in np.flatnonzero((distances >= 0) & (distances < device.min_range)).tolist():
        start = origin + device.min_range * directions[ray]
        length = device.max_range - device.min_range
        hit = world.ray(start, length * directions[ray])
        distances[ray] = -1.0 if hit is None else device.min_range + length * hit.fraction
        geoms[ray] = -1 if hit is None else hit.geom
    is_hit = (distances >= 0) & (distances <= device.max_range)
    distances[~is_hit], geoms[~is_hit] = device.max_range, -1
    return Scan(origin, directions, distances, is_hit, geoms)
