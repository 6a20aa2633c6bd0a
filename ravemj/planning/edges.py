"""Tests of configurations and of the straight lines between them."""

from collections.abc import Callable
from functools import lru_cache
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.space import Space

STEP = 0.04
"""Default step of trees, a weighted distance: OpenRAVE's default step length."""

LINE = 1.0
"""Largest length of one line of a tree, a weighted distance."""

ROUNDING = 1e-9
"""Part of a step by which a line may be longer than a number of steps."""

Allowed = Callable[[Floats], bool]
"""Whether a configuration is without collisions, and keeps the user's constraints."""


class Growth(NamedTuple):
    """Result of growing a tree along a line.

    Attributes:
        points: The allowed configurations along the line, at most one step apart, without its start; shape (m, n).
        is_blocked: Whether the next step is not allowed.
        arrives: Whether the last point is the target.
    """

    points: Floats
    is_blocked: bool
    arrives: bool


class Edges:
    """Tests of straight lines in steps of the space's resolution.

    Args:
        space: The configuration space.
        allowed: The test of one configuration.
        step: Distance of neighbouring nodes of a tree, a weighted distance; 0 selects ``STEP``.
    """

    def __init__(self, space: Space, allowed: Allowed, step: float = STEP) -> None:
        self.space, self.allowed = space, allowed
        self.step = step if step > 0 else STEP

    def grow(self, start: Floats, target: Floats, *, longest: float = LINE, whole: bool = False) -> Growth:
        """Return the steps from an allowed configuration towards another one, up to the first that is blocked.

        Args:
            start: The configuration to start from, shape (n,).
            target: The configuration to grow towards, shape (n,).
            longest: Largest length of the line, a weighted distance.
            whole: Return no steps at all if one of them is blocked, which takes fewer tests.
        """
        way, arrives = self._shortened(start, target, longest)
        count = max(1, ceil(self._length(way) / self.step - ROUNDING))
        tests = self.space.steps(way / count)
        free = count
        for number in bisection_order(count * tests):
            if number <= free * tests and not self.allowed(start + number / (count * tests) * way):
                free = 0 if whole else (number - 1) // tests
        points = start + np.arange(1, free + 1)[:, None] / count * way
        return Growth(points, free < count, arrives and free == count)

    def _shortened(self, start: Floats, target: Floats, longest: float) -> tuple[Floats, bool]:
        """Return the difference from a start to a target, cut to a length, and whether it is not cut."""
        way = self.space.difference(target, start)
        far = self._length(way)
        return (way * (longest / far), False) if far > longest * (1 + ROUNDING) else (way, True)

    def _length(self, way: Floats) -> float:
        weighted = self.space.weights * way
        return sqrt(weighted.dot(weighted))

    def onto(self, configuration: Floats) -> Floats:
        """Return the configuration nearest to another one that keeps the constraint: the same, as there is none."""
        return configuration

    def line(self, start: Floats, step: Floats) -> bool:
        """Return whether the line from a configuration that is allowed is so everywhere, its end included.

        Lines in collision are mostly so in their middle: halves are tested before quarters.
        """
        allowed, steps = self.allowed, self.space.steps(step)
        return all(allowed(start + number / steps * step) for number in bisection_order(steps))


@lru_cache(maxsize=256)
def bisection_order(steps: int) -> tuple[int, ...]:
    """Return the order in which the steps of a line are tested, 1 to ``steps``: its end, middle, quarters, ..."""
    order, pending = [steps], [(0, steps)]
    for low, high in pending:
        middle = (low + high) // 2
        if low < middle:
            order.append(middle)
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
