"""The overlay of a view: drawings, texts and controls."""

from typing import NamedTuple

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.style import AS_IT_IS, Style
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.mode_buttons import Panel
from ravemj.gui.interaction.shortcuts import Section
from ravemj.gui.interaction.tree import TreeRow
from ravemj.gui.interaction.viewpoint import Viewpoint
from ravemj.model.drawing import Primitives


class Label(NamedTuple):
    """A text at a point in the world [m], shape (3,)."""

    point: Floats
    text: str


class Overlay(NamedTuple):
    """Everything that a window or page draws over the bodies.

    Attributes:
        primitives: Drawings in the world.
        lines: Lines of text in the top left corner.
        panels: Buttons, wheels and sliders, for windows; pages have controls of their own.
        controls: Buttons and sliders as plain data, except for mode buttons and wheels.
        labels: Texts in the world.
        help: Sections of the help while it is open.
        tree: Rows of the tree of bodies, links and joints while it is open.
        chosen: Names of the selected rows of the tree.
        style: Drawing style of the bodies.
        cursor: Shape of the pointer: ``default``, ``grab`` for a view that can be turned, ``pointer`` for a button or
            a clickable link, ``move`` for a handle, ``text`` for a text field.
        text_size: Height of the letters of the lines [points]; None: the default of the window or page.
    """

    primitives: Primitives
    lines: tuple[str, ...]
    panels: tuple[Panel, ...]
    controls: tuple[Control, ...] = ()
    labels: tuple[Label, ...] = ()
    help: tuple[Section, ...] = ()
    tree: tuple[TreeRow, ...] = ()
    chosen: tuple[str, ...] = ()
    style: Style = AS_IT_IS
    cursor: str = "default"
    text_size: float | None = None

    def labels_on(self, view: Viewpoint) -> list[tuple[float, float, str]]:
        """Return column, row [points] and text of the labels in front of the camera and inside the view."""
        if not self.labels:
            return []
        pixels, depths = view.camera.project([label.point for label in self.labels], *view.size)
        is_seen = (depths > 0) & (pixels >= 0).all(axis=1) & (pixels < view.size).all(axis=1)
        texts = zip(pixels.tolist(), is_seen.tolist(), self.labels, strict=True)
        return [(x, y, label.text) for (x, y), seen, label in texts if seen]
