"""The view of a window or a page, and the ways back from wherever the mouse has brought it."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from ravemj.core.transforms import Floats
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
    """Where a view is looked from. Nothing here needs the bodies, but for the spheres around them.

    Attributes:
        changes: How often what is seen may have changed.
    """

    def __init__(self, view: View, scene: Callable[[], Sphere]) -> None:
        """Begin.

        Args:
            view: The first view.
            scene: Returns a sphere around everything.
        """
        self._view = self._home = view
        self._scene = scene
        self._glide: _Glide | None = None
        self.changes = 0

    def another(self, scene: Callable[[], Sphere]) -> "Navigation":
        """Return one that begins with this view, and has the same way home; argument as for the first one."""
        other = Navigation(self.view, scene)
        other._home = self._home
        return other

    @property
    def view(self) -> View:
        """The view; while it glides, that where it will come to rest."""
        return self._view

    @view.setter
    def view(self, view: View) -> None:
        self._view, self._glide = view, None
        self.changes += 1

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
        """Let the view glide.

        Args:
            now: What ``time.monotonic`` says.
        """
        glide = self._glide
        if glide is None:
            return
        begun = now if glide.begun is None else glide.begun
        part = (now - begun) / GLIDE
        self._glide = replace(glide, begun=begun, part=part * part * (3 - 2 * part)) if part < 1 else None
        self.changes += 1

    def _glide_to(self, view: View) -> None:
        start = self.drawn
        self.view = view
        self._glide = _Glide(start)

    def focused(self) -> View:
        """Return the view with a focus: before one was set, as deep as the middle of the scene."""
        if self.view.distance > 0:
            return self.view
        center, radius = self._scene()
        depth = float((center - self.view.camera.position) @ self.view.camera.rotation[:, 2])
        return replace(self.view, distance=depth if depth > 0 else radius)

    def go(self, name: str) -> bool:
        """Do what a button or a key asks for; return False where there is no such way.

        Args:
            name: ``home``, ``upright``, ``turntable`` or one of ``SIDES``.
        """
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
        self._glide_to(self.view.fitted(*(sphere or self._scene())))
