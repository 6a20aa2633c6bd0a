"""fk-1: Where is the hand of an arm with two links?

The arm moves in the plane. Its first joint is at the origin; its links have lengths l1 and l2 [m]. The angle q1 is
measured from the x-axis to the first link, q2 from the first link to the second one, both counterclockwise [rad].

    hand_position(0, 0, 1.0, 0.5)        is [1.5, 0]
    hand_position(np.pi / 2, 0, 1, 0.5)  is [0, 1.5]

By hand: numpy's functions are enough.
"""

import numpy as np


def hand_position(q1, q2, l1, l2):
    """Return the position of the hand [m], an array of x and y."""
    return [l1 * np.cos(q1) + l2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 * np.sin(q1 + q2)]
