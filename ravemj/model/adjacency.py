"""Which pairs of links of a body are never tested against each other."""

from collections.abc import Iterable

from ravemj.model.scene import KinBody

Pair = tuple[int, int]


def adjacent_pairs(body: KinBody) -> set[Pair]:
    """Return the pairs of links that OpenRAVE's self-collision test leaves out.

    These are pairs with at most one moving joint between them, pairs that ``<adjacent>`` names, pairs with a link
    without shapes, and pairs that no chain of joints connects.

    Returns:
        Pairs of link indices, the smaller one first.
    """
    if len(body.links) < 2:
        return set()
    joints = body.all_joints
    rigid = components(len(body.links), ((joint.parent, joint.child) for joint in joints if joint.static))
    connected = components(len(body.links), ((joint.parent, joint.child) for joint in joints))
    one_joint = {ordered(rigid[joint.parent], rigid[joint.child]) for joint in joints}
    shapeless = {index for index, link in enumerate(body.links) if not link.geometries}

    def adjacent(first: int, second: int) -> bool:
        parts = ordered(rigid[first], rigid[second])
        joined = parts[0] == parts[1] or parts in one_joint
        return (
            (joined and body.joined_links_adjacent)
            or connected[first] != connected[second]
            or first in shapeless
            or second in shapeless
        )

    links = range(len(body.links))
    return {(i, j) for i in links for j in links if i < j and adjacent(i, j)} | set(body.adjacent)


def ordered(first: int, second: int) -> Pair:
    """Return two numbers, the smaller one first."""
    return (first, second) if first <= second else (second, first)


def components(count: int, edges: Iterable[Pair]) -> list[int]:
    """Return for each node the smallest node that edges connect it to."""
    label = list(range(count))

    def root(node: int) -> int:
        while label[node] != node:
            label[node] = label[label[node]]
            node = label[node]
        return node

    for first, second in edges:
        small, large = ordered(root(first), root(second))
        label[large] = small
    return [root(node) for node in range(count)]
