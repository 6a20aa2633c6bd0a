"""What collision checking knows of a world: which geom is whose, and which pairs of geoms each query is about."""

import os
from collections.abc import Callable, Generator, Hashable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.pairs import Detection, Masks, Pairs
from ravemj.engine.collision.rays import RayCaster
from ravemj.engine.collision.shapes import ShapeTests
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.world_model import WorldModel

if TYPE_CHECKING:
    from mujoco.batch import Batch

_Made = TypeVar("_Made")

MOST_PAIRS = 300_000
"""Pairs of geoms, and masks of bodies, that are kept for all queries together."""

MOST_AT_ONCE = 1000
"""Configurations that threads work on together, so that memory does not grow with their number."""

_WORTH_MASKS = 1.5
"""Setting masks pays where MuJoCo would look at so many times as many pairs without."""

_POSITIONS = 1  # mjSTAGE_POS: what follows from joint positions, contacts among it


class CollisionWorld:
    """The geoms of all bodies in the present model, and the pairs that were asked for before.

    ``Simulation.collisions`` returns it, up to date. Bodies may move in the meantime; whatever else changes makes a new
    one: ``stamp`` is the ``collision_stamp`` that it was made at.
    """

    def __init__(self, bodies: tuple[BodyState, ...], model: WorldModel, stamp: int) -> None:
        self.bodies, self.model, self.stamp = bodies, model, stamp
        self._model, self._data = model.model, model.data
        self.shapes = ShapeTests(model.model, model.data)
        self.detection = Detection(model, self.shapes)
        self._number = {body: number for number, body in enumerate(self.bodies)}
        self._pairs: dict[Hashable, Pairs] = {}
        self._kept: dict[Hashable, Any] = {}
        self._pair_count = 0
        self._find_owners(model.model)

    def _find_owners(self, model: mujoco.MjModel) -> None:
        """Find body and link of each geom; the arrays have a place for each MuJoCo body first."""
        owners, links = np.full(model.nbody, -1), np.zeros(model.nbody, dtype=int)
        enabled = np.zeros(model.nbody, dtype=bool)
        for number, body in enumerate(self.bodies):
            ids = self.model.part(body).body_ids
            owners[ids], links[ids], enabled[ids] = number, np.arange(len(ids)), body.link_enabled
        of_geom = model.geom_bodyid
        self._owner, self._link = owners[of_geom], links[of_geom]
        self._is_solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        self._collides = self._is_solid & enabled[of_geom]

    def group(self, body: BodyState) -> list[BodyState]:
        """Return a body and all that are connected to it by grabbing; it comes first."""
        return self.kept(("group", body), lambda: body.simulation.attached(body))

    def geoms_of_body(self, body: BodyState, *, enabled_only: bool = True) -> Ints:
        """Return the geoms of a body that collide, or would if all its links were enabled."""
        number = self._number.get(body, -2)
        among = self._collides if enabled_only else self._is_solid
        return np.flatnonzero(among & (self._owner == number))

    def geoms_of_link(self, body: BodyState, link: int, *, enabled_only: bool = True) -> Ints:
        """Return the geoms of a link that collide, or would if it were enabled."""
        geoms = self.geoms_of_body(body, enabled_only=enabled_only)
        return geoms[self._link[geoms] == link]

    def geoms_of_group(self, body: BodyState) -> Ints:
        """Return the geoms of a body and all that are connected to it by grabbing."""
        return self.kept(body, lambda: np.concatenate([self.geoms_of_body(one) for one in self.group(body)]))

    def geoms_of_others(self, body: BodyState) -> Ints:
        """Return the geoms of the bodies that are not connected to this one by grabbing."""
        numbers = [self._number[one] for one in self.group(body) if one in self._number]
        return np.flatnonzero(self._collides & ~np.isin(self._owner, numbers))

    def owner(self, geom: int) -> tuple[BodyState, int]:
        """Return the body and the index of the link that a geom belongs to."""
        return self.bodies[int(self._owner[geom])], int(self._link[geom])

    def geometry(self, geom: int) -> int:
        """Return which of its link's geometries a geom belongs to."""
        body, link = self.owner(geom)
        part = self.model.part(body)
        number = geom - int(self._model.body_geomadr[part.body_ids[link]])
        return int(np.searchsorted(np.cumsum(part.names.geoms[link]), number, side="right"))

    def labels(self, geoms: NDArray[np.int32]) -> Ints:
        """Return the indices of body and link of geoms (...), as (..., 2): 0 and -1 for the geom -1, which is none."""
        indices = np.array([*(body.index for body in self.bodies), 0])
        bodies, links = indices[self._owner[geoms]], self._link[geoms]
        nothing = geoms < 0
        return np.stack([np.where(nothing, 0, bodies), np.where(nothing, -1, links)], axis=-1)

    def kept(self, query: Hashable, make: Callable[[], _Made]) -> _Made:
        """Return what was made for a query before, or make it."""
        if query not in self._kept:
            self._kept[query] = make()
        return self._kept[query]

    def pairs(self, query: Hashable, find: Callable[[], tuple[Ints, Ints]]) -> Pairs:
        """Return the pairs that a query is about, which ``find`` finds where they are not known yet."""
        pairs = self._pairs.get(query)
        if pairs is None:
            first, second = find()
            size = len(first) + self._model.nbody  # which masks have
            self._pair_count += size
            if self._pair_count > MOST_PAIRS:
                self._pairs.clear()
                self._pair_count = size
            pairs = self._pairs[query] = Pairs(first, second, self.detection)
        return pairs

    def make_pairs(self, first: Ints, second: Ints) -> Pairs:
        """Return pairs of geoms for a query that is made once."""
        return Pairs(first, second, self.detection, once=True)

    def best_masks(self, first: Ints, second: Ints) -> tuple[Masks, bool]:
        """Return the masks with which MuJoCo finds pairs of geoms fastest.

        Returns:
            The masks, and whether MuJoCo looks at no other pairs with them and all geoms are convex. That is False as
            well if there are too many geoms to count their pairs.
        """
        masks = self.detection.masks(first, second)
        if self._model.ngeom**2 >= 2 * MOST_PAIRS:
            return masks, False
        pairs = np.triu_indices(self._model.ngeom, 1)
        everything, some = (int(self.detection.finds(*pairs, one).sum()) for one in (self.detection.all, masks))
        if everything < _WORTH_MASKS * some:
            masks, some = self.detection.all, everything
        return masks, some == len(first) and not self._has_concave

    @cached_property
    def _has_concave(self) -> bool:
        return any(map(self.shapes.is_concave, self._colliding.tolist()))

    def have_contacts(self, masks: Masks, qpos: Floats) -> NDArray[np.bool_]:
        """Return for each of ``MOST_AT_ONCE`` configurations at most, shape (n, nq), whether MuJoCo finds contacts."""
        if _processors() == 1:
            return self._have_contacts_one_by_one(masks, qpos)
        batch, count = self._batch, len(qpos)
        batch.bind("qpos")[:count] = qpos
        with self.detection.masked(masks):
            batch.forward(np.arange(count), stage=_POSITIONS)
        return batch.bind("ncon")[:count] > 0

    def _have_contacts_one_by_one(self, masks: Masks, qpos: Floats) -> NDArray[np.bool_]:
        """Do the same where there is one processor, on which a ``Batch`` takes longer, since it computes more."""
        model, data, target = self._model, self._data, self._data.qpos
        place, detect = mujoco.mj_kinematics, mujoco.mj_collision
        counts: list[int] = []
        with self.detection.masked(masks):
            for row in qpos:
                target[...] = row
                place(model, data)
                detect(model, data)
                counts.append(data.ncon)
        return np.array(counts) > 0

    @cached_property
    def _batch(self) -> "Batch":
        """Many states of the model, in which bodies without joints move, too, since it reads the model itself."""
        from mujoco.batch import Batch  # noqa: PLC0415 - slow to import

        batch = Batch(self._model, MOST_AT_ONCE)
        batch.set_models(self._model)
        batch.bind("ncon")
        return batch

    def collide(self, pairs: Pairs) -> bool:
        """Return whether any of the pairs touch or overlap."""
        near = pairs.near()
        return bool(near) and any(self.shapes.touch(*pairs.geoms(number)) for number in near)

    def hits(self, pairs: Pairs) -> Iterator[tuple[int, int]]:
        """Yield the pairs that touch or overlap."""
        return (geoms for geoms in map(pairs.geoms, pairs.near()) if self.shapes.touch(*geoms))

    def nearest(self, pairs: Pairs, limit: float) -> tuple[float, tuple[int, int] | None]:
        """Return the least signed distance of the pairs [m] and the pair, or the limit and None if none is nearer."""
        gaps, found = pairs.gaps(), None
        for number in np.argsort(gaps, kind="stable"):
            if gaps[number] >= limit:
                break
            pair = pairs.geoms(number)
            distance = self.shapes.distance(*pair, limit)
            if distance < limit:
                limit, found = distance, pair
        return limit, found

    def count_within(self, pairs: Pairs, tolerance: float) -> int:
        """Return how many of the pairs are nearer than a tolerance [m]."""
        near: list[int] = np.flatnonzero(pairs.gaps() <= tolerance).tolist()
        beyond = float(np.nextafter(tolerance, np.inf))
        measured = (self.shapes.distance(*pairs.geoms(number), beyond) for number in near)
        return sum(distance <= tolerance for distance in measured)

    @cached_property
    def rays(self) -> RayCaster:
        """Casts rays at what collides, or at other geoms."""
        return RayCaster(self._model, self._data, self._colliding)

    @cached_property
    def _colliding(self) -> Ints:
        return np.flatnonzero(self._collides)

    @block
    def moved(self, motions: Mapping[tuple[BodyState, int], Floats]) -> Generator[None]:
        """Put links elsewhere for the tests inside the ``with``, by motions in the world (4, 4); bodies stay."""
        positions, rotations = self._data.geom_xpos, self._data.geom_xmat
        with restoring(self._move_back):
            self.detection.is_overruled = True
            for (body, link), motion in motions.items():
                for geom in self.geoms_of_link(body, link, enabled_only=False):
                    positions[geom] = motion[:3, :3] @ positions[geom] + motion[:3, 3]
                    rotations[geom] = (motion[:3, :3] @ rotations[geom].reshape(3, 3)).ravel()
            yield

    def _move_back(self) -> None:
        self.detection.is_overruled = False
        mujoco.mj_kinematics(self._model, self._data)


def _processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def cross(first: Ints, second: Ints) -> tuple[Ints, Ints]:
    """Return all pairs of two sets of geoms."""
    return np.repeat(first, len(second)), np.tile(second, len(first))


def joined(pairs: Iterable[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    """Return the pairs of several sets of pairs, one after the other."""
    first, second = np.concatenate([np.zeros((2, 0), dtype=int), *map(np.array, pairs)], axis=1)
    return first, second
