"""regions-3: How are poses drawn from a region?

Given are the poses T0_w and Tw_e and the bounds Bw of a region, as on the page. Return `count` poses of the tool in the
region, drawn by chance: each of the six numbers is distributed evenly between its bounds, and they do not depend on one
another.

A region all of whose bounds are 0 has only one pose, T0_w @ Tw_e.

By hand: numpy's functions are enough. `np.random.default_rng().uniform(lower, upper)` draws evenly, and
`ravemj.matrixFromAxisAngle([0, 0, yaw])` is the pose of a turn about z.
"""

import numpy as np

import ravemj


def sample(T0_w, Tw_e, Bw, count):
    """Return poses of the tool in the world, shape (count, 4, 4)."""
    ...
