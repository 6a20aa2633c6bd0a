"""ar-2: Which solution is nearest?

Given are solutions of inverse kinematics, shape (n, 6), with all angles between -pi and pi [rad], the joint values now,
and the lower and upper limits of the joints, three arrays of shape (6,). Each angle may be changed by whole turns.
Return the joint values within the limits that are nearest to the ones now (the least np.linalg.norm of the difference),
shape (6,). There is at least one solution within the limits; some have none.

    With the limits -6 and 6, the angle 3 is nearest to -2 as 3 - 2 pi, which is -3.2832.

By hand: numpy's functions are enough.
"""

import numpy as np


def nearest(solutions, now, lower, upper):
    """Return the nearest joint values within the limits [rad], shape (6,)."""
    rows = []
    for solution in solutions:
        row = []
        for angle, value, low, high in zip(solution, now, lower, upper, strict=True):
            allowed = [angle + 2 * np.pi * k for k in range(-2, 3) if low <= angle + 2 * np.pi * k <= high]
            if allowed:
                row.append(min(allowed, key=lambda one: abs(one - value)))
        if len(row) == len(solution):
            rows.append(np.array(row))
    return min(rows, key=lambda q: np.linalg.norm(q - now))
