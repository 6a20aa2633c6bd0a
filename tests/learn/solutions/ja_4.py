"""ja-4: How long are the semi-axes of the manipulability ellipsoid?

Given is the Jacobian of the position of an arm's tool, shape (3, 7) [m/rad]. Of all joint velocities whose length is 1
(np.linalg.norm(qd) == 1), each gives the tool a velocity, and these fill an ellipsoid. Return the lengths of its three
semi-axes [m/s], the longest one first.

    semi_axes([[0, 0, 3], [0, 2, 0], [1, 0, 0]])  is [3, 2, 1]

By hand: numpy's functions are enough.
"""

import numpy as np


def semi_axes(J):
    """Return the lengths of the semi-axes, the longest one first, shape (3,)."""
    return np.linalg.svd(J, compute_uv=False)
