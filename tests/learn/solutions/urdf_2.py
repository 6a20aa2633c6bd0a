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

    def c_s(angle):
        return np.cos(angle), np.sin(angle)

    (cr, sr), (cp, sp), (cy, sy) = map(c_s, (roll, pitch, yaw))
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return z @ y @ x
