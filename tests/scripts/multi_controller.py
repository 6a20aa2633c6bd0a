# Arm and gripper have controllers of their own.
from openravepy import *
env = Environment()
env.StopSimulation()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
multi = RaveCreateMultiController(env, '')
robot.SetController(multi, list(range(robot.GetDOF())), 0)
arm = RaveCreateController(env, 'IdealController')
hand = RaveCreateController(env, 'idealcontroller')
multi.AttachController(arm, [0, 1], 0)
multi.AttachController(hand, [3], 0)
hand.SetDesired([0.03])
arm.SetDesired([0.2, -0.3])
for i in range(5):
    env.StepSimulation(0.01)
print('values', robot.GetDOFValues(), arm.IsDone(), hand.IsDone())
robot.SetController(RaveCreateController(env, 'IdealController'))
robot.GetController().SetDesired([0, 0, 0, 0])
env.StepSimulation(0.01)
print('values', robot.GetDOFValues(), robot.WaitForController(1))
