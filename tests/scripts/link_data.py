# Prints the links as a table, and the whole body's centre of mass.
from openravepy import *
import numpy
env = Environment()
env.Load('data/arm.robot.xml')
robot = env.GetRobots()[0]
total, moment = 0, numpy.zeros(3)
for link in robot.GetLinks():
    total += link.GetMass()
    moment += link.GetMass() * link.GetGlobalCOM()
    print(link.GetIndex(), link.GetName(), link.GetMass(), link.GetParent().GetName())
print('total', total, 'com', numpy.allclose(moment / total, robot.GetCenterOfMass()))
print('joints', [(j.GetName(), j.GetDOFIndex()) for j in robot.GetJoints()], [j.GetName() for j in robot.GetPassiveJoints()])
print('chain', [j.GetName() for j in robot.GetChain(0, robot.GetLink('hand').GetIndex())])
print('affects', robot.DoesAffect(robot.GetJointIndex('elbow'), 3), robot.DoesAffect(robot.GetJointIndex('elbow'), 1))
print('parent', robot.GetJoint('elbow').GetHierarchyParentLink().GetName(), robot.GetJoint('elbow').GetAnchor())
print('hash', len(robot.GetKinematicsGeometryHash()))
