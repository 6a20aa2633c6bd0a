"""Tests of configurations and of the straight lines between them."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import ceil, sqrt
from typing import NamedTuple, Protocol

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.certificates import Certificate
from ravemj.planning.curves import Curve, line_curve
from ravemj.planning.space import Space

STEP = 0.04
"""Default length of a step of a tree, a weighted distance, as in OpenRAVE."""

LINE = 1.0
"""Maximum length of an edge of a tree, a weighted distance."""

ROUNDING = 1e-9
"""Rounding tolerance of the length of a line, as a fraction of a step."""

Allowed = Callable[[Floats], bool]
"""Test of a configuration for collisions and user constraints."""


Proof = Callable[[Sequence[Curve]], bool]
"""Proof that a motion is free of collisions at all times."""


class Certifier(Protocol):
    """Proofs that motions are free of collisions at all times; see ``manipulation.certification``."""

    def proves(self, curves: Sequence[Curve]) -> bool:
        """Return whether a motion is proven free of collisions."""
        ...

    def certificate(self, curves: Sequence[Curve], *, whole: bool = True) -> Certificate:
        """Return the certificate of a motion; unless ``whole``, the proof ends at the first undecided span."""
        ...


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
        step: Length of a step of a tree, a weighted distance; 0 selects ``STEP``.
        proof: Additional test of lines that shorten a path, or None.
        certifier: Function that returns the certifier of motions, or None if there is none.
        clear: The test of one configuration on a line that shortens a path; None means ``allowed``.

    Attributes:
        is_strict: Whether the edges of trees have to pass ``proof``, too.
    """

    def __init__(
        self,
        space: Space,
        allowed: Allowed,
        step: float = STEP,
        proof: Proof | None = None,
        certifier: Callable[[], Certifier | None] = lambda: None,
        clear: Allowed | None = None,
    ) -> None:
        self.space, self.allowed, self.proof, self.certifier, self.clear = space, allowed, proof, certifier, clear
        self.step = step if step > 0 else STEP
        self.is_strict = False

    def grow(self, start: Floats, target: Floats, *, longest: float = LINE, whole: bool = False) -> Growth:
        """Return the steps from an allowed configuration towards another one, up to the first blocked step.

        Args:
            start: The configuration to start from, shape (n,).
            target: The configuration to grow towards, shape (n,).
            longest: Maximum length of the line, a weighted distance.
            whole: Whether to return no steps if one is blocked, which takes fewer tests.
        """
        way, arrives = self._shortened(start, target, longest)
        count = max(1, ceil(self._length(way) / self.step - ROUNDING))
        tests = self.space.steps(way / count)
        free = count
        for number in bisection_order(count * tests):
            if number <= free * tests and not self.allowed(start + number / (count * tests) * way):
                free = 0 if whole else (number - 1) // tests
        while free and self.is_strict and not self._is_proved(start, free / count * way):
            free = 0 if whole else free // 2
        points = start + np.arange(1, free + 1)[:, None] / count * way
        return Growth(points, free < count, arrives and free == count)

    def _shortened(self, start: Floats, target: Floats, longest: float) -> tuple[Floats, bool]:
        """Return the step towards the target, at most ``longest``, and whether it reaches the target."""
        way = self.space.difference(target, start)
        far = self._length(way)
        return (way * (longest / far), False) if far > longest * (1 + ROUNDING) else (way, True)

    def _length(self, way: Floats) -> float:
        weighted = self.space.weights * way
        return sqrt(weighted.dot(weighted))

    def onto(self, configuration: Floats) -> Floats:
        """Return the configuration unchanged; subclasses project it onto a constraint."""
        return configuration

    def line(self, start: Floats, step: Floats) -> bool:
        """Return whether the line from an allowed start to ``start + step`` is allowed everywhere.

        Halves are tested before quarters, since colliding lines mostly collide in the middle.
        """
        return self._passes(self.allowed, start, step) and (not self.is_strict or self._is_proved(start, step))

    def shortcut(self, start: Floats, step: Floats) -> bool:
        """Return whether a line passes the tests of shortcuts: ``clear`` or, without it, ``allowed``; and ``proof``."""
        return self._passes(self.clear or self.allowed, start, step) and self._is_proved(start, step)

    def _passes(self, test: Allowed, start: Floats, step: Floats) -> bool:
        steps = self.space.steps(step)
        return all(test(start + number / steps * step) for number in bisection_order(steps))

    def _is_proved(self, start: Floats, step: Floats) -> bool:
        return self.proof is None or self.proof([line_curve(start, step)])


@lru_cache(maxsize=256)
def bisection_order(steps: int) -> tuple[int, ...]:
    """Return the order in which steps 1 to ``steps`` of a line are tested: the end, the middle, quarters, ..."""
    order, pending = [steps], [(0, steps)]
    for low, high in pending:
        middle = (low + high) // 2
        if low < middle:
            order.append(middle)
            pending += [(low, middle), (middle, high)]
    return tuple(order)


def path_is_allowed(edges: Edges, points: Floats) -> bool:
    """Return whether a path of straight lines, shape (m, n), is allowed everywhere."""
    space = edges.space
    return edges.allowed(points[0]) and all(
        edges.line(points[index], space.difference(points[index + 1], points[index]))
        for index in range(len(points) - 1)
    )


def length(space: Space, points: Floats) -> float:
    """Return the weighted length of a path of straight lines."""
    return float(np.linalg.norm(space.weights * space.difference(points[1:], points[:-1]), axis=1).sum())


def nearby(
    space: Space,
    configuration: Floats,
    allowed: Allowed,
    tries: int,
    farthest: float,
    random: np.random.Generator,
    projected: Callable[[Floats], Floats] | None = None,
) -> Floats | None:
    """Return ``configuration`` if it is allowed, else an allowed random one nearby, or None after ``tries`` samples.

    Each value changes by at most ``farthest`` [rad or m]; the first tries stay closer. Candidates are then moved by
    ``projected``, if given.
    """
    if allowed(configuration):
        return configuration
    for attempt in range(tries if farthest > 0 else 0):
        reach = farthest * (attempt + 1) / tries
        candidate = space.clamp(configuration + random.uniform(-reach, reach, len(configuration)))
        if projected is not None:
            candidate = projected(candidate)
        if allowed(candidate):
            return candidate
    return None
