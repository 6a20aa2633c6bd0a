"""motions-3: Can you swing the pendulum up within its limits?

The double pendulum hangs down: its joint values are [0, 0]. Return a motion to the joint values `goal`, as 101 rows,
each with a time [s] and the two joint values. Times begin with 0 and increase.

- Between two rows, no joint is faster than its limit in `speeds` [rad/s].
- It starts and ends at rest: between the first two rows and between the last two, no joint is faster than a twentieth
  of its limit.
- It takes at most twice max(|goal| / speeds), the duration of a motion with full speed from beginning to end.

By hand: numpy's functions are enough.
"""

import numpy as np


def swing(goal, speeds):
    """Return times and joint values, shape (101, 3)."""
    duration = 1.5 * max(np.abs(goal) / speeds)
    u = np.linspace(0, 1, 101)
    s = 3 * u**2 - 2 * u**3
    return np.column_stack([duration * u, np.outer(s, goal)])
