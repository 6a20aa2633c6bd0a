# Velocity control with the Jacobian: the tool goes to a point.
from openravepy import *
import numpy
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobot('arm')
manip = robot.GetActiveManipulator()
robot.SetActiveDOFs([0, 1])
robot.SetActiveDOFValues([0.3, 0.5])
goal = numpy.array([0.5, 0.2, 0.3])
for step in range(500):
    position = manip.GetEndEffectorTransform()[0:3, 3]
    error = goal - position
    if numpy.linalg.norm(error) < 1e-8:
        break
    J = manip.CalculateJacobian()[:, :2]
    K = robot.ComputeJacobianTranslation(manip.GetEndEffector().GetIndex(), position, [0, 1])
    L = robot.CalculateJacobian(manip.GetEndEffector().GetIndex(), position)[:, :2]
    assert numpy.allclose(J, K) and numpy.allclose(K, L)
    robot.SetActiveDOFValues(robot.GetActiveDOFValues() + 0.3 * numpy.linalg.pinv(J).dot(error))
print('reached', manip.GetEndEffectorTransform()[0:3, 3], step < 499)
robot.SetActiveDOFVelocities([0.5, 0])
print('speed', numpy.linalg.norm(manip.GetVelocity()[0:3]))
print('turning', robot.ComputeJacobianAxisAngle(3)[2])
