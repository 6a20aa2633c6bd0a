"""What is drawn over the bodies."""

from typing import NamedTuple

from ravemj.core.transforms import Floats
from ravemj.graphics.rendering.style import AS_IT_IS, Style
from ravemj.gui.interaction.control import Control
from ravemj.gui.interaction.mode_buttons import Panel
from ravemj.gui.interaction.shortcuts import Section
from ravemj.gui.interaction.tree import Node
from ravemj.gui.interaction.viewpoint import View
from ravemj.model.drawing import Primitives


class Label(NamedTuple):
    """A text at a point in the world [m], shape (3,)."""

    point: Floats
    text: str


class Overlay(NamedTuple):
    """What is drawn over the bodies.

    Attributes:
        primitives: Figures in the world.
        lines: Text for the top left corner.
        panels: Buttons, wheels and sliders, for a shell that has none of its own.
        controls: What the buttons and sliders beside the tutorial's are, as plain data.
        labels: Texts in the world.
        help: What can be done, while that is unfolded.
        tree: The bodies, links and joints, while they are unfolded.
        chosen: Names of what of the tree is selected.
        style: How the bodies are drawn.
        cursor: How the pointer looks: ``default``, ``grab`` for a view that can be turned, ``pointer`` for a button or
            something to click on, ``move`` for something to drag, ``text`` for something to type into.
        text_size: Height of the letters of the lines [points]; None: as the shell likes.
    """

    primitives: Primitives
    lines: tuple[str, ...]
    panels: tuple[Panel, ...]
    controls: tuple[Control, ...] = ()
    labels: tuple[Label, ...] = ()
    help: tuple[Section, ...] = ()
    tree: tuple[Node, ...] = ()
    chosen: tuple[str, ...] = ()
    style: Style = AS_IT_IS
    cursor: str = "default"
    text_size: float | None = None

    def labels_on(self, view: View) -> list[tuple[float, float, str]]:
        """Return column and row [points] and text of the labels that are before the eye and on a view."""
        if not self.labels:
            return []
        pixels, depths = view.camera.project([label.point for label in self.labels], *view.size)
        is_seen = (depths > 0) & (pixels >= 0).all(axis=1) & (pixels < view.size).all(axis=1)
        texts = zip(pixels.tolist(), is_seen.tolist(), self.labels, strict=True)
        return [(x, y, label.text) for (x, y), seen, label in texts if seen]
