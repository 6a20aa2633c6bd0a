"""planning-3: Can you find a path around the boxes?

The double pendulum hangs among three boxes. Return a path from the joint values `start` to `goal`, shape (n, 2) [rad],
on whose straight lines it touches no box. All angles may be between -pi and pi; the straight line is always blocked.

Check the straight lines of your path in steps of at most 0.04 rad; it is examined a little more kindly. A path does not
go on from pi to -pi. All 20 paths together may take 10 s.

The robot may be asked: `robot.SetDOFValues(values)`, then `robot.GetEnv().CheckCollision(robot)`. Leave the planners of
ravemj for later; about forty lines will do, in as many functions as you like.
"""

import numpy as np


def plan(robot, start, goal):
    """Return the waypoints of a path from start to goal, shape (n, 2)."""
    ...
