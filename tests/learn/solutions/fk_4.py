"""fk-4: Where is the tool of a SCARA?

A SCARA has two links that move in a horizontal plane, and a quill at the end that goes up and down and turns. With all
values 0, the arm lies along x: joint 1 at the origin, joint 2 at x = 0.425, joints 3 and 4 at x = 0.8, the tool below
these at the height z = 0.677 [m]. The axis of joint 1 points up; those of joints 2, 3 and 4 point down: 2 and 4 turn
about them [rad], 3 slides along its own [m]. The tool looks down: its z-axis points down, its x-axis along x.

    tool_pose(0, 0, 0.1, 0)  has the position [0.8, 0, 0.577], and the rotation [[1, 0, 0], [0, -1, 0], [0, 0, -1]]

By hand: numpy's functions are enough. Whether you have read the axes well, the robot decides: ravemj view scara
"""

import numpy as np


def tool_pose(q1, q2, q3, q4):
    """Return T_world_tool, shape (4, 4)."""
    elbow, hand, tool = q1, q1 - q2, q1 - q2 - q4
    x = 0.425 * np.cos(elbow) + 0.375 * np.cos(hand)
    y = 0.425 * np.sin(elbow) + 0.375 * np.sin(hand)
    c, s = np.cos(tool), np.sin(tool)
    return [[c, s, 0, x], [s, -c, 0, y], [0, 0, -1, 0.677 - q3], [0, 0, 0, 1]]
