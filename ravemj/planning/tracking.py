"""Configurations that reach one goal after the other, without jumps between them."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.planning.space import Space

LARGEST_JUMP = 0.5
"""The largest step of a joint between consecutive goals [rad or m]; a larger one is another branch of solutions."""

_FIRST_STEP = 1000.0
"""What the way from the start to the first goal costs: a path that begins where the robot is beats all others."""

Solve = Callable[[int, Floats], Sequence[Floats]]
"""Returns configurations that reach a goal, by its number; it may search near the second argument."""

Connects = Callable[[int, Floats, Floats], bool]
"""Whether a configuration of the goal before leads straight to one of a goal, by the number of the latter."""


class _Layer(NamedTuple):
    """Configurations that reach one goal, lengths of the shortest ways to them, and places in the layer before."""

    rows: Floats
    costs: Floats
    parents: NDArray[np.intp]


def track(space: Space, count: int, start: Floats, solve: Solve, connects: Connects) -> Floats:
    """Return the shortest way through configurations of all goals, as far as there is one, shape (m, n).

    It begins at ``start`` if it can. Shortest ways to all solutions of a goal are kept, so that a branch that ends does
    the others no harm.
    """
    layers: list[_Layer] = []
    last = _Layer(start[None], np.zeros(1), np.zeros(1, dtype=np.intp))
    for number in range(count):
        last = _next_layer(space, number, last, solve, connects)
        if not len(last.rows):
            break
        layers.append(last)
    place = int(layers[-1].costs.argmin()) if layers else 0
    path: list[Floats] = []
    for layer in reversed(layers):
        path.append(layer.rows[place])
        place = int(layer.parents[place])
    return np.array(path[::-1]).reshape(-1, len(start))


def _next_layer(space: Space, number: int, before: _Layer, solve: Solve, connects: Connects) -> _Layer:
    rows: list[Floats] = []
    costs: list[float] = []
    parents: list[int] = []
    for row in solve(number, before.rows[before.costs.argmin()]):
        way = np.linalg.norm(space.weights * space.difference(row, before.rows), axis=1)
        totals = before.costs + (way if number else _FIRST_STEP * way)
        for parent in np.argsort(totals).tolist():
            if number == 0 or connects(number, before.rows[parent], row):
                rows.append(row)
                costs.append(float(totals[parent]))
                parents.append(parent)
                break
    return _Layer(np.array(rows).reshape(-1, before.rows.shape[1]), np.array(costs), np.array(parents, dtype=np.intp))
