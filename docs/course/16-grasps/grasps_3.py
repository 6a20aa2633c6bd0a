"""grasps-3: How hard do fingers have to press?

Two fingers press against an object from both sides, each horizontally and with the same force. The object has the mass
`mass` [kg], the friction coefficient is `friction`, and the hand lifts it with the acceleration `acceleration` upwards
[m/s^2], negative if the hand goes down faster and faster. Gravity is 9.81 m/s^2. Return the least force of each finger
[N] at which the object does not slip.

    least_force(0.2, 0.4, 5)  is about 3.7025
    least_force(0.2, 0.4, -9.81)  is 0: the object falls with the hand

By hand: numpy's functions are enough.
"""

import numpy as np


def least_force(mass, friction, acceleration):
    """Return the force of each finger [N]."""
    ...
