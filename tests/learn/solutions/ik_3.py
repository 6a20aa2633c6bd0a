"""ik-3: Which joint values take the hand of two links there?

The arm is that of fk-1: q1 is measured from the x-axis, q2 from the first link [rad], l1 and l2 are the lengths of the
links [m]. Return all solutions [q1, q2] for a hand at x, y: a list of two, in any order, or an empty list [] if the
goal is out of reach, too far or too near. Whole turns more or less do not matter.

    solutions(1, 1, 1, 1)  is [[0, pi / 2], [pi / 2, -pi / 2]]
    solutions(3, 0, 1, 1)  is []

By hand: numpy's functions are enough.
"""

import numpy as np


def solutions(x, y, l1, l2):
    """Return a list of the solutions [q1, q2]."""
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    if abs(cosine) > 1:
        return []
    found = []
    for q2 in (-np.arccos(cosine), np.arccos(cosine) - 2 * np.pi):
        q1 = np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2))
        found.append([q1, q2])
    return found
