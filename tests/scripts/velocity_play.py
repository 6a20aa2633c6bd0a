# Plays joint speeds with the velocity controller.
from openravepy import *
env = Environment()
env.StopSimulation()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
robot.SetController(RaveCreateController(env, 'IdealVelocityController'), list(range(4)), 0)
robot.GetController().SetDesired([0.5, -0.25, 0, 0])
for i in range(100):
    env.StepSimulation(0.01)
print('values', robot.GetDOFValues()[0:2])
