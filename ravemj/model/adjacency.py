"""Adjacent links: pairs that self-collision tests leave out."""

import numpy as np

from ravemj.core.graphs import Pair, ShortestPaths, ordered_pair
from ravemj.model.scene import KinBody


def adjacent_pairs(body: KinBody) -> set[Pair]:
    """Return the pairs of links that OpenRAVE's self-collision test leaves out.

    These are pairs that a joint joins, or whose shortest path of joints has at most one that moves, pairs that no chain
    of joints connects, pairs that ``<adjacent>`` names, and pairs with a link without shapes. A body can do without the
    first three.

    Returns:
        Pairs of link indices, the smaller one first.
    """
    if len(body.links) < 2:
        return set()
    count = len(body.links)
    shapeless = [not link.geometries for link in body.links]
    joined = _joined(body) if body.joined_links_adjacent else set[Pair]()
    empty = {(i, j) for i in range(count) for j in range(i + 1, count) if shapeless[i] or shapeless[j]}
    return joined | empty | set(body.adjacent)


def _joined(body: KinBody) -> set[Pair]:
    """Return the pairs of links that a joint joins, or between which at most one joint moves on the shortest path."""
    joints = body.all_joints
    edges = [(joint.parent, joint.child) for joint in joints]
    paths = ShortestPaths(len(body.links), edges)
    moving = paths.totals([not joint.static for joint in joints])
    return {ordered_pair(*edge) for edge in edges} | {(i, j) for i, j in np.argwhere(moving <= 1).tolist() if i < j}
