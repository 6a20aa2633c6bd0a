"""Controllers, beyond what OpenRAVE's answers in tests/data show."""

import numpy as np
import pytest

import ravemj


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.StopSimulation()
    env.Load("models/env.xml")
    yield env
    env.Destroy()


@pytest.fixture
def robot(env):
    return env.GetRobots()[0]


def path(env, robot, *points, name=None):
    """A trajectory through joint values, each followed by the seconds since the one before."""
    spec = ravemj.ConfigurationSpecification()
    spec.AddGroup(f"joint_values {name or robot.GetName()} 0 1", 2, "linear")
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, np.ravel(points))
    return trajectory


def step(env, *timesteps):
    for timestep in timesteps:
        env.StepSimulation(timestep)


def test_names(env):
    assert ravemj.RaveCreateController(env, "IDEALcontroller with arguments").GetXMLId() == "IDEALcontroller"
    assert isinstance(ravemj.RaveCreateController(env, "odevelocity"), ravemj.VelocityController)
    assert ravemj.RaveCreateController(env, "nonsense") is None
    assert ravemj.RaveCreateController(env, "") is None
    assert ravemj.RaveCreateMultiController(env).GetXMLId() == "GenericMultiController"
    assert ravemj.RaveCreateMultiController(env, "IdealController") is None


def test_controllers_without_a_robot_take_no_commands(env, robot):
    controller = ravemj.RaveCreateController(env, "IdealController")
    assert controller.GetRobot() is None
    assert controller.IsDone()
    assert len(controller.GetControlDOFIndices()) == 0
    for command in (
        lambda: controller.SetDesired([0, 0]),
        lambda: controller.SetPath(path(env, robot, [0, 0, 0], [1, 1, 1])),
    ):
        with pytest.raises(ravemj.openrave_exception) as caught:
            command()
        assert caught.value.GetCode() == "NotInitialized"


def test_all_dofs_means_those_that_there_are_then(env, robot):
    made = ravemj.RaveCreateRobot(env, "")
    controller = made.GetController()
    assert len(controller.GetControlDOFIndices()) == 0
    np.testing.assert_array_equal(robot.GetController().GetControlDOFIndices(), [0, 1])


def test_what_a_state_saver_undoes_comes_back_with_the_next_step(env, robot):
    with robot:
        robot.GetController().SetDesired([0.4, 0.5])
        np.testing.assert_allclose(robot.GetDOFValues(), [0.4, 0.5])
    np.testing.assert_array_equal(robot.GetDOFValues(), [0, 0])
    step(env, 0.01)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.4, 0.5])
    assert robot.GetController().IsDone()


@pytest.mark.parametrize("values", [[0.1], [0.1, 0.2, 0.3], [0.1, np.nan], [[0.1, 0.2]]])
def test_wrong_values_change_nothing(env, robot, values):
    controller = robot.GetController()
    controller.SetPath(path(env, robot, [0, 0, 0], [1, 1, 1]))
    step(env, 0.5)
    with pytest.raises(ravemj.ArgumentError, match="values"):
        controller.SetDesired(values)
    step(env, 0.1)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.5, 0.5])


def test_a_path_for_another_robot_moves_nothing(env, robot):
    robot.SetDOFValues([0.7, 0.7])
    controller = robot.GetController()
    assert controller.SetPath(path(env, robot, [0, 0, 0], [1, 1, 0.1], name="other"))
    step(env, 0.06, 0.06)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.7, 0.7])
    assert not controller.IsDone()
    step(env, 0.06)
    assert controller.IsDone()


def test_a_path_is_copied_and_ends_exactly(env, robot):
    trajectory = path(env, robot, [0, 0, 0], [1, -1, 0.1])
    controller = robot.GetController()
    controller.SetPath(trajectory)
    trajectory.Remove(0, 2)
    step(env, *[0.03] * 5)
    assert controller.IsDone()
    np.testing.assert_array_equal(robot.GetDOFValues(), [1, -1])
    assert controller.GetTime() == pytest.approx(0.1)
    robot.SetDOFValues([0.2, 0.2])
    step(env, 0.03)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.2, 0.2])


def test_a_controller_of_one_joint_plays_its_part_of_a_path(env, robot):
    controller = ravemj.RaveCreateController(env, "IdealController")
    assert robot.SetController(controller, [1], 0)
    robot.SetDOFValues([0.3, 0.3])
    controller.SetPath(path(env, robot, [0, 0, 0], [1, -1, 0.1]))
    step(env, 0.1, 0.1)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.3, -1])


def test_set_controller_in_its_old_form(env, robot):
    controller = ravemj.RaveCreateController(env, "IdealController")
    assert robot.SetController(controller, "arguments")
    np.testing.assert_array_equal(controller.GetControlDOFIndices(), [0, 1])
    assert robot.SetController(None)
    assert robot.GetController() is None
    assert not robot.WaitForController(0)
    with pytest.raises(IndexError):
        robot.SetController(controller, [2], 0)
    assert robot.GetController() is None


def test_a_multi_controller_shares_the_joints_out(env, robot):
    multi = ravemj.RaveCreateMultiController(env)
    first, second = (ravemj.RaveCreateController(env, "IdealController") for _ in range(2))
    with pytest.raises(ravemj.openrave_exception):
        multi.AttachController(first, [0], 0)
    assert robot.SetController(multi)
    assert multi.AttachController(second, [1], 0)
    assert multi.AttachController(first, [0], 0)
    with pytest.raises(ravemj.ArgumentError, match="DOF 1 has a controller"):
        multi.AttachController(ravemj.RaveCreateController(env, "IdealController"), [1], 0)
    assert multi.GetController(0) is first
    multi.SetDesired([0.1, 0.2])
    np.testing.assert_allclose(robot.GetDOFValues(), [0.1, 0.2])
    assert not multi.IsDone()
    step(env, 0.01)
    assert multi.IsDone()
    second.SetDesired([0.5])
    assert not multi.IsDone()
    np.testing.assert_allclose(robot.GetDOFValues(), [0.1, 0.5])
    multi.SetPath(path(env, robot, [0, 0, 0], [1, -1, 0.1]))
    step(env, 0.05, 0.05)
    np.testing.assert_allclose(robot.GetDOFValues(), [0.5, -0.5])
    assert multi.GetTime() == pytest.approx(0.1)
    np.testing.assert_array_equal(multi.GetTorque(), [0, 0])
    multi.Reset()
    assert multi.IsDone()
    multi.RemoveController(first)
    assert multi.GetController(0) is None


def test_velocities_without_physics(env, robot):
    controller = ravemj.RaveCreateController(env, "IdealVelocityController")
    robot.SetController(controller, [0, 1], 0)
    robot.SetDOFLimits([-0.5, -5], [0.5, 5])
    assert controller.SetDesired([-1, 100])
    assert controller.IsDone()
    step(env, 0.1, 0.1)
    fastest = robot.GetDOFVelocityLimits()[1]
    np.testing.assert_allclose(robot.GetDOFValues(), [-0.2, 0.2 * fastest])
    np.testing.assert_allclose(controller.GetVelocity(), [-1, fastest])
    controller.Reset()
    step(env, 0.1)
    np.testing.assert_allclose(robot.GetDOFValues(), [-0.2, 0.2 * fastest])
    with pytest.raises(ravemj.openrave_exception) as caught:
        controller.SetPath(None)
    assert caught.value.GetCode() == "NotImplemented"


def error_of(function):
    """The code and the message of the exception that a function raises, or None."""
    try:
        function()
    except ravemj.openrave_exception as error:
        return error.GetCode(), str(error)


def told(robot, **flags):
    """The controller of a robot, after commands such as ``SetThrowExceptions=1``."""
    controller = robot.GetController()
    for name, flag in flags.items():
        assert controller.SendCommand(f"{name} {flag}") == ""
    return controller


def test_too_fast_a_path_is_a_warning_or_an_exception(env, robot, caplog):
    robot.SetDOFVelocityLimits([2, 1])
    fast = path(env, robot, [0, 0, 0], [0.2, 0.3, 0.1])
    controller = told(robot, SetThrowExceptions=0)
    controller.SetPath(fast)
    step(env, 0.05, 0.05, 0.05, 0.05)
    assert controller.IsDone()
    assert caplog.text.count("speed limit is 0.050001 in 0.05 s") == 1
    caplog.clear()

    robot.SetDOFValues([0, 0])
    told(robot, SetThrowExceptions=1).SetPath(fast)
    step(env, 0.05)
    code, message = error_of(lambda: step(env, 0.05))
    assert code == "Assert"
    assert "'Pendulum' moves joint 'Joint1' by 0.15;" in message
    assert controller.IsDone()
    np.testing.assert_allclose(robot.GetDOFValues(), [0, 0], atol=1e-12)
    step(env, 0.05)
    np.testing.assert_allclose(robot.GetDOFValues(), [0, 0], atol=1e-12)
    assert not caplog.text


def test_a_path_within_the_limits_is_no_problem_however_time_is_stepped(env, robot, caplog):
    robot.SetDOFVelocityLimits([2, 3])
    controller = told(robot, SetThrowExceptions=1)
    controller.SetPath(path(env, robot, [0, 0, 0], [2, -3, 1]))
    step(env, 0.5, 0.1, 0.001, 0.3, 0.7, 0.01)
    np.testing.assert_allclose(robot.GetDOFValues(), [2, -3])
    assert not caplog.text


def test_a_jump_to_the_start_of_a_path_is_too_fast(env, robot):
    told(robot, SetThrowExceptions=1).SetPath(path(env, robot, [1, 1, 0], [1.1, 1.1, 1]))
    assert error_of(lambda: step(env, 0.05))[0] == "Assert"


@pytest.mark.filterwarnings("ignore:.*loads at")
def test_limits_of_joints_are_kept_or_an_exception(env):
    assert env.Load("tests/data/limited.xml")
    robot = env.GetRobot("Limited")
    start = robot.GetDOFValues()
    controller = told(robot, SetThrowExceptions=1)
    code, message = error_of(lambda: controller.SetDesired([0, 1.5]))
    assert (code, "joint 'Elbow' is set to 1.5, outside its limits" in message) == ("Assert", True)
    np.testing.assert_array_equal(robot.GetDOFValues(), start)
    assert controller.IsDone()
    assert controller.SetDesired([0, 2])
    told(robot, SetThrowExceptions=0)
    with pytest.warns(ravemj.RavemjWarning, match="limit"):
        assert controller.SetDesired([0, 1.5])
    np.testing.assert_allclose(robot.GetDOFValues(), [0, np.pi / 2])


@pytest.mark.parametrize("throws", [0, 1])
@pytest.mark.parametrize("checks", [0, 1])
@pytest.mark.parametrize("by_path", [True, False])
def test_collisions_are_a_problem_only_if_they_are_checked(env, robot, caplog, throws, checks, by_path):
    """As OpenRAVE's own answers in the case ``retime-32-controller-commands``."""
    robot.SetDOFVelocityLimits([10, 10])
    robot.SetDOFValues([1, 0])
    post = ravemj.RaveCreateKinBody(env, "")
    post.InitFromBoxes(np.array([[*robot.GetLinks()[-1].GetGlobalCOM(), 0.01, 0.01, 0.01]]), True)
    post.SetName("post")
    env.Add(post)
    assert env.CheckCollision(robot)
    robot.SetDOFValues([0, 0])
    assert not env.CheckCollision(robot)

    controller = told(robot, SetThrowExceptions=throws, SetCheckCollisions=checks)

    def run():
        if by_path:
            controller.SetPath(path(env, robot, [0, 0, 0], [1, 0, 1]))
            step(env, *[0.05] * 23)
        else:
            controller.SetDesired([1, 0])

    error = error_of(run)
    raised = bool(throws and checks)
    assert (error is not None) == raised
    assert (raised and "post" in error[1] and error[0] == "Assert") == raised
    assert ("collides" in caplog.text) == bool(checks and not throws)
    assert controller.IsDone() == (by_path or raised)
    assert (robot.GetDOFValues()[0] < 1) == (by_path and raised)


def test_commands(env, robot):
    controller = robot.GetController()
    known = [controller.SupportsCommand(name) for name in ("setthrowexceptions", "SetCheckCollisions", "help", "x")]
    assert known == [True, True, True, False]
    assert "SetThrowExceptions" in controller.SendCommand("help")
    assert controller.SendCommand("  SETTHROWEXCEPTIONS   1 ") == ""
    for wrong in ("SetThrowExceptions", "SetThrowExceptions yes", "", " "):
        assert error_of(lambda text=wrong: controller.SendCommand(text))[0] == "InvalidArguments"
    assert error_of(lambda: controller.SendCommand("nosuch 1"))[0] == "CommandNotSupported"
    assert error_of(lambda: robot.SendCommand("SetThrowExceptions 1"))[0] == "CommandNotSupported"


@pytest.mark.parametrize("timestep", [0.07, 0.01])
def test_trajectories_grab_and_release(env, robot, timestep):
    """A body is held from the configuration of the waypoint that grabs it to that of the one that releases it."""
    mug = ravemj.RaveCreateKinBody(env, "")
    mug.InitFromBoxes(np.array([[0, 0, 0, 0.02, 0.02, 0.02]]), True)
    mug.SetName("mug")
    env.Add(mug)
    hand, index = robot.GetLinks()[-1], robot.GetLinks()[-1].GetIndex()
    spec = ravemj.ConfigurationSpecification()
    spec.AddGroup(f"joint_values {robot.GetName()} 0 1", 2, "linear")
    spec.AddGroup(f"grab {robot.GetName()} {index}", 1, "previous")
    spec.AddDeltaTimeGroup()
    own = mug.GetEnvironmentId()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    points = {"joint_values": [[0, 0], [0.1, 0.2], [0.4, -0.1], [0.2, 0]], "grab": [0, own, -own, 0]}
    rows = np.zeros((4, spec.GetDOF()))
    rows[1:, spec.GetGroupFromName("deltatime").offset] = 0.105
    for name, values in points.items():
        group = spec.GetGroupFromName(name)
        rows[:, group.offset : group.offset + group.dof] = np.reshape(values, (4, -1))
    trajectory.Insert(0, rows.ravel())
    robot.SetDOFValues(points["joint_values"][1])
    T_hand_mug = np.linalg.inv(hand.GetTransform()) @ mug.GetTransform()
    robot.SetDOFValues(points["joint_values"][2])
    T_world_end = hand.GetTransform() @ T_hand_mug
    robot.GetController().SetPath(trajectory)
    while not robot.GetController().IsDone():
        env.StepSimulation(timestep)
        if robot.GetGrabbed():
            np.testing.assert_allclose(hand.GetTransform() @ T_hand_mug, mug.GetTransform(), atol=1e-12)
    assert not robot.GetGrabbed()
    np.testing.assert_allclose(mug.GetTransform(), T_world_end, atol=1e-12)


def test_the_model_that_grabs_need_is_compiled_before_time_passes(env, robot, monkeypatch):
    """Compiling takes longer than scripts wait for a path of one waypoint."""
    spec = ravemj.ConfigurationSpecification()
    spec.AddGroup(f"grab {robot.GetName()} 0", 1, "previous")
    spec.AddGroup("deltatime", 1, "linear")
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes(np.array([[0, 0, 5, 0.1, 0.1, 0.1]]), True)
    box.SetName("box")
    env.Add(box)
    trajectory.Insert(0, [box.GetEnvironmentBodyIndex(), 0])
    robot.GetController().SetPath(trajectory)
    monkeypatch.setattr(env.simulation, "_compile", lambda: pytest.fail("compiled in a step"))
    for _ in range(3):
        env.StepSimulation(0.01)
    assert robot.GetController().IsDone()
    assert robot.GetGrabbed() == [box]


def test_grabs_of_bodies_that_are_not_there(env, robot, caplog):
    spec = ravemj.ConfigurationSpecification()
    spec.AddGroup(f"grab {robot.GetName()} 0", 1, "previous")
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, [77, 0])
    robot.GetController().SetPath(trajectory)
    step(env, 0.01, 0.01)
    assert robot.GetController().IsDone()
    assert "cannot grab or release body 77 with link 0" in caplog.text
