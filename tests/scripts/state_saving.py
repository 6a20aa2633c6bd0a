from openravepy import *
import numpy
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
mug = env.GetKinBody('mug')
try:
    with robot:
        robot.SetDOFValues([1, 1], [0, 1])
        robot.SetActiveDOFs([1])
        robot.GetLinks()[0].Enable(False)
        with robot:
            robot.SetDOFValues([-1], [0])
        print('inner', robot.GetDOFValues()[0:2])
        raise ValueError('out')
except ValueError as e:
    print('caught', e)
print('outer', robot.GetDOFValues()[0:2], robot.GetActiveDOF(), robot.GetLinks()[0].IsEnabled())

with robot.CreateRobotStateSaver(Robot.SaveParameters.LinkTransformation | Robot.SaveParameters.GrabbedBodies):
    robot.Grab(mug)
    robot.SetDOFValues([1], [0])
print('held', len(robot.GetGrabbed()), 'moved', mug.GetTransform()[1, 3])
with RobotStateSaver(robot), KinBodyStateSaver(mug):
    mug.SetTransform(matrixFromPose([1, 0, 0, 0, 5, 5, 5]))
print('mug', mug.GetTransform()[0:3, 3])
saver = mug.CreateKinBodyStateSaver(KinBody.SaveParameters.LinkTransformation)
mug.SetTransform(numpy.eye(4))
saver.Restore()
print('mug', mug.GetTransform()[0:3, 3])
with CollisionOptionsStateSaver(env.GetCollisionChecker(), CollisionOptions.Contacts):
    print('options', env.GetCollisionChecker().GetCollisionOptions())
print('options', env.GetCollisionChecker().GetCollisionOptions())
