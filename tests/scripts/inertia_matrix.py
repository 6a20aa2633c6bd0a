"""The inertia matrix of the tutorial's pendulum, column by column, and its gravity torques."""
import numpy
from openravepy import *

def compute_inertia_matrix(robot, q):
    n = robot.GetDOF()
    M = numpy.zeros((n, n))
    with robot:
        robot.SetDOFValues(q)
        robot.SetDOFVelocities(numpy.zeros(n))
        for i, e in enumerate(numpy.eye(n)):
            tm, tc, tg = robot.ComputeInverseDynamics(e, None, returncomponents=True)
            M[:, i] = tm
    return M, tg

env = Environment()
env.Load('data/env.xml')
robot = env.GetRobots()[0]
env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
M, tg = compute_inertia_matrix(robot, [0, 0])
print('M', M[0, 0], M[0, 1], M[1, 0], M[1, 1])
M, tg = compute_inertia_matrix(robot, [0.3, 0.4])
print('coupling', M[0, 1], 'gravity', abs(tg[1]))
print('values', robot.GetDOFValues())
