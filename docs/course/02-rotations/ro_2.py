"""ro-2: Where is what a camera sees?

A robot's hand carries a camera, and the camera sees a cup. Given are three poses, arrays of shape (4, 4): that of the
hand in the world, that of the camera in the frame of the hand, that of the cup in the frame of the camera [m]. Return
the pose of the cup in the world.

If all rotations are np.eye(3), the positions simply add up.

By hand: numpy's functions are enough.
"""

import numpy as np


def cup_in_world(T_world_hand, T_hand_camera, T_camera_cup):
    """Return T_world_cup, shape (4, 4)."""
    ...
