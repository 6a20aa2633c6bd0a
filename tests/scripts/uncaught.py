from openravepy import *

def move(robot):
    robot.SetDOFValues([0.5])

env = Environment()
env.Load('data/room.env.xml')
print('before')
move(env.GetRobots()[0])
print('never')
