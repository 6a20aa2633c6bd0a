"""ar-3: How can an arm move while its tool stays?

Given are a Panda and the seven joint values of its arm [rad]. Return joint velocities of length 1, shape (7,), that
leave the tool where it is, its position and its rotation. Either sign is right.

The robot may be asked, with arm = robot.GetActiveManipulator():

    robot.SetDOFValues(q, range(7))
    arm.CalculateJacobian()                    of the tool's position, shape (3, 7)
    arm.CalculateAngularVelocityJacobian()     of its rotation, shape (3, 7)
"""

import numpy as np


def self_motion(robot, q):
    """Return joint velocities of length 1 that do not move the tool, shape (7,)."""
    robot.SetDOFValues(q, range(7))
    arm = robot.GetActiveManipulator()
    J = np.vstack([arm.CalculateJacobian(), arm.CalculateAngularVelocityJacobian()])
    return -np.linalg.svd(J)[2][-1]
