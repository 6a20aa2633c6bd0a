"""ro-4: Where is a cup for the hand that is to take it?

Given are the poses of a hand and of a cup in the world, arrays of shape (4, 4) [m]. Return the pose of the cup in
the frame of the hand. Its position is how far the hand has to move, along its own axes, to be where the cup is.

If the two are the same, the result is np.eye(4). If neither is turned, its position is the difference of the two.

By hand: numpy's functions are enough.
"""

import numpy as np


def cup_in_hand(T_world_hand, T_world_cup):
    """Return T_hand_cup, shape (4, 4)."""
    return np.linalg.inv(T_world_hand) @ T_world_cup
