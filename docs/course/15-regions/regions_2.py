"""regions-2: Is a pose in a region?

Given are the poses T0_w and Tw_e and the bounds Bw of a region, as on the page, and the pose of a tool in the world.
Return whether the tool is in the region: whether there is a D with T_world_tool = T0_w @ D @ Tw_e, all of whose six
numbers are within their bounds. All bounds of angles are between -pi and pi, those of pitch between -1.5 and 1.5.

If D has the rotation R, its angles are roll = atan2(R[2, 1], R[2, 2]), pitch = -asin(R[2, 0]), and
yaw = atan2(R[1, 0], R[0, 0]), with indices that begin with 0.

By hand: numpy's functions are enough.
"""

import numpy as np


def contains(T0_w, Tw_e, Bw, T_world_tool):
    """Return whether the tool is in the region."""
    ...
