# Wants inverse kinematics.
from openravepy import *
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
manip = robot.SetActiveManipulator('gripper')
Tgoal = manip.GetEndEffectorTransform()
try:
    print('solution', manip.FindIKSolution(Tgoal, IkFilterOptions.CheckEnvCollisions))
except openrave_exception as e:
    print('no solver yet:', isinstance(e, NotImplementedError))
param = IkParameterization(Tgoal, IkParameterizationType.Transform6D)
print('goal', param.GetTransform6D()[0, 3], manip.GetIkParameterization(IkParameterizationType.Translation3D).GetTranslation3D()[0])
ikmodel = databases.inversekinematics.InverseKinematicsModel(robot, iktype=IkParameterization.Type.Transform6D)
print('model', ikmodel.manip.GetName(), ikmodel.iktype.name)
if not ikmodel.load():
    ikmodel.autogenerate()
