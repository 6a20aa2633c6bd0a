"""Topological orders and connected components of graphs."""

from collections.abc import Callable, Iterable

Pair = tuple[int, int]


def topological_order(items: Iterable[int], dependencies: Callable[[int], Iterable[int]]) -> list[int]:
    """Return items and their dependencies in topological order: each comes after its own dependencies.

    Of the members of a cycle, the one that is visited first comes last.

    Args:
        items: In the order that they keep where dependencies allow it.
        dependencies: Returns what an item depends on.
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
