"""motions-1: Where is the robot at a time?

A motion has waypoints: increasing times [s], shape (n,), and the joint values at each of them, shape (n, dof). Between
two waypoints the joint values change linearly; before the first and after the last one the robot stands still there.

    joint_values([0, 2, 3], [[0, 1], [4, 1], [4, 0]], 1)    is [2, 1]
    joint_values([0, 2, 3], [[0, 1], [4, 1], [4, 0]], 2.5)  is [4, 0.5]
    joint_values([0, 2, 3], [[0, 1], [4, 1], [4, 0]], 9)    is [4, 0]

By hand: numpy's functions are enough.
"""

import numpy as np


def joint_values(times, waypoints, t):
    """Return the joint values at time t, shape (dof,)."""
    ...
