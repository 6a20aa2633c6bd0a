"""Which link of a joint is its parent, and which joint places which link.

OpenRAVE decides both from a joint graph without direction. The rules, measured on OpenRAVE 0.149: link 0 and static
links have depth 0, and depths grow along paths from link 0; the shallower link of a joint is its parent; joints act
in order of depth, and the first one to reach a link places it. Later ones close a loop and are not satisfied, except
that a fixed joint always places its child.
"""

import sys
from collections import deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ravemj.core.graphs import topological_order

_UNREACHED = -1
"""The depth of a link that no path joins to link 0; OpenRAVE compares it with others."""


_HIGHEST = (sys.maxsize, sys.maxsize)


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
    """Direct the joints of a body: active ones in DOF order, then passive ones."""
    if not edges:
        return Hierarchy((), ())
    has_dofs = any(edge.active for edge in edges)  # without any, OpenRAVE makes no depths
    depths = _depths(static_links, edges) if has_dofs else [_UNREACHED] * len(static_links)
    swapped = tuple(_is_swapped(edge.links, static_links, depths, has_dofs=has_dofs) for edge in edges)
    ends = [tuple(reversed(edge.links)) if swap else edge.links for edge, swap in zip(edges, swapped, strict=True)]
    levels = [tuple(sorted(depths[link] for link in links)) for links in ends]
    grounded = [static_links[first] or static_links[second] for first, second in ends]
    placed_by: dict[int, int] = {}
    order = topological_order(_acting_order(levels, grounded), lambda index: edges[index].follows)
    for index in order:
        parent, child = ends[index]
        free = child != 0 and child not in placed_by
        if (free or edges[index].fixed) and child not in _ancestors(parent, placed_by, ends):  # none hangs on itself
            placed_by[child] = index
    return Hierarchy(swapped, _parents_first(set(placed_by.values()), ends, order))


def _acting_order(levels: Sequence[tuple[int, ...]], grounded: Sequence[bool]) -> list[int]:
    """Return the joints in the order in which OpenRAVE lets them act.

    The level of a joint is the depths of its links, the smaller one first. A joint waits for all joints on lower
    levels, but one at a static link not for others at static links. Those that wait no longer queue up in the order of
    the file.
    """
    queue, order = deque[int](), list[int]()
    waiting = list(range(len(levels)))
    while waiting or queue:
        unfinished = [*queue, *waiting]
        lowest = min(levels[index] for index in unfinished)
        lowest_free = min((levels[index] for index in unfinished if not grounded[index]), default=_HIGHEST)
        ready = [index for index in waiting if levels[index] <= (lowest_free if grounded[index] else lowest)]
        queue.extend(ready)
        waiting = [index for index in waiting if index not in set(ready)] if ready else waiting
        order.append(queue.popleft())
    return order


def _parents_first(placing: set[int], ends: Sequence[tuple[int, ...]], order: Sequence[int]) -> tuple[int, ...]:
    """Sort the joints that place a link so that each comes behind the one that places its parent."""
    placed_by = {ends[index][1]: index for index in placing}

    def carrying(index: int) -> list[int]:
        parent = ends[index][0]
        return [placed_by[parent]] if parent in placed_by else []

    return tuple(topological_order([index for index in order if index in placing], carrying))


def _depths(static_links: Sequence[bool], edges: Sequence[Edge]) -> list[int]:
    """Return the depth of each link: one more than the least depth that is known of its parents.

    A parent is the link before on a path from link 0 that meets no link twice. So a static link passes its depth on
    only to what lies behind it as seen from link 0.
    """
    neighbours: list[list[int]] = [[] for _ in static_links]
    for edge in edges:
        first, second = edge.links
        neighbours[first].append(second)
        neighbours[second].append(first)
    depths = [0 if index == 0 or static else _UNREACHED for index, static in enumerate(static_links)]
    waiting = {link: _parents(link, neighbours) for link, depth in enumerate(depths) if depth == _UNREACHED}
    settled = True
    while settled:
        settled = False
        for link in list(waiting):
            known = [depths[parent] for parent in waiting[link] if depths[parent] != _UNREACHED]
            if known:
                depths[link] = 1 + min(known)
                del waiting[link]
                settled = True
    return depths


def _parents(link: int, neighbours: Sequence[Sequence[int]]) -> list[int]:
    """Return the neighbours of a link that a path from link 0 reaches without that link."""
    reached = {0, link}
    pending = [0]
    while pending:
        for neighbour in neighbours[pending.pop()]:
            if neighbour not in reached:
                reached.add(neighbour)
                pending.append(neighbour)
    return [neighbour for neighbour in neighbours[link] if neighbour in reached]


def _is_swapped(links: tuple[int, int], static_links: Sequence[bool], depths: Sequence[int], *, has_dofs: bool) -> bool:
    """Return True where the second listed link is the parent; link 0 is never a child (gap-05, gap-06, gap-07)."""
    first, second = links
    if static_links[second]:  # in bodies without DOFs, too
        return not static_links[first] and first != 0
    if static_links[first]:
        return has_dofs and second == 0
    return depths[second] < depths[first]


def _ancestors(link: int, placed_by: dict[int, int], ends: Sequence[tuple[int, ...]]) -> Iterator[int]:
    """Yield a link and the links that it hangs on."""
    yield link
    while link in placed_by:
        link = ends[placed_by[link]][0]
        yield link
