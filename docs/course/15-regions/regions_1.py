"""regions-1: Where may a glass stand on a table?

A table has the lengths `length` in x and `width` in y [m]. The frame of the region has its origin in the middle of the
tabletop, and z points up. The frame of the glass has its origin in the middle of its bottom, which is a disk with the
radius `radius` [m]. The glass should stand on the table, with its whole bottom on it: upright, and turned about the
vertical as it likes. Return the bounds `Bw`.

The largest x of a glass of radius 0.03 on a table of length 0.8 is 0.37.

By hand: numpy's functions are enough.
"""

import numpy as np


def bounds(length, width, radius):
    """Return lower and upper bounds of x, y, z [m], roll, pitch, yaw [rad], shape (6, 2)."""
    ...
