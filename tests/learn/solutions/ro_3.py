"""ro-3: What is the inverse of a pose?

Given is the pose of a link in the world, shape (4, 4) [m]. Return the pose of the world in the frame of the link, which
is its inverse. No system of equations has to be solved for that: a transpose and a product are enough, and the
last row stays 0 0 0 1. (np.linalg.inv would give the same numbers. Do without it, once in your life.)

For the identity as rotation and the position [1, 2, 3], the result has the position [-1, -2, -3].

By hand: numpy's functions are enough.
"""

import numpy as np


def inverse(T_world_link):
    """Return T_link_world, shape (4, 4)."""
    R, p = T_world_link[:3, :3], T_world_link[:3, 3]
    T_link_world = np.eye(4)
    T_link_world[:3, :3] = R.T
    T_link_world[:3, 3] = -R.T @ p
    return T_link_world
