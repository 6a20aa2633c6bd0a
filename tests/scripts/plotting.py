# Handles keep what is drawn.
from openravepy import *
from openravepy import misc
import numpy
env = Environment()
env.Load('data/room.env.xml')
print('without', env.plot3([0, 0, 1], 5), env.drawarrow([0, 0, 0], [0, 0, 1]))
env.SetViewer('qtcoin')
handles = []
points = numpy.array([[0, 0, 1], [0, 1, 1], [1, 1, 1.0]])
handles.append(env.plot3(points=points, pointsize=0.05, colors=numpy.array([[1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), drawstyle=1))
handles.append(env.plot3(points[0], 5))
handles.append(env.drawlinestrip(points=points, linewidth=3.0, colors=numpy.array((0, 1, 0, 0.5))))
handles.append(env.drawlinelist(points[:2].flatten(), 2))
handles.append(env.drawarrow(p1=points[0], p2=points[1], linewidth=0.01, color=[1.0, 0.0, 0.0]))
handles.append(env.drawbox([0, 0, 2], [0.1, 0.1, 0.1]))
handles.append(env.drawtrimesh(points, numpy.array([[0, 1, 2]], dtype=numpy.int64), numpy.array([0, 0, 1, 0.3])))
handles.append(env.drawplane(numpy.eye(4), [1, 1], numpy.ones((8, 8, 3))))
handles.append(misc.DrawAxes(env, env.GetRobots()[0].GetActiveManipulator(), 0.3, 2))
print('handles', len(handles), [h is None for h in handles].count(True))
handles[0].SetShow(False)
handles[1].SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, 1]))
handles[2].Close()
try:
    env.plot3(points, 5, colors=numpy.ones((2, 3)))
except openrave_exception as e:
    print('wrong', e.GetCode())
del handles
print('camera', env.GetViewer().GetCameraTransform().shape)
env.Destroy()
