"""Pulling a link with a force, while physics moves it."""

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.physics import Physics, Spring
from ravemj.gui.interaction.dragging import Follow, in_plane
from ravemj.gui.interaction.picking import Hit
from ravemj.gui.interaction.viewpoint import Ray
from ravemj.model import drawing
from ravemj.model.drawing import Primitives

_RGBA = np.array([0.9, 0.15, 0.4, 1.0])
_WIDTH = 3.0
_RADIUS = 0.008
"""Radius of the spheres at the ends, as a part of the distance from the eye."""


class Pulling:
    """Hangs a link on a spring whose other end the pointer has; ``end`` takes it away."""

    def __init__(self, physics: Physics, hit: Hit) -> None:
        """Take hold of a point of a link that physics moves."""
        T_world_link = hit.body.link_transform(hit.link)
        point = (hit.position - T_world_link[:3, 3]) @ T_world_link[:3, :3]
        self._spring = Spring(hit.body, hit.link, point, hit.position)
        self._radius = _RADIUS * hit.distance
        self._physics = physics
        physics.spring = self._spring

    def follow(self, normal: Floats) -> Follow:
        """Return what leads the spring in the plane with some normal, unit vector, shape (3,)."""
        spring, start = self._spring, self._spring.goal

        def follow(ray: Ray) -> None:
            goal = in_plane(ray, start, normal)
            if goal is not None:
                spring.goal = goal

        return follow

    def end(self) -> None:
        """Let go; the simulation need not be locked."""
        if self._physics.spring is self._spring:  # else another view pulls by now
            self._physics.spring = None

    def primitives(self) -> Primitives:
        """Return the figure of the spring."""
        ends = np.array([self._spring.place, self._spring.goal])
        line = drawing.line_list(ends, _WIDTH, np.tile(_RGBA, (2, 1)))
        return drawing.merge([line, drawing.spheres(ends, self._radius, np.tile(_RGBA, (2, 1)))])
