"""Offscreen rendering with OpenGL."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.locks import is_left_to_end
from ravemj.errors import RenderingError
from ravemj.graphics.rendering import Renderer
from ravemj.graphics.rendering.backdrop import sky_colours
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.rendering.checks import check_data
from ravemj.graphics.rendering.contexts import OffscreenContext, close_at_exit
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.graphics.rendering.style import AS_IT_IS, Look, Style
from ravemj.model.drawing import NOTHING, Primitives
from ravemj.model.look import WHITE

_DEPTH_ZERO_FAR = 1
"""MuJoCo's ``mjDEPTH_ZEROFAR``: depth values are returned as rendered, without loss of precision."""


class GlRenderer(Renderer):
    """Renders one model with MuJoCo's classic OpenGL renderer.

    Any thread may render, one at a time: the context is current only while rendering.
    """

    def __init__(self, model: mujoco.MjModel, quality: Quality, context: OffscreenContext) -> None:
        self._gl_scene: GlScene | None = None
        self.backend = context.backend
        self._model = model
        self._size = quality.width, quality.height
        self._viewport = mujoco.MjrRect(0, 0, quality.width, quality.height)
        self._context = context
        with context.current():
            stage = GlScene(model, quality)
            offscreen = mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value
            mujoco.mjr_setBuffer(offscreen, stage.context)
            if stage.context.currentBuffer != offscreen:  # MuJoCo would draw into a window, which does not exist
                stage.close()
                raise RenderingError("the OpenGL driver has no offscreen framebuffers")
            self._gl_scene = stage
            self.has_shadows = stage.has_shadows
        close_at_exit(self)

    def render(
        self,
        data: mujoco.MjData,
        camera: Camera,
        look: Look | ArrayLike = WHITE,
        primitives: Primitives = NOTHING,
        style: Style = AS_IT_IS,
    ) -> NDArray[np.uint8]:
        """Render a picture; see :class:`ravemj.graphics.rendering.Renderer`."""
        chosen = Look.coerced(look)
        stage = self._filled_stage(data, camera, primitives, style, chosen)
        if stage.is_empty:
            return self._backdrop(chosen, camera)
        with self._context.current():
            stage.draw(self._viewport)
            picture = self._read(stage)
        if not stage.has_background:
            empty = ~self._codes(stage).any(axis=2)
            picture[empty] = self._backdrop(chosen, camera)[empty]
        return picture

    def _backdrop(self, look: Look, camera: Camera) -> NDArray[np.uint8]:
        columns, rows = camera.ray_parts(*self._size)
        rays = columns + rows
        return np.rint(255 * sky_colours(look, rays[..., 2] / np.linalg.norm(rays, axis=2))).astype(np.uint8)

    def segment(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.int32]:
        """Render the geom ids at pixel centres; see :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._filled_stage(data, camera, NOTHING, AS_IT_IS, Look())
        return stage.geom_ids(self._codes(stage))

    def resize(self, width: int, height: int, samples: int) -> None:
        """Set the size and the samples per pixel; see :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._gl_scene
        if stage is None:
            return
        self._size, self._viewport = (width, height), mujoco.MjrRect(0, 0, width, height)
        with self._context.current():
            stage.set_buffer(width, height, samples)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, stage.context)

    def depth(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.float32]:
        """Render the depths at pixel centres; see :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._filled_stage(data, camera, NOTHING, AS_IT_IS, Look())
        width, height = self._size
        buffer = np.empty((height, width), dtype=np.float32)
        with self._context.current():
            stage.draw_ids(self._viewport)
            shown = self._read(stage, buffer).any(axis=2)
        eye = stage.scene.camera[0]
        near, far = eye.frustum_near, eye.frustum_far
        # 1 at the nearest depth that is drawn, 0 at the farthest.
        depths = near * far / (buffer[::-1].astype(np.float64) * (far - near) + near)
        return np.where(shown, depths, np.inf).astype(np.float32)

    def close(self) -> None:
        """Free the context and its objects; a second call does nothing."""
        stage, self._gl_scene = self._gl_scene, None
        if stage is None:
            return
        if is_left_to_end():  # the main thread may be closing the display
            _never_freed.append(stage)
            return
        try:
            with self._context.current():
                stage.close()
        except RenderingError:
            _never_freed.append(stage)  # freeing it here would free objects of this thread's window
        self._context.close()

    def __del__(self) -> None:
        self.close()

    def _codes(self, stage: GlScene) -> NDArray[np.uint8]:
        with self._context.current():
            stage.draw_ids(self._viewport)
            return self._read(stage)

    def _filled_stage(
        self, data: mujoco.MjData, camera: Camera, primitives: Primitives, style: Style, look: Look
    ) -> GlScene:
        if self._gl_scene is None:
            raise RenderingError("this renderer is closed")
        check_data(self._model, data)
        self._gl_scene.fill(data, camera, self._size, primitives, style, look)
        return self._gl_scene

    def _read(self, stage: GlScene, depth: NDArray[np.float32] | None = None) -> NDArray[np.uint8]:
        """Return the rendered picture, top row first; also fill ``depth``, if given, bottom row first."""
        width, height = self._size
        pixels = np.empty((height, width, 3), dtype=np.uint8)
        stage.context.readDepthMap = _DEPTH_ZERO_FAR
        mujoco.mjr_readPixels(pixels, depth, self._viewport, stage.context)
        return pixels[::-1].copy()


_never_freed: list[GlScene] = []
