"""Rendering by ray casting with MuJoCo's collision geometry, without OpenGL.

It has flat shading with lights and highlights, transparency and the floor, but no textures or shadows. The cost is
about 0.1 microseconds per pixel and visible geom.
"""

import copy
from collections.abc import Generator, Iterator
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.blocks import block
from ravemj.core.transforms import Floats
from ravemj.errors import RenderingError
from ravemj.graphics.rendering import Renderer
from ravemj.graphics.rendering.backdrop import Backdrop, FloorLevel
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.rendering.checks import check_data
from ravemj.graphics.rendering.fragments import Fragments, Raster
from ravemj.graphics.rendering.gl_scene import DrawnExtent
from ravemj.graphics.rendering.lights import Lights
from ravemj.graphics.rendering.style import AS_IT_IS, DRAWN_GROUPS, Look, Style, drawn_geoms, geom_rgba
from ravemj.model.drawing import NOTHING, Primitives
from ravemj.model.look import WHITE

_BAND = 1 << 16
"""Number of rays cast at once: a few megabytes, independent of the size of the picture."""

_LAYERS = 6
"""Maximum number of transparent surfaces along a ray."""

_EDGE = 12
"""Colour difference between adjacent pixels (0..255) above which both are antialiased."""

_SUBPIXELS = np.array([(-0.125, -0.375), (0.375, -0.125), (0.125, 0.375), (-0.375, 0.125)])

_HIDDEN_GROUP = 5
_MAX_DEPTH = 1e10

_TWO_WALLS = (
    mujoco.mjtGeom.mjGEOM_SPHERE,
    mujoco.mjtGeom.mjGEOM_CAPSULE,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    mujoco.mjtGeom.mjGEOM_CYLINDER,
    mujoco.mjtGeom.mjGEOM_BOX,
)
"""Convex geom types, which a ray enters and leaves once: if it hits a back face, it started inside."""


class RayRenderer(Renderer):
    """Renders one model by casting a ray through each pixel."""

    backend = "ray"
    has_shadows = False

    def __init__(self, model: mujoco.MjModel, width: int, height: int, samples: int = 4) -> None:
        self._model = model
        self._size = width, height
        self._samples = samples
        self._lights = Lights(model)
        self._level = FloorLevel(model)
        self._closed = False

    def render(
        self,
        data: mujoco.MjData,
        camera: Camera,
        look: Look | ArrayLike = WHITE,
        primitives: Primitives = NOTHING,
        style: Style = AS_IT_IS,
    ) -> NDArray[np.uint8]:
        """Render a picture; see :class:`ravemj.graphics.rendering.Renderer`."""
        del style  # needs OpenGL
        width, height = self._size
        picture = np.empty((height, width, 3), dtype=np.uint8)
        scene = self._scene(data, camera, Look.coerced(look))
        drawn = Raster(camera, self._size, self._lights).fragments(primitives)
        for rows, rays in self._bands(camera):
            here = drawn.between(rows.start * width, rows.stop * width)
            picture[rows] = np.rint(scene.colors(rays, here)).reshape(-1, width, 3)
        if self._samples:
            self._smooth_edges(picture, scene, camera, primitives)
        return picture

    def segment(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.int32]:
        """Render the geom ids at pixel centres; see :class:`ravemj.graphics.rendering.Renderer`."""
        width, height = self._size
        geom_ids = np.empty((height, width), dtype=np.int32)
        scene = self._scene(data, camera)
        for rows, rays in self._bands(camera):
            geom_ids[rows] = scene.cast(rays)[0].reshape(-1, width)
        return geom_ids

    def resize(self, width: int, height: int, samples: int) -> None:
        """Set the size and the samples per pixel; see :class:`ravemj.graphics.rendering.Renderer`."""
        self._size, self._samples = (width, height), samples

    def depth(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.float32]:
        """Render the depths at pixel centres; see :class:`ravemj.graphics.rendering.Renderer`."""
        width, height = self._size
        depths = np.empty((height, width), dtype=np.float32)
        scene = self._scene(data, camera)
        for rows, rays in self._bands(camera):  # rays go 1 m ahead, so that their lengths are depths
            geom_ids, depth, _ = scene.cast(rays)
            depths[rows] = np.where(geom_ids < 0, np.inf, depth).reshape(-1, width)
        return depths

    def close(self) -> None:
        """Refuse further pictures; there is nothing to free."""
        self._closed = True

    def _scene(self, data: mujoco.MjData, camera: Camera, look: Look | None = None) -> "_RayScene":
        """Return the state to render, with a private copy of the model in which hidden geoms are excluded."""
        if self._closed:
            raise RenderingError("this renderer is closed")
        check_data(self._model, data)
        model = copy.copy(self._model)
        look = look or Look()
        self._lights.update(data, camera, DrawnExtent.from_model(model, data).depths(camera), look)
        floor = self._level.floor(data, look)
        seen = None if floor is None or not floor.is_below(camera) else floor
        backdrop = Backdrop(look, seen, camera, 1 / camera.pinhole(*self._size).fx)
        model.geom_group[~drawn_geoms(model)] = _HIDDEN_GROUP
        return _RayScene(model, data, camera.position, geom_rgba(model), self._lights, backdrop)

    def _bands(self, camera: Camera) -> Iterator[tuple[slice, Floats]]:
        width, height = self._size
        by_column, by_row = camera.ray_parts(width, height)
        step = max(1, _BAND // width)
        for start in range(0, height, step):
            rows = slice(start, min(start + step, height))
            yield rows, (by_column + by_row[rows]).reshape(-1, 3)

    def _smooth_edges(
        self,
        picture: NDArray[np.uint8],
        scene: "_RayScene",
        camera: Camera,
        primitives: Primitives,
    ) -> None:
        """Replace pixels that differ from a neighbour by the mean of four rays."""
        rows, columns = np.nonzero(_edges(picture))
        ray_of_pixel = np.full(picture.shape[:2], -1)
        ray_of_pixel[rows, columns] = np.arange(rows.size)
        by_column, by_row = camera.ray_parts(*self._size)
        sums = np.zeros((rows.size, 3))
        for offset in _SUBPIXELS:
            aside = offset / camera.pinhole(*self._size)[:2] @ camera.rotation[:, :2].T
            drawn = Raster(camera, self._size, self._lights, offset, ray_of_pixel.reshape(-1)).fragments(primitives)
            for start in range(0, rows.size, _BAND):
                some = slice(start, min(start + _BAND, rows.size))
                rays = by_column[0, columns[some]] + by_row[rows[some], 0] + aside
                sums[some] += scene.colors(rays, drawn.between(some.start, some.stop))
        picture[rows, columns] = np.rint(sums / len(_SUBPIXELS))


@dataclass
class _RayScene:
    """One state of a model, seen from one camera position."""

    model: mujoco.MjModel  # its geom groups select the visible geoms
    data: mujoco.MjData
    origin: Floats  # the eye in the world, (3,) [m]
    rgba: Floats  # colours of the geoms, (ngeom, 4)
    lights: Lights
    backdrop: Backdrop

    def colors(self, rays: Floats, drawn: Fragments, layers: int = _LAYERS) -> Floats:
        """Return the unrounded colours in 0..255, shape (N, 3), seen along rays in the world, shape (N, 3).

        ``drawn`` are the fragments of drawings on the rays; at most ``layers`` transparent surfaces are passed.
        """
        colors = self.backdrop.colours(rays)
        geom_ids, depth, normals = self.cast(rays)
        hit = np.flatnonzero(geom_ids >= 0)
        ids = geom_ids[hit]
        light, shine = self.lights.on(self.origin + depth[hit, None] * rays[hit], rays[hit], normals[hit])
        shaded = 255 * np.minimum(self.rgba[ids, :3] * light + shine, 1)
        opacity = self._opacity(ids)
        colors[hit] = shaded
        hidden = (geom_ids >= 0)[drawn.ray] & (drawn.depth > depth[drawn.ray])
        behind_surface = drawn.select(hidden)
        for geom in np.unique(ids[opacity < 1]) if layers else ():
            seen = np.flatnonzero(ids == geom)
            with self._without(geom):
                farther = behind_surface.of_rays(hit[seen], len(rays))
                behind = self.colors(rays[hit[seen]], farther, layers - 1)
            weight = opacity[seen, None]
            colors[hit[seen]] = weight * shaded[seen] + (1 - weight) * behind
        drawn.select(~hidden).over(colors)
        return colors

    def cast(self, rays: Floats) -> tuple[NDArray[np.int32], Floats, Floats]:
        """Return geom ids (-1: none), depths and outward unit normals (N, 3) of the first hits of rays, shape (N, 3).

        As in OpenGL, a convex geom that contains the camera is invisible. Meshes are visible from both sides.
        """
        count = len(rays)
        geom_ids = np.empty(count, dtype=np.int32)
        depth = np.empty(count)
        normals = np.empty((count, 3))
        given = self.model, self.data, self.origin, rays.reshape(-1), DRAWN_GROUPS, True, -1
        mujoco.mj_multiRay(*given, geom_ids, depth, normals.reshape(-1), count, _MAX_DEPTH)
        inside = (np.einsum("ij,ij->i", normals, rays) > 0) & self._has_two_walls(geom_ids)
        if inside.any():  # the camera is inside these geoms, so they are invisible
            again = np.flatnonzero(inside)
            self.model.geom_group[geom_ids[again]] = _HIDDEN_GROUP
            geom_ids[again], depth[again], normals[again] = self.cast(rays[again])
        return geom_ids, depth, normals

    def _has_two_walls(self, geom_ids: NDArray[np.int32]) -> NDArray[np.bool_]:
        two_walls = np.isin([*self.model.geom_type, -1], _TWO_WALLS)  # the last stands for no geom, -1
        return two_walls[geom_ids]

    def _opacity(self, geom_ids: NDArray[np.int32]) -> Floats:
        """Return the opacity of geoms as MuJoCo's OpenGL shows it, which draws both walls of convex geoms."""
        walls = 1 + self._has_two_walls(geom_ids)
        return 1 - (1 - self.rgba[geom_ids, 3]) ** walls

    @block
    def _without(self, geom: int) -> Generator[None]:
        group = int(self.model.geom_group[geom])
        self.model.geom_group[geom] = _HIDDEN_GROUP
        try:
            yield
        finally:
            self.model.geom_group[geom] = group


def _edges(picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return a mask, shape (H, W), of the pixels that differ from an adjacent pixel in their row or column."""
    edges = np.zeros(picture.shape[:2], dtype=np.bool_)
    for first, second in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        pixel, other = picture[first], picture[second]
        differs = (np.maximum(pixel, other) - np.minimum(pixel, other) > _EDGE).any(axis=2)
        edges[first] |= differs
        edges[second] |= differs
    return edges
