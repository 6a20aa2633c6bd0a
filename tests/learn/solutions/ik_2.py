"""ik-2: Where can the elbow be?

An arm with two links moves in the plane; its shoulder is at the origin, its hand is at x, y. The elbow is at the
distance l1 from the shoulder and l2 from the hand [m]: where two circles meet. Return both points, shape (2, 2), one in
each row, in any order. The hand is in reach.

    elbows(1, 1, 1, 1)  is [[1, 0], [0, 1]]

By hand: numpy's functions are enough. No angle is needed.
"""

import numpy as np


def elbows(x, y, l1, l2):
    """Return both positions of the elbow [m], shape (2, 2)."""
    d = np.hypot(x, y)
    u, v = np.array([x, y]) / d, np.array([-y, x]) / d
    a = (d**2 + l1**2 - l2**2) / (2 * d)
    h = np.sqrt(l1**2 - a**2)
    return [a * u + h * v, a * u - h * v]
