"""Renderer of a simulation and its overlay into the current OpenGL window."""

import time
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.engine.simulation import Simulation
from ravemj.engine.simulation.published import Published
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.graphics.rendering.style import Look, Style
from ravemj.gui.interaction import Interaction, Overlay, Viewpoint
from ravemj.gui.viewers.sharpness import CRISP, Level, Sharpness
from ravemj.gui.viewers.window_overlay import OverlayPainter
from ravemj.model.drawing import NOTHING, Primitives, merge
from ravemj.model.look import HORIZON

_WINDOW = mujoco.mjtFramebuffer.mjFB_WINDOW.value
_OFFSCREEN = mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value


class DrawTarget(NamedTuple):
    """Target of a frame: look, shadows (None: only with a graphics card), size, pixels per point."""

    look: Look
    shadows: bool | None
    pixels: tuple[int, int]
    ratio: float


def appearance(simulation: Simulation) -> object:
    """Return a key that changes when bodies or drawings must be redrawn; the caller has locked the simulation."""
    compiled = simulation.compiled()
    model, data = compiled.model, compiled.data
    state = data.geom_xpos.tobytes(), data.geom_xmat.tobytes(), model.geom_rgba.tobytes()
    return simulation.version, state, simulation.drawings.primitives()


class WindowRenderer:
    """Renders the frames of a window if anything has changed.

    Bodies are drawn into a buffer, at an adaptive resolution, and copied into the window. If only texts and buttons
    change, the buffer is reused.
    """

    def __init__(self) -> None:
        self._gl_scene: GlScene | None = None
        self._scene_key: object = None
        self._seen: object = None
        self._seen_view: object = None
        self._line = ""
        self._bodies: object = None
        self._model: mujoco.MjModel | None = None
        self._primitives = NOTHING
        self._published = 0
        self._drawn: object = None
        self._overlay: Overlay | None = None
        self._view: Viewpoint | None = None
        self._painter = OverlayPainter()
        self._sharpness = Sharpness()
        self._buffer = 1, 1

    def update(self, simulation: Simulation, interaction: Interaction, surface: DrawTarget) -> bool:
        """Copy the state of the simulation and the view; the caller has locked the simulation.

        Returns:
            Whether the frame differs from the previous one.
        """
        compiled = simulation.compiled()
        looks = appearance(simulation)
        seen = (looks, interaction.appearance, surface)
        if seen == self._seen and not self._line:
            return False
        self._seen, self._line = seen, ""
        self._overlay, self._view = interaction.overlay(), interaction.drawn_view
        self._published = simulation.published.number
        self._seen_view = self._view.camera, self._view.size, interaction.mode, surface, self._published
        self._primitives = merge([simulation.drawings.primitives(), self._overlay.primitives])
        stage = self._prepared_scene(compiled.model, simulation.version, surface.shadows)
        style = self._overlay.style
        stage.fill(compiled.data, self._view.camera, surface.pixels, self._primitives, style, surface.look)
        self._bodies = looks, _content(self._overlay.primitives), self._overlay.style
        return True

    def update_view(self, interaction: Interaction, surface: DrawTarget, line: str, published: Published) -> bool:
        """Copy the state of the view while other threads hold the simulation's lock; show the message ``line``.

        Bodies keep their last known or published poses.

        Returns:
            Whether the frame differs from the previous one.
        """
        view = interaction.drawn_view
        seen = view.camera, view.size, interaction.mode, surface, published.number
        if self._gl_scene is None or self._overlay is None or (seen == self._seen_view and line == self._line):
            return False
        if published.number != self._published:
            self._copy_published(self._gl_scene, published, view, surface, self._overlay.style)
        self._seen_view, self._line, self._view = seen, line, view
        lines = tuple(other for other in self._overlay.lines if other != line)
        self._overlay = self._overlay._replace(lines=(line, *lines) if line else lines)
        self._gl_scene.aim(view.camera, surface.pixels)
        return True

    def _copy_published(
        self, stage: GlScene, published: Published, view: Viewpoint, surface: DrawTarget, style: Style
    ) -> None:
        assert self._model is not None, "there is a scene of it"
        data = mujoco.MjData(self._model)
        self._published = published.number
        if published.copy_to(data, self._model):
            stage.fill(data, view.camera, surface.pixels, self._primitives, style, surface.look)
            self._bodies = self._published
            self._seen = None  # the holder of the lock may restore the earlier poses

    def _prepared_scene(self, model: mujoco.MjModel, version: int, shadows: bool | None) -> GlScene:
        key = version, shadows
        if self._gl_scene is None or self._scene_key != key:
            self.close()
            self._gl_scene, self._model, self._scene_key = GlScene(model, Quality(1, 1, shadows)), model, key
        return self._gl_scene

    def is_due(self, now: float) -> bool:
        """Return whether the scene at rest must be redrawn in full quality; ``now`` is from ``time.monotonic``."""
        return self._gl_scene is not None and self._sharpness.is_due(now)

    def draw(self, surface: DrawTarget, now: float) -> None:
        """Draw the last copied state, without the overlay; ``now`` is from ``time.monotonic``."""
        stage, view = self._gl_scene, self._view
        if stage is None or view is None:
            return
        content = self._bodies, view.camera.T_world_camera.tobytes(), view.camera.fovy, surface
        if self._sharpness.is_due(now):
            self._draw_bodies(stage, surface, CRISP)
        elif content != self._drawn:
            self._draw_bodies(stage, surface, self._sharpness.level_while_moving(now))
        self._drawn = content
        whole = mujoco.MjrRect(0, 0, *surface.pixels)
        mujoco.mjr_setBuffer(_OFFSCREEN, stage.context)
        mujoco.mjr_blitBuffer(mujoco.MjrRect(0, 0, *self._buffer), whole, 1, 0, stage.context)
        mujoco.mjr_setBuffer(_WINDOW, stage.context)

    def _draw_bodies(self, stage: GlScene, surface: DrawTarget, level: Level) -> None:
        begin = time.monotonic()
        columns, rows = (max(round(level.scale * length), 1) for length in surface.pixels)
        self._buffer = columns, rows
        stage.set_buffer(*self._buffer, level.samples)
        mujoco.mjr_setBuffer(_OFFSCREEN, stage.context)
        whole = mujoco.MjrRect(0, 0, *self._buffer)
        if stage.is_empty:
            mujoco.mjr_rectangle(whole, *(surface.look.background or HORIZON), 1.0)
        else:
            stage.draw(whole)
        mujoco.mjr_finish()
        self._sharpness.add_measurement(level, time.monotonic() - begin)

    @property
    def cursor(self) -> str:
        """Shape of the pointer, as in ``Overlay.cursor``."""
        return "default" if self._overlay is None else self._overlay.cursor

    def read(self, pixels: tuple[int, int]) -> NDArray[np.uint8]:
        """Return the drawn picture, shape (height, width, 3), top row first."""
        picture = np.zeros((pixels[1], pixels[0], 3), dtype=np.uint8)
        if self._gl_scene is not None:
            mujoco.mjr_readPixels(picture, None, mujoco.MjrRect(0, 0, *pixels), self._gl_scene.context)
        return picture[::-1].copy()

    def draw_overlay(self, surface: DrawTarget) -> None:
        """Draw the overlay over the picture."""
        if self._overlay is not None and self._view is not None:
            self._painter.paint(self._overlay, self._view, surface.pixels, surface.ratio)

    def close(self) -> None:
        """Free the OpenGL resources."""
        if self._gl_scene is not None:
            self._gl_scene.close()
            self._gl_scene = None


def _content(primitives: Primitives) -> tuple[bytes, ...]:
    """Return a key that is equal for equal drawings."""
    return tuple(array.tobytes() for batch in primitives.batches for array in batch)
