# Values outside the limits.
import warnings
warnings.simplefilter('ignore')
from openravepy import *
env = Environment()
env.Load('data/arm.robot.xml')
robot = env.GetRobots()[0]
lower, upper = robot.GetDOFLimits()
robot.SetDOFValues([5, -5, 5, 1])
print('clamped', (robot.GetDOFValues()[0:2] == [upper[0], lower[1]]).all(), robot.GetDOFValues()[2:])
robot.SetDOFValues([3], [0], KinBody.CheckLimitsAction.Nothing)
print('as is', robot.GetDOFValues([0]))
try:
    robot.SetDOFValues([3], [0], checklimits=KinBody.CheckLimitsAction.CheckLimitsThrow)
except openrave_exception as e:
    print('thrown', e.GetCode())
robot.SetDOFLimits(lower * 0.5, upper * 0.5)
robot.SetDOFVelocityLimits([1, 1, 1, 1])
print('limits', robot.GetJoint('shoulder').GetLimits()[1][0] == upper[0] / 2, robot.GetDOFValues([0]))
robot.SetDOFVelocities([9, 0, 0, 0], checklimits=2)
print('speed', robot.GetDOFVelocities()[0])
print('gripper', robot.GetLink('left').GetTransform()[1, 3] - robot.GetLink('right').GetTransform()[1, 3] > 0)
