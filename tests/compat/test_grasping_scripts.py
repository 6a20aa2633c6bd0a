"""The calls of OpenRAVE's examples that grasp: a Panda picks a box up by a table, by the first grasp, by a plan."""

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import CollisionReport, IkParameterization, databases, interfaces

WORLD = f"""<Environment>
  <Robot file="{ravemj.model_path("panda")}" name="panda">
    <jointvalues>0 -0.785398 0 -2.356194 0 1.570796 0.785398 0.03</jointvalues>
  </Robot>
  <KinBody name="table"><Translation>0.55 0 0.1</Translation>
    <Body name="t" type="static"><Geom type="box"><extents>0.25 0.4 0.1</extents></Geom></Body></KinBody>
  <KinBody name="mug"><Translation>0.5 0.1 0.2505</Translation>
    <Body name="m"><Geom type="box"><extents>0.025 0.025 0.05</extents></Geom></Body></KinBody>
</Environment>"""


@pytest.fixture
def env(tmp_path, monkeypatch):
    monkeypatch.setenv("OPENRAVE_HOME", str(tmp_path / "home"))
    env = ravemj.Environment()
    env.LoadData(WORLD)
    ikmodel = databases.inversekinematics.InverseKinematicsModel(
        env.GetRobots()[0], IkParameterization.Type.Transform6D
    )
    if not ikmodel.load():
        ikmodel.autogenerate()
    yield env
    env.Destroy()


class Options:
    boxdelta = 0.04


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """OpenRAVE's folder of those tests that only load the table, which the first one writes."""
    return tmp_path_factory.mktemp("tables")


@pytest.fixture
def gmodel(env, tables, monkeypatch):
    monkeypatch.setenv("OPENRAVE_HOME", str(tables))
    gmodel = databases.grasping.GraspingModel(env.GetRobots()[0], env.GetKinBody("mug"))
    if not gmodel.load():
        gmodel.autogenerate(Options)
    assert databases.grasping.GraspingModel(env.GetRobots()[0], env.GetKinBody("mug")).load()
    return gmodel


@pytest.mark.stress
def test_simplegrasping(env, gmodel):
    robot, target = gmodel.robot, gmodel.target
    basemanip, taskmanip = interfaces.BaseManipulation(robot), interfaces.TaskManipulation(robot)
    validgrasps, validindices = gmodel.computeValidGrasps(returnnum=1)
    assert np.array_equal(gmodel.grasps[validindices[0]], validgrasps[0])
    gmodel.moveToPreshape(validgrasps[0])
    Tgoal = gmodel.getGlobalGraspTransform(validgrasps[0], collisionfree=True)
    basemanip.MoveToHandPosition(matrices=[Tgoal])
    robot.WaitForController(0)
    assert gmodel.manip.GetTransform() == pytest.approx(Tgoal, abs=1e-6)
    taskmanip.CloseFingers()
    robot.WaitForController(0)
    robot.Grab(target)
    before = target.GetTransform()
    basemanip.MoveHandStraight(direction=[0, 0, 1], stepsize=0.01, minsteps=1, maxsteps=10)
    robot.WaitForController(0)
    assert target.GetTransform()[2, 3] == pytest.approx(before[2, 3] + 0.1, abs=0.011)
    assert not env.CheckCollision(robot)


def test_fastgrasping(env):
    """The search ends at the first grasp that the arm reaches."""
    robot, target = env.GetRobots()[0], env.GetKinBody("mug")
    gmodel = databases.grasping.GraspingModel(robot, target)
    gmodel.init(friction=0.4, avoidlinks=[])

    class GraspingError(Exception):
        pass

    def checkgraspfn(contacts, finalconfig, grasp, info):
        Tglobalgrasp = gmodel.getGlobalGraspTransform(grasp, collisionfree=True)
        gmodel.setPreshape(grasp)
        jointvalues = np.array(finalconfig[0])
        if gmodel.manip.CheckEndEffectorCollision(Tglobalgrasp, CollisionReport()):
            return False
        sol = gmodel.manip.FindIKSolution(Tglobalgrasp, True)
        if sol is not None:
            jointvalues[gmodel.manip.GetArmIndices()] = sol
            raise GraspingError(grasp, jointvalues)
        return True

    before = robot.GetDOFValues()
    rays = gmodel.computeBoxApproachRays(delta=0.02)
    with pytest.raises(GraspingError) as found:
        gmodel.generate(preshapes=[[0.04]], approachrays=rays, checkgraspfn=checkgraspfn)
    assert np.array_equal(robot.GetDOFValues(), before)
    assert not gmodel.load()  # nothing is left of the search
    grasp, values = found.value.args
    robot.SetDOFValues(values)
    assert gmodel.manip.GetTransform() == pytest.approx(gmodel.getGlobalGraspTransform(grasp), abs=1e-3)
    assert any(env.CheckCollision(link, target) for link in gmodel.manip.GetChildLinks())


@pytest.mark.stress
def test_an_arm_keeps_grasps_with_noise(env):
    """The base of an arm is far from the hand; noise of the target does not swing it."""
    gmodel = databases.grasping.GraspingModel(env.GetRobots()[0], env.GetKinBody("mug"))
    rays = gmodel.computeBoxApproachRays(delta=0.04)
    gmodel.generate(preshapes=[[0.04]], standoffs=[0], approachrays=rays, graspingnoise=0.01)
    assert len(gmodel.grasps) >= 10


def test_graspplanning(env, gmodel):
    """Plan grasp and place together, go on to the target, close, lift it, and put it where it was planned."""
    robot, target = gmodel.robot, gmodel.target
    basemanip = interfaces.BaseManipulation(robot)
    taskmanip = interfaces.TaskManipulation(robot, graspername=gmodel.grasper.plannername)
    Tdest = target.GetTransform()
    Tdest[:3, 3] += [0, -0.2, 0.002]
    goals, graspindex, _, traj = taskmanip.GraspPlanning(
        gmodel=gmodel,
        approachoffset=0.02,
        destposes=[Tdest],
        seedgrasps=3,
        seeddests=8,
        seedik=1,
        maxiter=1000,
        randomgrasps=False,
        randomdests=False,
        outputtrajobj=True,
    )
    assert traj.GetDuration() > 0
    robot.WaitForController(0)
    grasp = gmodel.grasps[graspindex]
    T = gmodel.getGlobalGraspTransform(grasp, collisionfree=True)
    direction = gmodel.getGlobalApproachDir(grasp)
    away = (T[:3, 3] - gmodel.manip.GetTransform()[:3, 3]) @ direction
    assert away == pytest.approx(0.02, abs=1e-3)
    basemanip.MoveHandStraight(direction=direction, ignorefirstcollision=0, stepsize=0.001, minsteps=10, maxsteps=20)
    robot.WaitForController(0)
    taskmanip.CloseFingers(translationstepmult=gmodel.translationstepmult, finestep=gmodel.finestep)
    robot.WaitForController(0)
    robot.Grab(target)
    basemanip.MoveHandStraight(direction=[0, 0, 1], stepsize=0.003, minsteps=1, maxsteps=10)
    robot.WaitForController(0)
    basemanip.MoveToHandPosition(matrices=[goals[0].GetTransform6D()], seedik=10)
    robot.WaitForController(0)
    assert target.GetTransform() == pytest.approx(Tdest, abs=1e-3)


@pytest.mark.parametrize("lacks", one_in(2, ["zeros", "columns"]))
def test_rows_without_a_pose_are_simulated(gmodel, lacks):
    """The pose is that of the table, which was simulated in the same way."""
    robot, target = gmodel.robot, gmodel.target
    taskmanip = interfaces.TaskManipulation(robot)
    valid, _ = gmodel.computeValidGrasps(returnnum=1)
    past = valid[0].copy()  # flies past the target
    past[list(gmodel.graspindices["igrasppos"])] += [0, 0, 1]
    rows, columns = np.array([past, valid[0]]), dict(gmodel.graspindices)
    for name in ("igrasptrans", "grasptrans_nocol"):
        if lacks == "zeros":
            rows[:, list(columns[name])] = 0
        else:
            del columns[name]
    before = target.GetTransform(), robot.GetDOFValues()
    _, index, _, traj = taskmanip.GraspPlanning(columns, rows, target, execute=False, outputtrajobj=True)
    assert index == 1
    assert np.array_equal(target.GetTransform(), before[0])
    assert np.array_equal(robot.GetDOFValues(), before[1])
    with robot:
        robot.SetActiveDOFs(gmodel.manip.GetArmIndices())
        robot.SetActiveDOFValues(traj.GetWaypoint(-1, robot.GetActiveConfigurationSpecification()))
        T = gmodel.manip.GetTransform()
    expected = gmodel.getGlobalGraspTransform(valid[0], collisionfree=True)
    assert T[:3, :3] == pytest.approx(expected[:3, :3], abs=1e-6)
    assert T[:3, 3] == pytest.approx(expected[:3, 3], abs=1.2e-3)  # OpenRAVE moves the hand back by steps of 1 mm


@pytest.mark.stress
def test_constraintplanning(env, gmodel):
    """A mug that stands a little inside of the table when it is grabbed moves upright, and along one plane."""
    robot, target = gmodel.robot, gmodel.target
    T = target.GetTransform()
    T[2, 3] = 0.245
    target.SetTransform(T)
    basemanip, taskmanip = interfaces.BaseManipulation(robot), interfaces.TaskManipulation(robot)
    assert taskmanip.prob.SendCommand("SetMinimumGoalPaths 1") is not None
    validgrasps, _ = gmodel.computeValidGrasps(returnnum=10)
    values = robot.GetDOFValues()
    values[gmodel.manip.GetGripperIndices()] = gmodel.getPreshape(validgrasps[-1])
    robot.GetController().SetDesired(values)
    robot.WaitForController(0)
    basemanip.MoveToHandPosition(
        matrices=[gmodel.getGlobalGraspTransform(validgrasps[-1], collisionfree=True)], seedik=10
    )
    robot.WaitForController(0)
    taskmanip.CloseFingers()
    robot.WaitForController(0)
    robot.Grab(target)
    assert env.CheckCollision(target)
    before, Tgoal = target.GetTransform(), gmodel.manip.GetEndEffectorTransform()
    Tgoal[2, 3] += 0.15
    traj = basemanip.MoveToHandPosition(
        matrices=[Tgoal],
        constraintfreedoms=[1, 1, 0, 1, 0, 0],
        constraintmatrix=np.eye(4),
        constrainterrorthresh=0.005,
        steplength=0.002,
        execute=False,
        outputtrajobj=True,
    )
    spec = robot.GetActiveConfigurationSpecification()
    for time in np.linspace(0, traj.GetDuration(), 50):
        with robot:
            robot.SetActiveDOFValues(traj.Sample(time, spec))
            change = target.GetTransform() @ np.linalg.inv(before)
            assert abs(target.GetTransform()[0, 3] - before[0, 3]) < 0.006
            assert change[2, 2] > np.cos(0.006)
    assert target.GetTransform() == pytest.approx(before)


def test_tutorial_on_one_grasp(gmodel):
    """Returning a trajectory, testing a grasp, and moving to where it begins."""
    robot = gmodel.robot
    grasp = gmodel.grasps[0]
    contacts, finalconfig, mindist, _ = gmodel.testGrasp(grasp=grasp, translate=True, forceclosure=True)
    assert len(contacts) >= 4
    assert mindist == pytest.approx(grasp[gmodel.graspindices["forceclosure"][0]], rel=1e-4)
    assert finalconfig[1].shape == (4, 4)
    with gmodel.GripperVisibility(gmodel.manip):
        gmodel.showgrasp(grasp, delay=0)
        assert gmodel.drawContacts(contacts) is not None
    traj = gmodel.moveToPreshape(grasp, execute=False, outputtrajobj=True)
    assert traj is not None
    assert robot.GetDOFValues()[-1] == pytest.approx(0.03)
