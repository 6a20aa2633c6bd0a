"""collisions-1: How far apart are two boxes?

The sides of both boxes are parallel to the axes. Each box has a centre [m] and extents [m], which are half of its
lengths in x, y and z. Return the distance of the nearest points of the two boxes [m]; 0 if they touch or overlap.

    distance([0, 0, 0], [1, 1, 1], [4, 0, 0], [1, 1, 1])  is 2
    distance([0, 0, 0], [1, 1, 1], [5, 6, 0], [1, 1, 1])  is 5: 3 m in x and 4 m in y
    distance([0, 0, 0], [1, 1, 1], [1, 1, 1], [1, 1, 1])  is 0

By hand: numpy's functions are enough.
"""

import numpy as np


def distance(centre1, extents1, centre2, extents2):
    """Return the distance of two boxes [m]."""
    gaps = np.abs(np.subtract(centre2, centre1)) - extents1 - extents2
    return np.linalg.norm(np.maximum(gaps, 0))
