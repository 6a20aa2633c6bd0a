# A robot without a file: two links, a hinge and a manipulator.
from openravepy import *
from numpy import *
env = Environment()

def link(name, z, extents):
    g = KinBody.GeometryInfo()
    g._type = GeometryType.Box
    g._vGeomData = extents
    g._vDiffuseColor = [1, 0, 0]
    info = KinBody.LinkInfo()
    info._name = name
    info._t = matrixFromPose([1, 0, 0, 0, 0, 0, z])
    info._vgeometryinfos = [g]
    info._mass = 2.0
    return info

joint = KinBody.JointInfo()
joint._name = 'j0'
joint._type = KinBody.JointType.Hinge
joint._linkname0, joint._linkname1 = 'l0', 'l1'
joint._vanchor = [0, 0, 0.1]
joint._vaxes = [[0, 1, 0]]
joint._vlowerlimit, joint._vupperlimit = [-1.0], [2.0]
joint._vmaxvel = [3.0]

manip = Robot.ManipulatorInfo()
manip._name = 'arm'
manip._sBaseLinkName, manip._sEffectorLinkName = 'l0', 'l1'
manip._tLocalTool = matrixFromPose([1, 0, 0, 0, 0, 0, 0.5])

robot = RaveCreateRobot(env, '')
robot.Init([link('l0', 0, [.1, .1, .1]), link('l1', 0.1, [.05, .05, .2])], [joint], [manip], [])
robot.SetName('made')
env.Add(robot)
print('dofs', robot.GetDOF(), robot.GetDOFLimits()[0], robot.GetDOFLimits()[1], robot.GetDOFVelocityLimits())
robot.SetDOFValues([pi/2])
print('tool', robot.GetActiveManipulator().GetTransform()[0:3, 3])
info = robot.GetLinks()[1].UpdateAndGetInfo()
print('mass', info._mass, info._vgeometryinfos[0]._vGeomData)
