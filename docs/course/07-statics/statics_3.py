"""statics-3: What does the gripper weigh at the wrist?

The last link of the Panda, `link7`, carries the gripper: the links `hand`, `left_finger` and `right_finger`. Which
force [N], and which torque about the origin of `link7` [N m], hold the gripper still, in the axes of the world? Put the
robot into the configuration `values` first, with `SetDOFValues`; g is 9.81 m/s^2.

The force is [0, 0, 7.4556] always. With [0, 0, 0, -np.pi / 2, 0, np.pi, 0, 0] the hand points along x, and the torque
is [-0.0506, -1.0365, 0].

The robot may be asked: links have `GetMass()`, `GetLocalCOM()`, `GetGlobalCOM()` and `GetTransform()`.
"""

import numpy as np


def wrench_at_wrist(robot, values):
    """Return the force and then the torque, shape (6,)."""
    ...
