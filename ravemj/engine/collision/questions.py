"""What is tested against what: the pairs of geoms of each kind of question.

A body that holds others, or is held, takes part with all of them, and is not tested against them.
"""

from collections.abc import Iterable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ravemj.core.graphs import Pair
from ravemj.core.transforms import Ints
from ravemj.engine.collision.resting import tested_pairs
from ravemj.engine.collision.world import CollisionWorld, Pairs, cross, joined
from ravemj.engine.simulation import BodyState
from ravemj.model.chains import dofs_moving
from ravemj.model.scene import KinBody


class MovedBy(NamedTuple):
    """Stands for the links that some DOFs move, or the pairs of links that they move against each other."""

    dofs: tuple[int, ...]


Links = frozenset[int] | MovedBy | None
"""Indices of the links of a body that take part; None: all."""

LinkPairs = frozenset[Pair] | MovedBy | None
"""Pairs of links of a body, the smaller index first; None: all."""

LinkOf = tuple[BodyState, int]
"""A body and the index of one of its links."""


def body_and_others(
    world: CollisionWorld,
    body: BodyState,
    links: Links = None,
    without_bodies: frozenset[BodyState] = frozenset(),
    without_links: frozenset[LinkOf] = frozenset(),
) -> Pairs:
    """Return the pairs of a body, or of some links and what they hold, and all other bodies."""

    def find() -> tuple[Ints, Ints]:
        others = _without(world, world.geoms_of_others(body), without_bodies, without_links)
        return cross(_part(world, body, links), others)

    return world.pairs(("others", body, links, without_bodies, without_links), find)


def link_and_others(
    world: CollisionWorld,
    link: LinkOf,
    without_bodies: frozenset[BodyState] = frozenset(),
    without_links: frozenset[LinkOf] = frozenset(),
) -> Pairs:
    """Return the pairs of a link, without what it holds, and all other bodies."""

    def find() -> tuple[Ints, Ints]:
        others = _without(world, world.geoms_of_others(link[0]), without_bodies, without_links)
        return cross(world.geoms_of_link(*link), others)

    return world.pairs(("link and others", link, without_bodies, without_links), find)


def bodies(world: CollisionWorld, first: BodyState, second: BodyState, links: Links = None) -> Pairs:
    """Return the pairs of two bodies; none if one holds the other."""

    def find() -> tuple[Ints, Ints]:
        together = second in world.group(first)
        return cross(_part(world, first, links), _nothing() if together else world.geoms_of_group(second))

    return world.pairs(("bodies", first, second, links), find)


def link_and_body(world: CollisionWorld, link: LinkOf, body: BodyState) -> Pairs:
    """Return the pairs of a link and a body; none if it is the link's own or one holds the other."""

    def find() -> tuple[Ints, Ints]:
        together = body in world.group(link[0])
        return cross(world.geoms_of_link(*link), _nothing() if together else world.geoms_of_group(body))

    return world.pairs(("link and body", link, body), find)


def links(world: CollisionWorld, first: LinkOf, second: LinkOf) -> Pairs:
    """Return the pairs of two links, also of one body, adjacent or not."""

    def find() -> tuple[Ints, Ints]:
        return cross(world.geoms_of_link(*first), _nothing() if first == second else world.geoms_of_link(*second))

    return world.pairs(("links", first, second), find)


def itself(world: CollisionWorld, body: BodyState, asked: LinkPairs = None) -> Pairs:
    """Return the pairs within a body and what it holds.

    Args:
        world: Where the body is.
        body: The body.
        asked: Only pairs of these links, or what they hold; those that DOFs move against each other; None: all.
    """

    def find() -> tuple[Ints, Ints]:
        wanted = moved_apart(body.scene, asked.dofs) if isinstance(asked, MovedBy) else asked
        return joined(_within(world, body, wanted))

    return world.pairs(("itself", body, asked), find)


def _within(
    world: CollisionWorld, body: BodyState, asked: frozenset[Pair] | None = None
) -> Iterable[tuple[Ints, Ints]]:
    tested = [link for link, one in enumerate(body.scene.links) if not one.self_collision_ignored]
    geoms = {link: world.geoms_of_link(body, link) for link in tested}
    held = [(grab, _held(world, grab.body)) for grab in body.grabs]
    found = [(a, b, (geoms[a], geoms[b])) for a, b in tested_pairs(world, body) if a in geoms and b in geoms]
    found += [(a, grab.link, (geoms[a], other)) for grab, other in held for a in tested if a not in grab.ignored]
    found += [(a.link, b.link, (one, other)) for (a, one), (b, other) in combinations(held, 2) if a.link != b.link]
    for first, second, sets in found:
        if asked is None or (min(first, second), max(first, second)) in asked:
            yield cross(*sets)
    if asked is None:
        for grab in body.grabs:
            yield from _within(world, grab.body)


def touching_links(world: CollisionWorld, holder: BodyState, body: BodyState) -> frozenset[int]:
    """Return the indices of a body's links that touch or overlap another body, enabled or not."""
    pairs = world.make_pairs(*cross(*(world.geoms_of_body(one, enabled_only=False) for one in (holder, body))))
    return frozenset(world.owner(first)[1] for first, _ in world.hits(pairs))


def moved_apart(body: KinBody, dofs: Iterable[int]) -> frozenset[Pair]:
    """Return the pairs of links, the smaller index first, that any of the DOFs moves against each other."""
    movers = [dofs_moving(body, link) & set(dofs) for link in range(len(body.links))]
    return frozenset((a, b) for a, b in combinations(range(len(movers)), 2) if movers[a] != movers[b])


def _part(world: CollisionWorld, body: BodyState, links: Links) -> Ints:
    """Return the geoms of some links and what they hold, or of a body and all that is connected to it."""
    if links is None:
        return world.geoms_of_group(body)
    if isinstance(links, MovedBy):
        wanted = set(links.dofs)
        links = frozenset(link for link in range(len(body.scene.links)) if wanted & dofs_moving(body.scene, link))
    own = [world.geoms_of_link(body, link) for link in sorted(links)]
    held = [_held(world, grab.body) for grab in body.grabs if grab.link in links]
    return np.concatenate([_nothing(), *own, *held])


def _held(world: CollisionWorld, body: BodyState) -> Ints:
    """Return the geoms of a body and of all that it holds."""
    return np.concatenate([world.geoms_of_body(one) for one in held_with(body)])


def held_with(body: BodyState) -> list[BodyState]:
    """Return a body and all that it holds, and so on."""
    return [body, *(one for grab in body.grabs for one in held_with(grab.body))]


def _without(world: CollisionWorld, geoms: Ints, bodies: frozenset[BodyState], links: frozenset[LinkOf]) -> Ints:
    left_out = [world.geoms_of_body(body) for body in bodies] + [world.geoms_of_link(*link) for link in links]
    return np.setdiff1d(geoms, np.concatenate(left_out)) if left_out else geoms


def _nothing() -> Ints:
    return np.zeros(0, dtype=np.int_)
