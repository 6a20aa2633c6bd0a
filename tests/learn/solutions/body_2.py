"""body-2: How far is a robot from falling?

Given are the centre of mass [m], an array of x, y and z in the world, and the corners of the support on the ground,
shape (n, 2), counterclockwise as seen from above. Project the centre of mass onto the ground, and return its smallest
distance from the straight lines through the edges [m]. A distance is positive on the inner side of its line, and
negative on the outer side. So the robot stands if the result is positive.

With the corners [[0, 0], [2, 0], [2, 1], [0, 1]], a centre of mass at [0.5, 0.4, 0.9] has the margin 0.4, and one at
[2.1, 0.4, 0.9] has -0.1.

By hand: numpy's functions are enough.
"""

import numpy as np


def margin(centre_of_mass, corners):
    """Return the margin of the centre of mass [m]."""
    distances = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, way = b - a, centre_of_mass[:2] - a
        distances.append((edge[0] * way[1] - edge[1] * way[0]) / np.linalg.norm(edge))
    return min(distances)
