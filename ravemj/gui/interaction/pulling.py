"""Pulling a simulated link with a force."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.physics import Physics, Spring
from ravemj.gui.interaction.dragging import Follow, in_plane
from ravemj.gui.interaction.picking import Hit
from ravemj.gui.interaction.viewpoint import ViewRay
from ravemj.model import drawing
from ravemj.model.drawing import Primitives

_RGBA = np.array([0.9, 0.15, 0.4, 1.0])
_WIDTH = 3.0
_RADIUS = 0.008
"""Radius of the spheres at the ends of the spring, as a fraction of the distance to the camera."""


class Pulling:
    """A virtual spring between a link and the pointer; ``end`` removes it."""

    def __init__(self, physics: Physics, hit: Hit) -> None:
        """Attach the spring to a point of a simulated link."""
        T_world_link = hit.body.link_transform(hit.link)
        point = (hit.position - T_world_link[:3, 3]) @ T_world_link[:3, :3]
        self._spring = Spring(hit.body, hit.link, point, hit.position)
        self._radius = _RADIUS * hit.distance
        self._physics = physics
        physics.spring = self._spring

    def follow(self, normal: Floats) -> Follow:
        """Return the drag callback that moves the spring's end in the plane with ``normal``, a unit vector (3,)."""
        spring, start = self._spring, self._spring.goal

        def follow(ray: ViewRay) -> None:
            goal = in_plane(ray, start, normal)
            if goal is not None:
                spring.goal = goal

        return follow

    def end(self) -> None:
        """Remove the spring. Needs no simulation lock."""
        if self._physics.spring is self._spring:  # else another view has replaced the spring
            self._physics.spring = None

    def primitives(self) -> Primitives:
        """Return the drawing of the spring."""
        ends = np.array([self._spring.place, self._spring.goal])
        line = drawing.line_list(ends, _WIDTH, np.tile(_RGBA, (2, 1)))
        return drawing.merge([line, drawing.spheres(ends, self._radius, np.tile(_RGBA, (2, 1)))])
