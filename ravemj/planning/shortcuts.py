"""Shorter paths: straight lines in place of detours."""

from collections.abc import Callable
from math import ceil

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges

_WORTH = 3e-3
"""A shortcut has to save this part of the whole path: testing lines is what takes time."""

_MOST_ENDS = 32
"""Number of ends of straight lines from one point that are tried."""


def shorten(
    edges: Edges,
    points: Floats,
    tries: int,
    random: np.random.Generator,
    proceed: Callable[[int], bool] = lambda attempt: True,
) -> Floats:
    """Return a path that is nowhere longer, from the same start to the same goal, shape (k, n).

    Straight lines between points of the path take the place of detours; then two random places at a time are connected
    by one, if it is allowed and shorter. This is tried ``tries`` times, while ``proceed``, asked with the number of the
    try, says so.
    """
    space = edges.space
    path = list(_without_detours(edges, points))
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
        start = edges.onto(_place(path[first], steps[first], lengths[first], low - (ends[first] - lengths[first])))
        end = edges.onto(_place(path[second], steps[second], lengths[second], high - (ends[second] - lengths[second])))
        step = space.difference(end, start)
        straight = float(np.linalg.norm(space.weights * step))
        # What is left of both lines is tested, too: in steps from its own ends, which are not those of the whole lines.
        if high - low - straight > _WORTH * ends[-1] and all(
            edges.line(one, space.difference(other, one))
            for one, other in ((start, end), (path[first], start), (end, path[second + 1]))
        ):
            path[first + 1 : second + 1] = [start, end]
    return _without_detours(edges, np.array(path))


def _place(start: Floats, step: Floats, length: float, along: float) -> Floats:
    return start + step * (along / length if length > 0 else 0.0)


def _without_detours(edges: Edges, path: Floats) -> Floats:
    """Return a path that goes from each of its points straight to the last one that a line reaches.

    Of many points, ``_MOST_ENDS`` are tried.
    """
    kept, last = [0], len(path) - 1
    while kept[-1] < last:
        start = path[kept[-1]]
        farther = range(last, kept[-1] + 1, -ceil((last - kept[-1]) / _MOST_ENDS))
        reached = (end for end in farther if edges.line(start, edges.space.difference(path[end], start)))
        kept.append(next(reached, kept[-1] + 1))
    return path[kept]
