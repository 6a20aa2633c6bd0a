"""Pairs of links of one body that are tested against each other."""

import itertools
from weakref import WeakKeyDictionary

from ravemj.core.graphs import Pair
from ravemj.core.transforms import Floats, inverse
from ravemj.engine.collision.world import CollisionWorld, cross, joined
from ravemj.engine.simulation import BodyState
from ravemj.model.chains import adjacent_pairs

_found: "WeakKeyDictionary[BodyState, tuple[Floats | None, frozenset[Pair]]]" = WeakKeyDictionary()


def tested_pairs(world: CollisionWorld, body: BodyState) -> list[Pair]:
    """Return the pairs of links, the smaller index first, that are neither adjacent nor touch in the rest pose.

    The rest pose is that in which the body was added, or which ``SetNonCollidingConfiguration`` declared.
    """
    left_out = adjacent_pairs(body.scene) | _touching_at_rest(world, body)
    links = range(len(body.scene.links))
    return [pair for pair in itertools.combinations(links, 2) if pair not in left_out]


def _touching_at_rest(world: CollisionWorld, body: BodyState) -> frozenset[Pair]:
    known = _found.get(body)
    if known is None or known[0] is not body.rest_poses:
        _found[body] = known = body.rest_poses, _find_touching(world, body)
    return known[1]


def _find_touching(world: CollisionWorld, body: BodyState) -> frozenset[Pair]:
    if body.rest_poses is None:
        return frozenset()
    links = range(len(body.scene.links))
    candidates = sorted(set(itertools.combinations(links, 2)) - adjacent_pairs(body.scene))
    geoms = [world.geoms_of_link(body, link, enabled_only=False) for link in links]
    pairs = world.make_pairs(*joined(cross(geoms[first], geoms[second]) for first, second in candidates))
    motions = {
        (body, link): rest @ inverse(now)
        for link, (rest, now) in enumerate(zip(body.rest_poses, body.link_transforms(), strict=True))
    }
    with world.moved(motions):
        return frozenset((world.owner(first)[1], world.owner(second)[1]) for first, second in world.hits(pairs))
