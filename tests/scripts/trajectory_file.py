# Saves a trajectory with velocities, reads it again, reverses it.
from openravepy import *
from openravepy import misc
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
spec = robot.GetActiveManipulator().GetArmConfigurationSpecification('quadratic')
spec.AddDerivativeGroups(1, True)
traj = RaveCreateTrajectory(env, '')
traj.Init(spec)
data = [0.0] * spec.GetDOF()
indices = robot.GetActiveManipulator().GetArmIndices()
for t, q, v in ((0, 0, 0), (1, 0.5, 1), (1, 1, 0)):
    spec.InsertDeltaTime(data, t)
    spec.InsertJointValues(data, [q] * len(indices), robot, indices, 0)
    spec.InsertJointValues(data, [v] * len(indices), robot, indices, 1)
    traj.Insert(traj.GetNumWaypoints(), data)
traj.SaveToFile('mine.traj')
open('mine.xml', 'wb').write(traj.serialize(0x8000))
other = RaveCreateTrajectory(env, '')
other.LoadFromFile('mine.traj')
third = misc.LoadTrajectoryFromFile(env, 'mine.xml')
for one in (traj, other, third, planningutils.ReverseTrajectory(traj)):
    sample = one.Sample(0.5)
    print('at 0.5', spec.ExtractJointValues(sample, robot, [0])[0], spec.ExtractJointValues(sample, robot, [0], 1)[0])
