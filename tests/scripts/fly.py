# A mug flies along a trajectory of poses.
from openravepy import *
import numpy
env = Environment()
mug = env.ReadKinBodyXMLFile('data/mug.kinbody.xml')
env.AddKinBody(mug)
spec = RaveGetAffineConfigurationSpecification(DOFAffine.Transform, mug, 'linear')
spec.AddDeltaTimeGroup()
traj = RaveCreateTrajectory(env, '')
traj.Init(spec)
up = matrixFromAxisAngle([0, 0, numpy.pi / 2])
up[0:3, 3] = [0, 0, 1]
for i, T in enumerate((numpy.eye(4), up)):
    values = RaveGetAffineDOFValuesFromTransform(T, DOFAffine.Transform)
    traj.Insert(i, numpy.r_[values, 2.0 * i])
for t in numpy.linspace(0, traj.GetDuration(), 3):
    T = spec.ExtractTransform(None, traj.Sample(t), mug)
    mug.SetTransform(T)
    print('mug', mug.GetTransform()[2, 3], axisAngleFromRotationMatrix(mug.GetTransform())[2])
