"""collisions-3: Where on a straight line does the robot first collide?

The Panda moves on a straight line from the joint values `start` to `goal`, in 40 equal steps. Check its configurations
0 (the start), 1, ..., 40 (the goal). Return the number of the first one in which the robot touches anything in its
environment, or itself; -1 if there is none. A post of 10 cm x 10 cm stands in front of the Panda.

From [-1.5, 0.5, 0, -1.5, 0, 2, 0, 0] to [1.5, 0.5, 0, -1.5, 0, 2, 0, 0] it is 17, and from there back as well.

The robot may be asked: `robot.SetDOFValues(values)`, `robot.CheckSelfCollision()`, and for what else it touches
`robot.GetEnv().CheckCollision(robot)`.
"""

import numpy as np


def first_collision(robot, start, goal):
    """Return the number of the first configuration in collision, or -1."""
    ...
