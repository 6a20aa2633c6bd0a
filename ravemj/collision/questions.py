"""What is tested against what: the pairs of geoms of each kind of question.

A body that holds others, or is held, takes part with all of them, and is not tested against them.
"""

from collections.abc import Iterable
from itertools import combinations

import numpy as np

from ravemj.chains import dofs_moving
from ravemj.collision.resting import tested_pairs
from ravemj.collision.world import CollisionWorld, Pairs, cross, joined
from ravemj.scene import KinBody
from ravemj.simulation import BodyState
from ravemj.transforms import Ints

Links = frozenset[int] | None
"""Indices of the links of a body that take part; None: all."""

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


def itself(world: CollisionWorld, body: BodyState, moved: Links = None, others: Links = None) -> Pairs:
    """Return the pairs within a body and what it holds.

    Args:
        world: Where the body is.
        body: The body.
        moved: Only pairs of one of these links, or what it holds, and one of the others; None: all.
        others: Which of the others; None: all.
    """

    def find() -> tuple[Ints, Ints]:
        return joined(_within(world, body, moved, others))

    return world.pairs(("itself", body, moved, others), find)


def _within(world: CollisionWorld, body: BodyState, moved: Links, others: Links = None) -> Iterable[tuple[Ints, Ints]]:
    tested = [link for link, one in enumerate(body.scene.links) if not one.self_collision_ignored]
    geoms = {link: world.geoms_of_link(body, link) for link in tested}
    held = [(grab, _held(world, grab.body)) for grab in body.grabs]
    asked = [(a, b, (geoms[a], geoms[b])) for a, b in tested_pairs(world, body) if a in geoms and b in geoms]
    asked += [(a, grab.link, (geoms[a], other)) for grab, other in held for a in tested if a not in grab.ignored]
    asked += [(a.link, b.link, (one, other)) for (a, one), (b, other) in combinations(held, 2) if a.link != b.link]
    for first, second, sets in asked:
        if _is_asked(first, second, moved, others):
            yield cross(*sets)
    if moved is None:
        for grab in body.grabs:
            yield from _within(world, grab.body, None)


def _is_asked(first: int, second: int, moved: Links, others: Links) -> bool:
    """Return whether one of two links is among those moved, and the other is another one."""
    if moved is None:
        return True
    other = second if first in moved else first
    return (first in moved) != (second in moved) and (others is None or other in others)


def touching_links(world: CollisionWorld, holder: BodyState, body: BodyState) -> frozenset[int]:
    """Return the indices of a body's links that touch or overlap another body."""
    pairs = world.make_pairs(*cross(world.geoms_of_body(holder), world.geoms_of_body(body)))
    return frozenset(world.owner(first)[1] for first, _ in world.hits(pairs))


def moved_links(body: KinBody, dofs: Iterable[int]) -> frozenset[int]:
    """Return the links that any of the DOFs move, directly or through mimic joints."""
    wanted = set(dofs)
    return frozenset(link for link in range(len(body.links)) if wanted & dofs_moving(body, link))


def _part(world: CollisionWorld, body: BodyState, links: Links) -> Ints:
    """Return the geoms of some links and what they hold, or of a body and all that is connected to it."""
    if links is None:
        return world.geoms_of_group(body)
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
