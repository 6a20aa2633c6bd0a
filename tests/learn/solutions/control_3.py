"""control-3: Which gains do not overshoot?

A joint with the inertia I [kg m^2] is pulled to its goal by a PD controller with the gains kp and kd; nothing else acts
on it. Return the gains [kp, kd] with which it is critically damped and has the frequency omega [rad/s].

    gains(1.0, 10.0)  is [100, 20]
    gains(0.5, 20.0)  is [200, 20]

By hand: numpy's functions are enough.
"""

import numpy as np


def gains(inertia, omega):
    """Return kp [N m/rad] and kd [N m s/rad], shape (2,)."""
    kp = inertia * omega**2
    return [kp, 2 * np.sqrt(kp * inertia)]
