"""MuJoCo's classic renderer, for offscreen buffers and windows.

A ``GlScene`` belongs to one model and one OpenGL context. The caller makes the context current in its thread before
calling any method, so that windows can use the same code.
"""

import copy
import logging
import threading
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block
from ravemj.core.forks import in_child
from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.backdrop import Floor, FloorLevel, skybox
from ravemj.graphics.rendering.camera import Camera, aim, bounding_sphere
from ravemj.graphics.rendering.contexts import draws_with_hardware
from ravemj.graphics.rendering.drawing_geoms import add_drawing_geoms
from ravemj.graphics.rendering.lights import place_lights
from ravemj.graphics.rendering.style import AS_IT_IS, DRAWN_GROUPS, Look, Style, drawn_geoms
from ravemj.model.drawing import NOTHING, Primitives
from ravemj.model.look import FLOOR_REACH

SHADOW_SIZE = 1024
"""Texels along one side of a shadow map. Larger maps are slow on a CPU, and the main light has several."""

_SHADOW_REACH = 1.05
"""Half the side of the shadow map, relative to the radius of the scene.

MuJoCo's offset against self-shadowing is proportional to this side; at 1, surfaces far from the light show artefacts.
"""

_SHADOW_DISTANCE = 1.1
"""Distance of lights from the centre of their shadow maps, less the camera's near depth [radii of the scene]."""

_SLICES, _STACKS = 48, 24
"""Facets around and along round shapes; with MuJoCo's 28 and 16, edges are visible in close-ups."""

_SAMPLES = 4
"""Initial samples per pixel of a context, since MuJoCo creates its multisampling buffer only at the start."""

_SPARE_GEOMS = 1000
_MAX_FIGURES = 300_000
"""Maximum number of drawn primitives in one picture; MuJoCo needs a second to allocate memory for so many."""

_SMALLEST = 1e-3
"""Minimum radius of a drawing's bounding sphere [m], for instance of a single point."""

_WIDEST = 1e-6
"""Minimum ratio of near to far depth; below it MuJoCo loses the background."""

FLOOR_MATERIAL = "floor"
"""Name of the material with the floor's grid in MJCF files."""

_FLOOR_BELOW = 1e-4
"""Gap between bodies and drawn floor, relative to the radius of the scene, so that a floor of the model hides it."""

_painting = threading.Lock()
"""Lock held while the model's texture temporarily contains a background colour."""

_LOG = logging.getLogger("ravemj")


@in_child
def _free_painting() -> None:
    global _painting  # noqa: PLW0603 - of the process
    _painting = threading.Lock()


_PLAIN = Look()


@dataclass(frozen=True)
class Quality:
    """Fixed properties of an OpenGL context."""

    width: int  # columns of the offscreen buffer
    height: int  # rows of the offscreen buffer
    shadows: bool | None = False  # whether to render shadows; None: only with a graphics card
    samples: int = 4  # per pixel against jagged edges, 0 or 4


class GlScene:
    """Renders one model with OpenGL from MuJoCo's ``MjvScene``, the list of drawn geoms; ``fill`` updates it."""

    def __init__(self, model: mujoco.MjModel, quality: Quality) -> None:
        self._model = model
        self.has_shadows = draws_with_hardware() if quality.shadows is None else quality.shadows
        with _quality_of(model, replace(quality, samples=_SAMPLES, shadows=self.has_shadows)):
            self.context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150.value)
        self.set_buffer(quality.width, quality.height, quality.samples)
        self._has_warned = False
        self._make_scene(_SPARE_GEOMS)
        self._option = drawing_option()
        self._skybox = _find_skybox(model)
        self._painted: object = None
        self._level = FloorLevel(model)
        self._floor: Floor | None = None
        self._material = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_MATERIAL.value, FLOOR_MATERIAL)

    @property
    def has_background(self) -> bool:
        """Whether the model has a skybox texture, into which background colours are painted."""
        return self._skybox is not None

    @property
    def is_empty(self) -> bool:
        """Whether nothing is drawn; MuJoCo would then leave the buffer unchanged."""
        return self.scene.ngeom == 0

    def _make_scene(self, room: int) -> None:
        self.scene = mujoco.MjvScene(self._model, self._model.ngeom + room + 1)  # the last one is for the floor
        self._room = room

    def fill(
        self,
        data: mujoco.MjData,
        camera: Camera,
        size: tuple[int, int],
        primitives: Primitives = NOTHING,
        style: Style = AS_IT_IS,
        look: Look = _PLAIN,
    ) -> None:
        """Copy geom poses, drawings, camera and look into the GL scene.

        With points or lines there are no shadows, since MuJoCo would draw points and lines again for each light with
        shadows, and add the colours. ``size`` is columns and rows of the viewport.
        """
        self._make_room(len(primitives))
        has_lines = bool(primitives.points.sizes.size or primitives.lines.sizes.size)
        self.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self.has_shadows and not has_lines
        self._look, self._floor = look, None if style.wireframe else self._level.floor(data, look)
        self._contents = DrawnExtent.from_model(self._model, data, primitives, self._floor)
        aim(self.scene, camera, size, self._contents.depths(camera))
        if self._model.nlight:
            mujoco.mj_camlight(self._model, data)
        user_camera = mujoco.MjvCamera()
        user_camera.type = mujoco.mjtCamera.mjCAMERA_USER
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        style.apply(self._option)
        mujoco.mjv_updateScene(self._model, data, self._option, None, user_camera, everything, self.scene)
        self._lights = [copy.copy(light) for light in self.scene.lights[: self.scene.nlight]]
        style.finish(self._model, self.scene)
        self._widths = [(array, array.copy()) for array in add_drawing_geoms(self.scene, primitives, camera, *size)]
        self._filled = self.scene.ngeom
        self.aim(camera, size)

    def aim(self, camera: Camera, size: tuple[int, int]) -> None:
        """Change only the camera of the filled scene."""
        near, far = self._contents.depths(camera)
        aim(self.scene, camera, size, (near, far))
        self._columns = size[0]
        place_lights(self._model, self.scene, self._lights, self._look, camera.rotation, soft=self.has_shadows)
        if self.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW]:
            self._cover_with_shadows(near)
        self.scene.ngeom = self._filled
        if self._floor is not None and self._floor.is_below(camera) and self._filled < self.scene.maxgeom:
            self._add_floor(self._floor, camera)

    def _add_floor(self, floor: Floor, camera: Camera) -> None:
        """Append the floor with fog towards the horizon; its colour is corrected for the lighting."""
        start, end = floor.fading(camera)
        half = floor.cell * np.ceil(FLOOR_REACH * end / floor.cell)
        middle = floor.cell * np.rint(camera.position[:2] / floor.cell)
        position = np.array([*middle, floor.height - _FLOOR_BELOW * floor.radius])
        light = sum(
            (light.ambient + light.diffuse * max(-float(light.dir[2]), 0.0) for light in self._drawn_lights()),
            start=np.full(3, 1e-3),
        )
        glow = max(float(np.max(floor.colour - light)), 0.0)  # its brightness in any light
        rgba = np.array([*floor.colour / (light + glow), 1], dtype=np.float32)
        slot = self.scene.geoms[self.scene.ngeom]
        size = np.array([half, half, 1.0])
        mujoco.mjv_initGeom(slot, mujoco.mjtGeom.mjGEOM_PLANE, size, position, np.eye(3).reshape(-1), rgba)
        slot.category, slot.segid = mujoco.mjtCatBit.mjCAT_DECOR, -1
        slot.specular = slot.reflectance = 0.0
        slot.matid, slot.emission = self._material, glow
        if self._material >= 0:
            self.context.mat_texrepeat[2 * self._material : 2 * self._material + 2] = 2 * half / floor.cell
        self.scene.ngeom += 1
        self.context.fogStart, self.context.fogEnd = start, end
        self.context.fogRGBA = np.array([*floor.horizon, 1], dtype=np.float32)

    def _drawn_lights(self) -> Sequence[mujoco.MjvLight]:
        return self.scene.lights[: self.scene.nlight]

    def set_buffer(self, width: int, height: int, samples: int) -> None:
        """Set the size and the samples per pixel (0 or 4) of the offscreen buffer."""
        context = self.context
        if (context.offWidth, context.offHeight, context.offSamples) == (width, height, samples):
            return
        if context.offSamples != samples:
            context.offSamples = samples
            mujoco.mjr_resizeOffscreen(1, 1, context)  # no effect if the size does not change
        mujoco.mjr_resizeOffscreen(width, height, context)

    def _make_room(self, figures: int) -> None:
        if figures > _MAX_FIGURES and not self._has_warned:
            self._has_warned = True
            _LOG.warning("%d figures are drawn, and OpenGL shows %d of them", figures, _MAX_FIGURES)
        if self._room < min(figures, _MAX_FIGURES):
            self._make_scene(min(2 * figures, _MAX_FIGURES))

    def draw(self, viewport: mujoco.MjrRect) -> None:
        """Render into a rectangle of the current framebuffer, in pixels from its lower left corner.

        If it has fewer columns than the size given to ``fill``, points and lines become narrower. The background is
        black if the model has no skybox texture.
        """
        self._paint_background()
        self.scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = self.scene.ngeom > self._filled
        for widths, whole in self._widths:
            widths[:] = viewport.width / self._columns * whole
        mujoco.mjr_render(viewport, self.scene, self.context)

    def draw_ids(self, viewport: mujoco.MjrRect) -> None:
        """Render geom ids instead of colours; :meth:`geom_ids` decodes them."""
        flags, count = self.scene.flags.copy(), self.scene.ngeom
        self.scene.ngeom = self._filled
        self.scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = False
        self.scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        self.scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        mujoco.mjr_render(viewport, self.scene, self.context)
        self.scene.flags[:] = flags
        self.scene.ngeom = count

    def geom_ids(self, pixels: NDArray[np.uint8]) -> NDArray[np.int32]:
        """Decode the pixels rendered by :meth:`draw_ids`, shape (..., 3), to geom ids, shape (...), -1 for none."""
        codes = pixels.astype(np.int32) @ np.array([1, 1 << 8, 1 << 16], dtype=np.int32)
        geom_of_code = np.full(self.scene.ngeom + 1, -1, dtype=np.int32)
        for drawn in self.scene.geoms[: self.scene.ngeom]:
            if drawn.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                geom_of_code[drawn.segid + 1] = drawn.objid
        return geom_of_code[codes]

    def close(self) -> None:
        """Free the OpenGL resources."""
        self.context.free()

    def _cover_with_shadows(self, near: float) -> None:
        """Move directional lights back so that their shadow maps cover the scene; ``near`` is the camera's near depth.

        The positions have no effect on the illumination. MuJoCo renders shadow maps with the camera's depth range.
        """
        center, radius = self._contents.spheres[0]
        self.context.shadowClip = _SHADOW_REACH * radius
        for light in self._drawn_lights():
            if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL and light.castshadow:
                light.pos = center - (near + _SHADOW_DISTANCE * radius) * light.dir

    def _paint_background(self) -> None:
        """Upload a new skybox to the graphics card if the background changed; the texture in the model is restored."""
        background = self._look.background
        if self._skybox is None or self._painted == (background,):
            return
        model, texture = self._model, self._skybox
        width, channels = int(model.tex_width[texture]), int(model.tex_nchannel[texture])
        start = int(model.tex_adr[texture])
        stop = start + width * int(model.tex_height[texture]) * channels
        with _painting:
            original = model.tex_data[start:stop].copy()
            model.tex_data[start:stop].reshape(-1, width, channels)[:, :, :3] = skybox(self._look, width)
            mujoco.mjr_uploadTexture(model, self.context, texture)
            model.tex_data[start:stop] = original
        self._painted = (background,)


def drawing_option() -> mujoco.MjvOption:
    """Return the visualization options: geoms of groups 0 to 2, without sites, tendons and other aids."""
    option = mujoco.MjvOption()
    option.geomgroup[:] = DRAWN_GROUPS
    option.sitegroup[:] = 0
    option.tendongroup[:] = 0
    option.flags[mujoco.mjtVisFlag.mjVIS_RANGEFINDER] = False
    return option


@dataclass(frozen=True, eq=False)
class DrawnExtent:
    """Bounding volume of the drawn objects, for the clipping depths."""

    spheres: tuple[tuple[Floats, float], ...]  # centres and radii around geoms, and around drawings if there are some
    planes: float  # drawn extent of planes [m]; 0 without planes
    floor: Floor | None  # the floor below the bodies

    @classmethod
    def from_model(
        cls,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        primitives: Primitives = NOTHING,
        floor: Floor | None = None,
    ) -> "DrawnExtent":
        """Return the extent of a model, drawings and the floor."""
        spheres = [bounding_sphere(model, data)]
        if len(primitives):
            center, radius = primitives.bounding_sphere()
            spheres.append((center, max(radius, _SMALLEST)))
        has_planes = (drawn_geoms(model) & (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)).any()
        return cls(tuple(spheres), 5 * model.vis.map.zfar * model.stat.extent if has_planes else 0.0, floor)

    def depths(self, camera: Camera) -> tuple[float, float]:
        """Return the near and far clipping depths [m] for a camera at any position.

        MuJoCo draws the background on a cube inside the far depth, which must therefore be well behind the scene. The
        depth buffer contains floats, 1 for the near depth, so wide ranges lose no precision.
        """
        (center, radius), *drawings = self.spheres
        near, far = _depths_of_sphere(center, radius, camera)
        for sphere in drawings:
            nearer, farther = _depths_of_sphere(*sphere, camera)
            far = max(far, farther)
            near = max(min(near, nearer), _WIDEST * far)
        planes = self.planes if self.floor is None else max(self.planes, FLOOR_REACH * self.floor.fading(camera)[1])
        if planes:
            near = min(near, 1e-2 * radius)
            far = max(far, planes)
        return near, far


def _depths_of_sphere(center: Floats, radius: float, camera: Camera) -> tuple[float, float]:
    depth = float((center - camera.position) @ camera.rotation[:, 2])
    near = max(0.9 * (depth - radius), 1e-4 * radius)
    return near, 5 * max(depth + radius, near)


def _find_skybox(model: mujoco.MjModel) -> int | None:
    """Return the id of the skybox texture; None if there is no writable one."""
    skyboxes = np.flatnonzero(model.tex_type == mujoco.mjtTexture.mjTEXTURE_SKYBOX)
    if skyboxes.size == 0 or model.tex_adr[skyboxes[0]] < 0 or model.tex_nchannel[skyboxes[0]] < 3:
        return None
    return int(skyboxes[0])


@block
def _quality_of(model: mujoco.MjModel, quality: Quality) -> Generator[None]:
    """Set the model fields for quality that ``MjrContext`` reads; restore them at the end of the block."""
    sizes: Sequence[tuple[object, str, int]] = (
        (model.vis.global_, "offwidth", quality.width),
        (model.vis.global_, "offheight", quality.height),
        (model.vis.quality, "offsamples", quality.samples),
        (model.vis.quality, "shadowsize", SHADOW_SIZE if quality.shadows else 0),
        (model.vis.quality, "numslices", _SLICES),
        (model.vis.quality, "numstacks", _STACKS),
    )
    before = [getattr(owner, name) for owner, name, _ in sizes]
    for owner, name, value in sizes:
        setattr(owner, name, value)
    try:
        yield
    finally:
        for (owner, name, _), value in zip(sizes, before, strict=True):
            setattr(owner, name, value)
