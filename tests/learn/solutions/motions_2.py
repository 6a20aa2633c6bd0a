"""motions-2: How long does a straight motion take at least?

The robot moves on a straight line from the joint values `start` to `goal`, at rest at both ends. `speeds` and
`accelerations` are the limits of each joint [rad/s, rad/s^2]. All joints share the fraction s of the path.
Return the shortest possible duration [s].

    shortest_duration([0], [3], [1], [1])        is 4: one second each to start and to brake, two at full speed
    shortest_duration([0], [1], [10], [1])       is 2: it brakes before it reaches full speed
    shortest_duration([0, 0], [1, -4], [9, 2], [1, 9])  is 2.5

By hand: numpy's functions are enough.
"""

import numpy as np


def shortest_duration(start, goal, speeds, accelerations):
    """Return the duration of the fastest straight motion [s]."""
    distances = np.abs(np.subtract(goal, start))
    v = min(np.array(speeds) / distances)
    a = min(np.array(accelerations) / distances)
    if v**2 / a > 1:  # a triangle
        return 2 * np.sqrt(1 / a)
    return 1 / v + v / a
