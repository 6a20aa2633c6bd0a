"""ik-4: Which joint values give the hand a direction, too?

The arm has three links in the plane, of lengths l1, l2 and l3 [m]; each angle is measured from the link before, the
first one from the x-axis [rad]. Given are the position x, y of the hand at the end of the third link, and the direction
phi of that link, measured from the x-axis. Return all solutions [q1, q2, q3] in a list, in any order: two, or [] if the
wrist is out of reach. Whole turns more or less do not matter.

    solutions(1, 1.5, np.pi / 2, 1, 1, 0.5)  is [[0, pi / 2, 0], [pi / 2, -pi / 2, pi / 2]]

By hand: numpy's functions are enough, and what you wrote for ik-3: from ik_3 import solutions as of_two_links.
"""

import numpy as np


def solutions(x, y, phi, l1, l2, l3):
    """Return a list of the solutions [q1, q2, q3]."""
    x, y = x - l3 * np.cos(phi), y - l3 * np.sin(phi)
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    if abs(cosine) > 1:
        return []
    found = []
    for q2 in (-np.arccos(cosine), np.arccos(cosine) - 2 * np.pi):
        q1 = np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2))
        found.append([q1, q2, phi - q1 - q2])
    return found
