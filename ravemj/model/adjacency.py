"""Adjacent links: pairs that self-collision tests leave out."""

from ravemj.core.graphs import Pair, connected_components, ordered_pair
from ravemj.model.scene import KinBody


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
    rigid = connected_components(len(body.links), ((joint.parent, joint.child) for joint in joints if joint.static))
    connected = connected_components(len(body.links), ((joint.parent, joint.child) for joint in joints))
    one_joint = {ordered_pair(rigid[joint.parent], rigid[joint.child]) for joint in joints}
    shapeless = {index for index, link in enumerate(body.links) if not link.geometries}

    def adjacent(first: int, second: int) -> bool:
        parts = ordered_pair(rigid[first], rigid[second])
        joined = parts[0] == parts[1] or parts in one_joint
        return (
            (joined and body.joined_links_adjacent)
            or connected[first] != connected[second]
            or first in shapeless
            or second in shapeless
        )

    links = range(len(body.links))
    return {(i, j) for i in links for j in links if i < j and adjacent(i, j)} | set(body.adjacent)
