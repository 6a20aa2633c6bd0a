"""Threads that read, write, draw and let time pass at once: everybody sees whole states, and nobody hangs."""

import contextlib
import threading
import time

import numpy as np
import pytest
from waiting import PATIENCE, await_that

import ravemj

DURATION = 0.3
TURN = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
"""Orientation of the pendulum's links at zero."""
BOX = """<KinBody name="{0}"><Body name="{0}" type="dynamic">
  <Geom type="box"><extents>.1 .1 .1</extents></Geom>
</Body></KinBody>"""


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.Load("models/env.xml")
    yield env
    env.Destroy()


@contextlib.contextmanager
def threads(*works):
    """Repeat each work in a thread of its own, at least once, while the block runs; what they raise is raised here."""
    errors, rounds, ending = [], [0] * len(works), threading.Event()

    def repeat(number, work):
        try:
            while not ending.is_set():
                work()
                rounds[number] += 1
        except BaseException as error:
            errors.append(error)

    running = [threading.Thread(target=repeat, args=pair, daemon=True) for pair in enumerate(works)]
    for thread in running:
        thread.start()
    yield rounds
    with contextlib.suppress(AssertionError):
        await_that(lambda: errors or min(rounds) > 0)
    ending.set()
    for thread in running:
        thread.join(PATIENCE)
    assert not [thread for thread in running if thread.is_alive()], "a thread hangs"
    if errors:
        raise errors[0]
    assert min(rounds) > 0


def turn_x(angle):
    return np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])


def state(number):
    """A pose and joint values that belong together."""
    T = np.eye(4)
    T[:3, :3], T[0, 3] = TURN, number
    return T, [0.3 * np.sin(number), 0.5 * np.cos(number)]


def expected(number):
    """The poses of the links in that state."""
    T, (first, second) = state(number)
    poses = np.array([T] * 3)
    for pose, angle in zip(poses, (0.0, first, first + second), strict=True):
        pose[:3, :3] = turn_x(angle) @ TURN
    poses[2, :3, 3] += turn_x(first) @ [0, 0, -0.2]
    return poses


def test_readers_see_whole_states(env):
    robot = env.GetRobots()[0]
    robot.SetTransformWithDOFValues(*state(0))
    numbers = iter(range(1, 10**9))

    def write():
        robot.SetTransformWithDOFValues(*state(next(numbers) % 50))

    def read():
        poses = np.array(robot.GetLinkTransformations())
        np.testing.assert_allclose(poses, expected(poses[0, 0, 3]), atol=1e-9)

    def read_locked():
        with env:
            number = robot.GetTransform()[0, 3]
            np.testing.assert_allclose(robot.GetDOFValues(), state(number)[1], atol=1e-12)
            np.testing.assert_allclose(robot.GetLinks()[2].GetTransform(), expected(number)[2], atol=1e-9)

    def draw():
        env.render(16, 12)

    def come_and_go():
        env.LoadData(f"<Environment>{BOX.format('box')}</Environment>")
        time.sleep(0.002)
        env.Remove(env.GetKinBody("box"))

    env.StartSimulation(0.001)
    with threads(write, read, read_locked, draw, come_and_go):
        time.sleep(DURATION)
        await_that(lambda: env.GetSimulationTime() > 0)


@pytest.mark.stress
@pytest.mark.parametrize("duration", [DURATION, 3.0])
def test_what_is_set_under_the_lock_is_seen_together(env, duration):
    """A box is always 1 m above the pendulum's tip, whoever looks, while other bodies come and go, also in copies."""
    robot = env.GetRobots()[0]
    env.LoadData(f"<Environment>{BOX.format('box')}{BOX.format('held')}</Environment>")
    box, held = env.GetKinBody("box"), env.GetKinBody("held")
    tip, above = robot.GetLinks()[2], np.array([0, 0, 1])
    robot.Grab(held, tip)
    numbers = iter(range(1, 10**9))
    env.StartSimulation(0.001)

    def write():
        number = next(numbers)
        with env:
            robot.SetDOFValues([0.3 * np.sin(number), 0.5 * np.cos(number)])
            T = box.GetTransform()
            T[:3, 3] = tip.GetTransform()[:3, 3] + above
            box.SetTransform(T)

    def compare(world):
        with world:
            poses = [world.GetKinBody(name).GetTransform()[:3, 3] for name in ("box", "held")]
            arm = world.GetRobots()[0].GetLinks()[2]
            np.testing.assert_allclose(poses[0], arm.GetTransform()[:3, 3] + above, atol=1e-9)
            assert world.GetRobots()[0].IsGrabbing(world.GetKinBody("held"))
            world.CheckCollision(world.GetRobots()[0])

    def copy():
        copied = env.CloneSelf(1)
        compare(copied)
        copied.Destroy()

    def play():
        robot.GetController().SetDesired(robot.GetDOFValues())
        robot.GetController().Reset()

    def come_and_go():
        env.LoadData(BOX.format("guest"))
        env.GetKinBody("guest").Enable(False)
        env.Remove(env.GetKinBody("guest"))

    write()
    with threads(write, lambda: compare(env), copy, lambda: env.render(16, 12), come_and_go):
        time.sleep(duration)
    with threads(play, lambda: env.render(16, 12), come_and_go, robot.GetDOFValues):
        time.sleep(duration)
    assert env.IsSimulationRunning()


def test_environments_that_copy_one_another_do_not_wait_forever(env):
    other = env.CloneSelf(1)
    with threads(lambda: other.Clone(env), lambda: env.Clone(other), lambda: env.render(16, 12)):
        time.sleep(DURATION)
    assert [len(one.GetBodies()) for one in (env, other)] == [1, 1]
    other.Destroy()


def test_commands_of_many_threads_are_carried_out(env):
    robot = env.GetRobots()[0]
    controller = robot.GetController()
    env.StartSimulation(0.001, realtime=False)

    def command(values):
        controller.SetDesired(values)
        robot.WaitForController(5)

    with threads(lambda: command([0.1, 0.2]), lambda: command([-0.1, -0.2]), robot.GetLinkTransformations):
        time.sleep(DURATION)
    assert robot.WaitForController(PATIENCE)
    assert abs(robot.GetDOFValues()[0]) == pytest.approx(0.1)


def test_physics_shows_whole_steps(env):
    for number, name in enumerate(("left", "right")):
        env.LoadData(f"<Environment>{BOX.format(name)}</Environment>")
        T = np.eye(4)
        T[0, 3] = number + 5
        env.GetKinBody(name).SetTransform(T)
    left, right = env.GetKinBody("left"), env.GetKinBody("right")
    env.SetPhysicsEngine("mujoco")
    env.GetPhysicsEngine().SetGravity([0, 0, -0.1])

    def read():
        with env:
            assert left.GetTransform()[2, 3] == pytest.approx(right.GetTransform()[2, 3], abs=1e-12)
            assert left.GetLinkVelocities()[0, 2] == pytest.approx(right.GetLinkVelocities()[0, 2], abs=1e-12)

    def push():
        with env:
            for body in (left, right):
                body.GetLinks()[0].SetForce([0, 0, 1], body.GetTransform()[:3, 3], False)

    def restart():
        with env:
            for body in (left, right):
                T = body.GetTransform()
                T[2, 3] = 0
                body.SetTransform(T)
                body.SetVelocity([0, 0, 0], [0, 0, 0])
        time.sleep(0.01)

    env.StartSimulation(0.001, realtime=False)
    with threads(read, push, restart, lambda: env.render(16, 12)):
        time.sleep(DURATION)
    env.StopSimulation()


def test_starting_and_stopping_from_many_threads_leaves_one_thread_at_most(env):
    def count():
        return sum(thread.name == "simulation time" for thread in threading.enumerate())

    before = count()
    with threads(
        lambda: env.StartSimulation(0.001),
        env.StopSimulation,
        env.GetSimulationTime,
        lambda: env.StepSimulation(0.001),
    ):
        time.sleep(DURATION)
    env.StopSimulation()
    assert count() == before
