# A humanoid in pymanoid's manner: tasks of feet, hand and centre of mass, and ticks that follow a box which moves.
from openravepy import *
env = Environment()
env.Load('data/biped.robot.xml')
robot = env.GetRobots()[0]
robot.SetActiveDOFs(range(robot.GetDOF()), DOFAffine.Transform)
box = RaveCreateKinBody(env, '')
box.InitFromBoxes(numpy.array([[0, 0, 0, 0.03, 0.03, 0.03]]), True)
box.SetName('target')
env.AddKinBody(box)
hand = robot.GetManipulator('right_hand')
T = hand.GetTransform()
box.SetTransform(T)
ik = WholeBodyIK(robot)
feet = [ik.add_contact(name, weight=1.) for name in ('left_foot', 'right_foot')]
com = ik.add_com(weight=1e-2)
reach = ik.add_reach('right_hand', box, weight=1e-3, gain=0.85, rotation=False)
ik.add_posture(weight=1e-6)
dt = 0.03
for tick in range(100):
    T[0:3, 3] += dt * numpy.array([0.04, 0.02, 0.06])
    with env:
        box.SetTransform(T)
        ik.step(dt)
for tick in range(60):
    ik.step(dt)
print('feet stay', max(abs(foot.residual).max() for foot in feet) < 1e-8)
print('hand follows', abs(hand.GetTransform()[0:3, 3] - T[0:3, 3]).max() < 0.01)
print('over the feet', abs(robot.GetCenterOfMass()[0:2] - com.target[0:2]).max() < 0.01)
print('again', ik.solve().steps > 0, len(robot.GetActiveDOFValues()))
