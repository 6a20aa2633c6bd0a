# Wants a planner, in all the ways that scripts know.
from openravepy import *
env = Environment()
env.Load('data/room.env.xml')
robot = env.GetRobots()[0]
robot.SetActiveDOFs(robot.GetActiveManipulator().GetArmIndices())

def basemanip():
    interfaces.BaseManipulation(robot).MoveActiveJoints(goal=[0.5, 0.2, 0])
def taskmanip():
    interfaces.TaskManipulation(robot).CloseFingers()
def planner():
    planner = RaveCreatePlanner(env, 'birrt')
    planner.InitPlan(robot, Planner.PlannerParameters())
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
    planningutils.SmoothActiveDOFTrajectory(RaveCreateTrajectory(env, ''), robot)
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
