"""ja-3: How fast is the tool of a robot?

Given are a Panda, the seven joint values q of its arm [rad], and their velocities qd [rad/s]. Return the velocity of
the origin of the tool in the world, three numbers [m/s].

The robot may be asked, with arm = robot.GetActiveManipulator():

    robot.SetDOFValues(q, range(7))
    arm.CalculateJacobian()         of the tool's origin, shape (3, 7)
    arm.GetTransform()              the tool's pose in the world
"""

import numpy as np


def tool_velocity(robot, q, qd):
    """Return the velocity of the tool's origin in the world [m/s], shape (3,)."""
    ...
