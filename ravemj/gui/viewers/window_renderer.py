"""Draws a simulation, and the text and the buttons over it, into the current OpenGL window."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.engine.simulation import Simulation
from ravemj.graphics.rendering.gl_scene import GlScene, Quality
from ravemj.gui.interaction import Interaction, Overlay, Panel
from ravemj.model.drawing import merge

_FONT = mujoco.mjtFont.mjFONT_NORMAL.value
_TOP_LEFT = mujoco.mjtGridPos.mjGRID_TOPLEFT.value


def appearance(simulation: Simulation) -> object:
    """Return what is equal for as long as bodies and drawings look the same; the caller has locked the simulation."""
    compiled = simulation.compiled()
    model, data = compiled.model, compiled.data
    state = data.geom_xpos.tobytes(), data.geom_xmat.tobytes(), model.geom_rgba.tobytes()
    return simulation.version, state, simulation.drawings.primitives()


class WindowRenderer:
    """Draws into a window, whenever something has changed."""

    def __init__(self) -> None:
        self._gl_scene: GlScene | None = None
        self._scene_key: object = None
        self._seen: object = None
        self._overlay: Overlay | None = None

    def look(
        self,
        simulation: Simulation,
        interaction: Interaction,
        background: ArrayLike,
        pixels: tuple[int, int],
        ratio: float,
    ) -> bool:
        """Take over how everything is now; the caller has locked the simulation.

        Args:
            simulation: What is drawn; it is not kept.
            interaction: The view, and what is drawn over it.
            background: Colour where nothing is, in 0..1.
            pixels: Width and height of the window.
            ratio: How many pixels a point has.

        Returns:
            Whether anything looks different from last time.
        """
        compiled = simulation.compiled()
        seen = (appearance(simulation), interaction.version, background, pixels, ratio)
        if seen == self._seen:
            return False
        self._seen = seen
        self._overlay = interaction.overlay()
        stage = self._prepared_scene(compiled.model, (simulation.version, ratio), ratio)
        primitives = merge([simulation.drawings.primitives(), self._overlay.primitives])
        stage.fill(compiled.data, interaction.drawn_view.camera, *pixels, primitives)
        return True

    def _prepared_scene(self, model: mujoco.MjModel, key: object, ratio: float) -> GlScene:
        if self._gl_scene is None or self._scene_key != key:
            self.close()
            self._gl_scene, self._scene_key = GlScene(model, Quality(1, 1)), key
            mujoco.mjr_changeFont(_font_scale(ratio), self._gl_scene.context)
        return self._gl_scene

    def draw(self, background: ArrayLike, pixels: tuple[int, int]) -> None:
        """Draw what was seen last, without text and buttons; arguments as for ``look``."""
        if self._gl_scene is not None:
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_WINDOW.value, self._gl_scene.context)
            self._gl_scene.draw(mujoco.MjrRect(0, 0, *pixels), np.rint(np.multiply(background, 255)).astype(np.uint8))

    def read(self, pixels: tuple[int, int]) -> NDArray[np.uint8]:
        """Return what was drawn, (height, width, 3), top row first."""
        picture = np.zeros((pixels[1], pixels[0], 3), dtype=np.uint8)
        if self._gl_scene is not None:
            mujoco.mjr_readPixels(picture, None, mujoco.MjrRect(0, 0, *pixels), self._gl_scene.context)
        return picture[::-1].copy()

    def draw_overlay(self, pixels: tuple[int, int], ratio: float) -> None:
        """Draw text and buttons over the picture."""
        if self._gl_scene is None or self._overlay is None:
            return
        if self._overlay.lines:
            text = "\n".join(self._overlay.lines)
            for _ in range(2):  # its background is half transparent; twice, white text can be read on white
                viewport = mujoco.MjrRect(0, 0, *pixels)
                mujoco.mjr_overlay(_FONT, _TOP_LEFT, viewport, text, "", self._gl_scene.context)
        for panel in self._overlay.panels:
            self._draw_panel(panel, pixels[1], ratio, self._gl_scene.context)

    def _draw_panel(self, panel: Panel, height: int, ratio: float, context: mujoco.MjrContext) -> None:
        x, y, width, rows = panel.rect
        left, top, right, bottom = (round(ratio * edge) for edge in (x, y, x + width, y + rows))
        viewport = mujoco.MjrRect(left, height - bottom, right - left, bottom - top)
        if panel.text:
            mujoco.mjr_label(viewport, _FONT, panel.text, *panel.rgba, 1, 1, 1, context)
        else:
            mujoco.mjr_rectangle(viewport, *panel.rgba)

    def close(self) -> None:
        """Free what OpenGL holds."""
        if self._gl_scene is not None:
            self._gl_scene.close()
            self._gl_scene = None


def _font_scale(ratio: float) -> int:
    """Return MuJoCo's scale of letters [percent], from 50 to 300."""
    return min(max(50 * round(2 * ratio), 50), 300)
