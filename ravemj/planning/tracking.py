"""Paths of configurations that reach a sequence of goals without jumps."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.planning.space import Space

LARGEST_JUMP = 0.5
"""Maximum joint step between consecutive goals [rad or m]; a larger one is a change of branch."""

_FIRST_STEP = 1000.0
"""Weight of the motion to the first goal, so large that paths near the present configuration win."""

Solve = Callable[[int, Floats], Sequence[Floats]]
"""Function that returns configurations that reach a goal, given its index and a configuration to search near."""

Connects = Callable[[int, Floats, Floats], bool]
"""Test whether a solution of the previous goal connects to a solution of the goal with a given index."""


class _Layer(NamedTuple):
    """Layer of the planning graph: IK solutions of a goal, path costs, and parents' indices in the layer before."""

    rows: Floats
    costs: Floats
    parents: NDArray[np.intp]


def track(space: Space, count: int, start: Floats, solve: Solve, connects: Connects) -> Floats:
    """Return the shortest path through solutions of all goals, up to the first unreachable goal, shape (m, n).

    Paths whose first configuration is near ``start`` are preferred. The shortest paths to all solutions of a goal are
    kept, so that dead ends of one IK branch do not affect the others.
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
