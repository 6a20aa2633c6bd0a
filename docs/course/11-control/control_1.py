"""control-1: Which torques does a PD controller give?

Given are the joint values and velocities of a robot, those that it should have (its goal), and the gains kp [N m/rad]
and kd [N m s/rad] of each joint; all are arrays of shape (n,). Return the torques of the joints [N m].

    pd_torques(0.0, 0.0, 0.5, 0.0, 10.0, 1.0)  is 5: towards the goal
    pd_torques(0.5, 2.0, 0.5, 0.0, 10.0, 1.0)  is -2: it brakes

By hand: numpy's functions are enough.
"""

import numpy as np


def pd_torques(values, velocities, goal_values, goal_velocities, kp, kd):
    """Return the torques [N m], shape (n,)."""
    ...
