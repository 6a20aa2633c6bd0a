"""Pairs of geoms, and which of them are near each other."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.shapes import TOUCHING, ShapeTests
from ravemj.engine.simulation.world_model import WorldModel

FEW = 16
"""So few pairs are looked at one by one, since MuJoCo's collision detection looks at all geoms."""

_MARGIN = 1e-6  # m; MuJoCo's collision detection finds what is this near: more than exact tests call touching
_OVERRIDE = int(mujoco.mjtEnableBit.mjENBL_OVERRIDE)
_MOST_CONTACTS = 1 / 4096  # for each byte of MuJoCo's working memory, where a contact takes 600

_ONES = np.ones(3)  # summing rows by a product with it is the fastest way for few of them
_NO_NUMBERS: list[int] = []
_NO_KEYS: list[int] = []

Bools = NDArray[np.bool_]


def key(first: int, second: int, count: int) -> int:
    """Return a number for a pair of geoms, whichever of them comes first; ``count`` is the number of geoms."""
    return first * count + second if first < second else second * count + first


class Detection:
    """MuJoCo's collision detection, which runs once for each configuration of a world and finds hulls that touch.

    It leaves out the geoms of one weld group, between which the model has no joint, those of a group and the one that
    it hangs on, unless that is the world's, and what the model excludes.

    ``positions`` and ``radii`` are those of spheres around all geoms. ``is_overruled`` says that geoms are where their
    links are not, so that only spheres find what is near.
    """

    def __init__(self, model: WorldModel, shapes: ShapeTests) -> None:
        self.model, self.shapes = model, shapes
        self._model, self._data = model.model, model.data
        self.positions, self.radii = model.data.geom_xpos, model.model.geom_rbound
        self.is_overruled = False
        self._stamp = -1
        self._keys: list[int] = _NO_KEYS
        self._found: bytes = b""
        self._option = self._model.opt
        self._option.o_margin = _MARGIN  # only ``_OVERRIDE`` lets it count
        self._most = int(self._data.narena * _MOST_CONTACTS)
        self._bodies = self._model.geom_bodyid
        self._welds = self._model.body_weldid[self._bodies]
        self._masks = self._model.geom_contype, self._model.geom_conaffinity

    def are_welded(self, first: Ints, second: Ints) -> Bools:
        """Return for each pair of geoms whether no joint is between them."""
        return self._welds[first] == self._welds[second]

    def finds(self, first: Ints, second: Ints) -> Bools:
        """Return for each pair of geoms whether MuJoCo's collision detection would look at it."""
        weld_ids = self._model.body_weldid
        welds, others = weld_ids[self._bodies[first]], weld_ids[self._bodies[second]]
        carriers = weld_ids[self._model.body_parentid]
        hanging = (carriers[welds] == others) | (carriers[others] == welds)
        hanging &= (welds != 0) & (others != 0)
        types, affinities = self._masks
        masked = ((types[first] & affinities[second]) | (types[second] & affinities[first])) == 0
        bodies, other_bodies = self._bodies[first], self._bodies[second]
        signatures = (np.minimum(bodies, other_bodies) << 16) + np.maximum(bodies, other_bodies)
        excluded = np.isin(signatures, self._model.exclude_signature)
        return ~((welds == others) | hanging | masked | excluded)

    def keys(self) -> list[int] | None:
        """Return ``key`` of the pairs whose hulls touch now; None if they are too many for MuJoCo.

        The list is the same one as long as the pairs are the same.
        """
        if self._stamp != self.model.stamp:
            self._stamp = self.model.stamp
            self._detect()
        return self._keys if len(self._keys) < self._most else None

    def _detect(self) -> None:
        option, flags = self._option, self._option.enableflags
        option.enableflags = flags | _OVERRIDE
        mujoco.mj_collision(self._model, self._data)
        option.enableflags = flags
        if not self._data.ncon:
            self._keys, self._found = _NO_KEYS, b""
            return
        geoms = self._data.contact.geom
        found = geoms.tobytes()
        if found != self._found:
            touching: list[list[int]] = geoms.tolist()
            self._keys = [key(one, other, self._model.ngeom) for one, other in touching]
            self._found = found


class Pairs:
    """Pairs of geoms that a query is about: the first geoms, shape (n,), and the second ones."""

    def __init__(self, first: Ints, second: Ints, detection: Detection, *, once: bool = False) -> None:
        """Take pairs; with ``once`` they are looked at only once, so that preparing them is not worth its time."""
        self.first, self.second = first, second
        self._detection = detection
        found = np.zeros(len(first), dtype=bool) if once or len(first) <= FEW else detection.finds(first, second)
        self._rest = np.flatnonzero(~found)
        numbers = np.flatnonzero(found).tolist()
        count, both = len(detection.radii), zip(first[found].tolist(), second[found].tolist(), strict=True)
        self._numbers = {key(*pair, count): number for pair, number in zip(both, numbers, strict=True)}
        self._spheres = _Spheres(first[self._rest], second[self._rest], detection)
        self._rest_is_welded = bool(detection.are_welded(first[self._rest], second[self._rest]).all())
        self._rest_stamp, self._rest_is_exact = -1, False
        self._rest_near = self._touching = _NO_NUMBERS
        self._touching_keys = _NO_KEYS

    def near(self) -> list[int]:
        """Return the numbers of the pairs that may touch, in order. The caller holds the lock."""
        detection = self._detection
        keys = None if detection.is_overruled else detection.keys() if self._numbers else _NO_KEYS
        if keys is None:
            return self._all_spheres.near().tolist()
        if keys is not self._touching_keys:
            self._touching = sorted({self._numbers[key] for key in keys if key in self._numbers})
            self._touching_keys = keys
        if not self._rest_is_welded or self._rest_stamp != detection.model.pose_stamp:
            self._rest_near, self._rest_is_exact = self._rest[self._spheres.near()].tolist(), False
            self._rest_stamp = detection.model.pose_stamp
        elif not self._rest_is_exact:  # what is asked again while joints move
            touch = detection.shapes.touch
            self._rest_near = [number for number in self._rest_near if touch(*self.geoms(number))]
            self._rest_is_exact = True
        return sorted(self._touching + self._rest_near) if self._rest_near else self._touching

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
