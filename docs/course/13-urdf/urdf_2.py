"""urdf-2: Which rotation are roll, pitch and yaw?

`<origin rpy="roll pitch yaw"/>` turns a frame about the x axis by roll, then about the y axis by pitch, then about the
z axis by yaw [rad]; all three axes stand still. Return the rotation matrix, which takes vectors of the turned frame to
the frame of the parent.

    rotation(np.pi / 2, 0, 0) @ [0, 1, 0]          is [0, 0, 1]
    rotation(np.pi / 2, 0, np.pi / 2) @ [1, 0, 0]  is [0, 1, 0]

By hand: numpy's functions are enough.
"""

import numpy as np


def rotation(roll, pitch, yaw):
    """Return the rotation matrix, shape (3, 3)."""
    ...
