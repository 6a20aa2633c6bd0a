"""Which link of a joint is its parent, and which joint places which link.

OpenRAVE decides both from a joint graph without direction. The rules, measured on OpenRAVE 0.149: a link's
depth is its least number of joints from link 0 or from a static link; the shallower link of a joint is its
parent; joints act in order of depth, and the first one to reach a link places it. Later ones close a loop and
are not satisfied, except that a fixed joint always places its child.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ravemj.core.graphs import topological_order


class Edge(NamedTuple):
    """A joint as an edge of the graph.

    Attributes:
        links: Indices of its two links, in the order in which the file lists them.
        fixed: True for a weld.
        active: True where it has a DOF.
        follows: Indices of the passive joints that it follows.
    """

    links: tuple[int, int]
    fixed: bool
    active: bool
    follows: tuple[int, ...] = ()


class Hierarchy(NamedTuple):
    """The directed joints.

    Attributes:
        swapped: For each joint, True where its second listed link is the parent.
        order: Indices of the joints that place a link, in the order in which they act.
    """

    swapped: tuple[bool, ...]
    order: tuple[int, ...]


def decide(static_links: Sequence[bool], edges: Sequence[Edge]) -> Hierarchy:
    """Direct the joints of a body.

    Args:
        static_links: For each link, whether it is static.
        edges: The joints: active ones in DOF order, then passive ones.
    """
    depths = _depths(static_links, edges)
    has_dofs = any(edge.active for edge in edges)  # without any, OpenRAVE directs nothing
    swapped = tuple(has_dofs and _is_swapped(edge.links, static_links, depths) for edge in edges)
    ends = [tuple(reversed(edge.links)) if swap else edge.links for edge, swap in zip(edges, swapped, strict=True)]
    unreached = len(static_links)

    def key(index: int) -> tuple[int, int, bool, int]:
        first, second = sorted(unreached if depths[link] is None else depths[link] or 0 for link in ends[index])
        return first, second, not edges[index].active, index

    placed_by: dict[int, int] = {}
    order = _leaders_first(sorted(range(len(edges)), key=key), edges)
    for index in order:
        parent, child = ends[index]
        free = child != 0 and child not in placed_by
        if (free or edges[index].fixed) and child not in _ancestors(parent, placed_by, ends):
            placed_by[child] = index
    return Hierarchy(swapped, _parents_first(set(placed_by.values()), ends, order))


def _leaders_first(order: Sequence[int], edges: Sequence[Edge]) -> list[int]:
    """Move each joint behind the passive joints that it follows."""
    return topological_order(order, lambda index: edges[index].follows)


def _parents_first(placing: set[int], ends: Sequence[tuple[int, ...]], order: Sequence[int]) -> tuple[int, ...]:
    """Sort the joints that place a link so that each comes behind the one that places its parent."""
    placed_by = {ends[index][1]: index for index in placing}

    def carrying(index: int) -> list[int]:
        parent = ends[index][0]
        return [placed_by[parent]] if parent in placed_by else []

    return tuple(topological_order([index for index in order if index in placing], carrying))


def _depths(static_links: Sequence[bool], edges: Sequence[Edge]) -> list[int | None]:
    neighbours: dict[int, list[int]] = {}
    for edge in edges:
        first, second = edge.links
        neighbours.setdefault(first, []).append(second)
        neighbours.setdefault(second, []).append(first)
    depths: list[int | None] = [0 if index == 0 or static else None for index, static in enumerate(static_links)]
    queue = deque(index for index, depth in enumerate(depths) if depth == 0)
    while queue:
        link = queue.popleft()
        for neighbour in neighbours.get(link, ()):
            if depths[neighbour] is None:
                depths[neighbour] = (depths[link] or 0) + 1
                queue.append(neighbour)
    return depths


def _is_swapped(links: tuple[int, int], static_links: Sequence[bool], depths: Sequence[int | None]) -> bool:
    """Return True where the second listed link is the parent."""
    first, second = links
    if static_links[first] != static_links[second]:
        static, other = (first, second) if static_links[first] else (second, first)
        parent = other if other == 0 else static  # link 0 is never a child
        return parent == second
    depth_first, depth_second = depths[first], depths[second]
    if depth_first is None or depth_second is None:
        return False
    return depth_second < depth_first


def _ancestors(link: int, placed_by: dict[int, int], ends: Sequence[tuple[int, ...]]) -> Iterator[int]:
    """Yield a link and the links that it hangs on."""
    yield link
    while link in placed_by:
        link = ends[placed_by[link]][0]
        yield link
