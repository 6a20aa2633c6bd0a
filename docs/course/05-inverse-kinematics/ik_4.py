"""ik-4: Which joint values give the hand a direction, too?

The arm has three links in the plane, of lengths l1, l2 and l3 [m]; each angle is measured from the link before, the
first one from the x-axis [rad]. Given are the position x, y of the hand at the end of the third link, and the direction
phi of that link, measured from the x-axis. Return all solutions [q1, q2, q3] in a list, in any order: two, or [] if the
wrist is out of reach. Whole turns more or less do not matter.

    solutions(1, 1.5, np.pi / 2, 1, 1, 0.5)  is [[0, np.pi / 2, 0], [np.pi / 2, -np.pi / 2, np.pi / 2]]

By hand: numpy's functions are enough, and what you wrote for ik-3: from ik_3 import solutions as of_two_links.
"""

import numpy as np


def solutions(x, y, phi, l1, l2, l3):
    """Return a list of the solutions [q1, q2, q3]."""
    ...
