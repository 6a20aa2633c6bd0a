"""Geom pairs of each type of collision query.

A body is tested together with all bodies that it has grabbed or that have grabbed it, and not against them.
"""

from collections.abc import Iterable
from itertools import combinations
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ravemj.core.graphs import Pair, ordered_pair
from ravemj.core.transforms import Floats, Ints, inverse
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.world import CollisionWorld, cross, joined
from ravemj.engine.simulation import BodyState
from ravemj.model.chains import dofs_moving, separate_pairs
from ravemj.model.motion_bounds import reach
from ravemj.model.scene import Bounds, KinBody


class MovedBy(NamedTuple):
    """Filter of links moved by DOFs, or of pairs of links moved relative to each other by DOFs."""

    dofs: tuple[int, ...]


Links = frozenset[int] | MovedBy | None
"""Indices of a body's links to test; None means all."""

LinkPairs = frozenset[Pair] | MovedBy | None
"""Pairs of links of a body, the smaller index first; None means all."""

LinkOf = tuple[BodyState, int]
"""Link by its body and index."""

_touching_at_rest: "WeakKeyDictionary[BodyState, tuple[Floats | None, frozenset[Pair]]]" = WeakKeyDictionary()
"""For each body, its rest poses and the pairs of links that touch in them."""


def body_and_others(
    world: CollisionWorld,
    body: BodyState | LinkOf,
    links: Links = None,
    without_bodies: frozenset[BodyState] = frozenset(),
    without_links: frozenset[LinkOf] = frozenset(),
) -> Pairs:
    """Return the pairs of a body and all other bodies.

    Args:
        world: The collision world.
        body: The body with its grabbed bodies, or one link without grabbed bodies.
        links: Restriction to these links of the body and their grabbed bodies.
        without_bodies: Other bodies to ignore.
        without_links: Links to ignore, also of the body itself.
    """

    def find() -> tuple[Ints, Ints]:
        others = _without(world, world.geoms_of_others(body_of(body)), without_bodies, without_links)
        return cross(_without(world, _geoms(world, body, links), frozenset(), without_links), others)

    is_whole = links is None and not without_bodies and not without_links  # then the body alone is the query
    return world.pairs(body if is_whole else ("others", body, links, without_bodies, without_links), find)


def each_other(
    world: CollisionWorld, first: BodyState | LinkOf, second: BodyState | LinkOf, links: Links = None
) -> Pairs:
    """Return the pairs of two bodies, of a link and a body, or of two links.

    The result is empty if one body has grabbed the other, and for a link and its own body; two links of one body are
    tested even if adjacent. ``links`` restricts the first body to these links and their grabbed bodies.
    """

    def find() -> tuple[Ints, Ints]:
        if isinstance(first, BodyState) or isinstance(second, BodyState):
            together = body_of(second) in world.group(body_of(first))
        else:
            together = first == second
        if together:
            return _nothing(), _nothing()
        if isinstance(first, BodyState) and not isinstance(second, BodyState):  # the link's geoms in turn
            others, ours = cross(_geoms(world, second), _geoms(world, first))
            return ours, others
        return cross(_geoms(world, first, links), _geoms(world, second))

    return world.pairs(("each other", first, second, links), find)


def itself(world: CollisionWorld, body: BodyState, asked: LinkPairs = None) -> Pairs:
    """Return the self-collision pairs of a body and its grabbed bodies, optionally only of links or link pairs."""

    def find() -> tuple[Ints, Ints]:
        wanted = moved_apart(body.scene, asked.dofs) if isinstance(asked, MovedBy) else asked
        return joined(_within(world, body, wanted))

    return world.pairs(("itself", body, asked), find)


def link_and_own_body(world: CollisionWorld, link: LinkOf) -> Pairs:
    """Return the self-collision pairs of a link's body that involve the link or its grabbed bodies; see ``itself``."""
    body, index = link
    others = range(len(body.scene.links))
    return itself(world, body, frozenset(ordered_pair(index, other) for other in others))


def _within(
    world: CollisionWorld, body: BodyState, asked: frozenset[Pair] | None = None
) -> Iterable[tuple[Ints, Ints]]:
    tested = [link for link, tested_link in enumerate(body.scene.links) if not tested_link.self_collision_ignored]
    geoms = {link: world.geoms_of_link(body, link) for link in tested}
    held = [(grab, _held(world, grab.body)) for grab in body.grabs]
    parts = [(a, b, (geoms[a], geoms[b])) for a, b in tested_pairs(world, body) if a in geoms and b in geoms]
    parts += [(a, grab.link, (geoms[a], other)) for grab, other in held for a in tested if a not in grab.ignored]
    parts += [(a.link, b.link, (geom, other)) for (a, geom), (b, other) in combinations(held, 2) if a.link != b.link]
    for first, second, sets in parts:
        if asked is None or ordered_pair(first, second) in asked:
            yield cross(*sets)
    if asked is None:
        for grab in body.grabs:
            yield from _within(world, grab.body)


def tested_pairs(world: CollisionWorld, body: BodyState) -> list[Pair]:
    """Return the pairs of links, the smaller index first, that are neither adjacent nor in contact in the rest pose.

    The rest pose is the pose at the addition of the body, or declared by ``SetNonCollidingConfiguration``.
    """
    known = _touching_at_rest.get(body)
    if known is None or known[0] is not body.rest_poses:
        _touching_at_rest[body] = known = body.rest_poses, _find_touching(world, body)
    return [pair for pair in separate_pairs(world.model.description(body)) if pair not in known[1]]


def _find_touching(world: CollisionWorld, body: BodyState) -> frozenset[Pair]:
    if body.rest_poses is None:
        return frozenset()
    motions = {
        (body, link): rest @ inverse(now)
        for link, (rest, now) in enumerate(zip(body.rest_poses, body.link_transforms(), strict=True))
    }
    with world.moved(motions):
        return touching_pairs(world, body)


def touching_pairs(world: CollisionWorld, body: BodyState) -> frozenset[Pair]:
    """Return the pairs of links, the smaller index first, that touch and are not adjacent; also disabled links."""

    def find() -> tuple[Ints, Ints]:
        described = world.model.description(body)
        geoms = [world.geoms_of_link(body, link, enabled_only=False) for link in range(len(described.links))]
        return joined(cross(geoms[first], geoms[second]) for first, second in separate_pairs(described))

    hits = world.hits(world.pairs(("separate links", body), find))
    return frozenset(ordered_pair(world.owner(first)[1], world.owner(second)[1]) for first, second in hits)


def touching_links(world: CollisionWorld, holder: BodyState, body: BodyState) -> frozenset[int]:
    """Return the indices of a body's links, also disabled ones, that touch or overlap ``holder``."""
    pairs = world.make_pairs(*cross(*(world.geoms_of_body(either, enabled_only=False) for either in (holder, body))))
    return frozenset(world.owner(first)[1] for first, _ in world.hits(pairs))


def moved_apart(body: KinBody, dofs: Iterable[int]) -> frozenset[Pair]:
    """Return the pairs of links, the smaller index first, that any of the DOFs moves relative to each other."""
    movers = [dofs_moving(body, link) & set(dofs) for link in range(len(body.links))]
    return frozenset((a, b) for a, b in combinations(range(len(movers)), 2) if movers[a] != movers[b])


def moved_links(body: KinBody, dofs: Iterable[int]) -> frozenset[int]:
    """Return the links that any of the DOFs moves."""
    wanted = frozenset(dofs)
    return frozenset(link for link in range(len(body.links)) if wanted & dofs_moving(body, link))


def body_of(thing: BodyState | LinkOf) -> BodyState:
    """Return the body, or the link's body."""
    return thing if isinstance(thing, BodyState) else thing[0]


def _geoms(world: CollisionWorld, thing: BodyState | LinkOf, links: Links = None) -> Ints:
    """Return geoms: of a link; of a body and all bodies connected by grabs; or of ``links`` and what they grab."""
    if not isinstance(thing, BodyState):
        return world.geoms_of_link(*thing)
    if links is None:
        return world.geoms_of_group(thing)
    if isinstance(links, MovedBy):
        links = moved_links(thing.scene, links.dofs)
    own = [world.geoms_of_link(thing, link) for link in sorted(links)]
    held = [_held(world, grab.body) for grab in thing.grabs if grab.link in links]
    return np.concatenate([_nothing(), *own, *held])


def _held(world: CollisionWorld, body: BodyState) -> Ints:
    """Return the geoms of a body and its grabbed bodies."""
    return np.concatenate([world.geoms_of_body(held_body) for held_body in held_with(body)])


def held_with(body: BodyState) -> list[BodyState]:
    """Return a body and its grabbed bodies, recursively."""
    return [body, *(held_body for grab in body.grabs for held_body in held_with(grab.body))]


def _without(world: CollisionWorld, geoms: Ints, bodies: frozenset[BodyState], links: frozenset[LinkOf]) -> Ints:
    left_out = [world.geoms_of_body(body) for body in bodies] + [world.geoms_of_link(*link) for link in links]
    return np.setdiff1d(geoms, np.concatenate(left_out)) if left_out else geoms


def _nothing() -> Ints:
    return np.zeros(0, dtype=np.int_)


def touching_region(body: BodyState) -> Bounds | None:
    """Return the box of base positions [m] outside which a body cannot touch other bodies at any joint values.

    None if there are no other shapes.
    """
    attached = body.simulation.attached(body)
    others = _boxes(other_body for other_body in body.simulation.bodies if other_body not in attached)
    if not others:
        return None
    origin, poses = body.link_transform(0)[:3, 3], body.link_transforms()
    farthest = max([reach(body.scene), *(_distance(box, origin) for box in _boxes([body]))])
    for grab in body.grabs:
        farthest += max((_distance(box, poses[grab.link, :3, 3]) for box in _boxes(held_with(grab.body))), default=0.0)
    low, high = np.min([box.low for box in others], axis=0), np.max([box.high for box in others], axis=0)
    return Bounds(low - farthest, high + farthest)


def _boxes(bodies: Iterable[BodyState]) -> list[Bounds]:
    boxes = [body.bounds.at(body.link_transforms(), [True] * len(body.scene.links)) for body in bodies]
    return [box for box in boxes if box is not None]


def _distance(box: Bounds, point: Floats) -> float:
    """Return the distance of a point from the farthest corner of a box."""
    return float(np.linalg.norm(np.maximum(np.abs(box.low - point), np.abs(box.high - point))))
