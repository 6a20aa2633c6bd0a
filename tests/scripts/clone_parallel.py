# Checks configurations in copies of the environment, in threads.
import threading
from openravepy import *
import numpy

env = Environment()
env.Load('data/room.env.xml')
env.Remove(env.GetKinBody('mug'))
angles = numpy.linspace(-1.6, 1.6, 33)
found = {}

def check(number):
    copy = env.CloneSelf(CloningOptions.Bodies)
    robot = copy.GetRobot('arm')
    for angle in angles[number::3]:
        with copy:
            robot.SetDOFValues([angle], [0])
            found[angle] = copy.CheckCollision(robot)
    copy.Destroy()

threads = [threading.Thread(target=check, args=(i,)) for i in range(3)]
for t in threads: t.start()
for t in threads: t.join()
print('checked', len(found), 'first collision', min(a for a in found if found[a]) > 1.0)
robot = env.GetRobots()[0]
print('here', robot.GetDOFValues()[0])
with robot:
    same = True
    for angle in angles:
        robot.SetDOFValues([angle], [0])
        same = same and env.CheckCollision(robot) == found[angle]
print('same', same)
