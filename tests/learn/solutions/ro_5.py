"""ro-5: Which quaternion is a rotation?

Given is a rotation matrix R, shape (3, 3), that turns by less than half a turn. Return the same rotation as a unit
quaternion in the order w, x, y, z. Either sign is right.

The sum of R's diagonal is 1 + 2 cos(a) for the angle a. And R - R.T is 2 sin(a) K, with K from the page.

    quaternion(np.eye(3))                            is [1, 0, 0, 0]
    quaternion([[0, -1, 0], [1, 0, 0], [0, 0, 1]])   is [0.7071, 0, 0, 0.7071]: a quarter about z

By hand: numpy's functions are enough.
"""

import numpy as np


def quaternion(R):
    """Return the quaternion w, x, y, z."""
    R = np.asarray(R)
    w = np.sqrt(1 + np.trace(R)) / 2
    return [w, *(np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4 * w))]
