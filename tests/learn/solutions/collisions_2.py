"""collisions-2: How many steps do not overlook a wall?

A robot moves on a straight line from the joint values `start` to `goal` [rad]. It is checked for collisions at n + 1
configurations, which divide the line into n equal steps. No point of the robot is farther from the axis of joint j than
`reach[j]` [m]. Return the smallest n for which no point of the robot moves farther than `thickness` [m] in one step,
by the bound of the page: the sum over the joints of reach times angle.

    steps([0, 0], [1, 0], [0.4, 0.2], 0.11)   is 4
    steps([0, 0], [1, -1], [0.4, 0.2], 0.11)  is 6

By hand: numpy's functions are enough.
"""

import numpy as np


def steps(start, goal, reach, thickness):
    """Return the number of steps."""
    farthest = sum(r * abs(b - a) for a, b, r in zip(start, goal, reach, strict=True))
    return np.ceil(farthest / thickness)
