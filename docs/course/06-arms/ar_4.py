"""ar-4: Where else can the elbow be?

Given are a Panda and the seven joint values of its arm [rad]. Return other joint values, shape (7,), within the limits,
that have the same pose of the tool, but the elbow somewhere else, at least 0.05 m away. The elbow is the origin of
link4. Any such joint values are right.

The robot may be asked, with arm = robot.GetActiveManipulator():

    robot.SetDOFValues(q, range(7))
    arm.GetTransform()                            the pose of the tool
    arm.ik(T_world_tool)                          its solutions and valid are explained on the page
    robot.GetLink("link4").GetTransform()[:3, 3]  the elbow
"""

import numpy as np


def other_elbow(robot, q):
    """Return joint values with the same pose of the tool, and another elbow [rad], shape (7,)."""
    ...
