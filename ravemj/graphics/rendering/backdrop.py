"""Background of pictures: one colour or a gradient, and a floor with a grid that fades with distance.

Neither is a body. The floor is at the lowest point of the drawn geoms, so that it hides nothing.
"""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.graphics.rendering.camera import Camera, bounding_sphere
from ravemj.graphics.rendering.style import Look, drawn_geoms
from ravemj.model.look import (
    FADE_END,
    FADE_START,
    FLOOR,
    FLOOR_REACH,
    HORIZON,
    LINE_WIDTH,
    LINES,
    NADIR,
    ZENITH,
    cell_size,
)

_LIFTED = 1e-6
"""Minimum height of the camera above a visible floor [radii of the scene]."""


class Floor(NamedTuple):
    """The floor of a scene.

    Attributes:
        height: z of the floor [m].
        cell: Spacing of the grid lines [m]; one line goes through the origin.
        center: Centre of a sphere around the bodies, shape (3,) [m].
        radius: Radius of the sphere [m].
        colour: Colour near the bodies, shape (3,), 0 to 1.
        horizon: Colour far away, shape (3,), 0 to 1.
    """

    height: float
    cell: float
    center: Floats
    radius: float
    colour: Floats
    horizon: Floats

    def fading(self, camera: Camera) -> tuple[float, float]:
        """Return the depths [m] between which the floor fades into the horizon."""
        distance = float(np.linalg.norm(self.center - camera.position))
        return distance + FADE_START * self.radius, distance + FADE_END * self.radius

    def is_below(self, camera: Camera) -> bool:
        """Return whether the floor is below a camera."""
        return float(camera.position[2]) - self.height > _LIFTED * self.radius


class FloorLevel:
    """Determines height and size of a model's floor.

    They are computed from the configuration in the file, so that the floor does not move with the bodies; it is lowered
    only if geoms are below it.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self._first = mujoco.MjData(model)

    def floor(self, data: mujoco.MjData, look: Look) -> Floor | None:
        """Return the floor for a state; None if the look has no floor."""
        if not look.floor:
            return None
        model, first = self.model, self._first
        mujoco.mj_kinematics(model, first)
        center, radius = bounding_sphere(model, first)
        lowest = min(look.lowest, lowest_point(model, first), lowest_point(model, data))
        height = lowest if math.isfinite(lowest) else 0.0
        colour = np.array(FLOOR if look.background is None else look.background)
        horizon = np.array(HORIZON if look.background is None else look.background)
        return Floor(height, cell_size(radius), center, radius, colour, horizon)


def lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the minimum z of the drawn geoms [m], without planes; infinity if there are none.

    The poses of the geoms must be computed (``mj_kinematics`` or ``mj_forward``).
    """
    geoms = np.flatnonzero(drawn_geoms(model) & (model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE))
    if not geoms.size:
        return math.inf
    up = data.geom_xmat[geoms].reshape(-1, 3, 3)[:, 2]  # the world's z axis in the geoms
    bounds = data.geom_xpos[geoms, 2] - _reach_down(model, geoms, up)
    lowest = math.inf
    for index in np.argsort(bounds).tolist():
        if bounds[index] >= lowest:
            break
        geom, exact = int(geoms[index]), float(bounds[index])
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:  # whose bounding boxes are lower
            exact = float(data.geom_xpos[geom, 2]) + float((_vertices(model, geom) @ up[index]).min())
        lowest = min(lowest, exact)
    return lowest


def _reach_down(model: mujoco.MjModel, geoms: Ints, up: Floats) -> Floats:
    """Return how far geoms extend below their origins in z [m], shape (N,); meshes by their bounding boxes.

    ``up`` is the world's z axis in the frame of each geom, shape (N, 3).
    """
    kind, size = model.geom_type[geoms], model.geom_size[geoms]
    boxes = model.geom_aabb[geoms]
    aside = np.sqrt(np.maximum(1 - up[:, 2] ** 2, 0))
    along = np.abs(up[:, 2])
    return np.select(
        [
            kind == mujoco.mjtGeom.mjGEOM_SPHERE,
            kind == mujoco.mjtGeom.mjGEOM_CAPSULE,
            kind == mujoco.mjtGeom.mjGEOM_CYLINDER,
            kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        ],
        [
            size[:, 0],
            size[:, 0] + along * size[:, 1],
            aside * size[:, 0] + along * size[:, 1],
            np.linalg.norm(up * size, axis=1),
        ],
        np.einsum("ij,ij->i", np.abs(up), boxes[:, 3:]) - np.einsum("ij,ij->i", up, boxes[:, :3]),
    )


def _vertices(model: mujoco.MjModel, geom: int) -> Floats:
    mesh = int(model.geom_dataid[geom])
    start = int(model.mesh_vertadr[mesh])
    return model.mesh_vert[start : start + int(model.mesh_vertnum[mesh])].astype(np.float64)


def sky_colours(look: Look, heights: Floats) -> Floats:
    """Return the background colours, shape (N, 3) in 0..1, of directions with z components ``heights``, shape (N,)."""
    if look.background is not None:
        return np.broadcast_to(np.array(look.background), (*heights.shape, 3))
    end = np.where(heights[..., None] > 0, ZENITH, NADIR)
    return np.array(HORIZON) + np.abs(heights)[..., None] * (end - np.array(HORIZON))


def skybox(look: Look, width: int) -> NDArray[np.uint8]:
    """Return the six faces of MuJoCo's skybox, stacked vertically, shape (6 * width, width, 3).

    MuJoCo's order is right, left, up, down, front, back; the four sides are equal.
    """
    place = (2 * np.arange(width) + 1) / width - 1
    across, down = np.meshgrid(place, place)
    length = np.sqrt(1 + across**2 + down**2)
    side, cap = -down / length, 1 / length
    faces = [side, side, cap, -cap, side, side]
    return np.rint(255 * sky_colours(look, np.concatenate(faces))).astype(np.uint8)


class Backdrop(NamedTuple):
    """Background and floor of one picture, for ray casting.

    Attributes:
        look: The look.
        floor: The visible floor, or None.
        camera: The camera.
        pixel: Width of a pixel at depth 1.
    """

    look: Look
    floor: Floor | None
    camera: Camera
    pixel: float

    def colours(self, rays: Floats) -> Floats:
        """Return the unrounded colours in 0..255, shape (N, 3), of rays in the world with depth 1, shape (N, 3)."""
        lengths = np.linalg.norm(rays, axis=1)
        colours = np.array(sky_colours(self.look, rays[:, 2] / lengths))
        if self.floor is not None:
            down = np.flatnonzero(rays[:, 2] < 0)
            colours[down] = self._floor_colours(self.floor, rays[down], lengths[down], colours[down])
        return np.rint(255 * colours)

    def _floor_colours(self, floor: Floor, rays: Floats, lengths: Floats, sky: Floats) -> Floats:
        height = self.camera.position[2] - floor.height
        depth = height / -rays[:, 2]
        start, end = floor.fading(self.camera)
        faded = np.clip((depth - start) / (end - start), 0, 1)[:, None]
        places = (self.camera.position[:2] + depth[:, None] * rays[:, :2]) / floor.cell
        footprint = self.pixel * depth / floor.cell
        slanted = footprint * lengths / -rays[:, 2]  # extent of a pixel along the ray; it is smaller across
        along = np.abs(rays[:, :2]) / np.maximum(np.linalg.norm(rays[:, :2], axis=1), 1e-12)[:, None]
        covered = _line_parts(places, footprint[:, None] + along * (slanted - footprint)[:, None])
        shade = 1 - (1 - LINES) * (1 - (1 - covered).prod(axis=1))
        near = shade[:, None] * floor.colour
        far = np.where(depth[:, None] < FLOOR_REACH * end, floor.horizon, sky)
        return near + faded * (far - near)


def _line_parts(places: Floats, footprints: Floats) -> Floats:
    """Return the fraction of each pixel that grid lines cover; positions and pixel widths are in grid cells."""
    half, apart = 0.5 * LINE_WIDTH, np.abs(places - np.rint(places))
    width = np.maximum(footprints, 1e-9)
    part = np.clip(0.5 + (half - apart) / width, 0, 1) * np.minimum(1, LINE_WIDTH / width)
    many = np.clip(2 * width - 1, 0, 1)
    return part + many * (LINE_WIDTH - part)
