"""What reports tell of a query: the pairs of links or geometries that collide, contact points, distances."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Literal, NamedTuple, Protocol

from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.shapes import Contact
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState

Listed = Literal["first pair", "links", "geometries"]
"""What is listed: only the first pair of links, each pair of links, or each pair of geometries."""


class GeometryOf(NamedTuple):
    """A geometry: its body, the index of its link in the body, and its own index in the link."""

    body: BodyState
    link: int
    geometry: int

    @classmethod
    def of(cls, world: CollisionWorld, geom: int) -> "GeometryOf":
        """Return the geometry that a geom of MuJoCo's belongs to."""
        return cls(*world.owner(geom), world.geometry(geom))


class Collision(NamedTuple):
    """Two geometries that touch or overlap, or the first two of two links.

    ``contacts`` are the contact points of all pairs of their geometries, where wanted.
    """

    first: GeometryOf
    second: GeometryOf
    contacts: list[Contact]


Counts = Callable[[Collision], bool]
"""Decides whether a collision counts."""


class Wanted(NamedTuple):
    """What a report should tell."""

    listed: Listed = "first pair"  # which collisions
    contacts: bool = False  # their contact points; without them, the search for the first pair ends sooner
    distance: bool = False  # the least one
    tolerance: float | None = None  # the number of pairs that are no farther apart than this [m]


class Findings(NamedTuple):
    """What was found of what is wanted."""

    collisions: list[Collision]  # those that count
    distance: float  # the least one [m], not negative, or the one that was given where none is less
    nearest: Collision | None  # the geometries that are so near, where there are any
    within: int  # number of pairs within the tolerance


class Checker(Protocol):
    """Collision queries with the options of an environment, and with the functions of users that decide what counts.

    The caller holds the lock.
    """

    @property
    def is_plain(self) -> bool:
        """Whether the engine's own tests answer as this does: no function of a user, no other geometries."""
        ...

    def world(self) -> AbstractContextManager[CollisionWorld]:
        """Return the world with the geometries that the queries are about."""
        ...

    def collides(self, world: CollisionWorld, pairs: Pairs) -> bool:
        """Return whether any of the pairs collide."""
        ...

    def find(self, world: CollisionWorld, pairs: Pairs) -> Findings:
        """Return what a report should tell of the pairs."""
        ...


def find(world: CollisionWorld, pairs: Pairs, wanted: Wanted, distance: float, counts: Counts | None) -> Findings:
    """Return what a report should tell of pairs of geoms.

    Distances greater than ``distance`` [m] are of no interest; without ``counts`` all collisions count.
    """
    collisions, nearest = _collisions(world, pairs, wanted, counts), None
    if wanted.distance:
        distance, near = world.nearest(pairs, distance)
        distance = max(distance, 0.0)
        nearest = near and Collision(GeometryOf.of(world, near[0]), GeometryOf.of(world, near[1]), [])
    within = 0 if wanted.tolerance is None else world.count_within(pairs, wanted.tolerance)
    return Findings(collisions, distance, nearest, within)


def _collisions(world: CollisionWorld, pairs: Pairs, wanted: Wanted, counts: Counts | None) -> list[Collision]:
    listed, contacts = wanted.listed, wanted.contacts
    found: dict[object, Collision] = {}
    for pair in world.hits(pairs):
        first, second = (GeometryOf.of(world, geom) for geom in pair)
        key = (first, second) if listed == "geometries" else (first[:2], second[:2])
        if key not in found:
            if found and listed == "first pair":
                break
            collision = Collision(first, second, [])
            if counts is not None and not counts(collision):
                continue
            found[key] = collision
        if contacts:
            found[key].contacts.append(world.shapes.contact(*pair))
        elif listed == "first pair":
            break
    return list(found.values())
