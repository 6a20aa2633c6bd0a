"""statics-1: Where is the centre of mass of an arm?

Given are the links of an arm: their masses [kg], shape (n,); the poses of their frames in the world, shape (n, 4, 4);
and their centres of mass [m], shape (n, 3), each in the frame of its own link. Return the centre of mass of the whole
arm in the world.

With two links of 1 kg and 3 kg, whose frames are not rotated and have their origins at [0, 0, 0] and [1, 0, 0], and
with centres of mass [0.5, 0, 0] in each, it is [1.25, 0, 0].

By hand: numpy's functions are enough.
"""

import numpy as np


def centre_of_mass(masses, T_world_links, centres):
    """Return the centre of mass of all links in the world [m], shape (3,)."""
    ...
