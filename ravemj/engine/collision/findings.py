"""Collisions as reports list them: one for each pair of links or of geometries, with its contact points."""

from collections.abc import Callable
from typing import Literal, NamedTuple

from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.shapes import Contact
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState

Listed = Literal["first pair", "links", "geometries"]
"""What is listed: only the first pair of links, each pair of links, or each pair of geometries."""


class GeometryOf(NamedTuple):
    """A geometry, by its place.

    Attributes:
        body: The body.
        link: Index of the link in the body.
        geometry: Index of the geometry in the link.
    """

    body: BodyState
    link: int
    geometry: int

    @classmethod
    def of(cls, world: CollisionWorld, geom: int) -> "GeometryOf":
        """Return the geometry that a geom of MuJoCo's belongs to."""
        return cls(*world.owner(geom), world.geometry(geom))


class Collision(NamedTuple):
    """Two links or geometries that touch or overlap.

    Attributes:
        first: A geometry of the first one.
        second: The geometry of the second one that it touches.
        contacts: The contact points of all pairs of their geometries, where wanted.
    """

    first: GeometryOf
    second: GeometryOf
    contacts: list[Contact]


def find_collisions(
    world: CollisionWorld,
    pairs: Pairs,
    listed: Listed,
    contacts: bool = False,
    counts: Callable[[GeometryOf, GeometryOf], bool] | None = None,
) -> list[Collision]:
    """Return the collisions of pairs of geoms.

    Args:
        world: Where the geoms are.
        pairs: The pairs.
        listed: What is listed.
        contacts: Whether contact points are wanted; without them, the search for the first pair ends sooner.
        counts: Decides whether a collision counts; None: all do.
    """
    found: dict[object, Collision] = {}
    for pair in world.hits(pairs):
        first, second = (GeometryOf.of(world, geom) for geom in pair)
        key = (first, second) if listed == "geometries" else (first[:2], second[:2])
        if key not in found:
            if found and listed == "first pair":
                break
            if counts is not None and not counts(first, second):
                continue
            found[key] = Collision(first, second, [])
        if contacts:
            found[key].contacts.append(world.shapes.contact(*pair))
        elif listed == "first pair":
            break
    return list(found.values())
