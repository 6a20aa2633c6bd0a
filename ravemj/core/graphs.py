"""Topological orders, connected components and shortest paths of graphs."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from ravemj.core.transforms import Ints

Pair = tuple[int, int]


def topological_order(items: Iterable[int], dependencies: Callable[[int], Iterable[int]]) -> list[int]:
    """Return items and their dependencies in topological order: each comes after its own dependencies.

    Items keep their order where dependencies allow it. Of the members of a cycle, the one visited first comes last.
    """
    order: list[int] = []
    met: set[int] = set()
    for item in items:
        path = [(item, iter(dependencies(item)))] if item not in met else []
        met.add(item)
        while path:
            current, rest = path[-1]
            following = next((other for other in rest if other not in met), None)
            if following is None:
                order.append(current)
                path.pop()
            else:
                met.add(following)
                path.append((following, iter(dependencies(following))))
    return order


def ordered_pair(first: int, second: int) -> Pair:
    """Return two numbers, the smaller one first."""
    return (first, second) if first <= second else (second, first)


def connected_components(count: int, edges: Iterable[Pair]) -> list[int]:
    """Return for each node the smallest node of its connected component (union-find)."""
    label = list(range(count))

    def root(node: int) -> int:
        while label[node] != node:
            label[node] = label[label[node]]
            node = label[node]
        return node

    for first, second in edges:
        small, large = ordered_pair(root(first), root(second))
        label[large] = small
    return [root(node) for node in range(count)]


class ShortestPaths:
    """The shortest paths between all nodes of an undirected graph (Floyd and Warshall).

    Among several shortest paths it takes the one whose largest inner node is smallest, as OpenRAVE does.

    Attributes:
        lengths: The number of edges on each, shape (count, count); ``count`` where there is none.
    """

    def __init__(self, count: int, edges: Sequence[Pair]) -> None:
        """Find the paths. Of several edges between two nodes the last one counts."""
        self._edges = edges
        self.lengths: Ints = np.full((count, count), count)
        np.fill_diagonal(self.lengths, 0)
        self._edge = np.full((count, count), -1)  # [end, start]: the first edge on the path from start to end
        for index, (first, second) in enumerate(edges):
            self.lengths[first, second] = self.lengths[second, first] = 1
            self._edge[first, second] = self._edge[second, first] = index
        for node in range(count):
            through = self.lengths[:, node, None] + self.lengths[node]
            shorter = through < self.lengths
            np.copyto(self.lengths, through, where=shorter)
            np.copyto(self._edge, self._edge[node], where=shorter)

    def path(self, start: int, end: int) -> list[int]:
        """Return the edges of the path between two nodes; none if there is no path, or if the nodes are the same."""
        path: list[int] = []
        while start != end and self._edge[end, start] >= 0:
            path.append(int(self._edge[end, start]))
            start = sum(self._edges[path[-1]]) - start
        return path

    def totals(self, weights: Sequence[int]) -> Ints:
        """Return the sum of the weights of the edges on each path, shape (count, count); 0 where there is none."""
        totals: Ints = np.zeros_like(self.lengths)
        count = len(self.lengths)
        of_edge = np.array(weights, dtype=int)
        both_ends = np.array([first + second for first, second in self._edges], dtype=int)
        for length in range(1, count):
            ends, starts = np.nonzero(self.lengths == length)
            if not len(ends):
                break
            first = self._edge[ends, starts]
            totals[ends, starts] = of_edge[first] + totals[ends, both_ends[first] - starts]
        return totals


def lies_between(edges: Sequence[Pair], edge: Pair, start: int, end: int) -> bool:
    """Return whether an edge lies on a simple path between two nodes, which visits no node twice.

    It does if no single node cuts its two ends off from these nodes (Menger).
    """
    neighbours: dict[int, list[int]] = {}
    for first, second in edges:
        neighbours.setdefault(first, []).append(second)
        neighbours.setdefault(second, []).append(first)

    def reaches_without(node: int | None) -> bool:
        reached, pending = {start, end, node}, [one for one in (start, end) if one != node]
        while pending:
            current = pending.pop()
            if current in edge:
                return True
            news = [other for other in neighbours.get(current, ()) if other not in reached]
            reached.update(news)
            pending += news
        return False

    return start != end and all(reaches_without(node) for node in (None, *neighbours))
