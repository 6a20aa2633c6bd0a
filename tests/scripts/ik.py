# Inverse kinematics: a solver is loaded, and brings the hand back to where it was.
from openravepy import *
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
manip = robot.SetActiveManipulator('gripper')
Tgoal = manip.GetEndEffectorTransform()
try:
    print('solution', manip.FindIKSolution(Tgoal, IkFilterOptions.CheckEnvCollisions))
except openrave_exception as e:
    print('no solver yet:', e.GetCode())
param = IkParameterization(Tgoal, IkParameterizationType.Transform6D)
print('goal', param.GetTransform6D()[0, 3], manip.GetIkParameterization(IkParameterizationType.Translation3D).GetTranslation3D()[0])
ikmodel = databases.inversekinematics.InverseKinematicsModel(robot, iktype=IkParameterization.Type.Transform6D)
print('model', ikmodel.manip.GetName(), ikmodel.iktype.name)
if not ikmodel.load():
    ikmodel.autogenerate()
print('goal again', numpy.allclose(Tgoal, manip.GetEndEffectorTransform()), manip.GetIkSolver() is not None)
robot.SetDOFValues([0.3, 0.7], manip.GetArmIndices()[:2])
solution = manip.FindIKSolution(Tgoal, IkFilterOptions.IgnoreSelfCollisions)
robot.SetDOFValues(solution, manip.GetArmIndices())
print('back', abs(manip.GetEndEffectorTransform() - Tgoal).max() < 1e-8)
