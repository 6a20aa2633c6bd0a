"""Pictures by OpenGL, without a window."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.locks import is_left_to_end
from ravemj.errors import RenderingError
from ravemj.graphics.rendering import Renderer
from ravemj.graphics.rendering.camera import Camera
from ravemj.graphics.rendering.checks import WHITE, check_data, color_bytes
from ravemj.graphics.rendering.contexts import OffscreenContext, close_at_exit
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.graphics.rendering.style import AS_IT_IS, Style
from ravemj.model.drawing import NOTHING, Primitives

_DEPTH_ZERO_FAR = 1
"""MuJoCo's ``mjDEPTH_ZEROFAR``: depths are handed out as they are drawn, which loses no digits."""


class GlRenderer(Renderer):
    """Draws one model with MuJoCo's classic OpenGL renderer.

    A picture may be drawn from any thread, one at a time: the context is current only while one is drawn.
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
            if stage.context.currentBuffer != offscreen:  # MuJoCo would draw into a window, and there is none
                stage.close()
                raise RenderingError("the OpenGL driver has no offscreen framebuffers")
            self._gl_scene = stage
        close_at_exit(self)

    def render(
        self,
        data: mujoco.MjData,
        camera: Camera,
        background: ArrayLike = WHITE,
        primitives: Primitives = NOTHING,
        style: Style = AS_IT_IS,
    ) -> NDArray[np.uint8]:
        """See :class:`ravemj.graphics.rendering.Renderer`."""
        color = color_bytes(background)
        stage = self._filled_stage(data, camera, primitives, style)
        if stage.is_empty:
            return np.broadcast_to(color, (*self._size[::-1], 3)).copy()
        with self._context.current():
            stage.draw(self._viewport, color)
            picture = self._read(stage)
        if not stage.has_background:
            picture[~self._codes(stage).any(axis=2)] = color
        return picture

    def segment(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.int32]:
        """See :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._filled_stage(data, camera, NOTHING, AS_IT_IS)
        return stage.geom_ids(self._codes(stage))

    def resize(self, width: int, height: int, samples: int) -> None:
        """See :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._gl_scene
        if stage is None:
            return
        self._size, self._viewport = (width, height), mujoco.MjrRect(0, 0, width, height)
        with self._context.current():
            stage.set_buffer(width, height, samples)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, stage.context)

    def depth(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.float32]:
        """See :class:`ravemj.graphics.rendering.Renderer`."""
        stage = self._filled_stage(data, camera, NOTHING, AS_IT_IS)
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
        """Free the context and what is in it; a second call does nothing."""
        stage, self._gl_scene = self._gl_scene, None
        if stage is None:
            return
        if is_left_to_end():  # the main thread may just close the display
            _never_freed.append(stage)
            return
        try:
            with self._context.current():
                stage.close()
        except RenderingError:
            _never_freed.append(stage)  # freeing it here would free what the window in this thread holds
        self._context.close()

    def __del__(self) -> None:
        self.close()

    def _codes(self, stage: GlScene) -> NDArray[np.uint8]:
        with self._context.current():
            stage.draw_ids(self._viewport)
            return self._read(stage)

    def _filled_stage(self, data: mujoco.MjData, camera: Camera, primitives: Primitives, style: Style) -> GlScene:
        if self._gl_scene is None:
            raise RenderingError("this renderer is closed")
        check_data(self._model, data)
        self._gl_scene.fill(data, camera, self._size, primitives, style)
        return self._gl_scene

    def _read(self, stage: GlScene, depth: NDArray[np.float32] | None = None) -> NDArray[np.uint8]:
        """Return what was drawn; a buffer for depths is filled too, the last row first."""
        width, height = self._size
        pixels = np.empty((height, width, 3), dtype=np.uint8)
        stage.context.readDepthMap = _DEPTH_ZERO_FAR
        mujoco.mjr_readPixels(pixels, depth, self._viewport, stage.context)
        return pixels[::-1].copy()


_never_freed: list[GlScene] = []
