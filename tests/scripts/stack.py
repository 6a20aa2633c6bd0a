# Stacks boxes on the table by their bounding boxes.
from openravepy import *
import numpy
env = Environment()
env.Load('data/room.env.xml')
top = env.GetKinBody('table').ComputeAABB()
z = top.pos()[2] + top.extents()[2]
for i, half in enumerate([0.1, 0.05, 0.02]):
    box = RaveCreateKinBody(env, '')
    box.InitFromBoxes(numpy.array([[0, 0, 0, half, half, half]]), True)
    box.SetName('box%d' % i)
    env.Add(box, True)
    T = numpy.eye(4)
    T[0:3, 3] = top.pos()[0], 0.18, z + half + 0.001
    box.SetTransform(T)
    z += 2 * half + 0.001
    print(box.GetName(), box.GetTransform()[2, 3], env.CheckCollision(box))
