"""Adjacent links: pairs that self-collision tests leave out."""

from ravemj.core.graphs import Pair, ordered_pair
from ravemj.model.chains import connections
from ravemj.model.scene import KinBody


def adjacent_pairs(body: KinBody) -> frozenset[Pair]:
    """Return the pairs of links that OpenRAVE's self-collision test leaves out.

    These are pairs that a joint joins, or whose shortest path of joints has at most one that moves, pairs that no chain
    of joints connects, pairs that ``<adjacent>`` names, and pairs with a link without shapes. A body can do without the
    first three.

    Returns:
        Pairs of link indices, the smaller one first.
    """
    if len(body.links) < 2:
        return frozenset()
    links = range(len(body.links))
    joined = connections(body).close_pairs if body.joined_links_adjacent else frozenset[Pair]()
    empty = {ordered_pair(i, j) for i in links if not body.links[i].geometries for j in links if i != j}
    return joined | empty | set(body.adjacent)
