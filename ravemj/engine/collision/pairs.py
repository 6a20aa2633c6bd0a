"""Pairs of geoms, and which of them are near each other."""

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.detection import Detection
from ravemj.engine.collision.shapes import TOUCHING

_BODIES_PER_PAIR = 64
"""So many bodies take MuJoCo's collision detection as long as one pair takes here: it looks at the masks of all."""

_ONES = np.ones(3)  # summing rows by a product with it is the fastest way for few of them
_NO_NUMBERS: list[int] = []


class Pairs:
    """Pairs of geoms that a query is about: the first geoms, shape (n,), and the second ones."""

    def __init__(self, first: Ints, second: Ints, detection: Detection, *, once: bool = False) -> None:
        """Take pairs; with ``once`` they are looked at only once, so that preparing them is not worth its time."""
        self.first, self.second = first, second
        self._detection = detection
        one_by_one = once or len(first) * _BODIES_PER_PAIR <= detection.body_count
        found = np.zeros(len(first), dtype=bool) if one_by_one else detection.finds(first, second)
        self._rest = np.flatnonzero(~found)
        numbers = np.flatnonzero(found).tolist()
        both = zip(first[found].tolist(), second[found].tolist(), strict=True)
        self._numbers = {_ordered(*pair): number for pair, number in zip(both, numbers, strict=True)}
        self._masks = detection.masks(first[found], second[found])
        self._spheres = _Spheres(first[self._rest], second[self._rest], detection)
        self._rest_is_welded = bool(detection.are_welded(first[self._rest], second[self._rest]).all())
        self._rest_stamp, self._rest_is_exact = -1, False
        self._rest_near = self._touching = _NO_NUMBERS
        self._stamp, self._are_too_many = -1, False
        self._found = b""  # the contacts, as MuJoCo has them

    def near(self) -> list[int]:
        """Return the numbers of the pairs that may touch, in order. The caller holds the lock."""
        detection = self._detection
        if detection.is_overruled:
            return self._all_spheres.near().tolist()
        if self._stamp != detection.model.stamp and self._numbers:
            self._detect()
        if self._are_too_many:
            return self._all_spheres.near().tolist()
        if not self._rest_is_welded or self._rest_stamp != detection.model.pose_stamp:
            self._rest_near, self._rest_is_exact = self._rest[self._spheres.near()].tolist(), False
            self._rest_stamp = detection.model.pose_stamp
        elif not self._rest_is_exact:  # what is asked again while joints move
            touch = detection.shapes.touch
            self._rest_near = [number for number in self._rest_near if touch(*self.geoms(number))]
            self._rest_is_exact = True
        return sorted(self._touching + self._rest_near) if self._rest_near else self._touching

    def _detect(self) -> None:
        """Find which of the pairs that MuJoCo looks at have hulls that touch."""
        geoms = self._detection.detect(self._masks)
        self._stamp, self._are_too_many = self._detection.model.stamp, geoms is None
        if geoms is None or not len(geoms):
            self._touching, self._found = _NO_NUMBERS, b""
            return
        found = geoms.tobytes()
        if found != self._found:
            numbers, touching = self._numbers, {_ordered(*pair) for pair in geoms.tolist()}
            self._found = found
            self._touching = sorted(numbers[pair] for pair in touching if pair in numbers)

    def geoms(self, number: int) -> tuple[int, int]:
        """Return both geoms of a pair."""
        return int(self.first[number]), int(self.second[number])

    @cached_property
    def _all_spheres(self) -> "_Spheres":
        return _Spheres(self.first, self.second, self._detection)

    def gaps(self) -> Floats:
        """Return how far apart the spheres of each pair are [m], negative where they overlap, shape (n,)."""
        positions, radii = self._detection.positions, self._detection.radii
        apart = np.linalg.norm(positions[self.first] - positions[self.second], axis=1)
        return apart - radii[self.first] - radii[self.second]


class _Spheres:
    """Spheres around pairs of geoms."""

    def __init__(self, first: Ints, second: Ints, detection: Detection) -> None:
        count = len(first)
        self._positions = detection.positions
        self._geoms = np.concatenate([first, second])
        reach = detection.radii[first] + detection.radii[second]
        self._square = (reach * (1 + 1e-9) + 2 * TOUCHING) ** 2
        # For what is computed each time: making new arrays takes longer than filling these.
        self._centers = np.empty((2 * count, 3))
        self._from, self._apart = self._centers[:count], self._centers[count:]
        self._distance = np.empty(count)

    def near(self) -> Ints:
        """Return the numbers of the pairs whose spheres touch, in order."""
        apart = self._apart
        self._positions.take(self._geoms, 0, self._centers, "clip")  # all are there; the default mode is slower
        apart -= self._from
        apart *= apart
        return (apart.dot(_ONES, self._distance) < self._square).nonzero()[0]


def _ordered(first: int, second: int) -> tuple[int, int]:
    return (first, second) if first < second else (second, first)
