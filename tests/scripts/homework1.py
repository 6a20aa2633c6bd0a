#!/usr/bin/env python
# HW1: bring the arm to a configuration, look where the hand is, and whether it is in collision.
import time
import openravepy

if not __openravepy_build_doc__:
    from openravepy import *
    from numpy import *

if __name__ == "__main__":
    env = Environment()
    env.Load('data/room.env.xml')
    env.Remove(env.GetKinBody('mug'))
    robot = env.GetRobots()[0]

    jointnames = ['shoulder', 'elbow']
    robot.SetActiveDOFs([robot.GetJoint(name).GetDOFIndex() for name in jointnames])
    for goal in ([0.5, -0.9], [1.3, 0.2]):
        robot.SetActiveDOFValues(goal)
        robot.GetController().SetDesired(robot.GetDOFValues())
        time.sleep(0.05)
        T = robot.GetActiveManipulator().GetEndEffectorTransform()
        print('hand', T[0:3, 3], 'collision', env.CheckCollision(robot))
    env.Destroy()
