"""Edges on a constraint: intermediate configurations are projected onto it.

After D. Berenson, S. Srinivasa, D. Ferguson and J. Kuffner, "Manipulation planning on constraint manifolds", ICRA 2009.
"""

from collections import deque
from collections.abc import Callable
from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.curves import path_curves
from ravemj.planning.edges import LINE, ROUNDING, STEP, Allowed, Edges, Growth, Proof
from ravemj.planning.projection import PROJECTION_STEPS, Error, project
from ravemj.planning.space import Space

_PROJECTED = 0.1
"""Error norm at which a projection onto the constraint stops, as a fraction of the constraint's threshold."""

_INSIDE = 0.5
"""Error norm above which a configuration is projected onto the constraint, as a fraction of its threshold."""

_DETOUR = 0.8
"""Maximum length of each half of a projected edge, relative to the edge; a longer half is a jump on the constraint."""

_SHORTEST = 1e-3
"""Length of a part of an edge, relative to the edge, below which the part is not halved and the edge is rejected."""


class Manifold(NamedTuple):
    """Constraint manifold.

    Attributes:
        error: The error function, which is zero on the manifold.
        threshold: The tolerance of the error norm.
        norm: Returns the error norm of a configuration faster than ``error``; None if there is no faster function.
    """

    error: Error
    threshold: float
    norm: Callable[[Floats], float] | None = None

    def off(self, values: Floats) -> float:
        """Return the error norm of a configuration."""
        return float(np.linalg.norm(self.error(values)[0])) if self.norm is None else self.norm(values)

    def has(self, values: Floats) -> bool:
        """Return whether a configuration is on the manifold."""
        return self.off(values) <= self.threshold


class ConstrainedEdges(Edges):
    """Tests of edges on a constraint manifold; ``allowed`` need not test the constraint."""

    def __init__(
        self, space: Space, allowed: Allowed, manifold: Manifold, step: float = STEP, proof: Proof | None = None
    ) -> None:
        super().__init__(space, allowed, step, proof)
        self._manifold = manifold

    def grow(self, start: Floats, target: Floats, *, longest: float = LINE, whole: bool = False) -> Growth:
        """Grow along the constraint towards a target, like ``Edges.grow``, while steps are allowed and come closer."""
        points, here, arrives = [start], start, False
        for _ in range(ceil(longest / self.step - ROUNDING)):
            end, arrives = self._towards(here, target)
            if not (self._far(end, target) < self._far(here, target) and self.line(here, end - here)):
                return Growth(np.array([] if whole else points[1:]).reshape(-1, len(start)), True, False)
            here = end
            points.append(here)
            if arrives:
                break
        return Growth(np.array(points[1:]), False, arrives)

    def _towards(self, start: Floats, target: Floats) -> tuple[Floats, bool]:
        """Return the configuration one step closer to a target, on the constraint, and whether it is the target."""
        way, arrives = self._shortened(start, target, self.step)
        if arrives and self._manifold.has(start + way):
            return start + way, True
        return self.onto(start + way), False

    def onto(self, configuration: Floats) -> Floats:
        """Project a configuration to an error well below the threshold; if that fails, return it unchanged."""
        if self._manifold.off(configuration) <= _INSIDE * self._manifold.threshold:
            return configuration
        smallest = _PROJECTED * self._manifold.threshold
        steps, projected = project(configuration, self._manifold.error, self.space, smallest, PROJECTION_STEPS)
        return configuration if steps < 0 else projected

    def line(self, start: Floats, step: Floats) -> bool:
        """Return whether the projected edge from an allowed start to ``start + step`` is allowed everywhere."""
        return self._bent_line(start, step, proved=self.is_strict)

    def shortcut(self, start: Floats, step: Floats) -> bool:
        """Return whether a projected edge is allowed and passes the proof required of shortcuts."""
        return self._bent_line(start, step, proved=True)

    def _bent_line(self, start: Floats, step: Floats, *, proved: bool) -> bool:
        points = self.bent(start, start + step)
        if points is None or not proved or self.proof is None:
            return points is not None
        return self.proof(path_curves(points, self.space.difference))

    def bent(self, start: Floats, end: Floats) -> Floats | None:
        """Return the configurations along a projected edge, shape (m, n); None if one of them is not allowed.

        They are so close that straight lines between them keep the constraint. ``start`` must be allowed.
        """
        if not (self._manifold.has(end) and self.allowed(end)):
            return None
        points, pending = {0.0: start, 1.0: end}, deque([(0.0, 1.0)])
        while pending:
            low, high = pending.popleft()
            if self._is_straight(points[low], points[high]):
                continue
            middle = self._middle(points[low], points[high])
            if middle is None or high - low < _SHORTEST or not self.allowed(middle):
                return None
            between = (low + high) / 2
            points[between] = middle
            pending += [(low, between), (between, high)]
        return np.array([points[part] for part in sorted(points)])

    def _is_straight(self, start: Floats, end: Floats) -> bool:
        """Return whether a line is so short that edge tests make a single step, and its middle keeps the constraint."""
        step = self.space.difference(end, start)
        most = max(_INSIDE * self._manifold.threshold, self._manifold.off(start), self._manifold.off(end))
        return self.space.steps(step) == 1 and self._manifold.off(start + step / 2) <= most

    def _middle(self, start: Floats, end: Floats) -> Floats | None:
        """Return the middle of an edge, projected onto the constraint; None if that fails or leads far away."""
        step = self.space.difference(end, start)
        middle = self.onto(start + step / 2)
        farther = max(self._far(start, middle), self._far(middle, end))
        is_between = farther <= _DETOUR * float(np.linalg.norm(step))
        return middle if is_between and self._manifold.has(middle) else None

    def _far(self, start: Floats, end: Floats) -> float:
        return float(np.linalg.norm(self.space.difference(end, start)))


def bent_path(edges: ConstrainedEdges, points: Floats) -> Floats | None:
    """Return the configurations along a path of projected edges, shape (m, n); None if one is not allowed."""
    bent = [edges.bent(start, end) for start, end in pairwise(points)]
    rows = [rows_of_edge[1:] for rows_of_edge in bent if rows_of_edge is not None]
    return np.concatenate([points[:1], *rows]) if len(rows) == len(bent) else None
