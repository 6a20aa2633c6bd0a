"""body-1: Which step serves two tasks best?

Given are two tasks: the Jacobian of each, shape (m, n), the error of each, shape (m,), and its weight. Return the step
dq of the n joints that makes w1 |J1 dq - e1|^2 + w2 |J2 dq - e2|^2 + damping |dq|^2 smallest, where |v|^2 is the sum of
the squares of v.

For one joint with the goals 1 (weight 3) and 0 (weight 1), and without damping, it is three quarters of the distance to
the first one: best_step([[1.0]], [1.0], 3.0, [[1.0]], [0.0], 1.0, 0.0) is [0.75].

By hand: numpy's functions are enough.
"""

import numpy as np


def best_step(J1, e1, w1, J2, e2, w2, damping):
    """Return the step of the joints, shape (n,)."""
    A = w1 * J1.T @ J1 + w2 * J2.T @ J2 + damping * np.eye(J1.shape[1])
    return np.linalg.solve(A, w1 * J1.T @ e1 + w2 * J2.T @ e2)
