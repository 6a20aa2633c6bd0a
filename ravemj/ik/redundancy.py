"""What is left open: joints that can have any value, and postures in which two joints turn about one line."""

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.tasks import Task
from ravemj.ik.vectors import Floats

SINGULAR_STEP = np.pi / 8
"""Where two joints turn about one line, the first of them is shown at every such angle."""
_COAXIAL = 1e-9
_POSTURES = 4


def rank(chain: Chain, task: Task) -> int:
    """Return how many independent motions of the tool that count the joints can make."""
    values = np.random.default_rng(7).uniform(-3, 3, (_POSTURES, chain.dof)) * np.where(chain.prismatic, 0.1, 1.0)
    _, jacobians = chain.forward_and_jacobian(values)
    scaled = jacobians * np.array([1 / chain.reach] * 3 + [1.0] * 3)[:, None]
    return int(np.linalg.matrix_rank(scaled[:, list(task.rows)], tol=1e-4).max(initial=0))


def choices(chain: Chain, task: Task) -> Iterator[tuple[int, ...]]:
    """Return sets of joints that can be left free, so many that the others are not too many.

    The last joint comes first and the first one second: with these locked, the geometry of the rest does not depend on
    their value. The others follow from the tool to the base.
    """
    count = chain.dof - rank(chain, task)
    order = [chain.dof - 1, 0, *range(chain.dof - 2, 0, -1)][: chain.dof]
    for chosen in itertools.combinations(order, count):
        yield tuple(sorted(chosen))


def samples(chain: Chain, free: Sequence[int], steps: Sequence[float], start: Floats | None = None) -> Floats:
    """Return values of free joints within their limits: a start, or 0, then a step more, a step less, and so on.

    Args:
        chain: The arm.
        free: The free joints, k of them.
        steps: A step for each [rad or m].
        start: Values to start at, shape (k,).

    Returns:
        Values, shape (K, k); one row of no values if there is no free joint. The last of several joints changes first.
    """
    columns: list[list[float]] = []
    for index, (joint, step) in enumerate(zip(free, steps, strict=True)):
        low, high = chain.lower[joint], chain.upper[joint]
        if chain.circular[joint] or (not chain.prismatic[joint] and high - low > 2 * np.pi):
            low, high = -np.pi, np.pi
        centre = float(np.clip(0.0 if start is None else start[index], low, high))
        up = centre + step * np.arange(1, int((high - centre) / step + 1e-9) + 1)
        down = centre - step * np.arange(1, int((centre - low) / step + 1e-9) + 1)
        both = itertools.zip_longest(up.tolist(), down.tolist())
        columns.append([centre, *(value for pair in both for value in pair if value is not None)])
    return np.array(list(itertools.product(*columns)), dtype=float).reshape(-1, len(columns))


def coaxial_joints(chain: Chain, values: Floats) -> tuple[int, int, float] | None:
    """Find two joints that turn about the same line in a posture, shape (n,).

    Returns:
        The joints, and 1 or -1 for the same or the opposite direction; None if there are none.
    """
    axes, points = chain.placed_axes(values)
    turning = np.nonzero(~chain.prismatic)[0]
    for first, second in itertools.combinations(turning.tolist(), 2):
        away = np.cross(axes[first], points[second] - points[first]) / chain.reach
        if np.abs(np.cross(axes[first], axes[second])).max() < _COAXIAL and np.abs(away).max() < _COAXIAL:
            return first, second, float(np.sign(axes[first] @ axes[second]))
    return None


def spread(chain: Chain, row: Floats, at: Sequence[float] = ()) -> Floats:
    """Return postures (K, n) with the tool's pose of one (n,): where two joints turn about one line, those between them.

    Args:
        chain: The arm.
        row: Joint values.
        at: More values that the first of the two joints shall have.
    """
    found = coaxial_joints(chain, row)
    if found is None:
        return row[None]
    first, second, sign = found
    angles = np.array([*np.arange(-np.pi + SINGULAR_STEP, np.pi + 1e-9, SINGULAR_STEP), *at, row[first]])
    rows = np.repeat(row[None], len(angles), axis=0)
    rows[:, first] = angles
    rows[:, second] -= sign * (angles - row[first])
    return rows
