"""Ctrl-C at any place leaves no lock held and no body moved."""

import contextlib
import logging

import numpy as np
import pytest
from conftest import one_in
from interrupts import interrupts, is_free

import ravemj
from ravemj import IkFilterOptions, IkParameterization
from ravemj.core.blocks import block, restoring

pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # in destructors

HERE, THERE = [0.1, 0.2], [0.3, -0.2]


@pytest.fixture(autouse=True)
def _quiet(caplog):
    caplog.set_level(logging.CRITICAL, "ravemj")


@pytest.fixture
def env():
    env = ravemj.load(ravemj.model_path("pendulum"))
    env.GetRobots()[0].SetDOFValues(HERE)
    return env


@pytest.fixture
def robot(env):
    return env.GetRobots()[0]


def with_robot(env, robot):
    with robot:
        robot.SetDOFValues(THERE)
        with robot:
            env.CheckCollision(robot)


def with_saver(env, robot):
    with robot.CreateRobotStateSaver():
        robot.SetDOFValues(THERE)


def in_a_stack(env, robot):
    with contextlib.ExitStack() as stack:
        stack.enter_context(env)
        stack.enter_context(robot)
        robot.SetDOFValues(THERE)


def plan(env, robot):
    ravemj.interfaces.BaseManipulation(robot).MoveActiveJoints(goal=THERE, execute=False, outputtrajobj=True)


@pytest.mark.stress
@pytest.mark.parametrize(("action", "most"), [(with_robot, 300), (with_saver, 200), (plan, 25)])
def test_what_moves_a_body_moves_it_back(env, robot, action, most):
    for place in interrupts(lambda: action(env, robot), most):
        assert is_free(env), place
        assert robot.GetDOFValues().tolist() == HERE, place
        assert robot.innermost_block is None


def test_a_stack_of_contexts_ends_as_blocks_do(env, robot):
    in_a_stack(env, robot)
    assert is_free(env)
    assert robot.GetDOFValues().tolist() == HERE


@pytest.mark.parametrize("model", ["pendulum", "panda"])
def test_no_answer_on_collisions_is_that_of_an_earlier_configuration(model):
    """The Panda has pairs of links that may collide, so that two questions share what MuJoCo finds."""
    env = ravemj.load(ravemj.model_path(model))
    robot = env.GetRobots()[0]
    wall = ravemj.RaveCreateKinBody(env, "")
    wall.InitFromBoxes(np.array([[*robot.GetLinks()[-1].GetTransform()[:3, 3], 0.02, 0.02, 0.02]]), True)
    wall.SetName("wall")
    env.Add(wall)
    start = robot.GetDOFValues()
    answers = {}
    for turn in (0.0, 1.0):
        robot.SetDOFValues(start + turn * (np.arange(robot.GetDOF()) == 0))
        answers[tuple(robot.GetDOFValues().tolist())] = env.CheckCollision(robot), robot.CheckSelfCollision()

    def ask():
        for values in answers:
            robot.SetDOFValues(values)
            env.CheckCollision(robot)
            robot.CheckSelfCollision()

    assert len(set(answers.values())) == 2
    for place in interrupts(ask, 1000):
        found = env.CheckCollision(robot), robot.CheckSelfCollision()
        assert found == answers[tuple(robot.GetDOFValues().tolist())], place


@pytest.mark.stress
def test_certifying_leaves_bodies_and_shapes_where_they_were(env, robot):
    wall = ravemj.RaveCreateKinBody(env, "")
    wall.InitFromBoxes([[0, 0, 0, 0.1, 0.01, 0.3]])
    wall.SetName("wall")
    env.Add(wall)
    away = ravemj.matrixFromPose([1, 0, 0, 0, 0, 0.35, 0])
    wall.SetTransform(away)
    spec = robot.GetConfigurationSpecificationIndices(range(2), "linear")
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, [*HERE, 0, *THERE, 1])
    touching = robot.GetLinks()[-1].GetTransform()
    for place in interrupts(trajectory.certify, 60):
        assert robot.GetDOFValues().tolist() == HERE, place
        assert is_free(env), place
        assert not env.CheckCollision(robot), place
        wall.SetTransform(touching)
        assert env.CheckCollision(robot), place
        wall.SetTransform(away)


def with_env(env, robot):
    with env, env:
        robot.GetDOFValues()


def lock(env, robot):
    env.Lock()
    env.Unlock()


def start_and_stop(env, robot):
    with contextlib.suppress(RuntimeError):  # Python's own, of a wait in ``Thread.start`` that is interrupted
        env.StartSimulation(0.001)
    env.StopSimulation()


ACTIONS = {
    "with env": with_env,
    "SetDOFValues": lambda env, robot: robot.SetDOFValues(np.array(THERE)),
    "SetDOFValues of some": lambda env, robot: robot.SetDOFValues([9], [0]),
    "CheckCollision": lambda env, robot: env.CheckCollision(robot),
    "StepSimulation": lambda env, robot: env.StepSimulation(0.01),
    "Load": lambda env, robot: env.Load(ravemj.model_path("pendulum")),
    "CloneSelf": lambda env, robot: env.CloneSelf().Destroy(),
    "Start and stop": start_and_stop,
    "WriteToMemory": lambda env, robot: env.WriteToMemory("collada"),
    "plot": lambda env, robot: env.plot3(np.zeros(3), 1),
}


@pytest.mark.stress
@pytest.mark.parametrize("name", one_in(2, list(ACTIONS)))
def test_no_lock_stays_held(env, robot, name):
    for place in interrupts(lambda: ACTIONS[name](env, robot), 40):
        assert is_free(env), place
    env.StopSimulation()


@pytest.mark.stress
def test_inverse_kinematics_leaves_the_robot():
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    model = ravemj.databases.inversekinematics.InverseKinematicsModel(robot, IkParameterization.Type.Transform6D)
    model.load() or model.autogenerate()
    arm, before = robot.GetActiveManipulator(), robot.GetDOFValues()
    goal = IkParameterization(arm.GetTransform(), IkParameterization.Type.Transform6D)
    options = IkFilterOptions.CheckEnvCollisions
    for place in interrupts(lambda: arm.FindIKSolution(goal, options), 40):
        assert is_free(env), place
        assert robot.GetDOFValues().tolist() == before.tolist(), place
        assert len(robot.GetActiveDOFIndices()) == robot.GetDOF()


def test_an_interrupt_before_the_lock_is_acquired_is_no_other_error(env, robot):
    """The lock is released only if it was acquired."""
    lock = env.simulation.lock

    class Interrupting:
        is_held = property(lambda self: lock.is_held)
        release, release_if_held = lock.release, lock.release_if_held

        def acquire(self):
            raise KeyboardInterrupt

    env.simulation.lock = Interrupting()
    with pytest.raises(KeyboardInterrupt):
        robot.SetDOFValues(HERE)


def test_blocks_end_completely():
    """A restoring function that is interrupted is called again."""
    begun, ended = [], []

    def restore():
        begun.append(len(begun))
        ended.append(len(begun))

    @block
    def both():
        with restoring(restore):
            yield "given"

    def run():
        with both() as given:
            assert given == "given"

    entered = 0
    for _ in interrupts(run):
        assert not begun or ended
        entered += bool(begun)
        begun.clear()
        ended.clear()
    assert entered > 3


def test_the_error_in_a_block_is_raised():
    @block
    def nothing():
        yield

    with pytest.raises(ValueError, match="mine"), nothing():
        raise ValueError("mine")
