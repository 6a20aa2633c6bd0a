"""Rules of ``InverseKinematicsModel``: every type, every free joint, wrong arguments, solvers that were removed."""

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import IkParameterizationType as Type
from ravemj import IkReturnAction
from ravemj.compat.databases.inversekinematics import InverseKinematicsError, InverseKinematicsModel

TYPES = [kind for kind in Type if kind.name != "none" and not kind.name.endswith("Velocity")]
TYPES = [kind for kind in TYPES if kind.name not in {"VelocityDataBit", "CustomDataBit", "UniqueIdMask"}]
FEW = "6"
CONFIGURATION = [0.3, 0.2, -0.9, 0.4, -0.5, 0.6]


@pytest.fixture(params=["panda", "puma560"])
def arm(request):
    env = ravemj.load(ravemj.model_path(request.param))
    yield env.GetRobots()[0].GetActiveManipulator()
    env.Destroy()


@pytest.fixture
def panda():
    env = ravemj.load(ravemj.model_path("panda"))
    yield env.GetRobots()[0].GetActiveManipulator()
    env.Destroy()


@pytest.fixture(scope="module")
def puma():
    env = ravemj.load(ravemj.model_path("puma560"))
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.1, 0.1]]), True)
    box.SetName("box")
    env.Add(box)
    arm = env.GetRobots()[0].GetActiveManipulator()
    assert InverseKinematicsModel(env.GetRobots()[0], iktype=Type.Transform6D).load()
    yield arm
    env.Destroy()


def test_there_are_sixteen_types():
    assert len(TYPES) == 16


@pytest.mark.parametrize("kind", one_in(2, TYPES), ids=lambda kind: kind.name)
def test_every_type_divides_the_joints_and_solves(arm, kind):
    model = InverseKinematicsModel(arm.GetRobot(), iktype=kind)
    assert not model.has()
    assert model.solveindices is model.freeindices is model.iksolver is model.freeinc is None
    assert model.load()
    assert model.has()
    assert sorted([*model.freeindices, *model.solveindices]) == arm.GetArmIndices().tolist()
    assert len(model.freeinc) == len(model.freeindices) == model.iksolver.GetNumFreeParameters()
    found, wrong = model.testik(FEW)
    assert found >= 0.5  # free joints are sampled
    assert wrong == 0
    assert kind.name in model.getikname()


@pytest.mark.parametrize("joint", range(7))
@pytest.mark.parametrize("by_name", [False, True])
def test_each_free_joint_of_seven(panda, joint, by_name, caplog):
    robot, index = panda.GetRobot(), int(panda.GetArmIndices()[joint])
    named = {"freejoints": [robot.GetJointFromDOFIndex(index).GetName()]} if by_name else {"freeindices": [index]}
    model = InverseKinematicsModel(robot, iktype=Type.Transform6D, **named)
    assert model.freeindices == [index]
    assert model.load(freeinc=[0.2])
    if model.freeindices == [index]:
        assert model.freeinc == [0.2]
        assert model.iksolver.GetNumFreeParameters() == 1
        assert not caplog.text
    else:
        assert f"no solver samples the joints [{index}]" in caplog.text
    assert model.testik(FEW)[1] == 0


def test_a_model_without_a_type_takes_that_of_the_solver(arm):
    robot = arm.GetRobot()
    without = InverseKinematicsModel(robot)
    assert (without.load(), without.iktype, without.has(), arm.GetIkSolver()) == (False, None, False, None)
    for call in (without.testik, without.perftiming):
        with pytest.raises(InverseKinematicsError, match="iktype is not known"):
            call(2)
    for call in (without.getikname, without.getfilename, without.getstatsfilename, without.GetDefaultIndices):
        with pytest.raises(InverseKinematicsError, match="iktype is not known"):
            call()
    without.autogenerate()
    assert (without.iktype, without.has()) == (Type.Transform6D, True)
    for kind in TYPES:
        assert InverseKinematicsModel(robot, iktype=kind).load()
        again = InverseKinematicsModel(robot)
        assert (again.iktype, again.load(), again.iktype) == (None, True, kind)


def test_a_solver_that_was_removed_is_made_again_by_load(arm):
    model = InverseKinematicsModel(arm.GetRobot(), iktype=Type.Transform6D)
    for _ in range(3):
        assert model.load()
        assert arm.FindIKSolution(arm.GetTransform(), 0) is not None
        assert arm.SetIkSolver(None)
        assert arm.GetIkSolver() is None
        assert not model.has()
        with pytest.raises(ravemj.openrave_exception, match="no solver of inverse kinematics"):
            arm.FindIKSolution(arm.GetTransform(), 0)


def test_another_type_replaces_the_solver(arm):
    first, second = (InverseKinematicsModel(arm.GetRobot(), iktype=kind) for kind in TYPES[:2])
    assert first.load()
    assert second.load()
    assert (first.has(), second.has()) == (False, True)


WRONG = {
    "joint": ({"freejoints": ["nosuch"]}, LookupError, "no joint 'nosuch'"),
    "half": ({"freejoints": [1.5]}, TypeError, "float.*freejoints="),
    "half index": ({"freeindices": [1.5]}, TypeError, "float.*freeindices="),
    "word": ({"freeindices": ["x"]}, TypeError, "str.*freeindices="),
    "twice": ({"freeindices": [2, 2]}, InverseKinematicsError, "name a joint twice"),
    "outside": ({"freeindices": [99]}, InverseKinematicsError, "outside of the arm"),
    "negative": ({"freejoints": [-1]}, InverseKinematicsError, "outside of the arm"),
    "bare": ({"freejoints": "j1"}, TypeError, "freejoints: is of type str, and should be a list"),
    "bare index": ({"freeindices": 2}, TypeError, "freeindices: is of type int, and should be a list"),
    "type": ({"iktype": "pose"}, TypeError, "iktype: is of type str"),
    "arm": ({"manip": "arm"}, TypeError, "manip: is of type str, and should be a Manipulator"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_arguments_are_named(panda, name):
    options, error, message = WRONG[name]
    with pytest.raises(error, match=message):
        InverseKinematicsModel(panda.GetRobot(), **{"iktype": Type.Transform6D, **options})


@pytest.mark.parametrize("robot", [None, "panda", 3])
def test_a_model_needs_a_robot(robot):
    with pytest.raises((ValueError, TypeError), match=r"give a robot or a manipulator|robot: is of type"):
        InverseKinematicsModel(robot)


@pytest.mark.parametrize("steps", [[0.1, 0.1], [0], [-0.1], [np.nan], 0.1, "x", ["x"]])
def test_wrong_steps_are_refused(panda, steps):
    model = InverseKinematicsModel(panda.GetRobot(), iktype=Type.Transform6D)
    assert model.load()
    with pytest.raises((InverseKinematicsError, TypeError, ValueError), match="freeinc"):
        model.load(freeinc=steps)


@pytest.mark.parametrize("count", ["x", "3.5", "", "0", "-3", 0, None, [1]])
def test_numbers_of_trials_are_whole_and_above_0(panda, count):
    model = InverseKinematicsModel(panda.GetRobot(), iktype=Type.Transform6D)
    assert model.load()
    with pytest.raises((ValueError, TypeError), match="iktests"):
        model.testik(count)
    assert len(model.perftiming(3)) == 3


@pytest.mark.parametrize("is_inside_a_box", [False, True])
@pytest.mark.parametrize("flags", range(64))
def test_each_combination_of_flags_gives_the_same_answer_in_every_form(puma, flags, is_inside_a_box):
    robot = puma.GetRobot()
    robot.SetDOFValues(CONFIGURATION)
    goal = puma.GetTransform()
    robot.SetDOFValues(np.zeros(6))
    box = robot.GetEnv().GetKinBody("box")
    box.SetTransform(goal if is_inside_a_box else ravemj.matrixFromPose([1, 0, 0, 0, 9, 9, 9]))
    lower, upper = robot.GetDOFLimits(puma.GetArmIndices())
    before = robot.GetDOFValues()
    one, answer = puma.FindIKSolution(goal, flags), puma.FindIKSolution(goal, flags, ikreturn=True)
    rows, answers = puma.FindIKSolutions(goal, flags), puma.FindIKSolutions(goal, flags, ikreturn=True)
    assert (one is None) == (len(rows) == 0) == (answer.GetAction() != IkReturnAction.Success)
    assert (one is None) == (len(answer.GetSolution()) == 0)
    assert len(answers) == len(rows)
    assert all(every.GetAction() == IkReturnAction.Success for every in answers)
    assert (robot.GetDOFValues() == before).all()
    if one is None:
        assert answer.GetAction() & (IkReturnAction.Reject | IkReturnAction.Quit)
        assert rows.shape == (0,)
        return
    assert (one.shape, one.dtype, rows.shape[1]) == ((6,), np.float64, 6)
    np.testing.assert_array_equal(answer.GetSolution(), one)
    assert np.abs(rows - one).max(axis=1).min() < 1e-9
    for row in rows:
        assert flags & 4 or ((row >= lower - 1e-9) & (row <= upper + 1e-9)).all()
        with robot:
            robot.SetDOFValues(row, puma.GetArmIndices(), 0)
            np.testing.assert_allclose(puma.GetTransform(), goal, atol=1e-9)
