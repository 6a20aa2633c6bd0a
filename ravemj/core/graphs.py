"""Things that depend on each other, put in order."""

from collections.abc import Callable, Iterable


def dependencies_first(items: Iterable[int], dependencies: Callable[[int], Iterable[int]]) -> list[int]:
    """Return items and what they depend on, each behind its own dependencies.

    Where some depend on each other in a circle, the one that is met first comes behind the others.

    Args:
        items: In the order that they keep where nothing speaks against it.
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
