"""planning-2: Where does a step towards a sample end?

A tree grows from the joint values `node` towards `sample`, on a straight line, by the length `step` [rad]; if the
sample is nearer than that, only to the sample. Lengths are those of vectors of joint values. Return where it ends.

    steer([0, 0], [3, 4], 1.0)      is [0.6, 0.8]
    steer([0, 0], [0.3, 0.4], 1.0)  is [0.3, 0.4]

By hand: numpy's functions are enough.
"""

import numpy as np


def steer(node, sample, step):
    """Return the joint values of the new node, shape (dof,)."""
    ...
