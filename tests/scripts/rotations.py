from openravepy import *
from numpy import *
q = quatFromAxisAngle([0, 0, pi/2])
print('quat', q, quatFromRotationMatrix(rotationMatrixFromAxisAngle([0, 0, 1], pi/2)))
T = matrixFromPose(r_[q, 1, 2, 3])
print('point', dot(T, [1, 0, 0, 1])[0:3], transformPoints(T, [[1, 0, 0]])[0])
print('inverse', dot(linalg.inv(T), T)[0], poseFromMatrix(T)[4:])
print('slerp', 2 * arctan2(quatSlerp([1, 0, 0, 0], q, 0.5)[3], quatSlerp([1, 0, 0, 0], q, 0.5)[0]))
print('axis angle', axisAngleFromRotationMatrix(T), axisAngleFromQuat(quatMult(q, q)))
print('turned', dot(rotationMatrixFromQuat(quatRotateDirection([1, 0, 0], [0, 1, 0])), [1, 0, 0]))
