"""Shorter paths: straight lines in place of detours."""

from collections.abc import Callable

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges

_WORTH = 1e-3
"""A shortcut has to save this part of what it replaces."""


def shorten(
    edges: Edges,
    points: Floats,
    tries: int,
    random: np.random.Generator,
    proceed: Callable[[int], bool] = lambda attempt: True,
) -> Floats:
    """Return a path that is nowhere longer, from the same start to the same goal.

    Two random places of the path are connected by a straight line, if it is allowed and shorter.

    Args:
        edges: Tests lines.
        points: The path, shape (m, n); it is allowed.
        tries: How many lines are tried.
        random: Draws places.
        proceed: Asked before each try, with its number, whether to go on.

    Returns:
        Shape (k, n).
    """
    space = edges.space
    path = list(_without_straight_corners(edges, points))
    for attempt in range(tries):
        if len(path) < 3 or not proceed(attempt):
            break
        steps = space.difference(np.array(path[1:]), np.array(path[:-1]))
        lengths = np.linalg.norm(space.weights * steps, axis=1)
        ends: Floats = np.cumsum(lengths)
        low, high = sorted((random.random() * float(ends[-1]), random.random() * float(ends[-1])))
        first, second = (min(int(np.searchsorted(ends, place)), len(steps) - 1) for place in (low, high))
        if first == second:
            continue
        start = _place(path[first], steps[first], lengths[first], low - (ends[first] - lengths[first]))
        end = _place(path[second], steps[second], lengths[second], high - (ends[second] - lengths[second]))
        step = space.difference(end, start)
        straight = float(np.linalg.norm(space.weights * step))
        if straight < (high - low) * (1 - _WORTH) and edges.line(start, step):
            path[first + 1 : second + 1] = [start, end]
    return _without_straight_corners(edges, np.array(path))


def _place(start: Floats, step: Floats, length: float, along: float) -> Floats:
    return start + step * (along / length if length > 0 else 0.0)


def _without_straight_corners(edges: Edges, path: Floats) -> Floats:
    """Return the path without corners that a line to the next one but one makes needless."""
    space, kept = edges.space, [0]
    for index in range(1, len(path) - 1):
        before, after = path[kept[-1]], path[index + 1]
        if not edges.line(before, space.difference(after, before)):
            kept.append(index)
    return path[[*kept, len(path) - 1]] if len(path) > 1 else path
