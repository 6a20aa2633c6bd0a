# The names of master.
import openravepy as orpy
import numpy as np
orpy.RaveInitialize(True, level=orpy.DebugLevel.Error)
env = orpy.Environment()
env.Load('data/room.env.xml')
robot = env.GetRobot('arm')
mug = env.ReadKinBodyURI('data/mug.kinbody.xml')
env.Add(mug, orpy.InterfaceAddMode.AllowRenaming)
print('renamed', mug.GetName() != 'mug', env.GetNumBodies())
report = orpy.CollisionReport()
with env:
    mug.SetTransform([1, 0, 0, 0, 0.6, 0.1, 0.2])
    hit = env.CheckCollision(mug, report=report)
print('hit', hit, report.nNumValidCollisions if hasattr(report, 'nNumValidCollisions') else len(report.collisionInfos))
print('status', orpy.PlannerStatus.HasSolution.statusCode == orpy.PlannerStatusCode.HasSolution)
print('body', env.GetBodyFromEnvironmentBodyIndex(robot.GetEnvironmentBodyIndex()) == robot)
print('infos', robot.ExtractInfo()._name, len(robot.GetManipulators()))
print(repr(robot.GetLink('hand')), eval('orpy.' + repr(robot.GetLink('hand'))) == robot.GetLink('hand'))
orpy.RaveDestroy()
