"""Results of collision queries: colliding pairs, contact points, distances."""

from collections.abc import Callable
from typing import Literal, NamedTuple, Protocol

from ravemj.core.graphs import Pair
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.patches import patches
from ravemj.engine.collision.shapes import Contact
from ravemj.engine.collision.world import CollisionWorld, GeometryOf

Listed = Literal["first pair", "links", "geometries"]
"""Pairs to list: only the first pair of links, each pair of links, or each pair of geometries."""


class Collision(NamedTuple):
    """Colliding pair of geometries, or the first colliding pair of two links.

    ``contacts`` are the contact points of all geometry pairs, if requested.
    """

    first: GeometryOf
    second: GeometryOf
    contacts: list[Contact]


Counts = Callable[[Collision], bool]
"""Function that decides whether a collision is reported."""


class Wanted(NamedTuple):
    """Requested contents of a report."""

    listed: Listed = "first pair"  # which collisions
    contacts: bool = False  # their contact points; without them, the search for the first pair ends sooner
    distance: bool = False  # the least one
    tolerance: float | None = None  # the number of pairs that are no farther apart than this [m]


class Findings(NamedTuple):
    """Result of a collision query."""

    collisions: list[Collision]  # those not ignored
    distance: float  # the smallest one [m], not negative; the given limit if none is smaller
    nearest: Collision | None  # the nearest geometries, if any
    within: int  # number of pairs within the tolerance


class Checker(Protocol):
    """Collision queries with the options of an environment and its user callbacks.

    The caller holds the lock.
    """

    @property
    def is_plain(self) -> bool:
        """Whether the engine's default tests give the same results: no user callbacks, no geometry groups."""
        ...

    def world(self) -> CollisionWorld:
        """Return the collision world of the queries."""
        ...

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return whether any of the pairs collide."""
        ...

    def find(self, world: CollisionWorld, pairs: Pairs) -> Findings:
        """Return the requested contents of a report on the pairs."""
        ...


def find(world: CollisionWorld, pairs: Pairs, wanted: Wanted, distance: float, counts: Counts | None) -> Findings:
    """Return the requested contents of a report on geom pairs.

    Distances above ``distance`` [m] are skipped; ``counts`` may ignore collisions.
    """
    collisions, nearest = _collisions(world, pairs, wanted, counts), None
    if wanted.distance:
        distance, near = world.nearest(pairs, distance)
        distance = max(distance, 0.0)
        nearest = near and Collision(world.geometry(near[0]), world.geometry(near[1]), [])
    within = 0 if wanted.tolerance is None else world.count_within(pairs, wanted.tolerance)
    return Findings(collisions, distance, nearest, within)


def _collisions(world: CollisionWorld, pairs: Pairs, wanted: Wanted, counts: Counts | None) -> list[Collision]:
    listed = wanted.listed
    collisions: dict[object, tuple[Collision, list[Pair]]] = {}
    for pair in world.hits(pairs):
        first, second = world.geometry(pair[0]), world.geometry(pair[1])
        key = (first, second) if listed == "geometries" else (first[:2], second[:2])
        if key not in collisions:
            if collisions and listed == "first pair":
                break
            collision = Collision(first, second, [])
            if counts is not None and not counts(collision):
                continue
            collisions[key] = collision, []
        if wanted.contacts:
            collisions[key][1].append(pair)
        elif listed == "first pair":
            break
    touching = [(collision, pair) for collision, some in collisions.values() for pair in some]
    contacts = patches(world, [pair for _, pair in touching]) if touching else []
    for (collision, _), points in zip(touching, contacts, strict=True):
        collision.contacts.extend(points)
    return [collision for collision, _ in collisions.values()]
