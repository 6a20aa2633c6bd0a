"""Which configurations and straight lines between them are allowed."""

from collections.abc import Callable
from functools import lru_cache
from math import sqrt

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.space import Space

RANGE = 1.0
"""The largest length [rad or m] of one line of a tree."""

Allowed = Callable[[Floats], bool]
"""Whether a configuration is without collisions, and keeps the user's constraints."""


class Edges:
    """Tests straight lines in steps of the space's resolution; ``allowed`` tests one configuration."""

    def __init__(self, space: Space, allowed: Allowed) -> None:
        self.space, self.allowed = space, allowed

    def towards(self, start: Floats, target: Floats) -> tuple[Floats, bool]:
        """Return a step towards a configuration, no longer than a line of a tree, and whether it gets there."""
        step = self.space.difference(target, start)
        far = sqrt(step.dot(step))
        return (step * (RANGE / far), False) if far > RANGE else (step, True)

    def onto(self, configuration: Floats) -> Floats:
        """Return where lines that are meant for a configuration end: there, unless a constraint says otherwise."""
        return configuration

    def line(self, start: Floats, step: Floats) -> bool:
        """Return whether the line from a configuration that is allowed is so everywhere, its end included.

        Lines in collision are mostly so in their middle: halves are tested before quarters.
        """
        allowed = self.allowed
        return all(allowed(start + part * step) for part in bisection_order(self.space.steps(step)))


@lru_cache(maxsize=1024)
def bisection_order(steps: int) -> tuple[float, ...]:
    """Return the parts of the way at which a line of some steps is tested: its end, its middle, its quarters, ..."""
    order, pending = [1.0], [(0, steps)]
    for low, high in pending:
        middle = (low + high) // 2
        if low < middle:
            order.append(middle / steps)
            pending += [(low, middle), (middle, high)]
    return tuple(order)


def path_is_allowed(edges: Edges, points: Floats) -> bool:
    """Return whether a path of straight lines is allowed everywhere, shape (m, n)."""
    space = edges.space
    return edges.allowed(points[0]) and all(
        edges.line(points[index], space.difference(points[index + 1], points[index]))
        for index in range(len(points) - 1)
    )


def length(space: Space, points: Floats) -> float:
    """Return the length of a path of straight lines, in weighted distances."""
    return float(np.linalg.norm(space.weights * space.difference(points[1:], points[:-1]), axis=1).sum())


def nearby(
    space: Space, configuration: Floats, allowed: Allowed, tries: int, farthest: float, random: np.random.Generator
) -> Floats | None:
    """Return a configuration itself if it is allowed, else an allowed one near it, or None.

    Each value moves by ``farthest`` [rad or m] at most; the first of the tries stay nearer.
    """
    if allowed(configuration):
        return configuration
    for attempt in range(tries if farthest > 0 else 0):
        reach = farthest * (attempt + 1) / tries
        candidate = space.clamp(configuration + random.uniform(-reach, reach, len(configuration)))
        if allowed(candidate):
            return candidate
    return None
