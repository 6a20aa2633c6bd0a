# Models as text.
from openravepy import *
env = Environment()
box = """<KinBody name="box%d"><Body name="b"><Translation>%f 0 0</Translation>
<Geom type="box"><extents>0.1 0.2 0.3</extents></Geom></Body></KinBody>"""
for i in range(3):
    print('loaded', env.LoadData(box % (i, i)))
body = env.ReadKinBodyXMLData(box % (0, 9))
try:
    env.Add(body)
except openrave_exception as e:
    print('twice', e.GetCode())
env.Add(body, True)
print('bodies', ' '.join(sorted(b.GetName() for b in env.GetBodies() if b.GetName().startswith('box')))[:14], len(env.GetBodies()))
robot = env.ReadRobotData(open('data/arm.robot.xml').read())
print('robot', robot.GetName(), len(robot.GetLinks()), env.GetRobot('arm'))
env.Add(robot)
print('robot', env.GetRobot('arm') == robot, robot.GetDOF())
print('broken', env.LoadData('<KinBody name="x"'), env.Load('nowhere.env.xml'))
