"""cameras-2: Which point does a depth camera see?

Given are the camera matrix K, shape (3, 3); the pose of the camera in the world, shape (4, 4), which looks along its
z axis with x to the right and y down; a pixel [u, v]; and its depth [m], measured along the z axis of the camera.
Return the point in the world.

With K = [[300, 0, 160], [0, 300, 120], [0, 0, 1]] and a camera at the origin whose axes are those of the world, the
pixel [160, 120] with depth 2 shows [0, 0, 2], and [220, 150] with depth 1 shows [0.2, 0.1, 1].

By hand: numpy's functions are enough.
"""

import numpy as np


def seen_point(K, T_world_camera, pixel, depth):
    """Return the point that the pixel shows, in the world [m], shape (3,)."""
    ...
