"""Planners, their parameters, and what they say when there is no way."""

import gc
import re
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import TESTS, one_in
from waiting import PATIENCE

import ravemj
from ravemj import Planner, PlannerStatus, planningutils
from ravemj.engine.collision.moving import moving_test
from ravemj.planning import rrt
from ravemj.rave.planning.path_planners import PathPlanner

ARM = """<Environment><Robot name="arm"><KinBody>
<Body name="base"><Geom type="box"><extents>0.1 0.1 0.05</extents></Geom></Body>
<Body name="upper"><offsetfrom>base</offsetfrom><Translation>0 0 0.1</Translation>
  <Geom type="box"><extents>0.2 0.03 0.03</extents><Translation>0.2 0 0</Translation></Geom></Body>
<Body name="fore"><offsetfrom>upper</offsetfrom><Translation>0.4 0 0.08</Translation>
  <Geom type="box"><extents>0.15 0.02 0.03</extents><Translation>0.15 0 0</Translation></Geom></Body>
<Joint name="one" type="hinge"><Body>base</Body><Body>upper</Body><offsetfrom>upper</offsetfrom><axis>0 0 1</axis>
  <limitsrad>-2.8 2.8</limitsrad><maxvel>2</maxvel><maxaccel>8</maxaccel></Joint>
<Joint name="two" type="hinge"><Body>upper</Body><Body>fore</Body><offsetfrom>fore</offsetfrom><axis>0 0 1</axis>
  <limitsrad>-2.5 2.5</limitsrad><maxvel>3</maxvel><maxaccel>6</maxaccel></Joint>
</KinBody><Manipulator name="hand"><base>base</base><effector>fore</effector></Manipulator></Robot></Environment>"""


@pytest.fixture
def env():
    made = ravemj.Environment()
    made.LoadData(ARM)
    box(made, "post", [0.55, 0, 0.15, 0.05, 0.05, 0.2])
    made.GetRobot("arm").SetDOFValues([-1.2, 0.2])
    return made


@pytest.fixture
def robot(env):
    return env.GetRobot("arm")


def box(env, name, numbers):
    body = ravemj.RaveCreateKinBody(env, "")
    body.InitFromBoxes([numbers])
    body.SetName(name)
    env.Add(body)
    return body


def parameters(robot, goal=(1.2, 0.2), **numbers):
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(goal)
    params.SetMaxIterations(numbers.get("iterations", 5000))
    return params


def planned(robot, params, name="birrt"):
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), name)
    planner.InitPlan(robot, params)
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    return planner.PlanPath(trajectory), trajectory


@pytest.mark.parametrize("name", ["birrt", "BIRRT", "BasicRRT", "RAStar", "ra*"])
def test_plans_keep_limits_and_collisions_at_every_moment(robot, name):
    status, trajectory = planned(robot, parameters(robot), name)
    assert status == PlannerStatus.HasSolution
    planningutils.VerifyTrajectory(None, trajectory, 0.01)
    assert robot.GetDOFValues() == pytest.approx([-1.2, 0.2])
    spec = robot.GetActiveConfigurationSpecification()
    assert trajectory.GetWaypoint(0, spec) == pytest.approx([-1.2, 0.2])
    assert trajectory.GetWaypoint(-1, spec) == pytest.approx([1.2, 0.2])


def test_exploration_gives_configurations_without_collisions(robot):
    params = parameters(robot)
    params.SetExtraParameters("<expectedsize>30</expectedsize>")
    status, trajectory = planned(robot, params, "ExplorationRRT")
    assert (status.statusCode, trajectory.GetNumWaypoints()) == (1, 30)


@pytest.mark.parametrize(
    ("start", "goal", "words"),
    [
        ([-1.2, 0.2], [0, 0], "goal: it collides: link 'fore' of 'arm' with link '.*' of 'post'"),
        ([0, 0], [1.2, 0.2], "start: it collides: "),
        ([-1.2, 0.2], [3, 0.2], r"goal: joint 'one' is 3, outside its limits \[-2.8, 2.8\]"),
        ([-1.2, 0.2], [np.nan, 0.2], r"goal: \[nan, 0.2\] should be finite"),
        ([-1.2, 0.2], [], "there is no goal"),
        ([-1.2, 0.2], [1, 2, 3], "_vgoalconfig: has 3 numbers, and should have a multiple of 2"),
    ],
)
def test_what_cannot_be_planned_says_why(robot, start, goal, words):
    robot.SetDOFValues(start)
    params = parameters(robot, goal)
    assert ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt").InitPlan(robot, params) is False
    status, trajectory = planned(robot, params)
    assert status == PlannerStatus.Failed
    assert not status
    with pytest.raises(ravemj.openrave_exception):
        trajectory.GetNumWaypoints()
    assert re.search(words, status.description), status.description
    assert robot.GetDOFValues() == pytest.approx(start)


@pytest.mark.parametrize("tag", ["resolution", "velocitylimit", "lowerlimit", "jerklimit"])
@pytest.mark.parametrize("numbers", [[0.5], [0.5, 0.5, 0.5]])
def test_limits_and_resolutions_of_the_wrong_length_are_named(robot, tag, numbers):
    params = parameters(robot)
    params.SetExtraParameters(f"<_vconfig{tag}>{' '.join(map(str, numbers))}</_vconfig{tag}>")
    status, _ = planned(robot, params)
    assert (status, status.description) == (0, f"_vconfig{tag}: is {numbers}, and should be 2 numbers")


def test_numbers_that_are_none_and_robots_without_active_joints_are_named(robot):
    params = parameters(robot)
    params.SetConfigVelocityLimit([np.nan, 1])
    assert "_vconfigvelocitylimit: is [nan, 1.0]" in planned(robot, params)[0].description
    robot.SetActiveDOFs([])
    assert planned(robot, parameters(robot))[0].description.startswith("nothing moves")


def test_parameters_that_make_no_sense_are_named(env, robot):
    for name, tag in (("BasicRRT", "goalbias"), ("ExplorationRRT", "expectedsize")):
        params = parameters(robot)
        params.SetExtraParameters(f"<{tag}>some</{tag}>")
        with pytest.raises(ravemj.openrave_exception, match=f"<{tag}>: 'some' should be a number"):
            planned(robot, params, name)
    params = parameters(robot)
    params.SetRandomGeneratorSeed(-5)
    assert planned(robot, params)[0] == PlannerStatus.HasSolution
    robot.SetDOFVelocityLimits([2, 0])
    assert "velocity or acceleration limit is 0" in planned(robot, parameters(robot))[0].description
    robot.SetDOFVelocityLimits([2, 3])
    robot.SetDOFLimits([-np.inf, -2.5], [np.inf, 2.5])
    assert planned(robot, parameters(robot))[0].description == "joint 'one' has no limits, and should have some"


@pytest.mark.parametrize("slow", [False, True])
def test_a_robot_that_is_removed_while_it_is_planned_for(env, robot, slow):
    params = parameters(robot)
    if slow:
        params.add_constraint(lambda values: True)
    planner = ravemj.RaveCreatePlanner(env, "birrt")
    planner.InitPlan(robot, params)
    handle = planner.RegisterPlanCallback(lambda progress: env.Remove(robot) and None)
    with pytest.raises(ravemj.openrave_exception, match="'arm' is not in an environment"):
        planner.PlanPath(ravemj.RaveCreateTrajectory(env, ""))
    handle.Close()
    env.Add(robot)
    assert robot.GetDOFValues() == pytest.approx([-1.2, 0.2])
    assert planner.PlanPath(ravemj.RaveCreateTrajectory(env, "")) == PlannerStatus.HasSolution


def test_another_thread_removes_a_robot_when_the_planner_is_done(env, robot):
    params = parameters(robot)
    planner = ravemj.RaveCreatePlanner(env, "birrt")
    planner.InitPlan(robot, params)
    remover = threading.Thread(target=env.Remove, args=[robot])
    handle = planner.RegisterPlanCallback(lambda progress: None if remover.ident else remover.start())
    assert planner.PlanPath(ravemj.RaveCreateTrajectory(env, "")) == PlannerStatus.HasSolution
    remover.join()
    handle.Close()
    assert env.GetRobots() == []


CTRL_C = """
import signal, sys
sys.path[:0] = {folders!r}
import numpy, ravemj, test_planners
env = ravemj.Environment()
env.LoadData(test_planners.ARM)
robot = env.GetRobot("arm")
robot.SetDOFValues([-1.2, 0.2])
test_planners.box(env, "wall", [0.4, 0, 0.2, 0.2, 0.01, 0.3])
helper = ravemj.interfaces.BaseManipulation(robot)
try:
    print("planning", flush=True)
    helper.MoveActiveJoints([1.2, 0.2], maxiter=10**9)
except KeyboardInterrupt:
    print(robot.GetDOFValues().tolist(), robot.GetController().IsDone(), env.GetRobots() == [robot])
"""


@pytest.mark.stress
def test_ctrl_c_leaves_the_robot_where_it_was_and_nothing_half_executed():
    script = CTRL_C.format(folders=[str(TESTS), str(TESTS / "planning")])
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "planning\n"
    time.sleep(0.1)  # any time will do
    process.send_signal(signal.SIGINT)
    said, complaints = process.communicate(timeout=PATIENCE)
    assert (said, complaints) == ("[-1.2, 0.2] True True\n", "")


def test_a_failure_for_want_of_time_or_iterations_says_so(robot):
    params = parameters(robot, iterations=20)
    params.add_constraint(lambda values: abs(values[0]) > 0.1)  # a wall
    assert "the iterations were used up after 20 iterations" in planned(robot, params)[0].description


@pytest.mark.parametrize("name", ["birrt", "BasicRRT", "RAStar"])
def test_a_time_limit_ends_a_search_within_one_iteration(robot, monkeypatch, name):
    """Each test of a configuration takes a second of a pretended clock."""
    passed = [0.0]
    now = time.monotonic()
    monkeypatch.setattr(rrt, "time", SimpleNamespace(monotonic=lambda: now + passed[0]))

    def wall(values):
        passed[0] += 1
        return abs(values[0]) > 0.1

    params = parameters(robot, iterations=10**9)
    params.add_constraint(wall)
    params.SetMaxPlanningTime(300_000)
    status, _ = planned(robot, params, name)
    assert "the time was used up" in status.description
    assert 300 < passed[0] < 1500


@pytest.mark.stress
@pytest.mark.parametrize("name", ["birrt", "BasicRRT", "ExplorationRRT", "RAStar"])
def test_the_memory_of_a_failing_search_is_bounded_by_what_it_did(robot, name):
    """Nothing is set aside for a thousand million iterations; a configuration takes less than a kilobyte."""
    params = parameters(robot, iterations=10**9)
    params.SetExtraParameters("<expectedsize>1000000</expectedsize>")
    params.add_constraint(lambda values: abs(values[0]) > 0.1)
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), name)
    planner.InitPlan(robot, params)
    interrupt = ravemj.PlannerAction.Interrupt
    handle = planner.RegisterPlanCallback(lambda progress: interrupt if progress._iteration >= 150 else None)
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    tracemalloc.start()
    planner.PlanPath(trajectory)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    handle.Close()
    size = sum(tree.count for tree in planner.search.trees)
    assert size < 150 * 10  # lines of one iteration: no configuration is farther than the space is wide
    assert most < 1_000_000 + 1000 * size


def test_callbacks_interrupt(robot):
    seen = []
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    planner.InitPlan(robot, parameters(robot))

    def stop(progress):
        seen.append(progress._iteration)
        return ravemj.PlannerAction.Interrupt

    handle = planner.RegisterPlanCallback(stop)
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    assert planner.PlanPath(trajectory) == ravemj.PlannerStatusCode.Interrupted
    assert seen == [0]
    handle.Close()
    assert planner.PlanPath(trajectory) == ravemj.PlannerStatusCode.HasSolution
    assert seen == [0]


def test_an_exception_in_a_callback_leaves_the_robot_where_it_was(robot):
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    planner.InitPlan(robot, parameters(robot))

    def fail(progress):
        if progress._iteration > 1:
            raise KeyboardInterrupt

    handle = planner.RegisterPlanCallback(fail)
    with pytest.raises(KeyboardInterrupt):
        planner.PlanPath(ravemj.RaveCreateTrajectory(robot.GetEnv(), ""))
    assert robot.GetDOFValues() == pytest.approx([-1.2, 0.2])
    assert not robot.GetEnv().CheckCollision(robot)
    handle.Close()


def test_constraints_and_goals_of_the_users_own(robot):
    params = parameters(robot)
    params.add_constraint(lambda values: values[1] < 2.4)
    asked = []
    params.set_goal_sampler(lambda: asked.append(1) or np.array([1.1, 0.3]), 0.5)
    params.SetPostProcessing("", "")
    status, trajectory = planned(robot, params)
    assert status == PlannerStatus.HasSolution
    assert trajectory.GetAllWaypoints2D()[:, 1].max() < 2.4
    params.add_constraint(lambda values: values[0] < 0)
    assert "a constraint does not allow it" in planned(robot, params)[0].description


def test_held_bodies_plan_with_the_robot(env, robot):
    params = parameters(robot)
    pole = box(env, "pole", [0, 0, 0, 0.02, 0.02, 0.1])
    T = robot.GetLink("fore").GetTransform() @ ravemj.matrixFromPose([1, 0, 0, 0, 0.32, 0, 0])
    pole.SetTransform(T)
    robot.Grab(pole, robot.GetLink("fore"))
    status, trajectory = planned(robot, params)
    assert status == PlannerStatus.HasSolution
    for moment in np.linspace(0, trajectory.GetDuration(), 300):
        spec = robot.GetActiveConfigurationSpecification()
        robot.SetActiveDOFValues(trajectory.Sample(moment, spec))
        assert not env.CheckCollision(robot)
    robot.SetDOFValues([-1.2, 0.2])
    assert pole.GetTransform() == pytest.approx(T)


@pytest.mark.parametrize("held", [False, True])
def test_the_fast_test_of_planners_is_the_general_one(env, robot, held):
    if held:
        pole = box(env, "pole", [0, 0, 0, 0.02, 0.02, 0.1])
        pole.SetTransform(robot.GetLink("fore").GetTransform() @ ravemj.matrixFromPose([1, 0, 0, 0, 0.32, 0, 0]))
        robot.Grab(pole, robot.GetLink("fore"))
    box(env, "far", [-0.4, 0.3, 0.15, 0.1, 0.05, 0.2])
    samples = np.random.default_rng(0).uniform([-2.8, -2.5], [2.8, 2.5], (300, 2))
    state = robot.simulation_state
    with env:
        collides = moving_test(state, (0, 1))
        fast = [collides(one) for one in samples]
        state.moved()
    general = []
    for one in samples:
        robot.SetDOFValues(one)
        general.append(env.CheckCollision(robot) or robot.CheckSelfCollision())
    assert fast == general
    assert 30 < sum(fast) < 270


def test_planners_take_the_fast_test_but_with_groups_of_geometries(env, robot):
    bodies = parameters(robot).resolved().bodies
    checker = env.GetCollisionChecker()
    assert bodies.fast_test() is not None
    checker.SetGeometryGroup("padded")
    assert bodies.fast_test() is None
    checker.SetGeometryGroup("")
    assert bodies.fast_test() is not None


def test_parameters_as_text_and_back(robot):
    params = parameters(robot)
    params.SetExtraParameters("<foo>3</foo>")
    text = repr(params).split('"""')[1]
    retimer = ravemj.RaveCreatePlanner(robot.GetEnv(), "LinearTrajectoryRetimer")
    assert retimer.InitPlan(None, text)
    again = retimer.GetParameters()
    assert again.GetConfigVelocityLimit().tolist() == params.GetConfigVelocityLimit().tolist()
    assert again.GetConfigurationSpecification() == params.GetConfigurationSpecification()
    assert repr(again).startswith(repr(params).partition("<foo>")[0])
    assert "<foo>3</foo>" in repr(again)
    assert "<pointtolerance>0.2</pointtolerance>" in repr(again)
    birrt = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    params.SetExtraParameters("<_nmaxiterations>17</_nmaxiterations>")
    birrt.InitPlan(robot, params)
    assert re.findall("<_nmaxiterations>([^<]*)<", repr(birrt.GetParameters())) == ["17", "20", "100"]
    assert "<minimumgoalpaths>1</minimumgoalpaths>" in repr(birrt.GetParameters())
    assert Planner.PlannerParameters(params) == params


def test_planners_without_a_problem_and_with_a_wrong_one(robot):
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    status = planner.PlanPath(ravemj.RaveCreateTrajectory(robot.GetEnv(), ""))
    assert (status.statusCode, status.errorOrigin) == (0, "birrt")
    with pytest.raises(TypeError):
        planner.InitPlan(robot, 5)
    with pytest.raises(ravemj.openrave_exception, match="give PlannerParameters"):
        planner.InitPlan(robot, "<plannerparameters/>")
    assert planner.InitPlan(robot, Planner.PlannerParameters()) is False
    with pytest.raises(ravemj.openrave_exception, match="trajectory: is None"):
        planningutils.RetimeActiveDOFTrajectory(None, robot)


def line(robot, points):
    trajectory = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    trajectory.Init(robot.GetActiveConfigurationSpecification())
    trajectory.Insert(0, np.ravel(points))
    return trajectory


@pytest.mark.parametrize("name", ["Linear", "Parabolic", "Cubic", "Cubic2", "Quintic"])
def test_retimed_trajectories_pass_the_strict_check(robot, name):
    planner = f"{name.rstrip('2')}TrajectoryRetimer{'2' if name.endswith('2') else ''}"
    trajectory = line(robot, [[-1.2, 0.2], [-0.8, 0.3], [-1.0, 1.0]])
    assert planningutils.RetimeActiveDOFTrajectory(trajectory, robot, plannername=planner)
    planningutils.VerifyTrajectory(None, trajectory, 0.003)
    robot.SetDOFVelocityLimits([0.1, 0.1])
    with pytest.raises(ravemj.openrave_exception, match=r"speed of value . is") as caught:
        planningutils.VerifyTrajectory(None, trajectory, 0.003)
    assert caught.value.GetCode() == "InconsistentConstraints"


@pytest.mark.parametrize("name", ["LinearSmoother", "ParabolicSmoother", "CubicSmoother", "QuinticSmoother"])
def test_smoothed_trajectories_pass_the_strict_check(robot, name):
    trajectory = line(robot, [[-1.2, 0.2], [-1.2, 2.45], [0, 2.45], [1.2, 2.45], [1.2, 0.2]])
    retimed = line(robot, trajectory.GetAllWaypoints2D())
    planningutils.RetimeActiveDOFTrajectory(retimed, robot, plannername="ParabolicTrajectoryRetimer")
    assert planningutils.SmoothActiveDOFTrajectory(trajectory, robot, plannername=name)
    planningutils.VerifyTrajectory(None, trajectory, 0.01)
    if name == "ParabolicSmoother":
        assert trajectory.GetDuration() < retimed.GetDuration()


def test_smoothers_refuse_paths_in_collision(robot):
    trajectory = line(robot, [[-1.2, 0.2], [1.2, 0.2]])
    status = planningutils.SmoothActiveDOFTrajectory(trajectory, robot)
    assert "the path is in collision from the start" in status.description
    assert trajectory.GetDuration() == 0


@pytest.mark.parametrize("call", [planningutils.RetimeActiveDOFTrajectory, planningutils.SmoothActiveDOFTrajectory])
def test_trajectories_of_other_robots_are_refused(env, robot, call):
    other = ravemj.RaveCreateRobot(env, "")
    other.Clone(robot, 0)
    other.SetName("brother")
    env.Add(other)
    trajectory = line(other, [[0, 0], [1, 0.5]])
    status = call(trajectory, robot)
    assert not status
    assert "the trajectory has no group 'joint_values arm 0 1'" in status.description
    assert trajectory.GetAllWaypoints2D().tolist() == [[0, 0], [1, 0.5]]


def test_post_processing_by_an_unknown_planner_fails(robot):
    params = parameters(robot)
    params.SetPostProcessing("nosuchsmoother", "")
    assert "there is no planner 'nosuchsmoother'" in planned(robot, params)[0].description


def test_circular_joints_go_the_short_way_at_every_moment():
    env = ravemj.Environment()
    circular = ARM.replace('name="one" type="hinge"', 'name="one" type="hinge" circular="true"')
    env.LoadData(circular.replace("<limitsrad>-2.8 2.8</limitsrad>", ""))
    robot = env.GetRobot("arm")
    for name in ("Linear", "Parabolic", "Cubic", "Quintic"):
        trajectory = line(robot, [[3.0, 0], [-3.0, 0], [-2.0, 0.1]])
        assert planningutils.RetimeActiveDOFTrajectory(trajectory, robot, plannername=f"{name}TrajectoryRetimer")
        spec = robot.GetActiveConfigurationSpecification()
        turned = [np.cos(trajectory.Sample(t, spec)[0]) for t in np.linspace(0, trajectory.GetDuration(), 50)]
        assert max(turned) < 0  # the long way passes 0
        planningutils.VerifyTrajectory(None, trajectory, 0.01)


def test_modules_take_commands(env, robot):
    module = ravemj.RaveCreateModule(env, "BaseManipulation")
    env.Add(module, True, "arm")
    text = module.SendCommand("MoveActiveJoints goal -0.9 0.3 maxiter 100 execute 0 outputtraj")
    trajectory = ravemj.RaveCreateTrajectory(env, "").deserialize(text)
    assert trajectory.GetWaypoint(-1, robot.GetActiveConfigurationSpecification()) == pytest.approx([-0.9, 0.3])
    assert module.SendCommand("moveactivejoints goals 2 -0.9 0.3 -0.8 0.3 jitter 0.01") == ""
    assert module.SendCommand("MoveActiveJoints goal 0 0 execute 0 jitter 0") is None
    assert module.SendCommand("JitterActive execute 0 outputfinal").split() == ["-1.2", "0.2"]
    for wrong in ("goal 1", "nosuch 1", "goal a b", "goal nan 0", "maxiter nan", "maxiter inf", "goals 9999999999 1"):
        with pytest.raises(ravemj.openrave_exception) as caught:
            module.SendCommand(f"MoveActiveJoints {wrong}")
        assert caught.value.GetCode() == "InvalidArguments"
    env.Remove(robot)
    with pytest.raises(ravemj.openrave_exception, match="there is no robot"):
        module.SendCommand("MoveActiveJoints goal 0 0")


@pytest.mark.stress
def test_helpers_take_their_modules_with_them(env, robot):
    helper = ravemj.interfaces.BaseManipulation(robot, plannername="nosuch", maxvelmult=0.5)
    assert [one.GetXMLId() for one in env.GetModules()] == ["BaseManipulation"]
    assert "maxvelmult 5.0" in helper.args
    env.Reset()
    assert len(env.GetModules()) == 1
    del helper
    gc.collect()
    assert env.GetModules() == []


def test_execution_begins_with_the_next_step(env, robot):
    env.StopSimulation()
    helper = ravemj.interfaces.BaseManipulation(robot)
    assert not helper.MoveActiveJoints(goal=[-0.9, 0.3])  # an empty reply, as of OpenRAVE's module
    assert robot.GetDOFValues() == pytest.approx([-1.2, 0.2])
    for _ in range(200):
        env.StepSimulation(0.01)
    assert robot.GetDOFValues() == pytest.approx([-0.9, 0.3])
    with pytest.raises(ravemj.PlanningError, match="goal: it collides"):
        helper.MoveActiveJoints(goal=[0, 0])
    assert robot.GetController().IsDone()


@pytest.mark.parametrize(
    ("direction", "step"), [([np.nan, 1], 0.01), ([1, np.inf], 0.01), ([1, 1], 0), ([1, 1], np.nan)]
)
def test_fingers_that_would_move_for_ever_are_refused(robot, direction, step):
    helper = ravemj.interfaces.TaskManipulation(robot)
    with pytest.raises(ravemj.openrave_exception, match="finite directions, and a step above 0"):
        helper.ReleaseActive(direction, execute=False, finestep=step)


@pytest.mark.parametrize(("hand", "divisions"), [([np.nan], 10), ([0.5], 0)])
def test_joints_without_a_place_to_go_are_refused(robot, hand, divisions):
    robot.SetActiveDOFs([0])
    with pytest.raises(ravemj.openrave_exception, match="should be finite numbers in 1 at least"):
        ravemj.interfaces.BaseManipulation(robot).MoveUnsyncJoints(hand, [1], maxdivision=divisions, execute=False)


@pytest.mark.parametrize("turning", one_in(2, [ravemj.DOFAffine.RotationAxis, ravemj.DOFAffine.RotationQuat]))
def test_a_base_moves_with_its_joints_round_what_is_in_the_way(env, robot, turning):
    affine = ravemj.DOFAffine.X | ravemj.DOFAffine.Y | turning
    robot.SetActiveDOFs([0, 1], affine, [0, 0, 1])
    robot.SetAffineTranslationLimits([-2, -2, -2], [2, 2, 2])
    goal = robot.GetActiveDOFValues() + np.eye(len(robot.GetActiveDOFValues()))[2] * 1.3
    helper = ravemj.interfaces.BaseManipulation(robot)
    trajectory = helper.MoveActiveJoints(goal=goal, execute=False, outputtrajobj=True)
    assert robot.GetTransform() == pytest.approx(np.eye(4))
    spec = robot.GetActiveConfigurationSpecification()
    post = env.GetKinBody("post")
    most = 0.0
    for time_s in np.linspace(0, trajectory.GetDuration(), 80):
        robot.SetActiveDOFValues(trajectory.Sample(time_s, spec))
        assert not env.CheckCollision(robot, post)
        most = max(most, abs(robot.GetTransform()[1, 3]))
    assert most > 0.05  # straight through the post is no way
    assert robot.GetActiveDOFValues() == pytest.approx(goal)
    assert robot.GetTransform()[:3, 3] == pytest.approx([1.3, 0, 0])


def two_rooms(seed=0):
    """Return a base in one of two rooms of 6 x 3 m, and a goal in the other; the door is 0.8 m wide."""
    env = ravemj.Environment()
    base = ravemj.RaveCreateRobot(env, "")
    base.InitFromBoxes([[0, 0, 0.5, 0.32, 0.28, 0.5]])
    base.SetName("base")
    env.Add(base)
    outer = [[0, 0, 0.5, 0.05, 1.5, 0.5], [6, 0, 0.5, 0.05, 1.5, 0.5], [3, -1.5, 0.5, 3, 0.05, 0.5]]
    door = np.random.default_rng(seed).uniform(-0.8, 0.8)
    inner = [
        [3, (side * 1.5 + door + side * 0.4) / 2, 0.5, 0.05, (1.5 - 0.4 - side * door) / 2, 0.5] for side in (-1, 1)
    ]
    for number, numbers in enumerate([*outer, [3, 1.5, 0.5, 3, 0.05, 0.5], *inner]):
        box(env, f"wall{number}", numbers)
    parts = ravemj.DOFAffine
    base.SetActiveDOFs([], parts.X | parts.Y | parts.RotationAxis, [0, 0, 1])
    base.SetAffineTranslationResolution([0.01] * 3)
    base.SetActiveDOFValues([1.0, -0.8, 0.0])
    assert not env.CheckCollision(base)
    return base, np.array([5.0, 0.8, 1.0])


@pytest.mark.parametrize("seed", one_in(4, range(4)))
def test_a_base_goes_through_a_door_with_openraves_limits_of_100_m(seed):
    base, goal = two_rooms(seed)
    assert base.GetActiveDOFLimits()[1][0] == 100
    assert base.GetActiveDOFWeights().tolist() == [2, 2, 2]
    helper = ravemj.interfaces.BaseManipulation(base)
    trajectory = helper.MoveActiveJoints(goal=goal, steplength=0.15, execute=False, outputtrajobj=True)
    spec = base.GetActiveConfigurationSpecification()
    for time_s in np.linspace(0, trajectory.GetDuration(), 300):
        base.SetActiveDOFValues(trajectory.Sample(time_s, spec))
        assert not base.GetEnv().CheckCollision(base)
    assert base.GetActiveDOFValues() == pytest.approx(goal)


def test_bases_are_sampled_where_they_can_touch_something_and_between_start_and_goal():
    base, _ = two_rooms()
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(base)
    values = params.resolved()
    reach = np.linalg.norm([0.32, 0.28, 1.0])
    near = values.bodies.near_others(values.space(), np.array([[1.0, -0.8, 0.0], [50.0, 0.8, 1.0]]))
    assert near.lower == pytest.approx([-0.05 - reach, -1.55 - reach, -np.pi])
    assert near.upper == pytest.approx([50.0, 1.55 + reach, np.pi])
    base.SetAffineTranslationLimits([-0.1, -9, 0], [9, 1, 0])
    params.SetRobotActiveJoints(base)
    near = params.resolved().bodies.near_others(params.resolved().space(), np.array([[1.0, -0.8, 0.0]]))
    assert [near.lower[0], near.upper[1]] == [-0.1, 1.0], "limits are kept"
    box(base.GetEnv(), "rod", [1.0, -0.8, 1.2, 2.0, 0.05, 0.1])
    assert base.Grab(base.GetEnv().GetKinBody("rod"), base.GetLinks()[0])
    held = params.resolved().bodies.near_others(params.resolved().space(), np.array([[1.0, -0.8, 0.0]]))
    assert held.lower[1] < near.lower[1] - 2.0, "what a robot holds reaches farther"


@pytest.mark.parametrize("step", [0.05, 0.3])
def test_the_step_length_is_the_step_of_the_trees(robot, step):
    params = parameters(robot)
    params.SetStepLength(step)
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "birrt")
    planner.InitPlan(robot, params)
    assert planner.PlanPath(ravemj.RaveCreateTrajectory(robot.GetEnv(), "")) == PlannerStatus.HasSolution
    lengths = []
    for tree in planner.search.trees:
        nodes = tree.nodes()
        lengths += [params.DistMetricFn(nodes[child], nodes[parent]) for child, parent in tree.lines()]
    assert 0.7 * step < max(lengths) <= step * (1 + 1e-9)


@pytest.mark.parametrize(
    "send",
    [
        lambda helper, **options: helper.MoveActiveJoints(goal=[1.2, 0.2], execute=False, **options),
        lambda helper, **options: helper.MoveManipulator(goal=[1.2, 0.2], execute=False, **options),
        lambda helper, **options: helper.prob.SendCommand(
            "MoveManipulator goal 1.2 0.2 execute 0" + "".join(f" {name} {value}" for name, value in options.items())
        ),
    ],
)
def test_commands_hand_the_step_length_to_the_planner(robot, monkeypatch, send):
    robot.SetActiveManipulator("hand")
    given, run = [], PathPlanner.run

    def noted(planner, values, trajectory):
        given.append(values.numbers["_fsteplength"])
        return run(planner, values, trajectory)

    monkeypatch.setattr(PathPlanner, "run", noted)
    helper = ravemj.interfaces.BaseManipulation(robot)
    send(helper, steplength=0.2)
    send(helper)
    assert given == pytest.approx([0.2, 0.04])
    for wrong in (0, -1):
        with pytest.raises(ravemj.openrave_exception, match=f"steplength: is {wrong}, and should be more than 0"):
            send(helper, steplength=wrong)


def test_a_touching_start_is_jittered_and_left(env, robot):
    robot.SetDOFValues([0, 0.64])
    assert env.CheckCollision(robot)
    helper = ravemj.interfaces.BaseManipulation(robot)
    trajectory = helper.MoveActiveJoints(goal=[0.5, 1.0], execute=False, outputtrajobj=True, jitter=0.1)
    spec = robot.GetActiveConfigurationSpecification()
    assert trajectory.GetWaypoint(0, spec) == pytest.approx([0, 0.64])
    assert trajectory.GetWaypoint(-1, spec) == pytest.approx([0.5, 1.0])
    with pytest.raises(ravemj.PlanningError, match="start: it collides"):
        helper.MoveActiveJoints(goal=[0.5, 1.0], jitter=0)


def test_a_base_whose_goal_touches_is_jittered_and_reaches_it(env, robot):
    affine = ravemj.DOFAffine.X | ravemj.DOFAffine.Y | ravemj.DOFAffine.RotationAxis
    robot.SetActiveDOFs([], affine, [0, 0, 1])
    robot.SetAffineTranslationLimits([-3, -3, -3], [3, 3, 3])
    robot.SetAffineTranslationResolution([0.01] * 3)
    corner = robot.ComputeAABB().pos() + robot.ComputeAABB().extents()
    env.Remove(env.GetKinBody("post"))
    box(env, "wall", [corner[0] + 0.5, 0, 0, 0.105, 3, 3])
    goal = np.array([0.4, 0.5, 0])
    with robot:
        robot.SetActiveDOFValues(goal)
        assert env.CheckCollision(robot, env.GetKinBody("wall"))
    helper = ravemj.interfaces.BaseManipulation(robot)
    trajectory = helper.MoveActiveJoints(goal=goal, execute=False, outputtrajobj=True, jitter=0.05)
    spec = robot.GetActiveConfigurationSpecification()
    places = [trajectory.Sample(time, spec) for time in np.linspace(0, trajectory.GetDuration(), 500)]
    assert places[0] == pytest.approx([0, 0, 0])
    assert places[-1] == pytest.approx(goal)
    assert np.abs(np.diff(places, axis=0)).max() < 0.05  # no jump where the way to the goal begins


def test_what_joints_do_not_move_is_no_obstacle_of_theirs(env, robot):
    box(env, "floor", [0, 0, -0.1, 0.3, 0.3, 0.1])
    assert env.CheckCollision(robot)  # the base stands on it
    assert planned(robot, parameters(robot))[0] == PlannerStatus.HasSolution
    params = parameters(robot)
    params.add_constraint(lambda values: True)  # this takes the slow test
    assert planned(robot, params)[0] == PlannerStatus.HasSolution
    env.GetKinBody("floor").SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 0.2]))
    described = planned(robot, parameters(robot))[0].description
    assert re.match("start: it collides: link 'upper' of 'arm' with link .* of 'floor'", described), described


def test_trajectories_are_executed_and_verified_from_their_text(robot):
    helper = ravemj.interfaces.BaseManipulation(robot)
    goal = robot.GetActiveDOFValues() + 0.1
    text = helper.MoveActiveJoints(goal=goal, execute=False, outputtraj=True)
    helper.VerifyTrajectory(text, samplingstep=0.01)
    helper.VerifyTrajectory(data=text, resettiming=True)
    robot.GetEnv().StopSimulation()
    helper.TrajFromData(text)
    while not robot.GetController().IsDone():
        robot.GetEnv().StepSimulation(0.05)
    np.testing.assert_allclose(robot.GetActiveDOFValues(), goal, atol=1e-9)
    robot.SetDOFVelocityLimits([1e-3] * robot.GetDOF())
    with pytest.raises(ravemj.openrave_exception, match="VerifyTrajectory"):
        helper.VerifyTrajectory(text)
    with pytest.raises(ravemj.openrave_exception):
        helper.TrajFromData("no trajectory")


def test_a_base_that_turns_about_any_axis_gets_around_a_wall():
    env = ravemj.load(ravemj.model_path("pendulum"))
    robot = env.GetRobots()[0]
    box(env, "wall", [1.5, 0, 0, 0.05, 0.4, 0.4])
    parts = ravemj.DOFAffine
    robot.SetActiveDOFs([], parts.X | parts.Y | parts.Z | parts.Rotation3D)
    robot.SetAffineTranslationLimits([-4] * 3, [4] * 3)
    robot.SetAffineTranslationResolution([0.05] * 3)
    params = Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig([3.0, 0, 0, 0.3, 0.2, 1.0])
    params.SetMaxIterations(300)
    status, _ = planned(robot, params)
    assert status == PlannerStatus.HasSolution, status.description
