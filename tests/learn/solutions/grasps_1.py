"""grasps-1: Can two fingers hold there?

Two fingers touch an object at the points `first` and `second` [m]. The surface has the unit normals `first_normal` and
`second_normal` there, which point out of the object, towards the fingers. Return whether the line between the points is
inside both friction cones: its angle with each of the normals is less than atan(friction), as the fingers push against
the normals.

    is_antipodal([0, 0, 0], [-1, 0, 0], [0.04, 0, 0], [1, 0, 0], 0.5)  is True
    is_antipodal([0, 0, 0], [1, 0, 0], [0.04, 0, 0], [-1, 0, 0], 0.5)  is False: the normals point into the object

By hand: numpy's functions are enough.
"""

import numpy as np


def is_antipodal(first, first_normal, second, second_normal, friction):
    """Return whether the two contacts can press against each other."""
    line = (second - first) / np.linalg.norm(second - first)
    least = np.cos(np.arctan(friction))
    return -first_normal @ line > least and second_normal @ line > least
