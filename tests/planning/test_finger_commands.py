"""``TaskManipulation``: all combinations of the arguments of its finger motions, and its commands as text."""

import itertools

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import interfaces
from ravemj.errors import ErrorCode

FLAGS = list(itertools.product([False, True], repeat=4))  # execute, outputtraj, outputfinal, outputtrajobj
DIRECTIONS = (None, [1], [-1])


@pytest.fixture
def scene():
    env = ravemj.load(ravemj.model_path("panda"))
    env.StopSimulation()
    robot = env.GetRobots()[0]
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes(np.array([[0, 0, 0, 0.02, 0.02, 0.02]]), True)
    box.SetName("box")
    env.Add(box)
    box.SetTransform(robot.GetActiveManipulator().GetTransform())
    yield env, robot, box
    env.Destroy()


@pytest.mark.parametrize("with_box", [False, True])
@pytest.mark.parametrize("direction", one_in(2, DIRECTIONS))
@pytest.mark.parametrize("name", ["CloseFingers", "ChuckFingers", "ReleaseFingers", "UnchuckFingers"])
def test_results_of_all_combinations(scene, name, direction, with_box):
    env, robot, box = scene
    if not with_box:
        env.Remove(box)
    dofs = robot.GetActiveManipulator().GetGripperIndices()
    lower, upper = robot.GetDOFLimits(dofs)
    opens = "Close" not in name and name != "ChuckFingers"
    sign = np.array(direction or -robot.GetActiveManipulator().GetChuckingDirection() * (1 if opens else -1))
    task, finals = interfaces.TaskManipulation(robot), []
    for execute, outputtraj, outputfinal, outputtrajobj in FLAGS:
        start = np.full(len(dofs), 0.03)
        robot.SetDOFValues(start, dofs)
        flags = {"outputtraj": outputtraj, "outputfinal": outputfinal, "outputtrajobj": outputtrajobj}
        final, motion = getattr(task, name)(movingdir=direction, execute=execute, **flags)
        for _ in range(200 if execute else 1):
            env.StepSimulation(0.01)
        end = robot.GetDOFValues(dofs)
        assert execute or (end == start).all()
        assert (final is None) == (not outputfinal)
        assert type(motion).__name__ == ("Trajectory" if outputtrajobj else "str" if outputtraj else "NoneType")
        if outputfinal:
            finals.append(final)
            assert (final >= lower).all()
            assert (final <= upper).all()
            assert (sign * (final - start) >= -1e-12).all()
        if execute and outputfinal:
            np.testing.assert_allclose(end, final, atol=1e-9)
    assert len(finals) == 8
    np.testing.assert_array_equal(finals, [finals[0]] * 8)


@pytest.mark.parametrize("coarse", one_in(3, [None, 0.2, 0.05]))
@pytest.mark.parametrize("fine", [None, 1e-3, 1e-4])
@pytest.mark.parametrize("factor", [None, 0.05, 0.5])
@pytest.mark.parametrize("offset", [None, [0.0], [0.004], [1.0]])
def test_steps_and_offsets(scene, coarse, fine, factor, offset):
    env, robot, _ = scene
    steps = {"coarsestep": coarse, "finestep": fine, "translationstepmult": factor}
    final, _ = interfaces.TaskManipulation(robot).CloseFingers(offset=offset, outputfinal=True, **steps)
    resolution = (fine or (coarse or 0.1) / 100) * (0.1 if factor is None else factor)
    assert final == pytest.approx([0.02], abs=2 * resolution)  # the box is 0.04 m wide
    for _ in range(200):
        env.StepSimulation(0.01)
    expected = final - (0 if offset is None else offset)  # closing is downwards
    np.testing.assert_allclose(robot.GetDOFValues([7]), np.maximum(expected, 0), atol=1e-9)


def send(robot, text):
    return interfaces.TaskManipulation(robot).prob.SendCommand(text)


@pytest.mark.parametrize("module", [interfaces.TaskManipulation, interfaces.BaseManipulation])
@pytest.mark.parametrize("case", [str, str.lower, str.upper])
def test_bodies_are_grabbed_and_released_by_commands(scene, module, case):
    _, robot, box = scene
    command = module(robot).prob.SendCommand
    for _ in range(2):
        assert command(f"{case('GrabBody name')} box") == ""
        assert robot.GetGrabbed() == [box]
        assert command(case("ReleaseAll")) == ""
        assert robot.GetGrabbed() == []
    assert command(case("ReleaseAll")) == ""


def test_bodies_that_do_not_exist_are_named_in_the_log(scene, caplog):
    _, robot, _ = scene
    assert send(robot, "GrabBody name nosuch") is None
    assert "there is no body 'nosuch', only 'Panda', 'box'" in caplog.text
    caplog.clear()
    assert send(robot, "ReleaseFingers target nosuch execute 0") == ""
    assert "there is no body 'nosuch'" in caplog.text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("GrabBody", "give the body: GrabBody name B"),
        ("GrabBody box", "no argument 'box'; it takes name"),
        ("GrabBody name", "name: the text ends where a word should follow"),
        ("ReleaseAll now", "no argument 'now'; it takes none"),
        ("CloseFingers movingdir", "movingdir: the text ends where a number should follow"),
        ("CloseFingers movingdir 1 1", "no argument '1'; it takes execute"),
        ("CloseFingers offset x", "offset: 'x' should be a number"),
        ("ReleaseFingers target", "target: the text ends"),
    ],
)
def test_wrong_commands_name_the_argument(scene, text, message):
    _, robot, _ = scene
    with pytest.raises(ravemj.openrave_exception, match=message) as raised:
        send(robot, text)
    assert raised.value.GetCode() == ErrorCode.InvalidArguments.name


@pytest.mark.parametrize("name", ["CloseFingers", "ReleaseFingers"])
@pytest.mark.parametrize("wrong", [{"movingdir": [1, 1]}, {"movingdir": []}, {"movingdir": [[1]]}])
def test_wrong_numbers_of_values(scene, name, wrong):
    _, robot, _ = scene
    with pytest.raises(AssertionError, match="the gripper has 1 joints"):
        getattr(interfaces.TaskManipulation(robot), name)(**wrong)
