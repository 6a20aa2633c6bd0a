"""ja-2: What does a single joint do to a point?

A revolute joint turns with 1 rad/s about an axis. Given are a unit vector along the axis, the anchor (a point on the
axis), and a point that the joint carries, arrays of three numbers in the world [m]. Return six numbers: the velocity of
the point [m/s], then the angular velocity [rad/s]. That is the joint's column of the Jacobian.

    column([0, 0, 1], [0, 0, 0], [2, 0, 0])  is [0, 2, 0, 0, 0, 1]
    column([0, 0, 1], [2, 0, 5], [2, 0, 0])  is [0, 0, 0, 0, 0, 1]: the point is on the axis

By hand: numpy's functions are enough.
"""

import numpy as np


def column(axis, anchor, point):
    """Return the velocity of the point and the angular velocity, shape (6,)."""
    ...
