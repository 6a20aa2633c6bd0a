"""Extents of the geoms of a MuJoCo model, at the poses of its data."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints

_GEOM = mujoco.mjtGeom


def colliding(model: mujoco.MjModel) -> Ints:
    """Return the indices of the collision geoms of finite size; planes are excluded."""
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    return np.flatnonzero(solid & (model.geom_type != int(_GEOM.mjGEOM_PLANE)))


def reach(model: mujoco.MjModel, geom: int, direction: Floats) -> tuple[float, float]:
    """Return the minimum and maximum coordinate of a geom along a direction in its frame, from its origin [m]."""
    kind, (a, b, c) = int(model.geom_type[geom]), model.geom_size[geom].tolist()
    if kind == _GEOM.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        along = model.mesh_vert[first : first + count] @ direction
        return float(along.min()), float(along.max())
    x, y, z = np.abs(direction).tolist()
    if kind == _GEOM.mjGEOM_BOX:
        half = a * x + b * y + c * z
    elif kind == _GEOM.mjGEOM_CYLINDER:
        half = a * float(np.hypot(x, y)) + b * z
    elif kind == _GEOM.mjGEOM_CAPSULE:
        half = a + b * z
    else:
        half = a if kind == _GEOM.mjGEOM_SPHERE else float(model.geom_rbound[geom])
    return -half, half


def box(model: mujoco.MjModel, geom: int, position: Floats, rotation: Floats) -> tuple[Floats, Floats]:
    """Return the bounding box of a geom with a pose in a frame: minimum and maximum, each of shape (3,)."""
    sides = np.array([reach(model, geom, row) for row in rotation])
    return position + sides[:, 0], position + sides[:, 1]


def lowest(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, int]:
    """Return the height of the lowest point of collision geoms [m], and its body; 0 and the world if there are none."""
    heights = [
        (float(data.geom_xpos[geom, 2]) + reach(model, geom, data.geom_xmat[geom, 6:])[0], int(model.geom_bodyid[geom]))
        for geom in colliding(model).tolist()
    ]
    return min(heights, default=(0.0, 0))
