"""Simulation time: the thread that lets it pass, and what it does not disturb."""

import gc
import logging
import subprocess
import sys
import threading
import time
import weakref

import pytest

import ravemj
from ravemj.engine.clock import Clock

PENDULUM = "models/env.xml"


def time_threads():
    return [thread for thread in threading.enumerate() if thread.name == "simulation time"]


def wait_until(condition, seconds=5.0):
    """Wait for something that takes milliseconds."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(1e-3)
    return condition()


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
    assert robot.WaitForController(5)
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
    assert wait_until(lambda: env.GetSimulationTime() > 5_000_000)
    assert env.GetSimulationTime() % 500_000 == 0
    env.StopSimulation()
    stopped = env.GetSimulationTime()
    time.sleep(0.01)
    assert env.GetSimulationTime() == stopped


def test_real_time_keeps_pace_with_the_wall():
    steps = []
    clock = Clock(threading.RLock(), steps.append)
    clock.start(0.005, realtime=True)
    began = time.monotonic()
    time.sleep(0.2)
    clock.stop()
    passed = time.monotonic() - began
    assert 0.3 * passed < clock.now * 1e-6 < passed + 0.005
    assert set(steps) == {0.005}


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
    assert wait_until(lambda: env.GetSimulationTime() > held + 250_000)


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

    assert wait_until(is_gone)


def test_a_failing_step_stops_time_with_a_message(caplog):
    def fail(timestep):
        raise ValueError(f"no step of {timestep}")

    clock = Clock(threading.RLock(), fail)
    clock.start(0.001, realtime=True)
    assert wait_until(lambda: "no step of 0.001" in caplog.text)
    assert wait_until(lambda: not time_threads())
    assert clock.now == 0
    caplog.clear()
    clock.wake()
    assert wait_until(lambda: "no step of 0.001" in caplog.text)
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
        assert robot.WaitForController(60)
        assert wait_until(lambda: "speed limit" in caplog.text, 60)
        caplog.clear()
    controller.SetDesired([0.1, 0.1])
    assert robot.WaitForController(60)


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
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
    assert (run.returncode, run.stdout, run.stderr) == (0, "done\n", "")
