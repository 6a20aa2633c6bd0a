"""Whole turns: equivalent angles within the limits of an arm."""

import itertools
from math import ceil, floor

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Bools, Floats, Ints

TOLERANCE = 1e-10
"""Tolerance of limits [rad or m]; values within it are clamped."""
_TURN = 2 * np.pi


def nearest_turns(
    chain: Chain, values: Floats, near: Floats | float = 0.0, *, tolerance: float = TOLERANCE
) -> tuple[Floats, Bools]:
    """Shift revolute joints by whole turns into their limits, as near as possible to reference values.

    Circular joints have no limits; they are wrapped to [-pi, pi].

    Args:
        chain: The arm.
        values: Joint values, shape (..., n).
        near: Reference joint values, which broadcast against ``values``.
        tolerance: Tolerance of limits.

    Returns:
        The values, and for each row whether all are within the limits, shape (...).
    """
    lower, upper = chain.bounds
    with np.errstate(invalid="ignore"):
        least = np.ceil((lower - tolerance - values) / _TURN)
        most = np.floor((upper + tolerance - values) / _TURN)
        wanted = np.round((np.where(chain.circular, 0.0, near) - values) / _TURN)
        turns = np.minimum(np.maximum(wanted, least), np.maximum(most, least)) * chain.turning
        moved = values + _TURN * turns
        good = (moved >= lower - tolerance) & (moved <= upper + tolerance)
    return np.minimum(np.maximum(moved, lower), upper), np.logical_and.reduce(good, axis=-1)


def beyond_limits(chain: Chain, values: Floats) -> Floats:
    """Return the largest violation of limits in configurations (..., n) [rad, or m divided by the reach], shape (...).

    Angles are measured to the nearer limit, regardless of turns. Violations within the tolerance of ``nearest_turns``
    are 0.
    """
    lower, upper = chain.bounds
    turned = np.minimum(*_turns_beyond(chain, values))
    slid = np.maximum(np.maximum(lower - values, values - upper) - TOLERANCE, 0.0) / chain.reach
    return np.where(chain.prismatic, slid, turned).max(axis=-1, initial=0.0)


def clamped(chain: Chain, values: Floats) -> Floats:
    """Return configurations (..., n) within the limits; angles outside them move to the nearer limit."""
    below, above = _turns_beyond(chain, values)
    return np.where(chain.turning & (below < above), chain.bounds[0], nearest_turns(chain, values)[0])


def _turns_beyond(chain: Chain, values: Floats) -> tuple[Floats, Floats]:
    """Return how far angles are below the lower and above the upper limits, modulo full turns, in [0, 2 pi].

    Both are 0 if the angle plus some number of full turns is within the limits.
    """
    lower, upper = chain.bounds
    below, above = lower - values, values - upper
    with np.errstate(invalid="ignore"):
        fits = np.ceil((below - TOLERANCE) / _TURN) <= np.floor((TOLERANCE - above) / _TURN)
        below -= _TURN * np.floor(below / _TURN)  # as ``np.mod``, which takes several times as long
        above -= _TURN * np.floor(above / _TURN)
    return np.where(fits, 0.0, below), np.where(fits, 0.0, above)


def all_turns(chain: Chain, values: Floats) -> Floats:
    """Return all equivalents of configurations ``values`` (N, n) within the limits, shape (K, n).

    A revolute joint with a range of more than a turn has several values, a circular joint one, in [-pi, pi].
    """
    return all_turns_with_sources(chain, values)[0]


def all_turns_with_sources(chain: Chain, values: Floats) -> tuple[Floats, Ints]:
    """Return the rows of ``all_turns``, and for each the index of its row in ``values``, shape (K,)."""
    lower, upper = chain.bounds
    first, inside = nearest_turns(chain, values)
    rows, sources = first[inside], np.flatnonzero(inside)
    for joint in chain.wide:
        low, high = float(lower[joint]), float(upper[joint])
        steps = [
            range(ceil((low - TOLERANCE - value) / _TURN), floor((high + TOLERANCE - value) / _TURN) + 1)
            for value in rows[:, joint].tolist()
        ]
        counts = list(map(len, steps))
        if any(count > 1 for count in counts):
            turns = np.array(list(itertools.chain.from_iterable(steps)))
            rows, sources = np.repeat(rows, counts, axis=0), np.repeat(sources, counts)
            rows[:, joint] = np.minimum(np.maximum(rows[:, joint] + _TURN * turns, low), high)
    return rows, sources


def distances(chain: Chain, values: Floats, start: Floats, weights: Floats | None = None) -> Floats:
    """Return weighted distances (...) of joint values (..., n) from ``start``; circular joints take the shorter arc."""
    away = values - start
    away = np.where(chain.circular, np.mod(away + np.pi, _TURN) - np.pi, away)
    return np.sqrt((away * away * (1.0 if weights is None else weights * weights)).sum(axis=-1))
