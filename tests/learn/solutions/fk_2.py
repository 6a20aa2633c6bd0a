"""fk-2: Where is the hand of an arm in space?

The arm stands on a column: joint 1 turns about the vertical z-axis of the world. At the height h is joint 2, and from
there the upper arm of length a lies along x; at its end is joint 3, and from there the forearm of length b, along x
too. Both turn about the y-axis. The hand's frame is at the end of the forearm, with the same axes.

    hand_pose(0, 0, 0, 0.5, 0.4, 0.3)          has the position [0.7, 0, 0.5] and no rotation
    hand_pose(0, np.pi / 2, 0, 0.5, 0.4, 0.3)  has the position [0, 0, -0.2]: the arm hangs down

By hand, from angles [rad] and lengths [m]: numpy's functions are enough. Write two helpers: a turn, and a shift.
"""

import numpy as np


def hand_pose(q1, q2, q3, h, a, b):
    """Return T_world_hand, shape (4, 4)."""

    def shift(x, y, z):
        T = np.eye(4)
        T[:3, 3] = x, y, z
        return T

    def turn_y(angle):
        T = np.eye(4)
        c, s = np.cos(angle), np.sin(angle)
        T[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
        return T

    c, s = np.cos(q1), np.sin(q1)
    turn_z = np.eye(4)
    turn_z[:2, :2] = [[c, -s], [s, c]]
    return turn_z @ shift(0, 0, h) @ turn_y(q2) @ shift(a, 0, 0) @ turn_y(q3) @ shift(b, 0, 0)
