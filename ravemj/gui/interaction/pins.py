"""Pinned links, and their drawings."""

from weakref import WeakKeyDictionary

import numpy as np

from ravemj.engine.simulation import BodyState, Simulation
from ravemj.gui.interaction.picking import visible_box
from ravemj.model import drawing
from ravemj.model.drawing import NOTHING, Primitives

_RGBA = np.array([0.85, 0.1, 0.1, 1.0])
_WIDTH = 3.0
_HEAD, _STALK = 0.25, np.array([1.2, 0.0, 1.2])
"""Radius of a pin's head and its offset from the link's centre [half diagonals of the link]."""


class Pins:
    """The pinned links of all bodies: links that keep their poses while other links are dragged."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._links: WeakKeyDictionary[BodyState, set[int]] = WeakKeyDictionary()

    def toggle(self, body: BodyState, link: int) -> None:
        """Pin a link, or unpin it."""
        self._links.setdefault(body, set()).symmetric_difference_update({link})

    def of_body(self, body: BodyState) -> list[int]:
        """Return the indices of the pinned links of a body."""
        return sorted(self._links.get(body, ()))

    def primitives(self) -> Primitives:
        """Return a pin above each pinned link."""
        figures = [
            figure
            for body in self._links
            if self._simulation.holds(body)
            for link in self.of_body(body)
            if (figure := _pin(body, link)) is not None
        ]
        return drawing.merge(figures) if figures else NOTHING


def _pin(body: BodyState, link: int) -> Primitives | None:
    box = visible_box(body, [link], np.eye(4))
    if box is None:
        return None
    size = float(np.linalg.norm(box.half))
    ends = box.center + np.outer([0.0, size], _STALK)
    line = drawing.line_list(ends, _WIDTH, np.tile(_RGBA, (2, 1)))
    return drawing.merge([line, drawing.spheres(ends[1:], _HEAD * size, _RGBA[None])])
