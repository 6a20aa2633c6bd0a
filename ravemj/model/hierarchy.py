"""Parent links of joints, and the joint that determines the pose of each link ("places" it).

OpenRAVE determines both from an undirected joint graph. The rules, measured on OpenRAVE 0.149: link 0 and static links
have depth 0, and depths grow along paths from link 0; the shallower link of a joint is its parent; joints act in order
of depth, and the first one to reach a link places it. Later ones close a loop and are not satisfied, except that a
fixed joint always places its child.
"""

import bisect
import heapq
import sys
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

from ravemj.core.graphs import depth_first, topological_order

_UNREACHED = -1
"""Depth that OpenRAVE uses for a link without path to link 0, when comparing links."""


_HIGHEST = (sys.maxsize, sys.maxsize)


class Edge(NamedTuple):
    """Joint as an edge of the graph.

    Attributes:
        links: Indices of its two links, in the order of the file.
        fixed: Whether it is a weld.
        active: Whether it has a DOF.
        follows: Indices of the passive joints that it mimics.
    """

    links: tuple[int, int]
    fixed: bool
    active: bool
    follows: tuple[int, ...] = ()


class Hierarchy(NamedTuple):
    """Parent and child links of joints, and the joints that place links.

    Attributes:
        swapped: For each joint, whether its second listed link is the parent.
        order: Indices of the joints that place a link, in their order of evaluation.
    """

    swapped: tuple[bool, ...]
    order: tuple[int, ...]


def decide(static_links: Sequence[bool], edges: Sequence[Edge]) -> Hierarchy:
    """Determine the parent link of each joint, and the joints that place links.

    ``edges`` are the active joints in DOF order, then the passive ones.
    """
    if not edges:
        return Hierarchy((), ())
    has_dofs = any(edge.active for edge in edges)  # without static links, OpenRAVE assigns no depths
    depths = _depths(static_links, edges) if has_dofs else [_UNREACHED] * len(static_links)
    swapped = tuple(_is_swapped(edge.links, static_links, depths, has_dofs=has_dofs) for edge in edges)
    ends = [tuple(reversed(edge.links)) if swap else edge.links for edge, swap in zip(edges, swapped, strict=True)]
    levels = [tuple(sorted(depths[link] for link in links)) for links in ends]
    grounded = [static_links[first] or static_links[second] for first, second in ends]
    placed_by: dict[int, int] = {}
    carriers: set[int] = set()
    order = topological_order(_acting_order(levels, grounded), lambda index: edges[index].follows)
    for index in order:
        parent, child = ends[index]
        free = child != 0 and child not in placed_by
        if (free or edges[index].fixed) and not _hangs_on(parent, child, placed_by, ends, carriers):
            placed_by[child] = index
            carriers.add(parent)
    return Hierarchy(swapped, _parents_first(set(placed_by.values()), ends, order))


def _acting_order(levels: Sequence[tuple[int, ...]], grounded: Sequence[bool]) -> list[int]:
    """Return the joints in the order in which OpenRAVE evaluates them.

    The level of a joint is the depths of its links, the smaller one first. A joint waits for all joints on lower
    levels, except that a joint at a static link (``grounded``) does not wait for others at static links. Ready joints
    are queued in the order of the file.
    """
    by_level = sorted(range(len(levels)), key=lambda index: levels[index])
    unfinished, free = deque(by_level), deque(index for index in by_level if not grounded[index])
    waiting_free, waiting_grounded = deque(free), deque(index for index in by_level if grounded[index])
    queue, order, finished = deque[int](), list[int](), set[int]()
    while unfinished:
        ready: list[int] = []
        for waiting, bound in ((waiting_free, unfinished), (waiting_grounded, free)):
            lowest = levels[bound[0]] if bound else _HIGHEST
            while waiting and levels[waiting[0]] <= lowest:
                ready.append(waiting.popleft())
        queue.extend(sorted(ready))
        order.append(queue.popleft())
        finished.add(order[-1])
        for items in (unfinished, free):
            while items and items[0] in finished:
                items.popleft()
    return order


def _parents_first(placing: set[int], ends: Sequence[tuple[int, ...]], order: Sequence[int]) -> tuple[int, ...]:
    """Sort the joints that determine link poses, so that each follows the one whose child is its parent link."""
    placed_by = {ends[index][1]: index for index in placing}

    def carrying(index: int) -> list[int]:
        parent = ends[index][0]
        return [placed_by[parent]] if parent in placed_by else []

    return tuple(topological_order([index for index in order if index in placing], carrying))


def _depths(static_links: Sequence[bool], edges: Sequence[Edge]) -> list[int]:
    """Return the depth of each link: one more than the smallest known depth of its parents.

    A parent is the previous link on a simple path from link 0. Therefore a static link, whose depth is 0, determines
    depths only of links to which a path from link 0 passes through it.
    """
    neighbours: list[list[int]] = [[] for _ in static_links]
    for edge in edges:
        first, second = edge.links
        neighbours[first].append(second)
        neighbours[second].append(first)
    depths = [0 if index == 0 or static else _UNREACHED for index, static in enumerate(static_links)]
    parents = _parents(neighbours)
    children: list[list[int]] = [[] for _ in static_links]
    for link, own_parents in enumerate(parents):
        for parent in own_parents:
            children[parent].append(link)
    # In each round, links get their depths in the order of the file, once that of a parent is known.
    turns = [(1, child) for link, depth in enumerate(depths) if depth != _UNREACHED for child in children[link]]
    heapq.heapify(turns)
    while turns:
        turn, link = heapq.heappop(turns)
        if depths[link] == _UNREACHED:
            depths[link] = 1 + min(depths[parent] for parent in parents[link] if depths[parent] != _UNREACHED)
            for child in children[link]:
                heapq.heappush(turns, (turn if child > link else turn + 1, child))
    return depths


def _parents(neighbours: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return for each link the neighbours that a path from link 0 reaches without passing the link.

    In the depth-first search tree from link 0, neighbours are ancestors or descendants of a link. The ancestors always
    have such a path; the descendants have one unless the link is an articulation point that separates them from link 0.
    """
    number, above, highest = depth_first(neighbours, 0)
    branches: list[list[int]] = [[] for _ in neighbours]
    for branch, link in above.items():
        branches[link].append(branch)

    def is_reached(link: int, other: int) -> bool:
        if other not in number or other == link:
            return False
        if number[other] < number[link]:
            return True
        place = bisect.bisect_right(branches[link], number[other], key=lambda branch: number[branch])
        return highest[branches[link][place - 1]] < number[link]

    return [[other for other in near if is_reached(link, other)] for link, near in enumerate(neighbours)]


def _is_swapped(links: tuple[int, int], static_links: Sequence[bool], depths: Sequence[int], *, has_dofs: bool) -> bool:
    """Return whether the second listed link is the parent; link 0 is never a child (tests gap-05, gap-06, gap-07)."""
    first, second = links
    if static_links[second]:  # also in bodies without DOFs
        return not static_links[first] and first != 0
    if static_links[first]:
        return has_dofs and second == 0
    return depths[second] < depths[first]


def _hangs_on(
    link: int, other: int, placed_by: dict[int, int], ends: Sequence[tuple[int, ...]], carriers: set[int]
) -> bool:
    """Return whether ``link`` is ``other`` or its descendant; ``carriers`` are the links that have children."""
    while link != other and other in carriers and link in placed_by:
        link = ends[placed_by[link]][0]
    return link == other
