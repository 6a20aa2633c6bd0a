"""ja-5: In which direction is the tool slowest?

Given are a Panda and the seven joint values of its arm [rad]. As in ja-4, joint velocities of length 1 give the tool
velocities that fill an ellipsoid. Return a unit vector along its shortest axis, in the world: in this direction, the
tool is slowest. Either sign is right.

The robot may be asked, with arm = robot.GetActiveManipulator():

    robot.SetDOFValues(q, range(7))
    arm.CalculateJacobian()         of the tool's origin, shape (3, 7)
"""

import numpy as np


def slowest_direction(robot, q):
    """Return a unit vector, shape (3,)."""
    robot.SetDOFValues(q, range(7))
    U = np.linalg.svd(robot.GetActiveManipulator().CalculateJacobian())[0]
    return -U[:, -1]
