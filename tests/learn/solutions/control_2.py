"""control-2: How does a controller hold an arm against gravity?

The Panda has the joint values `values` and velocities `velocities`, and should be at rest at `goal`. Return the torques
of a PD controller with the gains kp and kd, plus those that hold the Panda still against gravity where it is now, with
the joint values `values`. All arrays have 8 numbers; the last joint is the gripper's, a slide [m, N].

At [0, 0, 0, -np.pi / 2, 0, np.pi / 2, 0, 0] joint 2 holds -29.349 N m, and joint 4 holds 22.043 N m.

The robot may be asked: put it there with `robot.SetDOFValues(values)`. `robot.ComputeInverseDynamics(None, None, True)`
returns three arrays: torques of accelerations, of velocities (Coriolis), and of gravity.
"""

import numpy as np


def torques(robot, values, velocities, goal, kp, kd):
    """Return the torques of a PD controller with gravity compensation, shape (8,)."""
    robot.SetDOFValues(values)
    gravity = robot.ComputeInverseDynamics(None, None, True)[2]
    return kp * (goal - values) - kd * velocities + gravity
