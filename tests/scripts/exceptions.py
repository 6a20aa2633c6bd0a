# What can go wrong, and how scripts see it.
import sys
from openravepy import *
env = Environment()
print('load', env.Load('missing.env.xml'), env.GetKinBody('x'), env.GetRobot('x'))
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
for call in (lambda: robot.SetDOFValues([1, 2]), lambda: robot.SetActiveManipulator('leg'), lambda: env.CheckCollision(None),
             lambda: env.Load('data/room.env.xml'), lambda: robot.GetController().SendCommand('dance'),
             lambda: robot.SetTransform([[0] * 4] * 4), lambda: env.GetBodies()[1].SetName('arm')):
    try:
        call()
        print('nothing')
    except openrave_exception as e:
        print('openrave_exception', e.GetCode(), len(e.message) > 10)
print('lookups', robot.GetLink('x'), robot.GetJoint('x'), robot.GetJointIndex('x'), robot.GetManipulator('x'))
print('plugins', RaveLoadPlugin('libplugin.so'), RaveCreateModule(env, 'nothing'), RaveCreateController(env, 'x'))
sys.exit(3)
