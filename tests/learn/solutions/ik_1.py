"""ik-1: Can the hand get there?

An arm with two links moves in the plane; its shoulder is at the origin, and both joints can turn all the way round.
Given are a position x, y for the hand, and the lengths l1 and l2 of the links [m]. Return True if the hand can be
there, and False if not.

    reachable(1.4, 0, 1.0, 0.5)  is True
    reachable(2.0, 0, 1.0, 0.5)  is False

By hand: numpy's functions are enough.
"""

import numpy as np


def reachable(x, y, l1, l2):
    """Return whether the hand can be at x, y."""
    return abs(l1 - l2) <= np.hypot(x, y) <= l1 + l2
