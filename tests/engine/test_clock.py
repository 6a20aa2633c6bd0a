"""Simulation time: the thread that lets it pass, and what it does not disturb."""

import gc
import logging
import subprocess
import sys
import threading
import time
import weakref
from types import SimpleNamespace

import pytest
from waiting import PATIENCE, await_that

import ravemj
from ravemj.core.locks import StateLock
from ravemj.engine.clock import Clock

PENDULUM = "models/env.xml"


def time_threads():
    return [thread for thread in threading.enumerate() if thread.name == "simulation time"]


@pytest.fixture
def env():
    env = ravemj.Environment()
    yield env
    env.Destroy()


def robot_in(env):
    env.Load(PENDULUM)
    return env.GetRobots()[0]


def test_nothing_starts_a_thread_but_what_needs_time(env):
    before = time_threads()
    robot = robot_in(env)
    robot.SetDOFValues([0.1, 0.2])
    robot.GetController()
    env.StepSimulation(0.01)
    env.GetPhysicsEngine()
    assert time_threads() == before
    env.GetSimulationTime()
    assert len(time_threads()) == len(before) + 1


def test_a_command_lets_time_pass_until_it_is_done(env):
    robot = robot_in(env)
    assert robot.GetController().SetDesired([0.3, -0.3])
    assert not robot.GetController().IsDone()
    assert robot.WaitForController(PATIENCE)
    assert env.GetSimulationTime() >= 10_000


def test_stopped_time_stands_still_and_steps_by_hand(env):
    env.StopSimulation()
    start = env.GetSimulationTime()
    assert not env.IsSimulationRunning()
    assert not time_threads()
    for timestep in (0.01, 0.0025, 1.5, 1e-6):
        env.StepSimulation(timestep)
    assert env.GetSimulationTime() - start == 1512501
    assert type(start) is int


def test_start_sets_step_and_pace(env):
    env.StartSimulation(0.5, realtime=False)
    assert env.IsSimulationRunning()
    await_that(lambda: env.GetSimulationTime() > 5_000_000)
    assert env.GetSimulationTime() % 500_000 == 0
    env.StopSimulation()
    stopped = env.GetSimulationTime()
    time.sleep(0.01)
    assert env.GetSimulationTime() == stopped


class Wall(threading.Event):
    """The clock on the wall, which waiting turns, and what ends the simulation's time, after 100 waits."""

    now, waits = 0.0, 0

    def wait(self, timeout=None):
        self.now += timeout
        self.waits += 1
        return self.is_set()

    def is_set(self):
        return self.waits > 100


@pytest.mark.parametrize(
    ("usual", "longest", "lost"),
    [
        (0.0, 0.0, 0.0),
        (0.004, 0.0, 0.0),
        (0.0, 0.09, 0.0),  # a short break is made up for
        (0.0, 1.0, 0.9),  # a long one is not
        (0.01, 0.0, 100 * 0.0051),  # steps follow one another as fast as they can
    ],
)
def test_real_time_keeps_pace_with_the_wall(monkeypatch, usual, longest, lost):
    """Steps of 5 ms take some time on the wall each, and one of them takes longer."""
    wall, steps = Wall(), []
    monkeypatch.setattr("ravemj.engine.clock.time", SimpleNamespace(monotonic=lambda: wall.now))
    monkeypatch.setattr("ravemj.engine.clock.Flag", lambda: wall)

    def step(timestep):
        steps.append(timestep)
        wall.now += longest if len(steps) == 50 else usual

    clock = Clock(StateLock(), step)
    clock.start(0.005, realtime=True)
    await_that(lambda: not time_threads())
    assert steps == [0.005] * 100
    assert wall.now - clock.now * 1e-6 == pytest.approx(lost, abs=0.011)


@pytest.mark.parametrize("timestep", [-0.01, float("nan"), float("inf")])
def test_steps_are_times(env, timestep):
    with pytest.raises(ravemj.ArgumentError, match="timestep"):
        env.StepSimulation(timestep)
    with pytest.raises(ravemj.ArgumentError, match="timestep"):
        env.StartSimulation(timestep)


def test_time_stands_still_while_the_environment_is_held(env):
    env.StartSimulation(0.001)
    with env:
        held = env.GetSimulationTime()
        time.sleep(0.02)
        assert env.GetSimulationTime() == held
        env.StepSimulation(0.25)
        assert env.GetSimulationTime() == held + 250_000
    await_that(lambda: env.GetSimulationTime() > held + 250_000)


def test_stopping_inside_a_locked_block_does_not_hang(env):
    env.StartSimulation(0.001)
    with env:
        env.StopSimulation()
    assert not time_threads()


def test_waiting_inside_a_locked_block_does_not_hang(env, caplog):
    robot = robot_in(env)
    with env:
        robot.GetController().SetDesired([0.1, 0.1])
        with pytest.raises(ravemj.openrave_exception, match="with env") as caught:
            robot.WaitForController(0)
        assert caught.value.GetCode() == "InvalidState"
        with caplog.at_level(logging.WARNING, "ravemj"):
            assert robot.WaitForController(0.5) is False
        assert "stands still" in caplog.text
    assert robot.WaitForController(0)


def test_destroyed_environments_leave_no_thread(env):
    env.GetSimulationTime()
    assert time_threads()
    env.Destroy()
    assert not time_threads()
    env.GetSimulationTime()
    assert not time_threads()


def test_forgotten_environments_leave_no_thread():
    env = ravemj.Environment()
    robot_in(env).GetController().SetDesired([0.1, 0.1])
    gone = weakref.ref(env)
    del env

    def is_gone():
        gc.collect()
        return gone() is None and not time_threads()

    await_that(is_gone)


def test_a_failing_step_stops_time_with_a_message(caplog):
    def fail(timestep):
        raise ValueError(f"no step of {timestep}")

    clock = Clock(StateLock(), fail)
    clock.start(0.001, realtime=True)
    await_that(lambda: "no step of 0.001" in caplog.text)
    await_that(lambda: not time_threads())
    assert clock.now == 0
    caplog.clear()
    clock.wake()
    await_that(lambda: "no step of 0.001" in caplog.text)
    clock.stop()


def test_commands_that_fail_in_the_thread_end_and_the_next_one_runs(env, caplog):
    robot = robot_in(env)
    robot.SetDOFVelocityLimits([1, 1])
    spec = robot.GetActiveConfigurationSpecification()
    spec.AddDeltaTimeGroup()
    trajectory = ravemj.RaveCreateTrajectory(env, "")
    trajectory.Init(spec)
    trajectory.Insert(0, [0, 0, 0, 1, 1, 0.1])
    controller = robot.GetController()
    controller.SendCommand("SetThrowExceptions 1")
    for _ in range(2):
        robot.SetDOFValues([0, 0])
        controller.SetPath(trajectory)
        assert robot.WaitForController(PATIENCE)
        await_that(lambda: "speed limit" in caplog.text)
        caplog.clear()
    controller.SetDesired([0.1, 0.1])
    assert robot.WaitForController(PATIENCE)


def test_the_thread_does_not_keep_python_alive():
    script = f"""
import ravemj, time
env = ravemj.Environment()
env.Load({PENDULUM!r})
env.StartSimulation(0.001)
while env.GetSimulationTime() == 0:
    time.sleep(0.001)
print("done")
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert (run.returncode, run.stdout, run.stderr) == (0, "done\n", "")


@pytest.mark.stress
def test_python_ends_after_the_thread(tmp_path):
    """A thread that came back from MuJoCo later crashed the process, in one run of six."""
    script = tmp_path / "script.py"
    script.write_text(
        "import atexit, threading\n"
        "atexit.register(lambda: print([one.name for one in threading.enumerate()]))  # runs last: the first one\n"
        "import ravemj\n"
        "env = ravemj.load(ravemj.model_path('pendulum'))\n"
        "env.StartSimulation(0.001, realtime=False)\n"
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "['MainThread']", "")
