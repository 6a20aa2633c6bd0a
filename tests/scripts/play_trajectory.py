"""Plays a timed trajectory on the robot."""
from openravepy import *
import numpy

env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
robot.SetActiveDOFs([0, 1])
spec = robot.GetActiveConfigurationSpecification('linear')
spec.AddDeltaTimeGroup()
traj = RaveCreateTrajectory(env, '')
traj.Init(spec)
for dt, values in ((0, [0, 0]), (0.2, [0.2, -0.1]), (0.1, [0.1, 0.3])):
    traj.Insert(traj.GetNumWaypoints(), numpy.r_[values, dt])
print('points', traj.GetNumWaypoints(), 'duration', traj.GetDuration())
middle = traj.Sample(0.1)
print('middle', spec.ExtractJointValues(middle, robot, [0, 1], 0))
robot.GetController().SetPath(traj)
print('arrived', robot.WaitForController(0))
print('values', robot.GetDOFValues()[0:2], robot.GetController().IsDone())
