"""Camera navigation of one view: home, standard views, fitting, and smooth transitions."""

from dataclasses import dataclass, replace

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.simulation import Simulation
from ravemj.graphics.rendering import bounding_sphere
from ravemj.gui.interaction.viewpoint import Viewpoint

GLIDE = 0.2
"""Duration of a camera transition [s]."""

SIDES = {
    "front": (-1.0, 0.0, 0.0),
    "behind": (1.0, 0.0, 0.0),
    "left": (0.0, -1.0, 0.0),
    "right": (0.0, 1.0, 0.0),
    "above": (0.0, 0.0, -1.0),
    "below": (0.0, 0.0, 1.0),
}
"""Viewing directions of six views. Robots face along +x, so the front view looks along -x."""

Sphere = tuple[Floats, float]
"""Centre [m], shape (3,), and radius [m] of a sphere."""


@dataclass(frozen=True, eq=False)
class _Glide:
    start: Viewpoint
    begun: float | None = None
    part: float = 0.0


class Navigation:
    """The viewpoint of one view and its transitions. Its methods never wait for the simulation's lock."""

    def __init__(self, view: Viewpoint, simulation: Simulation) -> None:
        self._view = self._home = view
        self._simulation = simulation
        self._sphere: Sphere = np.zeros(3), 1.0
        self._glide: _Glide | None = None

    def another(self) -> "Navigation":
        """Return a copy for another view, with the same home view."""
        other = Navigation(self.view, self._simulation)
        other._home, other._sphere = self._home, self._sphere
        return other

    @property
    def appearance(self) -> object:
        """A key that changes when the viewpoint changes."""
        return self._view, self._glide

    def scene_sphere(self) -> Sphere:
        """Return the bounding sphere of the scene; the last known one while other threads hold the lock."""
        with self._simulation.lock.attempt(0) as is_free:
            if is_free:
                compiled = self._simulation.compiled()
                self._sphere = bounding_sphere(compiled.model, compiled.data)
        return self._sphere

    @property
    def view(self) -> Viewpoint:
        """The viewpoint; during a transition its final one."""
        return self._view

    @view.setter
    def view(self, view: Viewpoint) -> None:
        self._view, self._glide = view, None

    @property
    def drawn(self) -> Viewpoint:
        """The viewpoint to draw: during a transition the interpolated one."""
        glide = self._glide
        if glide is None:
            return self._view
        return replace(glide.start, size=self._view.size).interpolated(self._view, glide.part)

    def set_home(self) -> None:
        """Make the present viewpoint the home view."""
        self._home = self._view

    def advance(self, now: float) -> None:
        """Advance the transition; ``now`` is from ``time.monotonic``."""
        glide = self._glide
        if glide is None:
            return
        begun = now if glide.begun is None else glide.begun
        part = (now - begun) / GLIDE
        self._glide = replace(glide, begun=begun, part=part * part * (3 - 2 * part)) if part < 1 else None

    def _glide_to(self, view: Viewpoint) -> None:
        start = self.drawn
        self.view = view
        self._glide = _Glide(start)

    def focused(self) -> Viewpoint:
        """Return the viewpoint with a focus; by default at the depth of the scene's centre."""
        if self.view.distance > 0:
            return self.view
        center, radius = self.scene_sphere()
        depth = float((center - self.view.camera.position) @ self.view.camera.rotation[:, 2])
        return replace(self.view, distance=depth if depth > 0 else radius)

    def go(self, name: str) -> bool:
        """Move to ``home``, ``upright``, ``turntable`` or one of ``SIDES``; return False for other names."""
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
        """Start a transition to a viewpoint into which a sphere just fits, by default the scene's bounding sphere."""
        self._glide_to(self.view.fitted(*(sphere or self.scene_sphere())))
