# Weights and resolutions for planners.
from openravepy import *
env = Environment()
env.Load('data/env.xml')
robot = env.GetRobots()[0]
lmodel = databases.linkstatistics.LinkStatisticsModel(robot)
if not lmodel.load():
    lmodel.autogenerate()
lmodel.setRobotWeights()
lmodel.setRobotResolutions(xyzdelta=0.01)
print('weights', sum(robot.GetDOFWeights()), robot.GetDOFWeights()[0] > robot.GetDOFWeights()[1])
print('resolutions', 0.01 / robot.GetDOFResolutions()[1])
cdmodel = databases.convexdecomposition.ConvexDecompositionModel(robot)
if not cdmodel.load():
    cdmodel.autogenerate()
