# Names that were gone after 0.9.
from openravepy import *
import numpy
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
robot.SetActiveManipulator(1)
print('manip', robot.GetActiveManipulatorIndex(), robot.GetActiveManipulator().GetName())
manip = robot.SetActiveManipulator('gripper')
print('arm', manip.GetArmJoints(), manip.GetGripperJoints(), manip.GetClosingDirection(), manip.GetPalmDirection())
print('limits', robot.GetDOFMaxVel()[0:2], robot.GetDOFMaxAccel()[0:2], robot.GetDOFMaxTorque()[0:2])
print('jacobians', robot.CalculateAngularVelocityJacobian(2)[2, 0:2], robot.CalculateRotationJacobian(2, [1, 0, 0, 0]).shape)
print('quat', quatMult([0, 1, 0, 0], [0, 1, 0, 0]), rotationMatrixFromQuat([1, 0, 0, 0])[0])
print('affine', Robot.DOFAffine.X | Robot.DOFAffine.Y, KinBody.Link.GeomType.Box == GeometryType.Box)
print('status', PlannerStatus.HasSolution == 1, KinBody.Joint.Type is not None, InterfaceType.robot.name)
body = env.ReadKinBodyXMLFile('data/mug.kinbody.xml')
body.SetName('other')
env.AddKinBody(body)
info = KinBody.Link.GeometryInfo()
info._type, info._vGeomData = KinBody.Link.GeomType.Sphere, [0.1, 0, 0]
ball = RaveCreateKinBody(env, '')
ball.InitFromGeometries([info])
ball.SetName('ball')
env.AddKinBody(ball)
print('names', [b.GetName() for b in env.GetBodies()][-2:], body.GetLinks()[0].GetGeometries()[0].GetCylinderRadius())
raveLogInfo('fine')
