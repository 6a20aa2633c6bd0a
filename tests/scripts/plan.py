# Plans in all the ways that scripts know, and wants more.
from openravepy import *
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
env.GetKinBody('mug').SetTransform(matrixFromPose([1, 0, 0, 0, 0, 0, 2]))
robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())

def basemanip():
    interfaces.BaseManipulation(robot).MoveActiveJoints(goal=[0.5, 0.2, 0])
def taskmanip():
    interfaces.TaskManipulation(robot).CloseFingers()
def planner():
    planner = RaveCreatePlanner(env, 'birrt')
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig([0.5, 0.2, 0])
    assert planner.InitPlan(robot, params)
    assert planner.PlanPath(RaveCreateTrajectory(env, '')) == PlannerStatus.HasSolution
def parameters():
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig([0.5, 0.2, 0])
def retime():
    traj = RaveCreateTrajectory(env, '')
    traj.Init(robot.GetActiveConfigurationSpecification())
    traj.Insert(0, robot.GetActiveDOFValues())
    traj.Insert(1, [0.5, 0.2, 0])
    planningutils.RetimeActiveDOFTrajectory(traj, robot, hastimestamps=False, maxvelmult=1, maxaccelmult=1)
def smooth():
    traj = RaveCreateTrajectory(env, '')
    traj.Init(robot.GetActiveConfigurationSpecification())
    traj.Insert(0, robot.GetActiveDOFValues())
    traj.Insert(1, [0.5, 0.2, 0])
    assert planningutils.SmoothActiveDOFTrajectory(traj, robot) == PlannerStatus.HasSolution
def grasping():
    model = databases.grasping.GraspingModel(robot, env.GetKinBody('mug'))
    if not model.load():
        model.autogenerate()
def reachability():
    model = databases.kinematicreachability.ReachabilityModel(robot)
    if not model.load():
        model.autogenerate()

for wish in (basemanip, taskmanip, planner, parameters, retime, smooth, grasping, reachability):
    try:
        wish()
        print(wish.__name__, 'worked')
    except NotImplementedError as e:
        print(wish.__name__, '-', e.capability)
print(RaveCreatePlanner(env, 'OMPL_RRTConnect'))
