"""Randomized A*: expands the most promising configuration first, with random neighbours instead of a grid.

After R. Diankov and J. Kuffner, "Randomized statistical path planning", IROS 2007.
"""

import heapq
from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.rrt import Budget, End, Search, SearchTree, without_repetitions

_STEP = 0.3
"""Distance between a node and its sampled neighbours [rad or m]."""

_REACH = 1.0
"""Maximum length of an edge to a goal [rad or m]."""

_APART = 0.5
"""Minimum distance between nodes, as a fraction of ``_STEP``."""

_NEIGHBOURS = 8
"""Number of neighbours sampled per expansion of a node."""


def search_by_cost(
    edges: Edges, starts: Sequence[Floats], goals: Sequence[Floats], budget: Budget, random: np.random.Generator
) -> Search:
    """A* over sampled configurations: expand the one with the least cost-to-come plus distance to a goal."""
    space, tree = edges.space, SearchTree(edges.space)
    ways: list[float] = []
    pending: list[tuple[float, int]] = []

    def add(configuration: Floats, parent: int, way: float) -> None:
        ways.append(way)
        number = tree.add(configuration, parent)
        heapq.heappush(pending, (way + min(space.distance(goal, configuration) for goal in goals), number))

    for start in starts:
        add(start, -1, 0.0)
    iteration = 0
    while (stopped := budget.end(iteration)) is None:
        cost, number = heapq.heappop(pending)
        node = tree.node(number).copy()
        goal = min(range(len(goals)), key=lambda index: space.distance(goals[index], node))
        step = space.difference(goals[goal], node)
        if np.linalg.norm(step) <= _REACH and edges.line(node, step):
            path = without_repetitions(np.array([*tree.branch(number)[::-1], goals[goal]]))
            return Search(End.found, path, tree.root(number), goal, iteration + 1, (tree,))
        for direction in random.normal(size=(_NEIGHBOURS, len(node))):
            neighbour = edges.onto(space.clamp(node + direction * (_STEP / np.linalg.norm(direction))))
            nearest = tree.node(tree.nearest(neighbour))
            way = space.difference(neighbour, node)
            if np.linalg.norm(space.difference(neighbour, nearest)) > _APART * _STEP and edges.line(node, way):
                add(neighbour, number, ways[number] + space.distance(neighbour, node))
        heapq.heappush(pending, (cost + _STEP, number))  # it may have more neighbours
        iteration += 1
    return Search(stopped, None, -1, -1, iteration, (tree,))
