"""planning-1: Which node of a tree is nearest?

Given are the nodes of a tree, joint values of shape (n, dof), and a sample, of shape (dof,) [rad]. All joints turn
without limits, like those of the pendulum, so an angle and the same angle plus whole turns are one configuration.
The distance is the length of the vector of the smallest turns of the joints. Return the index of the nearest node.

    nearest([[0, 0], [1, 1], [3, 3]], [1.1, 0.8])  is 1
    nearest([[0, 0], [1, 1], [3, 3]], [-3, -3])    is 2: it is only 0.28 rad away in each joint

By hand: numpy's functions are enough.
"""

import numpy as np


def nearest(nodes, sample):
    """Return the index of the node that is nearest to the sample."""
    ...
