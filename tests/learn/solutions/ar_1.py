"""ar-1: In how many ways does a PUMA reach a pose?

Given are a PUMA 560 and a pose for its tool in the world, shape (4, 4). Return all joint values within the limits that
take the tool there, a solution in each row, shape (ways, 6), in any order. Of solutions that differ by whole turns, one
is enough.

The robot may be asked:

    arm = robot.GetActiveManipulator()
    found = arm.ik(T_world_tool)      with found.solutions and found.valid, as on the page
"""

import numpy as np


def all_ways(robot, T_world_tool):
    """Return the joint values of all ways [rad], shape (ways, 6)."""
    found = robot.GetActiveManipulator().ik(T_world_tool)
    return found.solutions[0][found.valid[0]]
