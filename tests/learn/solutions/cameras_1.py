"""cameras-1: At which pixel is a point seen?

Given are the camera matrix K, shape (3, 3); the pose of the camera in the world, shape (4, 4), which looks along its
z axis with x to the right and y down; and a point in the world [m] in front of it. Return its pixel [u, v],
not rounded.

With K = [[300, 0, 160], [0, 300, 120], [0, 0, 1]] and a camera at the origin whose axes are those of the world, the
point [0, 0, 2] is seen at [160, 120], and [0.2, 0.1, 1] at [220, 150].

By hand: numpy's functions are enough.
"""

import numpy as np


def pixel(K, T_world_camera, point):
    """Return the pixel at which the point is seen, shape (2,)."""
    x, y, z, _ = np.linalg.inv(T_world_camera) @ [*point, 1]
    u, v, w = K @ [x, y, z]
    return [u / w, v / w]
