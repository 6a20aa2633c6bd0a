"""Whole turns: which angles that show the same configuration are within the limits of an arm."""

import itertools
from math import ceil, floor

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Bools, Floats

TOLERANCE = 1e-10
"""How far [rad or m] values may be beyond a limit; they are put onto it."""
_TURN = 2 * np.pi


def nearest_turns(
    chain: Chain, values: Floats, near: Floats | float = 0.0, *, tolerance: float = TOLERANCE
) -> tuple[Floats, Bools]:
    """Move revolute joints by whole turns to where they are within their limits, and as near as possible to others.

    Circular joints have no limits; they come to [-pi, pi], so that their distance is that of angles.

    Args:
        chain: The arm.
        values: Joint values, shape (..., n).
        near: Joint values to be near to, which broadcast against them.
        tolerance: How far values may be beyond a limit.

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


def all_turns(chain: Chain, values: Floats) -> Floats:
    """Return all rows (K, n) that show the configurations of given rows and are within the limits.

    A revolute joint with a range of more than a turn gives several values, circular joints one, in [-pi, pi].
    """
    lower, upper = chain.bounds
    first, inside = nearest_turns(chain, values)
    rows = first[inside]
    for joint in chain.wide:
        low, high = float(lower[joint]), float(upper[joint])
        steps = [
            range(ceil((low - TOLERANCE - value) / _TURN), floor((high + TOLERANCE - value) / _TURN) + 1)
            for value in rows[:, joint].tolist()
        ]
        counts = list(map(len, steps))
        if any(count > 1 for count in counts):
            turns = np.array(list(itertools.chain.from_iterable(steps)))
            rows = np.repeat(rows, counts, axis=0)
            rows[:, joint] = np.minimum(np.maximum(rows[:, joint] + _TURN * turns, low), high)
    return rows


def distances(chain: Chain, values: Floats, start: Floats, weights: Floats | None = None) -> Floats:
    """Return weighted distances (...) of joint values (..., n) from others; circular joints take the shorter way."""
    away = values - start
    away = np.where(chain.circular, np.mod(away + np.pi, _TURN) - np.pi, away)
    return np.sqrt((away * away * (1.0 if weights is None else weights * weights)).sum(axis=-1))
