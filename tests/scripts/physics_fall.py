# A box falls freely, then stands on the floor.
from openravepy import *
import numpy
env = Environment()
env.StopSimulation()
for name, z, half in (('floor', -0.5, 0.5), ('box', 2.0, 0.1)):
    g = KinBody.GeometryInfo()
    g._type, g._vGeomData = GeometryType.Box, [5 * half] * 2 + [half] if name == 'floor' else [half] * 3
    info = KinBody.LinkInfo()
    info._name, info._mass, info._vgeometryinfos, info._bStatic = name, 1.0, [g], name == 'floor'
    info._vinertiamoments = [0.01, 0.01, 0.01]
    body = RaveCreateKinBody(env, '')
    body.Init([info], [])
    body.SetName(name)
    env.Add(body)
    body.SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, z]))
physics = RaveCreatePhysicsEngine(env, 'ode')
env.SetPhysicsEngine(physics)
env.GetPhysicsEngine().SetGravity(numpy.array((0, 0, -9.8)))
box = env.GetKinBody('box')
for i in range(200):
    env.StepSimulation(0.001)
print('fallen %.2f' % (2 - box.GetTransform()[2, 3]), 'time', env.GetSimulationTime())
print('speed %.2f' % box.GetLinks()[0].GetVelocity()[2])
for i in range(2000):
    env.StepSimulation(0.001)
print('rests %.2f' % box.GetTransform()[2, 3], 'gravity', physics.GetGravity())
