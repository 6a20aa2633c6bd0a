"""Conversion of link pairs that MuJoCo never tests to adjacent links."""

from itertools import combinations

import mujoco

from ravemj.core.graphs import ordered_pair
from ravemj.engine.mjcf_reading.trees import BodyTree


def add_adjacent(model: mujoco.MjModel, tree: BodyTree, colliding: set[int]) -> None:
    """Add the pairs of a body's links that MuJoCo never tests against each other.

    These are the pairs in ``<exclude>``, those excluded by masks, and those of a body and its parent. Links connected
    by a joint are adjacent anyway.
    """
    geoms = {body: _geoms(model, body, colliding) for body in tree.links}
    solid = [body for body, own_geoms in geoms.items() if own_geoms]
    signatures = {int(signature) for signature in model.exclude_signature}
    named = _named_pairs(model)
    joined = {ordered_pair(*joint.links) for joint in tree.builder.joints}
    masks = {body: _masks(model, own_geoms) for body, own_geoms in geoms.items()}
    for first_body, other in combinations(solid, 2):
        pair = ordered_pair(tree.links[first_body], tree.links[other])
        if pair in joined or ordered_pair(first_body, other) in named:
            continue
        low, high = ordered_pair(first_body, other)
        excluded = (low << 16) + high in signatures or (high << 16) + low in signatures
        if excluded or _are_filtered(model, first_body, other) or not _meet(masks[first_body], masks[other]):
            tree.builder.adjacent.append(pair)


def _geoms(model: mujoco.MjModel, body: int, colliding: set[int]) -> list[int]:
    first = int(model.body_geomadr[body])
    return [geom for geom in range(first, first + int(model.body_geomnum[body])) if geom in colliding]


def _named_pairs(model: mujoco.MjModel) -> set[tuple[int, int]]:
    """Return the pairs of bodies whose geoms are named in ``<pair>``."""
    bodies = zip(
        model.geom_bodyid[model.pair_geom1].tolist(), model.geom_bodyid[model.pair_geom2].tolist(), strict=True
    )
    return {ordered_pair(body, other) for body, other in bodies}


def _masks(model: mujoco.MjModel, geoms: list[int]) -> set[tuple[int, int]]:
    return {(int(model.geom_contype[geom]), int(model.geom_conaffinity[geom])) for geom in geoms}


def _meet(first: set[tuple[int, int]], second: set[tuple[int, int]]) -> bool:
    return any(type1 & affinity2 or type2 & affinity1 for type1, affinity1 in first for type2, affinity2 in second)


def _are_filtered(model: mujoco.MjModel, body: int, other: int) -> bool:
    """Return whether MuJoCo ignores collisions of two bodies: they are fixed together, or parent and child."""
    first, second = int(model.body_weldid[body]), int(model.body_weldid[other])
    if first == second:
        return True
    above = [int(model.body_weldid[model.body_parentid[weld]]) for weld in (first, second)]
    return bool(first and second) and (above[0] == second or above[1] == first)
