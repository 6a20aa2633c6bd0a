# The base drives: affine DOFs.
from openravepy import *
import numpy
env = Environment()
env.Load('data/arm.robot.xml')
robot = env.GetRobots()[0]
robot.SetActiveDOFs([0], DOFAffine.X | DOFAffine.Y | DOFAffine.RotationAxis, [0, 0, 1])
robot.SetActiveDOFValues([0.1, 1, 2, numpy.pi / 2])
print('base', robot.GetTransform()[0:3, 3], axisAngleFromRotationMatrix(robot.GetTransform())[2])
lower, upper = robot.GetActiveDOFLimits()
print('limits', lower[1:3], upper[1:3])
print('dofs', robot.GetActiveDOF(), robot.GetActiveDOFIndices(), robot.GetAffineDOF() == 11)
print('tool', robot.GetActiveManipulator().GetTransform()[0:3, 3])
spec = robot.GetActiveConfigurationSpecification()
print('spec', [(g.name.split()[0], g.dof) for g in spec.GetGroups()])
