"""Inverse kinematics by the API: what is asked, what is checked, what stays as it was."""

from contextlib import nullcontext

import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st
from ravemj.databases.inversekinematics import InverseKinematicsError, InverseKinematicsModel

import ravemj
from ravemj import IkFilterOptions, IkParameterization, IkReturn, IkReturnAction

Type = IkParameterization.Type
UNCHECKED = IkFilterOptions.IgnoreSelfCollisions
EVERYWHERE = UNCHECKED | IkFilterOptions.IgnoreJointLimits
CONFIGURATION = [-0.1, 0.6, -1.0, -1.2, 1.1, -1.9]
"""Of a PUMA: there are twelve ways to its pose, of which none collides."""

PLANAR = """<Environment><Robot name="planar"><KinBody>
  <Body name="base" type="dynamic"><Geom type="box"><extents>0.05 0.05 0.05</extents></Geom></Body>
  <Body name="l1" type="dynamic"><Translation>0 0 0.2</Translation>
    <Geom type="box"><extents>0.2 0.02 0.02</extents><Translation>0.25 0 0</Translation></Geom></Body>
  <Body name="l2" type="dynamic"><Translation>0.5 0 0.2</Translation>
    <Geom type="box"><extents>0.1 0.02 0.02</extents><Translation>0.2 0 0</Translation></Geom></Body>
  <Joint name="j1" type="hinge"><Body>base</Body><Body>l1</Body><offsetfrom>l1</offsetfrom><axis>0 0 1</axis>
    <limitsdeg>-360 360</limitsdeg></Joint>
  <Joint name="j2" type="hinge"><Body>l1</Body><Body>l2</Body><offsetfrom>l2</offsetfrom><axis>0 0 1</axis>
    <limitsdeg>-170 170</limitsdeg></Joint>
  </KinBody>
  <Manipulator name="arm"><base>base</base><effector>l2</effector><Translation>0.3 0 0</Translation>
    <direction>1 0 0</direction></Manipulator>
</Robot></Environment>"""


def arm_of(name, kind=Type.Transform6D):
    robot = ravemj.load(MODELS / name).GetRobots()[0]
    model = InverseKinematicsModel(robot, kind)
    assert model.load()
    return model.manip


@pytest.fixture
def puma():
    return arm_of("puma560.xml")


@pytest.fixture
def planar():
    env = ravemj.Environment()
    assert env.LoadData(PLANAR)
    robot = env.GetRobots()[0]
    model = InverseKinematicsModel(robot, Type.TranslationXY2D)
    assert model.load()
    return model.manip


def at(arm, values):
    """Where the tool is in a configuration; the robot goes back."""
    with arm.GetRobot() as robot:
        robot.SetDOFValues(values, arm.GetArmIndices())
        return arm.GetTransform()


def reaches(arm, values, T):
    with arm.GetRobot() as robot:
        robot.SetDOFValues(values, arm.GetArmIndices(), ravemj.CheckLimitsAction.Nothing)
        return np.abs(arm.GetTransform() - T).max() < 1e-7


# Solutions


shares = st.lists(st.floats(0.01, 0.99), min_size=6, max_size=6)


@given(shares, shares)
def test_solutions_reach_their_goal_and_the_nearest_is_one_of_them(configuration, start):
    arm = puma_once()
    robot = arm.GetRobot()
    robot.SetTransform(ravemj.matrixFromAxisAngle(start[:3]))
    lower, upper = robot.GetDOFLimits()
    values = lower + configuration * (upper - lower)
    T = at(arm, values)
    everything = arm.FindIKSolutions(T, UNCHECKED)
    assert all(reaches(arm, row, T) for row in everything)
    robot.SetDOFValues(lower + start * (upper - lower))
    best = arm.FindIKSolution(T, UNCHECKED)
    away = np.linalg.norm((everything - robot.GetDOFValues()) * robot.GetDOFWeights(), axis=1)
    nearest = np.linalg.norm((best - robot.GetDOFValues()) * robot.GetDOFWeights())
    assert reaches(arm, best, T)
    assert nearest <= away.min() + 1e-9
    if np.abs(np.sin(values[4])) > 0.01:  # else joints 4 and 6 turn about one line, and share any sum
        assert np.abs(everything - values).max(axis=1).min() < 1e-6


def puma_once(kept=[]):  # noqa: B006 - loading it for each example takes long
    if not kept:
        kept.append(arm_of("puma560.xml"))
    return kept[0]


def test_further_turns_are_solutions_and_the_nearest_turn_is_taken(planar):
    robot = planar.GetRobot()
    goal = IkParameterization(at(planar, [0.3, 0.8])[:2, 3], Type.TranslationXY2D)
    found = planar.FindIKSolutions(goal, UNCHECKED)
    assert sorted(np.round(found[:, 0], 6)) == sorted([*np.round([0.3, 0.3 - 2 * np.pi], 6), *rest(found, 0.3)])
    for start in (5.5, -5.5):
        robot.SetDOFValues([start, 0.8])
        best = planar.FindIKSolution(goal, UNCHECKED)
        away = np.linalg.norm(found - robot.GetDOFValues(), axis=1)
        np.testing.assert_allclose(best, found[np.argmin(away)])


def rest(found, value):
    """First values of the rows of the other elbow."""
    other = np.abs(np.sin((found[:, 0] - value) / 2)) > 1e-6
    assert other.sum() == 2
    return np.round(found[other, 0], 6).tolist()


def test_limits_are_seen_at_once_and_derive_nothing_anew(puma):
    robot, T = puma.GetRobot(), at(puma, CONFIGURATION)
    certificate = puma.ik_solver().certificate
    count = len(puma.FindIKSolutions(T, UNCHECKED))
    lower, upper = robot.GetDOFLimits()
    robot.SetDOFLimits(np.append([-0.2], lower[1:]), np.append([0.0], upper[1:]))
    assert len(puma.FindIKSolutions(T, UNCHECKED)) < count
    robot.SetDOFLimits(np.full(6, -0.01), np.full(6, 0.01))
    answer = puma.FindIKSolution(T, UNCHECKED, ikreturn=True)
    assert answer.GetAction() == IkReturnAction.RejectJointLimits
    assert puma.FindIKSolutions(T, UNCHECKED).shape == (0,)
    assert len(puma.FindIKSolutions(T, EVERYWHERE)) == 8
    robot.SetDOFLimits(np.array(CONFIGURATION), np.array(CONFIGURATION))  # all joints are locked
    np.testing.assert_allclose(puma.FindIKSolution(T, UNCHECKED), CONFIGURATION, atol=1e-9)
    assert puma.ik_solver().certificate is certificate


def test_the_robot_is_as_before_and_so_is_what_it_holds(puma):
    robot = puma.GetRobot()
    env = robot.GetEnv()
    ball = ravemj.RaveCreateKinBody(env, "")
    ball.InitFromBoxes([[0, 0, 0, 0.01, 0.01, 0.01]])
    ball.SetName("ball")
    env.Add(ball)
    ball.SetTransform(puma.GetTransform())
    robot.Grab(ball)
    robot.SetActiveDOFs([1, 0])
    T = at(puma, CONFIGURATION)
    before = [robot.GetDOFValues(), ball.GetTransform(), robot.GetLinkTransformations()]
    puma.FindIKSolution(T, IkFilterOptions.CheckEnvCollisions)
    puma.FindIKSolutions(T, IkFilterOptions.CheckEnvCollisions)
    after = [robot.GetDOFValues(), ball.GetTransform(), robot.GetLinkTransformations()]
    assert np.array_equal(before[0], after[0])
    assert np.array_equal(before[1], after[1])
    assert np.array_equal(before[2], after[2])
    assert robot.GetActiveDOFIndices().tolist() == [1, 0]


# Filters and failures


def test_a_filter_sees_each_solution_in_its_configuration_nearest_first(puma):
    robot, T = puma.GetRobot(), at(puma, CONFIGURATION)
    robot.SetDOFValues(CONFIGURATION)
    seen = []

    def look(values, arm, goal):
        assert np.array_equal(robot.GetDOFValues(), values)
        assert robot.GetActiveDOFIndices().tolist() == arm.GetArmIndices().tolist()
        assert goal.GetType() == Type.Transform6D
        seen.append(np.linalg.norm((values - CONFIGURATION) * robot.GetDOFWeights()))
        return IkReturnAction.Reject

    handle = puma.GetIkSolver().RegisterCustomFilter(0, look)
    assert puma.FindIKSolution(T, UNCHECKED) is None
    assert seen == sorted(seen)
    assert len(seen) == len(puma.FindIKSolutions(T, UNCHECKED | IkFilterOptions.IgnoreCustomFilters))
    answer = puma.FindIKSolution(T, UNCHECKED, ikreturn=True)
    assert answer.GetAction() & 0x8001 == 0x8001
    assert len(answer.GetSolution()) == 0
    del handle
    assert puma.FindIKSolution(T, UNCHECKED) is not None


def test_a_filter_can_end_the_search_attach_data_and_fail(puma):
    T, solver = at(puma, CONFIGURATION), puma.GetIkSolver()
    said = [IkReturnAction.Success, IkReturnAction.Quit, IkReturnAction.Success]
    answers = iter(said)
    with solver.RegisterCustomFilter(0, lambda values, arm, goal: next(answers)):
        assert puma.FindIKSolutions(T, UNCHECKED).shape == (0,)

    def attach(values, arm, goal):
        answer = IkReturn(IkReturnAction.Success)
        answer.SetMapKeyValue("grade", [len(values)])
        answer.SetUserData(goal)
        return answer

    with solver.RegisterCustomFilter(-5, attach):
        answer = puma.FindIKSolution(T, UNCHECKED, ikreturn=True)
        assert answer.GetMapData("grade").tolist() == [6]
        assert answer.GetUserData().GetType() == Type.Transform6D
        with puma.GetRobot() as robot:
            robot.SetDOFValues(CONFIGURATION)
            here = puma.GetIkParameterization(Type.Transform6D, False)
            assert solver.CallFilters(here).GetMapData("grade").tolist() == [6]
        with pytest.raises(ravemj.openrave_exception, match="where the tool is"):
            solver.CallFilters(here)
    with solver.RegisterCustomFilter(1, lambda values, arm, goal: 1 / 0):
        before = puma.GetRobot().GetDOFValues()
        with pytest.raises(ravemj.openrave_exception, match="ZeroDivisionError") as caught:
            puma.FindIKSolution(T, UNCHECKED)
        assert caught.value.GetCode() == "Assert"
        assert np.array_equal(puma.GetRobot().GetDOFValues(), before)
    assert puma.FindIKSolution(T, UNCHECKED) is not None


def test_failures_are_listed_with_their_reasons(puma):
    T, env = at(puma, CONFIGURATION), puma.GetRobot().GetEnv()
    wall = ravemj.RaveCreateKinBody(env, "")
    wall.InitFromBoxes([[*T[:3, 3], 0.005, 0.005, 0.005]])
    wall.SetName("wall")
    env.Add(wall)
    failures = []
    check = IkFilterOptions.CheckEnvCollisions
    answer = puma.FindIKSolution(T, check, ikreturn=True, ikFailureAccumulator=failures)
    assert answer.GetAction() == IkReturnAction.QuitEndEffectorCollision | IkReturnAction.Reject
    assert answer.GetIkFailureInfoIndices() == [0]
    assert "wall" in str(failures[0].GetCollisionReport().plink2)
    assert reaches(puma, failures[0].GetConfiguration(), T)
    far = T.copy()
    far[:3, 3] *= 20
    assert puma.FindIKSolution(far, check, ikFailureAccumulator=failures) is None
    assert failures[1].GetAction() == IkReturnAction.RejectKinematics
    assert puma.FindIKSolution(T, check | IkFilterOptions.IgnoreEndEffectorEnvCollisions) is not None
    wall.Enable(False)
    assert puma.FindIKSolution(T, check) is not None


def test_only_what_the_arm_moves_is_tested(puma):
    """A base that stands in the floor is no reason to reject a configuration: it is where it is."""
    T, robot = at(puma, CONFIGURATION), puma.GetRobot()
    env = robot.GetEnv()
    floor = ravemj.RaveCreateKinBody(env, "")
    base = robot.GetLinks()[0].ComputeAABB()
    floor.InitFromBoxes([[*(base.pos() - [0, 0, base.extents()[2]]), 1, 1, 0.02]])
    floor.SetName("floor")
    env.Add(floor)
    assert env.CheckCollision(robot)
    assert puma.FindIKSolution(T, IkFilterOptions.CheckEnvCollisions) is not None


# Free joints


def test_a_free_joint_is_searched_from_where_it_is_or_given():
    arm = arm_of("panda.xml")
    robot, values = arm.GetRobot(), np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.6, 0.5])
    T = at(arm, values)
    (free,) = arm.ik_solver().free
    robot.SetDOFValues(values + 0.02, arm.GetArmIndices())
    assert arm.FindIKSolution(T, UNCHECKED)[free] == pytest.approx(values[free] + 0.02)
    robot.SetDOFValues(values, arm.GetArmIndices())
    shares = arm.GetFreeParameters()
    robot.SetDOFValues(values - 0.1, arm.GetArmIndices())
    given_share = arm.FindIKSolutions(T, shares, UNCHECKED)
    assert np.abs(given_share - values).max(axis=1).min() < 1e-6
    assert np.ptp(given_share[:, free]) == 0
    np.testing.assert_allclose(arm.FindIKSolution(T, freevalues=shares, filteroptions=UNCHECKED), values, atol=1e-6)
    wide = InverseKinematicsModel(robot, Type.Transform6D)
    assert wide.load(freeinc=[0.5])
    found = np.unique(np.round(arm.FindIKSolutions(T, UNCHECKED)[:, free], 6))
    np.testing.assert_allclose(np.diff(found) % 0.5, 0, atol=1e-5)
    with pytest.raises(InverseKinematicsError, match="freeinc"):
        wide.setrobot([0.1, 0.2])
    with pytest.raises(TypeError):
        wide.setrobot(0.1)


def test_samples_of_many_free_joints_stay_within_bounds():
    arm = arm_of("panda.xml", Type.TranslationXY2D)
    assert len(arm.ik_solver(Type.TranslationXY2D).free) == 5
    goal = arm.GetIkParameterization(Type.TranslationXY2D)
    assert len(arm.ik_solver(Type.TranslationXY2D).free_samples()) < 20_000
    assert arm.FindIKSolution(goal, UNCHECKED) is not None


# Many goals


def test_batches_answer_as_one_goal_after_the_other(puma):
    robot = puma.GetRobot()
    robot.SetTransform(ravemj.matrixFromPose([0.6, 0, 0, 0.8, 1, 2, 3]))
    rng = np.random.default_rng(3)
    lower, upper = robot.GetDOFLimits()
    poses = np.array([at(puma, row) for row in rng.uniform(lower, upper, (20, 6))])
    poses[7, :3, 3] += 10
    found = puma.ik(poses)
    assert found.solutions.shape == (20, 8, 6)
    assert len(found.branches) == len(set(found.branches)) == 8
    assert not found.valid[7].any()
    for T, rows, valid in zip(poses, found.solutions, found.valid, strict=True):
        assert all(reaches(puma, row, T) for row in rows[valid])
        one = puma.FindIKSolutions(T, UNCHECKED)
        assert all(np.abs(np.sin((one - row) / 2)).max(axis=1).min() < 1e-7 for row in rows[valid])
    assert robot.ik(poses[0]).valid.shape == (1, 8)
    assert "spherical wrist" in puma.ik_solver().describe()
    with pytest.raises(ravemj.openrave_exception, match="rigid"):
        puma.ik(np.zeros((2, 4, 4)))
    seven = arm_of("panda.xml")
    many = seven.ik(seven.GetTransform())
    assert many.solutions.shape[1] == len(many.branches) == len(set(many.branches))


def test_batches_of_places(planar):
    places = np.array([at(planar, row)[:2, 3] for row in ([0.3, 0.8], [-1.0, 1.2])])
    found = planar.ik(places, Type.TranslationXY2D)
    for row, value in zip(found.solutions, ([0.3, 0.8], [-1.0, 1.2]), strict=True):
        assert np.abs(row - value).max(axis=1).min() < 1e-9


# Life of solvers


def test_solvers_go_with_tools_clones_and_robots(puma):
    robot, solver, T = puma.GetRobot(), puma.GetIkSolver(), at(puma, CONFIGURATION)
    tool = puma.GetLocalToolTransform()
    puma.SetLocalToolTransform(tool)
    puma.SetLocalToolDirection([1, 0, 0])
    assert puma.GetIkSolver() is solver
    clone = robot.GetEnv().CloneSelf(ravemj.CloningOptions.Bodies)
    twin = clone.GetRobots()[0].GetManipulators()[0]
    assert twin.GetIkSolver().GetEnv() == clone
    np.testing.assert_allclose(twin.FindIKSolutions(T, UNCHECKED), puma.FindIKSolutions(T, UNCHECKED))
    tool[:3, 3] += 0.1
    puma.SetLocalToolTransform(tool)
    assert puma.GetIkSolver() is None
    assert puma.SetIkSolver(solver)
    T = at(puma, CONFIGURATION)
    assert all(reaches(puma, row, T) for row in puma.FindIKSolutions(T, UNCHECKED))
    assert twin.GetIkSolver() is not None
    assert puma.SetIKSolver(None)
    assert puma.GetIkSolver() is None
    with pytest.raises(ravemj.openrave_exception, match=r"load\(\)") as caught:
        puma.FindIKSolution(T, 0)
    assert caught.value.GetCode() == "Failed"


def test_names_make_solvers(puma, caplog):
    env, T = puma.GetRobot().GetEnv(), at(puma, CONFIGURATION)
    model = InverseKinematicsModel(puma.GetRobot(), Type.Transform6D)
    solver = ravemj.RaveCreateIkSolver(env, model.getikname())
    assert solver.Supports(Type.Transform6D)
    with pytest.raises(ravemj.openrave_exception, match="SetIkSolver"):
        solver.GetNumFreeParameters()
    assert puma.SetIkSolver(solver)
    assert puma.FindIKSolution(T, UNCHECKED) is not None
    assert ravemj.RaveCreateIkSolver(env, "nonsense") is None
    assert "nonsense" in caplog.text
    with pytest.raises(ravemj.openrave_exception):
        puma.SetIkSolver("ikfast")


def test_models_tell_about_themselves(puma):
    model = InverseKinematicsModel(puma.GetRobot(), Type.Transform6D)
    assert model.load()
    assert model.has()
    assert model.testik("5") == (1.0, 0.0)
    assert model.freeindices == []
    other = model.clone(puma.GetRobot().GetEnv().CloneSelf(ravemj.CloningOptions.Bodies))
    assert other.has()
    puma.SetIkSolver(None)
    assert not model.has()
    model.generate(Type.Translation3D, freejoints=["joint4", 4, 5])
    assert model.solveindices == [0, 1, 2]
    assert puma.GetNumFreeParameters() == 3


# What cannot be


@pytest.mark.parametrize(
    ("manipulator", "said"),
    [
        ("<base>base</base><effector>base</effector>", "no joint that moves"),
        ("<effector>l2</effector>", "no base"),
    ],
)
def test_arms_that_are_none_say_so(manipulator, said, caplog):
    text = PLANAR[: PLANAR.index("<base>")] + manipulator + "</Manipulator></Robot></Environment>"
    env = ravemj.Environment()
    with pytest.warns(ravemj.RavemjWarning, match="no-arm") if "<base>" not in manipulator else nullcontext():
        assert env.LoadData(text)
    model = InverseKinematicsModel(env.GetRobots()[0], Type.TranslationXY2D)
    assert not model.load()
    assert said in model.ikfeasibility
    assert said in caplog.text
    assert model.manip.GetIkSolver() is None
    with pytest.raises(InverseKinematicsError, match=said):
        model.generate()
    with pytest.raises(ravemj.openrave_exception, match=said):
        model.manip.ik_solver()


def test_joints_that_follow_others_are_none_to_solve_for():
    env = ravemj.Environment()
    mimic = PLANAR.replace('"j2" type="hinge"', '"j2" type="hinge" enable="false" mimic_pos="j1"')
    assert env.LoadData(mimic.replace("<limitsdeg>-170 170</limitsdeg>", ""))
    model = InverseKinematicsModel(env.GetRobots()[0], Type.TranslationXY2D)
    assert not model.load()
    assert model.ikfeasibility == "'arm' has 1 joints to solve for, and TranslationXY2D needs 2"


def test_robots_without_arms_and_joints_outside_of_them_say_so(puma):
    env = ravemj.Environment()
    env.LoadData(PLANAR[: PLANAR.index("<Manipulator")] + "</Robot></Environment>")
    robot = env.GetRobots()[0]
    with pytest.raises(InverseKinematicsError, match="AddManipulator"):
        InverseKinematicsModel(robot, Type.Transform6D)
    with pytest.raises(ravemj.openrave_exception, match="SetActiveManipulator"):
        robot.ik(np.eye(4))
    with pytest.raises(InverseKinematicsError, match="outside"):
        InverseKinematicsModel(puma.GetRobot(), Type.Transform6D, freeindices=[9])
    with pytest.raises(LookupError, match="nobody"):
        InverseKinematicsModel(puma.GetRobot(), Type.Transform6D, freejoints=["nobody"])
    with pytest.raises(InverseKinematicsError, match="iktype"):
        InverseKinematicsModel(puma.GetRobot()).GetDefaultIndices()


@pytest.mark.parametrize("wrong", [np.full((4, 4), np.nan), np.diag([1, -1, 1, 1.0]), np.zeros((4, 4)), "x"])
def test_goals_that_are_no_poses_say_so(puma, wrong):
    for find in (puma.FindIKSolution, puma.FindIKSolutions):
        with pytest.raises(ravemj.openrave_exception, match="param") as caught:
            find(wrong, 0)
        assert caught.value.GetCode() == "InvalidArguments"


def test_goals_of_a_wrong_shape_are_value_errors(puma):
    for find in (puma.FindIKSolution, puma.FindIKSolutions):
        with pytest.raises(ValueError, match="param: has shape"):
            find([1, 2], 0)


def test_calls_without_options_or_with_others_are_type_errors(puma):
    T = puma.GetTransform()
    for call in (
        lambda: puma.FindIKSolution(T),
        lambda: puma.FindIKSolution(T, "x"),
        lambda: puma.FindIKSolution(T, None),
        lambda: puma.FindIKSolutions(T, filteroptions=0, nonsense=1),
    ):
        with pytest.raises(TypeError):
            call()
    assert puma.FindIKSolution(param=T, filteroptions=True) is not None
    assert puma.FindIKSolution(T, 0, True).GetAction() == 0


def test_solvers_of_removed_arms_and_of_other_environments_say_so(puma):
    robot, solver = puma.GetRobot(), puma.GetIkSolver()
    goal = puma.GetIkParameterization(Type.Transform6D, False)
    with pytest.raises(ravemj.openrave_exception, match="another environment"):
        arm_of("puma560.xml").SetIkSolver(solver)
    with pytest.raises(ravemj.openrave_exception, match="freevalues"):
        solver.SolveAll(goal, "x", 0)
    assert robot.RemoveManipulator(puma)
    with pytest.raises(ravemj.openrave_exception, match="removed"):
        solver.Solve(goal, None, 0)


# Between the samples of a free joint, and out of reach


NARROW = [-1.87, -1.69, -0.3, -0.75, 1.75, 1.79, 2.84]
"""Of a Panda: no sample of the free joint from 0 outwards has a solution for its pose."""


@pytest.mark.parametrize("options", [0, UNCHECKED, IkFilterOptions.CheckEnvCollisions])
def test_a_pose_between_samples_is_found_by_all_functions(options):
    panda = arm_of("panda.xml")
    T = at(panda, NARROW)
    rows = panda.FindIKSolutions(T, options)
    assert len(rows)
    assert all(reaches(panda, row, T) for row in [*rows, panda.FindIKSolution(T, options)])
    assert [answer.GetAction() for answer in panda.FindIKSolutions(T, options, ikreturn=True)] == [0] * len(rows)
    assert panda.FindIKSolution(T, options, ikreturn=True).GetAction() == 0


def test_a_filter_is_asked_between_the_samples_of_a_free_joint():
    panda = arm_of("panda.xml")
    T = at(panda, [0.3, 0.5, 0.4, -1.5, 0.2, 1.8, 0.1])
    samples = panda.FindIKSolutions(T, UNCHECKED)[:, 6]
    free, asked = np.unique(samples), []

    def between(values, manipulator, goal):
        asked.append(values[6])
        return IkReturnAction.Success if np.abs(values[6] - free).min() > 0.02 else IkReturnAction.Reject

    handle = panda.GetIkSolver().RegisterCustomFilter(0, between)
    rows = panda.FindIKSolutions(T, UNCHECKED)
    assert len(rows)
    assert all(reaches(panda, row, T) for row in rows)
    np.testing.assert_array_equal(asked[: len(samples)], samples)
    one = panda.FindIKSolution(T, UNCHECKED)
    assert reaches(panda, one, T)
    assert between(one, panda, None) == IkReturnAction.Success
    handle.Close()
    asked.clear()
    reject = panda.GetIkSolver().RegisterCustomFilter(0, lambda *one: asked.append(one) or IkReturnAction.Reject)
    assert not len(panda.FindIKSolutions(T, UNCHECKED))
    assert len(samples) < len(asked) < 2 * len(samples) + 300
    reject.Close()


def test_a_quit_ends_the_search_before_the_intervals():
    panda, asked = arm_of("panda.xml"), []
    T = at(panda, [0.3, 0.5, 0.4, -1.5, 0.2, 1.8, 0.1])
    handle = panda.GetIkSolver().RegisterCustomFilter(0, lambda *one: asked.append(one) or IkReturnAction.Quit)
    assert not len(panda.FindIKSolutions(T, UNCHECKED))
    assert panda.FindIKSolution(T, UNCHECKED) is None
    assert len(asked) == 2
    handle.Close()


def test_a_scaled_rotation_is_solved_as_in_openrave_with_a_warning(puma):
    T = at(puma, CONFIGURATION)
    T[:3, :3] *= 1.1
    with pytest.warns(ravemj.RavemjWarning, match="scaled by 1.1") as told:
        found = puma.FindIKSolution(T, UNCHECKED)
    assert [one.message.code for one in told] == ["scaled-rotation"]
    with pytest.warns(ravemj.RavemjWarning, match="scaled by 1.1"):
        goal = IkParameterization(T, Type.Transform6D)
    np.testing.assert_array_equal(puma.FindIKSolution(goal, UNCHECKED), found)
    with pytest.raises(ravemj.openrave_exception, match="scale or shear"):
        puma.ik(T)
    T[:3, :3] *= 1.0001 / 1.1
    assert len(puma.FindIKSolutions(T, UNCHECKED))
    assert puma.ik(T).valid.any()
