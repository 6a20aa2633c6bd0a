#!/usr/bin/env python
# HW2, from the days of Python 2: samples the workspace on a grid.
from openravepy import *
from homework2_utils import *
import numpy, string

env = Environment()
env.Load('data/room.env.xml')
env.Remove(env.GetKinBody('mug'))
robot = env.GetRobots()[0]
robot.SetActiveDOFs([0,1])

counts = {}
half = GRID/2
for i in xrange(-half, half+1):
    for j in range(-half, half+1):
        key = state(env, robot, [i*STEP, j*STEP])
        if not counts.has_key(key):
            counts[key] = 0
        counts[key] += 1
print "grid", GRID, "half", half, GRID/2.
print "free %d of %d"%(counts['free'], sum(counts.values()))
print "names", map(lambda n: n.upper(), sorted(counts.keys()))
try:
    robot.SetDOFValues([0])
except openrave_exception, e:
    print "error:", e.GetCode()
print >>sys.stderr, "done"
