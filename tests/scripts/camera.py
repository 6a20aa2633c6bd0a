# A picture of the room as a file.
from openravepy import *
import numpy
env = Environment()
env.SetViewer('qtcoin')
env.Load('data/room.env.xml')
viewer = env.GetViewer()
viewer.SetBkgndColor([0, 0, 0])
viewer.SetCamera(transformLookat(lookat=[0.4, 0, 0.2], camerapos=[0.4, -2, 0.2], cameraup=[0, 0, -1.0]))
print('camera', viewer.GetCameraTransform()[0:3, 3])
I = viewer.GetCameraImage(160, 120, viewer.GetCameraTransform(), [160, 160, 80, 60])
numpy.save('picture.npy', I)
