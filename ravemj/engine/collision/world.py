"""Collision world: the body and link of each geom, and cached geom pairs of queries."""

from collections.abc import Callable, Generator, Hashable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.caching import cached_property
from ravemj.core.threads import batch_threads
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
"""Maximum number of cached pairs and masks."""

MOST_AT_ONCE = 1000
"""Maximum number of configurations per multithreaded call, which bounds memory."""

_WORTH_MASKS = 1.5
"""Minimum ratio of all pairs to those left by masks, from which masks save time."""

_POSITIONS = 1  # mjSTAGE_POS: results of joint positions, including contacts


class GeometryOf(NamedTuple):
    """Geometry by its body, link index and geometry index."""

    body: BodyState
    link: int
    geometry: int


class CollisionWorld:
    """Geoms of all bodies in the present model, and cached pairs of queries.

    ``Simulation.collisions`` returns it, up to date. It stays valid while bodies move; after any other change, which
    increases the simulation's ``collision_stamp`` above ``stamp``, a new one is required.
    """

    def __init__(self, bodies: tuple[BodyState, ...], model: WorldModel, stamp: int) -> None:
        self.bodies, self.model, self.stamp = bodies, model, stamp
        self._model, self._data = model.model, model.data
        self.shapes = ShapeTests(model.model, model.data)
        self.detection = Detection(model, self.shapes)
        self._number = {body: number for number, body in enumerate(self.bodies)}
        self._pairs: dict[Hashable, Pairs] = {}
        self.known_pairs = self._pairs.get  # of a query that was asked before, or None
        self._kept: dict[Hashable, Any] = {}
        self._geometries: dict[int, GeometryOf] = {}
        self._pair_count = 0
        self._find_owners(model.model)

    def _find_owners(self, model: mujoco.MjModel) -> None:
        """Find the body and link of each geom."""
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
        """Return a body, followed by all bodies connected to it by grabs."""
        return self.kept(("group", body), lambda: body.simulation.attached(body))

    def geoms_of_body(self, body: BodyState, *, enabled_only: bool = True) -> Ints:
        """Return the collision geoms of a body, optionally including disabled links."""
        number = self._number.get(body, -2)
        among = self._collides if enabled_only else self._is_solid
        return np.flatnonzero(among & (self._owner == number))

    def geoms_of_link(self, body: BodyState, link: int, *, enabled_only: bool = True) -> Ints:
        """Return the collision geoms of a link; none if it is disabled, unless ``enabled_only`` is False."""
        geoms = self.geoms_of_body(body, enabled_only=enabled_only)
        return geoms[self._link[geoms] == link]

    def geoms_of_group(self, body: BodyState) -> Ints:
        """Return the collision geoms of a body and all bodies connected to it by grabs."""
        return self.kept(body, lambda: np.concatenate([self.geoms_of_body(member) for member in self.group(body)]))

    def geoms_of_others(self, body: BodyState) -> Ints:
        """Return the collision geoms of the bodies not connected to a body by grabs."""
        numbers = [self._number[member] for member in self.group(body) if member in self._number]
        return np.flatnonzero(self._collides & ~np.isin(self._owner, numbers))

    def owner(self, geom: int) -> tuple[BodyState, int]:
        """Return the body and the index of the link that a geom belongs to."""
        return self.bodies[int(self._owner[geom])], int(self._link[geom])

    def geometry(self, geom: int) -> GeometryOf:
        """Return the geometry that a geom belongs to."""
        known = self._geometries.get(geom)
        if known is None:
            body, link = self.owner(geom)
            part = self.model.part(body)
            number = geom - int(self._model.body_geomadr[part.body_ids[link]])
            place = int(np.searchsorted(np.cumsum(part.names.geoms[link]), number, side="right"))
            known = self._geometries[geom] = GeometryOf(body, link, place)
        return known

    def labels(self, geoms: NDArray[np.int32]) -> Ints:
        """Return body and link indices of geoms, shape (..., 2); 0 and -1 if the geom is -1 (none)."""
        indices = np.array([*(body.index for body in self.bodies), 0])
        bodies, links = indices[self._owner[geoms]], self._link[geoms]
        nothing = geoms < 0
        return np.stack([np.where(nothing, 0, bodies), np.where(nothing, -1, links)], axis=-1)

    def kept(self, query: Hashable, make: Callable[[], _Made]) -> _Made:
        """Return the cached result for a query, or make it."""
        if query not in self._kept:
            self._kept[query] = make()
        return self._kept[query]

    def pairs(self, query: Hashable, find: Callable[[], tuple[Ints, Ints]]) -> Pairs:
        """Return the cached pairs of a query, computed by ``find`` on first use."""
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
        """Return geom pairs for a single query."""
        return Pairs(first, second, self.detection, once=True)

    def best_masks(self, first: Ints, second: Ints) -> tuple[Masks, bool]:
        """Return the fastest masks with which MuJoCo finds geom pairs.

        Returns:
            The masks, and whether they admit no other pairs and all geoms are convex; False also if there are too many
            geoms to count their pairs.
        """
        masks = self.detection.masks(first, second)
        if self._model.ngeom**2 >= 2 * MOST_PAIRS:
            return masks, False
        pairs = np.triu_indices(self._model.ngeom, 1)
        everything, some = (int(self.detection.finds(*pairs, tested).sum()) for tested in (self.detection.all, masks))
        if everything < _WORTH_MASKS * some:
            masks, some = self.detection.all, everything
        return masks, some == len(first) and not self._has_concave

    @cached_property
    def _has_concave(self) -> bool:
        return any(map(self.shapes.is_concave, self._colliding.tolist()))

    def have_contacts(self, masks: Masks, qpos: Floats) -> NDArray[np.bool_]:
        """Return for at most ``MOST_AT_ONCE`` configurations, shape (n, nq), whether MuJoCo finds contacts."""
        threads = batch_threads()
        if threads == 1:
            return self._have_contacts_one_by_one(masks, qpos)
        batch, count = self.kept(("batch", threads), lambda: self._batch(threads)), len(qpos)
        batch.bind("qpos")[:count] = qpos
        with self.detection.masked(masks):
            batch.forward(np.arange(count), stage=_POSITIONS)
        return batch.bind("ncon")[:count] > 0

    def _have_contacts_one_by_one(self, masks: Masks, qpos: Floats) -> NDArray[np.bool_]:
        """Compute ``have_contacts`` in one thread; a ``Batch`` would be slower, since it computes more."""
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

    def _batch(self, threads: int) -> "Batch":
        """Return states of the model for several threads; they share the model, and with it poses of fixed bodies."""
        from mujoco.batch import Batch  # noqa: PLC0415 - slow to import

        batch = Batch(self._model, MOST_AT_ONCE, threads)
        batch.set_models(self._model)
        batch.bind("ncon")
        return batch

    def collide(self, pairs: Pairs) -> bool:
        """Return whether any of the pairs touch or overlap."""
        near = pairs.near()
        return any(self.shapes.touch(*pairs.geoms(number)) for number in near) if near else False

    def hits(self, pairs: Pairs) -> Iterator[tuple[int, int]]:
        """Yield the pairs that touch or overlap."""
        return (geoms for geoms in map(pairs.geoms, pairs.near()) if self.shapes.touch(*geoms))

    def nearest(self, pairs: Pairs, limit: float) -> tuple[float, tuple[int, int] | None]:
        """Return the smallest signed distance of the pairs [m] and its pair; ``limit`` and None if none is nearer."""
        gaps, nearest = pairs.gaps(), None
        for number in np.argsort(gaps, kind="stable"):
            if gaps[number] >= limit:
                break
            pair = pairs.geoms(number)
            distance = self.shapes.distance(*pair, limit)
            if distance < limit:
                limit, nearest = distance, pair
        return limit, nearest

    def count_within(self, pairs: Pairs, tolerance: float) -> int:
        """Return the number of pairs closer than a tolerance [m]."""
        near: list[int] = np.flatnonzero(pairs.gaps() <= tolerance).tolist()
        beyond = float(np.nextafter(tolerance, np.inf))
        measured = (self.shapes.distance(*pairs.geoms(number), beyond) for number in near)
        return sum(distance <= tolerance for distance in measured)

    @cached_property
    def rays(self) -> RayCaster:
        """Ray caster against all colliding geoms by default."""
        return RayCaster(self._model, self._data, self._colliding)

    @cached_property
    def _colliding(self) -> Ints:
        return np.flatnonzero(self._collides)

    @block
    def moved(self, motions: Mapping[tuple[BodyState, int], Floats]) -> Generator[None]:
        """Context manager that displaces geoms of links by motions in the world (4, 4); the bodies do not move."""
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


def cross(first: Ints, second: Ints) -> tuple[Ints, Ints]:
    """Return all pairs between two sets of geoms."""
    return np.repeat(first, len(second)), np.tile(second, len(first))


def joined(pairs: Iterable[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    """Concatenate sets of pairs."""
    first, second = np.concatenate([np.zeros((2, 0), dtype=int), *map(np.array, pairs)], axis=1)
    return first, second
