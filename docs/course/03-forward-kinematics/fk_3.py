"""fk-3: Where is the tool, seen from a link?

Given are a Panda, the seven joint values of its arm [rad], and the name of one of its links, such as "link4". Set the
joint values, and return the pose of the tool in the frame of that link, shape (4, 4) [m]. Seen from the hand, that is a
shift by 0.1034 along z, whatever the joint values are.

The robot may be asked:

    robot.SetDOFValues(q, range(7))
    robot.GetLink(name).GetTransform()                 its pose in the world
    robot.GetActiveManipulator().GetTransform()        the tool's pose in the world
"""

import numpy as np


def tool_in_link(robot, q, name):
    """Return T_link_tool, shape (4, 4)."""
    ...
