"""Candidate geom pairs of queries, a broad phase, and MuJoCo's collision detection."""

from collections.abc import Callable, Generator
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.shapes import TOUCHING, ShapeTests
from ravemj.engine.simulation.world_model import WorldModel

_BODIES_PER_PAIR = 64
"""Number of bodies for which MuJoCo's collision detection takes as long as one exact pair test."""

# Rows are summed fastest by a product with ``_ONES``, and taken fastest with ``mode="clip"``; all of them are there.
_ONES = np.ones(3)
_NO_NUMBERS: list[int] = []

_MARGIN = 1e-6  # m; MuJoCo's collision detection finds what is this near: more than exact tests call touching
_OVERRIDE = int(mujoco.mjtEnableBit.mjENBL_OVERRIDE)
_NO_TREES = int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
_FEW_GEOMS = 16  # of a body; for so many, trees of geoms take longer than a look at each pair
_MOST_CONTACTS = 1 / 4096  # for each byte of MuJoCo's working memory, where a contact takes 600

Bools = NDArray[np.bool_]
_Bits = NDArray[np.int32]
_NO_GEOMS = np.zeros((0, 2), dtype=np.int32)


class Masks(NamedTuple):
    """MuJoCo's ``body_contype`` and ``body_conaffinity``, restricting collision detection to some pairs of bodies."""

    types: _Bits
    affinities: _Bits


class Detection:
    """MuJoCo's collision detection, which finds contacts of convex hulls.

    It ignores excluded pairs, geoms of one weld group (without a joint between them), and geoms of a weld group and its
    parent group, unless the parent is the world.

    Attributes:
        positions: Centres of the bounding spheres of all geoms [m], shape (n, 3).
        radii: Radii of the spheres [m], shape (n,).
        all: The masks that admit all bodies.
        is_overruled: Whether geoms are displaced from their links, so that only bounding spheres are valid.
    """

    def __init__(self, model: WorldModel, shapes: ShapeTests) -> None:
        self.model, self.shapes = model, shapes
        self._model, self._data = model.model, model.data
        self.positions, self.radii = model.data.geom_xpos, model.model.geom_rbound
        self.body_count = model.model.nbody
        self.is_overruled = False
        self._most = int(self._data.narena * _MOST_CONTACTS)
        self._option = self._model.opt
        self._bodies = self._model.geom_bodyid
        self._welds = self._model.body_weldid[self._bodies]
        self._geom_masks = self._model.geom_contype, self._model.geom_conaffinity
        self._masks = Masks(self._model.body_contype, self._model.body_conaffinity)
        self.all = Masks(self._masks.types.copy(), self._masks.affinities.copy())
        self._queried = model.queried_model
        self._queried.opt.o_margin = _MARGIN
        self._queried.opt.enableflags |= _OVERRIDE
        # MuJoCo's trees of geoms give the same contacts, but take longer for few geoms.
        self._no_trees = _NO_TREES if self._model.body_geomnum.max() <= _FEW_GEOMS else 0
        self._queried.opt.disableflags |= self._no_trees
        # Memory views copy few numbers in half the time that arrays take.
        self._queried_masks = self._queried.body_contype.data, self._queried.body_conaffinity.data
        self._admitted: Masks | None = None  # the masks of ``_queried``, those of the last query
        self._stamp, self._found_stamp, self._questions, self._is_shared = -1, -1, 0, False
        self._found: NDArray[np.int32] | None = None
        self._contacts_stamp = -1

    @property
    def has_contacts(self) -> bool:
        """Whether ``data.contact`` are the contacts that ``detect`` last found in the present configuration."""
        return self._contacts_stamp == self.model.stamp and not self.is_overruled

    def are_welded(self, first: Ints, second: Ints) -> Bools:
        """Return for each pair of geoms whether there is no joint between them."""
        return self._welds[first] == self._welds[second]

    def finds(self, first: Ints, second: Ints, masks: Masks | None = None) -> Bools:
        """Return for each pair of geoms whether MuJoCo's collision detection tests it; ``masks`` restrict it."""
        weld_ids = self._model.body_weldid
        welds, others = weld_ids[self._bodies[first]], weld_ids[self._bodies[second]]
        carriers = weld_ids[self._model.body_parentid]
        hanging = (carriers[welds] == others) | (carriers[others] == welds)
        hanging &= (welds != 0) & (others != 0)
        bodies, other_bodies = self._bodies[first], self._bodies[second]
        seen = _match(*self._geom_masks, first, second)
        if masks is not None:
            seen &= _match(*masks, bodies, other_bodies)
        signatures = (np.minimum(bodies, other_bodies) << 16) + np.maximum(bodies, other_bodies)
        excluded = np.isin(signatures, self._model.exclude_signature)
        return ~((welds == others) | hanging | excluded) & seen

    def masks(self, first: Ints, second: Ints) -> Masks:
        """Return masks that admit the given pairs of geoms, and possibly further pairs of the same bodies."""
        types, affinities = np.zeros((2, self.body_count), dtype=np.int32)
        types[self._bodies[first]] = affinities[self._bodies[second]] = 1
        return Masks(types, affinities)

    def detect(self, masks: Masks) -> NDArray[np.int32] | None:
        """Detect hulls that touch or nearly touch at present.

        If the previous configuration had more than one query, all bodies are tested at the first query, and the other
        queries in this configuration use the result.

        Args:
            masks: The masks of the query.

        Returns:
            Both geoms of each contact, shape (n, 2); None if there may be too many for MuJoCo's memory.
        """
        if self._stamp != self.model.stamp:
            self._stamp, self._is_shared, self._questions = self.model.stamp, self._questions > 1, 0
        self._questions += 1
        if self._is_shared:
            if self._found_stamp == self._stamp:
                return self._found
            masks = self.all
        if masks is not self._admitted:
            self._admit(masks)
        mujoco.mj_collision(self._queried, self._data)
        count = self._data.ncon
        self._found = _NO_GEOMS if not count else self._data.contact.geom.copy() if count < self._most else None
        self._contacts_stamp = -1 if self._found is None else self._stamp
        self._found_stamp = self._stamp if self._is_shared else -1  # last, as an interrupt may have come before
        return self._found

    def _admit(self, masks: Masks) -> None:
        self._admitted = None  # first, as an interrupt may come between
        types, affinities = self._queried_masks
        types[:], affinities[:] = masks.types.data, masks.affinities.data
        self._admitted = masks

    def detect_near(self, look: Callable[[], None], margin: float = _MARGIN) -> None:
        """Run the detection ``look``, a result of ``overlaps``, also for hulls within ``margin`` [m] of each other."""
        option, flags = self._option, self._option.enableflags
        try:
            option.o_margin, option.enableflags = margin, flags | _OVERRIDE  # without the flag, no margin counts
            look()
        finally:  # no signal is handled in it
            option.enableflags = flags

    def overlaps(self, masks: Masks) -> Callable[[], None]:
        """Return a function that runs MuJoCo's detection of overlapping hulls with the given masks."""
        self._contacts_stamp = -1  # here, since the function is called in hot loops, between two stamps
        model, data, detect = self._model, self._data, mujoco.mj_collision
        if masks is self.all:
            return partial(detect, model, data)
        types, affinities = self._masks.types.data, self._masks.affinities.data
        some_types, some_affinities = masks.types.data, masks.affinities.data
        all_types, all_affinities = self.all.types.data, self.all.affinities.data

        def look() -> None:
            try:
                types[:], affinities[:] = some_types, some_affinities
                detect(model, data)
            finally:  # no signal is handled in it
                types[:], affinities[:] = all_types, all_affinities

        return look

    @block
    def masked(self, masks: Masks) -> Generator[None]:
        """Context manager that restricts MuJoCo to the masks' pairs."""
        self._contacts_stamp, flags = -1, self._option.disableflags
        with restoring(lambda: self._mask(self.all, flags)):
            self._mask(masks, flags | self._no_trees)
            yield

    def _mask(self, masks: Masks, flags: int) -> None:
        self._masks.types[...], self._masks.affinities[...] = masks
        self._option.disableflags = flags


class Pairs:
    """Candidate geom pairs of a query: two arrays of geom indices, shape (n,)."""

    def __init__(self, first: Ints, second: Ints, detection: Detection, *, once: bool = False) -> None:
        """Store pairs; ``once`` skips preparations for repeated use."""
        self.first, self.second = first, second
        self._detection, self._model = detection, detection.model
        one_by_one = once or len(first) * _BODIES_PER_PAIR <= detection.body_count
        is_detected = np.zeros(len(first), dtype=bool) if one_by_one else detection.finds(first, second)
        self._rest = np.flatnonzero(~is_detected)
        numbers = np.flatnonzero(is_detected).tolist()
        both = zip(first[is_detected].tolist(), second[is_detected].tolist(), strict=True)
        self._numbers = {_ordered(*pair): number for pair, number in zip(both, numbers, strict=True)}
        self._masks = detection.masks(first[is_detected], second[is_detected])
        self._spheres = _Spheres(first[self._rest], second[self._rest], detection)
        self._rest_is_welded = bool(detection.are_welded(first[self._rest], second[self._rest]).all())
        self._rest_stamp, self._rest_is_exact = -1, False
        self._rest_near = self._touching = _NO_NUMBERS
        self._stamp, self._are_too_many = -1, False
        self._found = b""  # the contacts, as MuJoCo has them

    def near(self) -> list[int]:
        """Return the indices of the pairs that may touch, in ascending order. The caller holds the lock."""
        detection, model = self._detection, self._model
        if detection.is_overruled:
            return self._all_spheres.near().tolist()
        if self._stamp != model.stamp and self._numbers:
            self._detect()
        if self._are_too_many:
            return self._all_spheres.near().tolist()
        if not self._rest_is_welded or self._rest_stamp != model.pose_stamp:
            self._rest_near, self._rest_is_exact = self._rest[self._spheres.near()].tolist(), False
            self._rest_stamp = model.pose_stamp
        elif not self._rest_is_exact:  # what is asked again while joints move
            touch = detection.shapes.touch
            self._rest_near = [number for number in self._rest_near if touch(*self.geoms(number))]
            self._rest_is_exact = True
        return sorted(self._touching + self._rest_near) if self._rest_near else self._touching

    def _detect(self) -> None:
        """Find the pairs with overlapping hulls, among those that MuJoCo can test."""
        geoms = self._detection.detect(self._masks)
        chosen = b"" if geoms is None or geoms is _NO_GEOMS else geoms.tobytes()
        if geoms is not None and chosen != self._found:
            numbers, touching = self._numbers, {_ordered(*pair) for pair in geoms.tolist()}
            self._touching = sorted(numbers[pair] for pair in touching if pair in numbers)
            self._found = chosen
        self._are_too_many = geoms is None
        self._stamp = self._model.stamp  # last, as an interrupt may have come before

    def geoms(self, number: int) -> tuple[int, int]:
        """Return both geoms of a pair."""
        return int(self.first[number]), int(self.second[number])

    @cached_property
    def _all_spheres(self) -> "_Spheres":
        return _Spheres(self.first, self.second, self._detection)

    def gaps(self) -> Floats:
        """Return the gaps between the bounding spheres of each pair [m], negative if they overlap, shape (n,)."""
        positions, radii = self._detection.positions, self._detection.radii
        apart = positions.take(self.first, 0, mode="clip") - positions.take(self.second, 0, mode="clip")
        apart *= apart
        return np.sqrt(apart.dot(_ONES)) - radii[self.first] - radii[self.second]


class _Spheres:
    """Bounding spheres of geom pairs."""

    def __init__(self, first: Ints, second: Ints, detection: Detection) -> None:
        count = len(first)
        self._positions = detection.positions
        self._geoms = np.concatenate([first, second])
        reach = detection.radii[first] + detection.radii[second]
        self._square = (reach * (1 + 1e-9) + 2 * TOUCHING) ** 2
        # Buffers of repeated computations: allocating arrays takes longer than filling these.
        self._centers = np.empty((2 * count, 3))
        self._from, self._apart = self._centers[:count], self._centers[count:]
        self._distance = np.empty(count)

    def near(self) -> Ints:
        """Return the indices of the pairs whose spheres touch, in ascending order."""
        apart = self._apart
        self._positions.take(self._geoms, 0, self._centers, "clip")
        apart -= self._from
        apart *= apart
        return (apart.dot(_ONES, self._distance) < self._square).nonzero()[0]


def _ordered(first: int, second: int) -> tuple[int, int]:
    return (first, second) if first < second else (second, first)


def _match(types: _Bits, affinities: _Bits, first: NDArray[np.integer], second: NDArray[np.integer]) -> Bools:
    """Return for each pair of geoms whether MuJoCo's contact types and affinities allow a contact."""
    return ((types[first] & affinities[second]) | (types[second] & affinities[first])) != 0
