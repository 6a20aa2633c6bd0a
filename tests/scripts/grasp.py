# Open the gripper around the mug, close it, take the mug along, let it go.
from openravepy import *
import numpy as np
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobot('arm')
mug = env.GetKinBody('mug')
manip = robot.SetActiveManipulator('gripper')
gripper = manip.GetGripperIndices()

robot.SetDOFValues([0.04], gripper)
print('open', env.CheckCollision(robot, mug), env.CheckCollision(robot))
robot.SetDOFValues([0.02], gripper)
print('closed', env.CheckCollision(robot, mug))
robot.SetDOFValues([0.04], gripper)

print('grab', robot.Grab(mug), [b.GetName() for b in robot.GetGrabbed()])
robot.SetDOFValues([-1.0], [0])
print('carried', mug.GetTransform()[0:3, 3])
robot.SetDOFValues([np.pi / 2], [0])
print('wall', env.CheckCollision(mug), env.CheckCollision(robot))
robot.SetDOFValues([-1.0], [0])
robot.Release(mug)
robot.SetDOFValues([0.0], [0])
print('left', mug.GetTransform()[0:3, 3], len(robot.GetGrabbed()))
RaveDestroy()
