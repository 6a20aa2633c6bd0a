"""Simulation time in a viewer: pause, step, pace, pulling with a force, contact forces; without a window."""

import math
import time

import numpy as np
import pytest
from test_interaction import SIZE, Hand
from waiting import await_that

import ravemj
from ravemj.engine.physics import Spring
from ravemj.gui.interaction import Button, Key, Leave, Move, Operate, Press, Release
from ravemj.gui.interaction.pointer_controller import WITHOUT_PHYSICS

WORLD = """<Environment>
<KinBody name="floor"><Body type="static">
  <Geom type="box"><translation>0 0 -0.05</translation><extents>2 2 0.05</extents></Geom></Body></KinBody>
<KinBody name="box"><translation>0 0 0.1</translation><Body type="dynamic">
  <Geom type="box"><extents>0.1 0.1 0.1</extents></Geom>
  <mass type="custom"><total>2</total><inertia>0.02 0 0 0 0.02 0 0 0 0.02</inertia></mass></Body></KinBody>
</Environment>"""
WEIGHT = 2 * 9.8
FROM_ABOVE = ravemj.transformLookat(lookat=[0, 0, 0.1], camerapos=[2, 1, 0.8], cameraup=[0, 0, -1])


@pytest.fixture
def env():
    env = ravemj.Environment()
    env.StopSimulation()
    env.LoadData(WORLD)
    env.SetPhysicsEngine("mujoco")
    env.GetPhysicsEngine().SetGravity([0, 0, -9.8])
    yield env
    env.Destroy()


@pytest.fixture
def hand(env):
    return Hand(env, FROM_ABOVE)


def control(hand, name):
    return next((control for control in hand.gui.overlay().controls if control.name == name), None)


def steps(env, count):
    for _ in range(count):
        env.StepSimulation(0.01)


# --- pause, step, pace


def test_there_is_time_to_control_only_with_physics_or_once_it_passes():
    env = ravemj.load("models/env.xml")
    env.StopSimulation()
    hand = Hand(env)
    assert control(hand, "run") is None
    env.StepSimulation(0.25)
    assert control(hand, "clock").text == "0.25 s"
    assert control(hand, "run").is_on is False


def test_a_step_is_one_step_and_stops_time(env, hand):
    env.StartSimulation(0.02)
    hand.press_key("arrowright")
    assert not env.IsSimulationRunning()
    before = env.GetSimulationTime()
    hand.gui.handle(Operate("step"))
    assert env.GetSimulationTime() == before + 20_000


def test_space_lets_time_pass_and_stops_it(env, hand):
    hand.press_key(" ")
    assert env.IsSimulationRunning()
    assert control(hand, "run").is_on
    await_that(lambda: env.GetSimulationTime() > 0)
    hand.press_key(" ")
    assert not env.IsSimulationRunning()
    stopped = env.GetSimulationTime()
    time.sleep(0.05)
    assert env.GetSimulationTime() == stopped


def test_space_is_for_the_motion_while_there_is_one(env):
    env.Load("models/env.xml")
    env.SetViewer("offscreen")
    playback = env.GetViewer().play(ravemj.Motion.line([0, 0], [1, 0]))
    for name in (" ", "-"):
        env.GetViewer().interaction.handle(Key(name))
    assert (playback.playing, playback.speed) == (False, 0.5)
    assert not env.IsSimulationRunning()
    assert env.clock.pace == 1


def test_the_pace_is_chosen_by_keys_and_by_a_button(env, hand):
    env.StartSimulation(0.01, realtime=False)
    assert control(hand, "pace").text == "max"
    hand.gui.handle(Operate("pace"))
    assert env.clock.pace == 0.1
    for key, pace in (("-", 0.1), ("+", 0.25), ("=", 0.5)):
        hand.press_key(key)
        assert env.clock.pace == pace
    assert control(hand, "pace").text == "0.5x"
    env.StartSimulation(0.01)
    assert env.clock.pace == 1


def test_time_at_half_pace_takes_twice_as_long(env):
    env.StartSimulation(0.001)
    env.clock.pace = 0.05
    begin, start = time.monotonic(), env.GetSimulationTime()
    time.sleep(0.3)
    await_that(lambda: env.GetSimulationTime() > start)
    passed = (env.GetSimulationTime() - start) / 1e6
    assert passed <= 0.05 * (time.monotonic() - begin) + 0.05 * 0.1 + 0.002  # it catches up with 0.1 s at most


def test_it_is_measured_how_fast_time_passes(env, hand):
    env.clock.pace = 1e-6  # the thread waits; this test lets time pass
    env.clock.resume()
    hand.gui.advance(100.0)
    assert control(hand, "clock").text.endswith("s, 0.00x")
    seen = hand.gui.appearance
    steps(env, 40)
    hand.gui.advance(100.5)
    assert control(hand, "clock").text.endswith("s, 0.80x")
    assert hand.gui.appearance != seen
    seen = hand.gui.appearance
    hand.gui.advance(100.6)
    assert hand.gui.appearance == seen  # nothing to be drawn anew
    env.StopSimulation()
    hand.gui.advance(101.5)
    assert control(hand, "clock").text.endswith(" s")


def test_a_step_that_fails_is_told_in_the_view(env, hand, monkeypatch, caplog):
    def fail(timestep):
        raise ValueError("no such luck")

    monkeypatch.setattr(env.GetPhysicsEngine(), "SimulateStep", fail)
    hand.gui.handle(Operate("step"))
    assert "The step failed: no such luck" in hand.lines()
    assert "a step of simulation time failed" in caplog.text


# --- pulling


def test_a_right_drag_pulls_a_body_to_the_pointer_and_lets_go(env, hand):
    box = env.GetKinBody("box")
    steps(env, 20)
    at = hand.at([0.1, 0.05, 0.1])
    hand.gui.handle(Press(*at, Button.RIGHT))
    hand.gui.handle(Move(at[0] + 40, at[1] - 120))
    spring = env.simulation.physics.spring
    assert len(hand.gui.overlay().primitives.spheres.corners) == 2
    steps(env, 300)
    aside = np.linalg.norm(spring.place[:2] - spring.goal[:2])
    assert aside < 0.01
    assert 0 < spring.goal[2] - spring.place[2] < 0.2  # it hangs a little low
    assert box.GetTransform()[2, 3] > 0.2
    hand.gui.handle(Release(at[0] + 40, at[1] - 120, Button.RIGHT))
    steps(env, 200)
    assert box.GetTransform()[2, 3] < 0.12
    assert not len(hand.gui.overlay().primitives.spheres.corners)


@pytest.mark.parametrize("end", [Leave(), Key("escape"), Press(1, 1)])
def test_whatever_ends_a_drag_ends_the_pull(env, hand, end):
    hand.gui.handle(Press(*hand.at([0.1, 0.05, 0.1]), Button.RIGHT))
    assert env.simulation.physics.spring is not None
    hand.gui.handle(end)
    assert env.simulation.physics.spring is None


def test_what_is_held_fast_stays_and_a_body_that_goes_is_pulled_no_more(env, hand):
    hand.gui.handle(Press(*hand.at([0.5, 0.5, 0]), Button.RIGHT))
    hand.gui.handle(Move(SIZE[0] / 2, 100))
    spring = env.simulation.physics.spring
    assert spring.state.scene.name == "floor"
    steps(env, 5)
    np.testing.assert_array_equal(env.GetKinBody("floor").GetTransform(), np.eye(4))
    hand.gui.handle(Press(*hand.at([0.1, 0.05, 0.1]), Button.RIGHT))
    env.Remove(env.GetKinBody("box"))
    steps(env, 2)


def test_a_spring_pulls_with_the_force_of_a_damped_oscillator(env, hand):
    """A mass at rest in its middle, without gravity: x = d (1 - (1 + w t) exp(-w t))."""
    box = env.GetKinBody("box")
    box.SetTransform([1, 0, 0, 0, 0, 0, 1])
    env.GetPhysicsEngine().SetGravity([0, 0, 0])
    env.simulation.physics.spring = Spring(box.simulation_state, 0, np.zeros(3), np.array([0.3, 0, 1]))
    steps(env, 10)
    angle = 15 * 0.1
    assert box.GetTransform()[0, 3] == pytest.approx(0.3 * (1 - (1 + angle) * math.exp(-angle)), abs=2e-3)


def test_without_physics_the_view_says_what_is_missing():
    env = ravemj.load("models/env.xml")
    hand = Hand(env)
    hand.drag((400, 500), (440, 500), button=Button.RIGHT)
    assert WITHOUT_PHYSICS in hand.lines()


# --- contacts


def test_contacts_of_physics_carry_the_weight(env, hand):
    steps(env, 100)
    points, forces = env.simulation.physics.contacts()
    np.testing.assert_allclose(forces.sum(axis=0), [0, 0, WEIGHT], atol=1e-3)
    np.testing.assert_allclose(points[:, 2], 0, atol=1e-3)
    hand.press_key("c")
    shown = hand.gui.overlay().primitives
    assert len(shown.spheres.corners) == len(points)
    assert shown.triangles.corners[..., 2].max() > 0.05  # arrows point up
