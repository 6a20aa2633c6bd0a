"""grasps-2: Which wrench does a contact push with?

A contact at `point` [m] pushes with `force` [N]. Return the wrench on the object: six numbers, first the force [N], and
then its torque about the centre of mass `centre` [N m]. All vectors are in the axes of the world.

    wrench([0, 0, 10], [0.1, 0, 0], [0, 0, 0])  is [0, 0, 10, 0, -1, 0]

By hand: numpy's functions are enough.
"""

import numpy as np


def wrench(force, point, centre):
    """Return force and torque, shape (6,)."""
    return np.concatenate([force, np.cross(point - centre, force)])
