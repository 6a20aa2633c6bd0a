"""ja-1: How does the hand move when two joints turn?

The arm is that of fk-1: it moves in the plane, its links have lengths l1 and l2 [m], q1 is measured from the x-axis and
q2 from the first link [rad]. Return its Jacobian, shape (2, 2) [m/rad]: the rows are x and y of the hand, the columns
are the velocities that q1 and q2 give it.

    jacobian(0, 0, 1.0, 0.5)          is [[0, 0], [1.5, 0.5]]
    jacobian(np.pi / 2, 0, 1.0, 0.5)  is [[-1.5, -0.5], [0, 0]]

By hand: numpy's functions are enough.
"""

import numpy as np


def jacobian(q1, q2, l1, l2):
    """Return the derivatives of the hand's position, shape (2, 2)."""
    s1, c1 = l1 * np.sin(q1), l1 * np.cos(q1)
    s12, c12 = l2 * np.sin(q1 + q2), l2 * np.cos(q1 + q2)
    return [[-s1 - s12, -s12], [c1 + c12, c12]]
