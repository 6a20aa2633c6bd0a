# Torques turn a pendulum without gravity.
from openravepy import *
import numpy
env = Environment()
env.StopSimulation()
env.Load('data/env.xml')
env.SetPhysicsEngine(RaveCreatePhysicsEngine(env, 'ode'))
env.GetPhysicsEngine().SetGravity([0, 0, 0])
robot = env.GetRobots()[0]
robot.GetDOFTorqueLimits()
robot.GetLinks()[0].SetStatic(True)
robot.SetController(None)
with robot:
    inertia = numpy.array([robot.ComputeInverseDynamics(unit) for unit in numpy.eye(2)])
wanted = numpy.array([0.5, -1.0])
for i in range(10):
    robot.SetDOFTorques(inertia.dot(wanted), True)
    env.StepSimulation(0.001)
print('accelerations', numpy.round(robot.GetDOFVelocities() / 0.01, 2))
