"""Whole turns: which angles that show the same posture are within the limits of an arm."""

import itertools

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Bools, Floats

TOLERANCE = 1e-10
"""How far [rad or m] values may be beyond a limit; they are put onto it."""
_TURN = 2 * np.pi


def _bounds(chain: Chain) -> tuple[Floats, Floats]:
    lower = np.where(chain.circular, -np.inf, chain.lower)
    return lower, np.where(chain.circular, np.inf, chain.upper)


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
    lower, upper = _bounds(chain)
    turning = ~chain.prismatic
    with np.errstate(invalid="ignore"):
        least = np.ceil((lower - tolerance - values) / _TURN)
        most = np.floor((upper + tolerance - values) / _TURN)
        wanted = np.round((np.where(chain.circular, 0.0, near) - values) / _TURN)
        turns = np.clip(wanted, least, np.maximum(most, least)) * turning
        moved = values + _TURN * turns
        good = (moved >= lower - tolerance) & (moved <= upper + tolerance)
    return np.clip(moved, lower, upper), np.logical_and.reduce(good, axis=-1)


def all_turns(chain: Chain, values: Floats) -> Floats:
    """Return all rows (K, n) that show the postures of given rows and are within the limits.

    A revolute joint with a range of more than a turn gives several values, several such joints all combinations.
    Circular joints give one value, in [-pi, pi].
    """
    lower, upper = _bounds(chain)
    first, inside = nearest_turns(chain, values)
    rows = first[inside]
    turning = ~chain.prismatic & ~chain.circular
    more = turning & ((rows - _TURN >= lower - TOLERANCE) | (rows + _TURN <= upper + TOLERANCE)).any(axis=0)
    for joint in np.nonzero(more)[0]:
        least = np.ceil((lower[joint] - TOLERANCE - rows[:, joint]) / _TURN).astype(int)
        most = np.floor((upper[joint] + TOLERANCE - rows[:, joint]) / _TURN).astype(int)
        counts = most - least + 1
        steps = np.fromiter(itertools.chain.from_iterable(map(range, least, most + 1)), int, counts.sum())
        rows = np.repeat(rows, counts, axis=0)
        rows[:, joint] = np.clip(rows[:, joint] + _TURN * steps, lower[joint], upper[joint])
    return rows


def distances(chain: Chain, values: Floats, start: Floats, weights: Floats | None = None) -> Floats:
    """Return weighted distances (...) of joint values (..., n) from others; circular joints take the shorter way."""
    away = values - start
    away = np.where(chain.circular, np.mod(away + np.pi, _TURN) - np.pi, away)
    return np.sqrt((away * away * (1.0 if weights is None else weights * weights)).sum(axis=-1))
