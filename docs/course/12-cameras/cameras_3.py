"""cameras-3: Which pose looks at a point?

Return the pose of a camera, shape (4, 4), whose eye is at `eye` and which looks at `point`, both in the world [m]: its
origin is the eye, its z axis points at the point, and its x axis, to the right of the picture, is horizontal. Its
y axis points down in the picture. The point is never straight above or below the eye.

If the eye is at [0, -2, 0] and the point at [0, 0, 0], then x is [1, 0, 0], y is [0, 0, -1] and z is [0, 1, 0].

By hand: numpy's functions are enough.
"""

import numpy as np


def look_at(eye, point):
    """Return the pose of the camera in the world, shape (4, 4)."""
    ...
