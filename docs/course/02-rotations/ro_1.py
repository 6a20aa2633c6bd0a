"""ro-1: Which matrix turns about a given axis?

Given are the direction of an axis, an array of three numbers of any length but 0, and an angle [rad], positive
counterclockwise for somebody at whom the axis points. Return the rotation matrix, shape (3, 3).

    rotation([0, 0, 1], np.pi / 2)  is [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    rotation([0, 0, 5], np.pi / 2)  is [[0, -1, 0], [1, 0, 0], [0, 0, 1]]

By hand: numpy's functions are enough.
"""

import numpy as np


def rotation(axis, angle):
    """Return the rotation matrix, shape (3, 3)."""
    ...
