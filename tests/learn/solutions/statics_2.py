"""statics-2: Which torques hold the double pendulum still?

The double pendulum of the tutorial has two arms of 0.2 m with masses m0 and m1 [kg]; the centre of mass of each is in
its middle. q0 is measured from straight down to the first arm, q1 from the first arm to the second one [rad]; torques
are positive in the same sense. Return the torques of both joints [N m] that hold it still; g is 9.81 m/s^2.

    holding_torques(0, 0, 8, 8)          is [0, 0]: it hangs down
    holding_torques(np.pi / 2, 0, 8, 8)  is [31.392, 7.848]

By hand: numpy's functions are enough.
"""

import numpy as np


def holding_torques(q0, q1, m0, m1):
    """Return the torques of both joints [N m], shape (2,)."""
    second = 9.81 * m1 * 0.1 * np.sin(q0 + q1)
    return [9.81 * (m0 * 0.1 + m1 * 0.2) * np.sin(q0) + second, second]
