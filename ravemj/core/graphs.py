"""Topological orders, connected components and shortest paths of graphs."""

import itertools
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

Pair = tuple[int, int]


def topological_order(items: Iterable[int], dependencies: Callable[[int], Iterable[int]]) -> list[int]:
    """Return items and their dependencies in topological order: each comes after its own dependencies.

    Items keep their order if dependencies allow it. Of the members of a cycle, the one visited first comes last.
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


class DepthFirst(NamedTuple):
    """The tree of a depth-first search in an undirected graph, with low points for finding cut vertices.

    Attributes:
        number: Discovery index of each visited node.
        above: Parent of each visited node in the tree, except the first.
        highest: Low point of each node: the smallest discovery index adjacent to its subtree. A node is a cut vertex
            for the subtree of a child unless the child's low point is below the node's index.
    """

    number: dict[int, int]
    above: dict[int, int]
    highest: dict[int, int]


def depth_first(neighbours: Sequence[Iterable[int]], start: int) -> DepthFirst:
    """Search an undirected graph depth-first, given the neighbours of each node."""
    tree = DepthFirst({start: 0}, {}, {start: 0})
    number, above, highest = tree
    path = [(start, iter(neighbours[start]))]
    while path:
        node, rest = path[-1]
        for other in rest:
            if other in number:
                highest[node] = min(highest[node], number[other])
            else:
                highest[other] = number[other] = len(number)
                above[other] = node
                path.append((other, iter(neighbours[other])))
                break
        else:
            path.pop()
            if path:
                highest[path[-1][0]] = min(highest[path[-1][0]], highest[node])
    return tree


class ShortestPaths:
    """The shortest paths in an undirected graph.

    Of several shortest paths it selects the one whose largest inner node is smallest, as in OpenRAVE. Of several edges
    between two nodes, the last one is used.
    """

    def __init__(self, count: int, edges: Sequence[Pair]) -> None:
        """Create the graph of ``count`` nodes from its edges."""
        self._edge: list[dict[int, int]] = [{} for _ in range(count)]  # to each neighbour
        for index, (first, second) in enumerate(edges):
            if first != second:
                self._edge[first][second] = self._edge[second][first] = index
        self._found: dict[Pair, list[int]] = {}

    def path(self, start: int, end: int) -> list[int]:
        """Return the edges of the path between two nodes; none if there is no path, or if the nodes are equal."""
        path = self._found.get((start, end))
        if path is None:
            path = self._found[start, end] = list(self._steps(start, end))
        return [*path]

    def _steps(self, start: int, end: int) -> Iterator[int]:
        distance = self._distances(end, start)
        while start != end and start in distance:
            step = self._step(start, end, distance)
            yield self._edge[start][step]
            start = step

    def _step(self, start: int, end: int, distance: dict[int, int]) -> int:
        """Return the next node on the shortest path from ``start``; ``distance`` is that from ``end``, by node."""
        nearer = self._nearer(start, distance)
        while len(nearer) > 1:  # recursively, towards the largest inner node
            end = self._largest_inner(start, end, distance)
            distance = self._distances(end, start)
            nearer = self._nearer(start, distance)
        return nearer[0]

    def _largest_inner(self, start: int, end: int, distance: dict[int, int]) -> int:
        """Return the minimum over all shortest paths from ``start`` to ``end`` of the largest inner node."""
        layers = [{start}]
        while end not in layers[-1]:
            layers.append({near for node in layers[-1] for near in self._nearer(node, distance)})
        largest = {end: -1}
        for layer in reversed(layers[:-1]):
            for node in layer:
                ways = (max(largest[near], near if near != end else -1) for near in self._nearer(node, distance))
                largest[node] = min(ways)
        return largest[start]

    def _nearer(self, node: int, distance: dict[int, int]) -> list[int]:
        """Return the neighbours of a node that are nearer to the origin of ``distance``."""
        return [other for other in self._edge[node] if distance.get(other, len(self._edge)) < distance[node]]

    def _distances(self, origin: int, wanted: int) -> dict[int, int]:
        """Return distances by node from ``origin``, by breadth-first search until ``wanted`` is reached."""
        distance = {origin: 0}
        queue = deque([origin])
        while queue and wanted not in distance:
            node = queue.popleft()
            for other in self._edge[node]:
                if other not in distance:
                    distance[other] = distance[node] + 1
                    queue.append(other)
        return distance

    def light_pairs(self, is_heavy: Sequence[bool]) -> Iterator[Pair]:
        """Yield the pairs of different nodes, the smaller one first, with at most one heavy edge on their path."""
        joined = [(index, (node, other)) for node, near in enumerate(self._edge) for other, index in near.items()]
        count = len(self._edge)
        part = connected_components(count, (pair for index, pair in joined if not is_heavy[index]))
        members: dict[int, list[int]] = {}
        for node, label in enumerate(part):
            members.setdefault(label, []).append(node)
        whole = connected_components(count, (pair for _, pair in joined))
        sizes, lines = Counter(whole), Counter(whole[pair[0]] for _, pair in joined)
        near_parts = {(label, label) for label in members}
        near_parts |= {ordered_pair(part[first], part[second]) for _, (first, second) in joined}
        for first_part, other in near_parts:
            is_tree = lines[whole[first_part]] == 2 * (sizes[whole[first_part]] - 1)  # each edge stands in there twice
            for first, second in itertools.product(members[first_part], members[other]):
                is_new = first < second or (first > second and first_part != other)
                if is_new and (is_tree or sum(is_heavy[index] for index in self.path(first, second)) <= 1):
                    yield ordered_pair(first, second)


def nodes_between(edges: Iterable[Pair], count: int, start: int, end: int) -> set[int]:
    """Return the nodes on paths between two nodes that visit no node twice; none if the two are equal.

    An edge lies on such a path if both of its nodes do. With an additional edge from the start to the end, these nodes
    form a block (biconnected component).
    """
    neighbours: list[list[int]] = [[] for _ in range(count)]
    for first, second in edges:
        neighbours[first].append(second)
        neighbours[second].append(first)
    neighbours[start].insert(0, end)
    neighbours[end].append(start)
    number, above, highest = depth_first(neighbours, start)
    block = {start, end} if start != end else set[int]()
    for node in list(number)[2:]:
        parent = above[node]
        if parent != start and parent in block and highest[node] < number[parent]:
            block.add(node)
    return block
