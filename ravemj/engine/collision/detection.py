"""MuJoCo's collision detection of some pairs of bodies."""

from collections.abc import Generator
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.transforms import Ints
from ravemj.engine.collision.shapes import ShapeTests
from ravemj.engine.simulation.world_model import WorldModel

_MARGIN = 1e-6  # m; MuJoCo's collision detection finds what is this near: more than exact tests call touching
_OVERRIDE = int(mujoco.mjtEnableBit.mjENBL_OVERRIDE)
_MOST_CONTACTS = 1 / 4096  # for each byte of MuJoCo's working memory, where a contact takes 600

Bools = NDArray[np.bool_]
_Bits = NDArray[np.int32]
_NO_GEOMS = np.zeros((0, 2), dtype=np.int32)


class Masks(NamedTuple):
    """Values of MuJoCo's ``body_contype`` and ``body_conaffinity`` with which it looks only at some pairs of bodies."""

    types: _Bits
    affinities: _Bits


class Detection:
    """MuJoCo's collision detection, which finds hulls that touch.

    It leaves out the geoms of one weld group, between which the model has no joint, those of a group and the one that
    it hangs on, unless that is the world's, and what the model excludes.

    Attributes:
        positions: Centres of spheres around all geoms [m], shape (n, 3).
        radii: Their radii [m], shape (n,).
        all: The masks with which MuJoCo looks at all bodies.
        is_overruled: Whether geoms are where their links are not, so that only spheres find what is near.
    """

    def __init__(self, model: WorldModel, shapes: ShapeTests) -> None:
        self.model, self.shapes = model, shapes
        self._model, self._data = model.model, model.data
        self.positions, self.radii = model.data.geom_xpos, model.model.geom_rbound
        self.body_count = model.model.nbody
        self.is_overruled = False
        self._most = int(self._data.narena * _MOST_CONTACTS)
        self._option = self._model.opt
        self._option.o_margin = _MARGIN  # only ``_OVERRIDE`` lets it count
        self._bodies = self._model.geom_bodyid
        self._welds = self._model.body_weldid[self._bodies]
        self._geom_masks = self._model.geom_contype, self._model.geom_conaffinity
        self._types, self._affinities = self._model.body_contype, self._model.body_conaffinity
        self.all = Masks(self._types.copy(), self._affinities.copy())
        self._stamp, self._questions, self._is_shared = -1, 0, False
        self._found: NDArray[np.int32] | None = None

    def are_welded(self, first: Ints, second: Ints) -> Bools:
        """Return for each pair of geoms whether no joint is between them."""
        return self._welds[first] == self._welds[second]

    def finds(self, first: Ints, second: Ints, masks: Masks | None = None) -> Bools:
        """Return for each pair of geoms whether MuJoCo's collision detection looks at it; ``masks`` restrict it."""
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
        """Return masks for pairs of geoms, with which MuJoCo may look at more pairs of the same bodies than these."""
        types, affinities = np.zeros((2, self.body_count), dtype=np.int32)
        types[self._bodies[first]] = affinities[self._bodies[second]] = 1
        return Masks(types, affinities)

    def detect(self, masks: Masks) -> NDArray[np.int32] | None:
        """Look for hulls that touch or nearly touch now.

        If there was more than one question about the last configuration, all bodies are looked at, once for all
        questions about this one.

        Returns:
            Both geoms of each contact, shape (n, 2); None if they may be too many for MuJoCo's memory.
        """
        if self._stamp != self.model.stamp:
            self._stamp, self._is_shared, self._questions = self.model.stamp, self._questions > 1, 0
        self._questions += 1
        if self._is_shared:
            if self._questions > 1:
                return self._found
            masks = self.all
        option, flags = self._option, self._option.enableflags
        try:
            option.enableflags = flags | _OVERRIDE
            self.detect_overlaps(masks)
        finally:  # no signal is handled in it
            option.enableflags = flags
        count = self._data.ncon
        self._found = _NO_GEOMS if not count else self._data.contact.geom.copy() if count < self._most else None
        return self._found

    def detect_overlaps(self, masks: Masks) -> None:
        """Look for hulls that overlap now."""
        if masks is self.all:
            mujoco.mj_collision(self._model, self._data)
            return
        try:
            self._types[...], self._affinities[...] = masks
            mujoco.mj_collision(self._model, self._data)
        finally:  # no signal is handled in it
            self._types[...], self._affinities[...] = self.all

    @block
    def masked(self, masks: Masks) -> Generator[None]:
        """Have MuJoCo look only at the pairs of masks inside the ``with``."""
        with restoring(self._unmask):
            self._types[...], self._affinities[...] = masks
            yield

    def _unmask(self) -> None:
        self._types[...], self._affinities[...] = self.all


def _match(types: _Bits, affinities: _Bits, first: NDArray[np.integer], second: NDArray[np.integer]) -> Bools:
    """Return for each pair whether the masks let MuJoCo look at it."""
    return ((types[first] & affinities[second]) | (types[second] & affinities[first])) != 0
