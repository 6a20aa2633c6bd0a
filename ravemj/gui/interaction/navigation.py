"""The view of a window or a page, and the ways back from wherever the mouse has brought it."""

from dataclasses import dataclass, replace

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import Simulation
from ravemj.graphics.rendering import bounding_sphere
from ravemj.gui.interaction.viewpoint import View

GLIDE = 0.2
"""How long the view takes to get where a button or a key sends it [s]."""

SIDES = {
    "front": (-1.0, 0.0, 0.0),
    "behind": (1.0, 0.0, 0.0),
    "left": (0.0, -1.0, 0.0),
    "right": (0.0, 1.0, 0.0),
    "above": (0.0, 0.0, -1.0),
    "below": (0.0, 0.0, 1.0),
}
"""The viewing directions of six views. Robots look along +x, so the one from the front looks along -x."""

Sphere = tuple[Floats, float]
"""Centre, shape (3,), and radius of a sphere [m]."""


@dataclass(frozen=True, eq=False)
class _Glide:
    start: View
    begun: float | None = None
    part: float = 0.0


class Navigation:
    """Where a view is looked from. Nothing here waits for the bodies."""

    def __init__(self, view: View, simulation: Simulation) -> None:
        self._view = self._home = view
        self._simulation = simulation
        self._sphere: Sphere = np.zeros(3), 1.0
        self._glide: _Glide | None = None

    def another(self) -> "Navigation":
        """Return one that begins with this view, and has the same way home."""
        other = Navigation(self.view, self._simulation)
        other._home, other._sphere = self._home, self._sphere
        return other

    @property
    def appearance(self) -> object:
        """What is equal for as long as the view looks the same."""
        return self._view, self._glide

    def scene_sphere(self) -> Sphere:
        """Return a sphere around everything: as it was last, while others have the simulation."""
        with self._simulation.lock.attempt(0) as is_free:
            if is_free:
                compiled = self._simulation.compiled()
                self._sphere = bounding_sphere(compiled.model, compiled.data)
        return self._sphere

    @property
    def view(self) -> View:
        """The view; while it glides, that where it will come to rest."""
        return self._view

    @view.setter
    def view(self, view: View) -> None:
        self._view, self._glide = view, None

    @property
    def drawn(self) -> View:
        """The view to be drawn: on its way, while it glides."""
        glide = self._glide
        if glide is None:
            return self._view
        return replace(glide.start, size=self._view.size).on_the_way(self._view, glide.part)

    def set_home(self) -> None:
        """Come back to the present view from now on."""
        self._home = self._view

    def pass_time(self, now: float) -> None:
        """Let the view glide; ``now`` as ``time.monotonic`` says."""
        glide = self._glide
        if glide is None:
            return
        begun = now if glide.begun is None else glide.begun
        part = (now - begun) / GLIDE
        self._glide = replace(glide, begun=begun, part=part * part * (3 - 2 * part)) if part < 1 else None

    def _glide_to(self, view: View) -> None:
        start = self.drawn
        self.view = view
        self._glide = _Glide(start)

    def focused(self) -> View:
        """Return the view with a focus: before one was set, as deep as the middle of the scene."""
        if self.view.distance > 0:
            return self.view
        center, radius = self.scene_sphere()
        depth = float((center - self.view.camera.position) @ self.view.camera.rotation[:, 2])
        return replace(self.view, distance=depth if depth > 0 else radius)

    def go(self, name: str) -> bool:
        """Go ``home``, ``upright``, ``turntable`` or to one of ``SIDES``; return False for other names."""
        if name == "home":
            self._glide_to(replace(self._home, size=self.view.size, is_upright=self.view.is_upright))
        elif name == "upright":
            self._glide_to(self.focused().levelled())
        elif name == "turntable":
            view = replace(self.focused(), is_upright=not self.view.is_upright)
            self._glide_to(view.levelled() if view.is_upright else view)
        elif name in SIDES:
            self._glide_to(self.focused().along(SIDES[name]))
        else:
            return False
        return True

    def fit(self, sphere: Sphere | None = None) -> None:
        """Show a sphere as large as it fits into the view; None: everything."""
        self._glide_to(self.view.fitted(*(sphere or self.scene_sphere())))
