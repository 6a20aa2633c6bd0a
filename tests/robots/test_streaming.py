"""Motions that are sent to robots in real time: ``StreamingController``, and the stream below it."""

import math
import os
import signal
import time

import numpy as np
import pytest
from waiting import await_that

import ravemj
from ravemj.errors import ArgumentError, RavemjError
from ravemj.robots.streaming import Guard, MotionRows, Stream

PERIOD = 0.01


class Clock:
    """A clock that passes while somebody waits, and by what the script adds."""

    def __init__(self):
        self.time = 1000.0

    def now(self):
        return self.time

    def wait(self, seconds, ended):
        if not ended.is_set():
            self.time += max(0.0, seconds)


class Robot:
    """Notes what is sent, and when; may take time, and fail."""

    def __init__(self, clock, takes=lambda number: 0.0, fails=()):
        self.clock, self.takes, self.fails = clock, takes, fails
        self.sent = []

    def __call__(self, moment, values, velocities):
        self.sent.append((self.clock.now(), moment, values, velocities))
        number = len(self.sent) - 1
        self.clock.time += self.takes(number)
        if number in self.fails:
            raise OSError(f"cable {number}")

    @property
    def moments(self):
        return np.array([moment for _, moment, _, _ in self.sent])

    @property
    def clock_times(self):
        return np.array([now for now, _, _, _ in self.sent])

    @property
    def velocities(self):
        return np.array([velocities for _, _, _, velocities in self.sent])


def rows(count=101, turn=0.0):
    times = np.arange(count) * PERIOD
    way = np.linspace(0, 1, count)
    values = np.column_stack([way, -way])
    return MotionRows(times, values, np.gradient(values, PERIOD, axis=0), ["a", "b"], np.array([turn, 0.0]))


def stream(takes=lambda number: 0.0, fails=(), guard=None, count=101, turn=0.0):
    clock = Clock()
    robot = Robot(clock, takes, fails)
    made = Stream(rows(count, turn), robot, PERIOD, guard(clock, robot) if guard else Guard(), clock)
    return made, robot


def test_rows_are_sent_in_time():
    made, robot = stream()
    made.run()
    assert made.failure is None
    np.testing.assert_allclose(robot.clock_times - 1000.0, rows().times, atol=1e-9)
    np.testing.assert_allclose(robot.moments, rows().times)
    np.testing.assert_allclose([values for _, _, values, _ in robot.sent], rows().values)


def test_a_send_that_takes_less_than_a_period_does_not_delay():
    made, robot = stream(takes=lambda number: 0.008)
    made.run()
    np.testing.assert_allclose(robot.clock_times - 1000.0, rows().times, atol=1e-9)


def test_a_late_row_delays_the_rest_and_causes_no_burst():
    made, robot = stream(takes=lambda number: 0.5 if number == 20 else 0.0)
    made.run()
    assert len(robot.sent) == 101
    assert np.diff(robot.clock_times).min() > PERIOD * 0.99
    assert robot.clock_times[-1] - robot.clock_times[0] == pytest.approx(1.0 + 0.49, abs=0.02)


def test_a_low_rate_is_said(caplog):
    made, _ = stream(takes=lambda number: 0.02)
    made.run()
    assert "sent at 50 Hz in place of 100 Hz" in caplog.text
    caplog.clear()
    made, _ = stream(takes=lambda number: 0.0105)
    made.run()
    assert not caplog.text


def test_a_failure_of_send_is_followed_by_one_try_to_hold():
    made, robot = stream(fails=(10,))
    made.run()
    assert str(made.failure) == "cable 10"
    assert len(robot.sent) == 12
    np.testing.assert_array_equal(robot.sent[-1][2], robot.sent[9][2])
    assert not robot.sent[-1][3].any()


def test_a_failure_of_the_hold_leaves_the_first_failure():
    made, robot = stream(fails=(10, 11))
    made.run()
    assert str(made.failure) == "cable 10"
    assert len(robot.sent) == 12


def test_a_failure_at_the_first_row_holds_nothing():
    made, robot = stream(fails=(0,))
    made.run()
    assert str(made.failure) == "cable 0"
    assert len(robot.sent) == 1


def test_a_stop_is_a_hold_of_half_a_second():
    made, robot = stream()
    robot.takes = lambda number: made.stop("a reason") or 0.0 if number == 30 else 0.0
    made.run()
    assert "stopped: a reason" in str(made.failure)
    held = robot.sent[31:]
    assert len(held) == 50
    assert all(np.array_equal(values, robot.sent[30][2]) and not velocities.any() for _, _, values, velocities in held)
    np.testing.assert_allclose(np.diff(robot.clock_times[31:]), PERIOD, atol=1e-9)


def follower(change, age=lambda number: 0.0):
    """Feedback of a robot that is where it was sent, changed."""

    def guard(clock, robot):
        def feedback():
            number = len(robot.sent)
            values = robot.sent[-1][2] if robot.sent else np.zeros(2)
            return clock.now() - age(number), values + change(number)

        return Guard(feedback, 0.1, 0.205)

    return guard


def test_a_robot_that_follows_moves_to_the_end():
    made, robot = stream(guard=follower(lambda number: 0.05))
    made.run()
    assert made.failure is None
    assert len(robot.sent) == 101


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda number: np.array([0.0, 0.3 if number == 40 else 0.0]),
            r"joint 'b' is at -0.09, and should be at -0.4 at 0.4 s",
        ),
        (lambda number: np.array([math.nan if number == 40 else 0.0, 0.0]), r"feedback: is \[nan"),
    ],
)
def test_a_robot_that_leaves_the_motion_is_held_where_it_is(change, message):
    made, robot = stream(guard=follower(change))
    made.run()
    assert isinstance(made.failure, RavemjError)
    with pytest.raises(RavemjError, match=message):
        raise made.failure
    assert len(robot.sent) == 40 + 50
    held = robot.sent[38][2] if np.isnan(change(40)).any() else robot.sent[39][2] + change(40)
    np.testing.assert_array_equal(robot.sent[-1][2], held)


def test_continuous_joints_may_be_whole_turns_away():
    made, _ = stream(guard=follower(lambda number: np.array([4 * math.pi, 0.0])), turn=2 * math.pi)
    made.run()
    assert made.failure is None
    made, _ = stream(guard=follower(lambda number: np.array([4 * math.pi, 0.0])))
    made.run()
    assert "joint 'a'" in str(made.failure)


def test_an_old_measurement_stops_the_motion():
    made, robot = stream(guard=follower(lambda number: 0.0, age=lambda number: max(0.0, (number - 20) * PERIOD)))
    made.run()
    assert "the last measurement is 0.21 s old" in str(made.failure)
    assert len(robot.sent) == 41 + 50


def test_no_measurement_at_all_stops_the_motion():
    made, robot = stream(guard=lambda clock, robot: Guard(lambda: None, 0.1, 0.205))
    made.run()
    assert "s old" in str(made.failure)
    np.testing.assert_array_equal(robot.sent[-1][2], robot.sent[20][2])


def test_a_failure_of_feedback_is_a_hold():
    def guard(clock, robot):
        def feedback():
            if len(robot.sent) == 5:
                raise KeyError("socket")
            return clock.now(), robot.sent[-1][2] if robot.sent else np.zeros(2)

        return Guard(feedback, 0.1, 0.2)

    made, robot = stream(guard=guard)
    made.run()
    assert isinstance(made.failure, KeyError)
    assert len(robot.sent) == 5 + 50


def test_feedback_of_another_length_is_an_error():
    made, _ = stream(guard=lambda clock, robot: Guard(lambda: (clock.now(), [0.0]), 0.1, 0.2))
    made.run()
    assert isinstance(made.failure, ArgumentError)


# The controller


@pytest.fixture
def arm():
    env = ravemj.load(ravemj.model_path("scara"))
    yield env.GetRobots()[0]
    env.Destroy()


def trajectory_to(robot, goal):
    return robot.from_joint_trajectory(robot.to_joint_trajectory(ravemj.Motion.line(robot.GetDOFValues(), goal)))


def test_the_controller_plays_in_the_manner_of_openrave(arm):
    sent = []
    controller = ravemj.StreamingController(arm, lambda *row: sent.append(row))
    assert arm.SetController(controller)
    assert controller.IsDone()
    goal = [0.2, -0.1, 0.02, 0.3]
    assert controller.SetPath(trajectory_to(arm, goal))
    assert arm.WaitForController(60)
    assert controller.IsDone()
    np.testing.assert_allclose(sent[-1][1], goal, atol=1e-9)
    assert not np.abs(sent[-1][2]).max() > 1e-9
    assert controller.GetTime() == pytest.approx(sent[-1][0])
    await_that(lambda: np.allclose(arm.GetDOFValues(), goal, atol=1e-6))


def test_joints_without_a_path_stay_where_they_are_measured(arm):
    measured = np.array([0.0, 0.0, 0.03, 0.0])
    arm.SetDOFValues([0, 0, 0.01, 0])
    arm.SetActiveDOFs([0])
    path = trajectory_to(arm, [0.05, 0, 0.01, 0])
    sent = []

    def send(moment, values, velocities):
        sent.append(values)
        measured[0] = values[0]

    arm.SetController(ravemj.StreamingController(arm, send, feedback=lambda: (time.monotonic(), measured), stale=60))
    arm.GetController().SetPath(path)
    assert arm.WaitForController(60)
    assert {row[2] for row in np.array(sent).tolist()} == {0.03}


def test_what_fails_a_check_is_not_sent(arm):
    sent = []
    controller = ravemj.StreamingController(arm, lambda *row: sent.append(row))
    with pytest.raises(RavemjError, match="no robot yet"):
        controller.SetPath(trajectory_to(arm, [0.2] * 2 + [0.02, 0.3]))
    arm.SetController(controller)
    path = trajectory_to(arm, [0.2, -0.1, 0.02, 0.3])
    arm.SetDOFValues([0.5, 0, 0, 0])
    with pytest.raises(ArgumentError, match=r"joint 'joint1' starts at 0 rad, and the robot is at 0.5 rad"):
        controller.SetPath(path)
    arm.SetDOFValues([0.0] * 4)
    arm.SetDOFVelocityLimits([0.01] * 4)
    with pytest.raises(ArgumentError, match="velocity"):
        controller.SetPath(path)
    with pytest.raises(RavemjError, match="None"):
        controller.SetPath(None)
    silent = ravemj.StreamingController(arm, lambda *row: sent.append(row), feedback=lambda: None)
    arm.SetController(silent)
    with pytest.raises(RavemjError, match="no measurement yet"):
        silent.SetPath(path)
    arm.SetController(controller, [1, 2], 0)
    arm.SetDOFVelocityLimits([6.0] * 4)
    with pytest.raises(ArgumentError, match="moves joint 'joint1', which the controller does not"):
        controller.SetPath(path)
    assert not sent


def test_a_failure_is_raised_and_never_done(arm):
    def send(moment, values, velocities):
        if moment > 0.05:
            raise OSError("cable")

    controller = ravemj.StreamingController(arm, send)
    arm.SetController(controller)
    path = trajectory_to(arm, [0.2, -0.1, 0.02, 0.3])
    controller.SetPath(path)
    for _ in range(2):
        with pytest.raises(OSError, match="cable"):
            arm.WaitForController(60)
    controller.Reset()
    assert controller.IsDone()


def test_a_running_path_is_not_replaced_but_reset(arm):
    sent = []
    controller = ravemj.StreamingController(arm, lambda *row: sent.append(row))
    arm.SetController(controller)
    path = trajectory_to(arm, [2.0, -1.0, 0.1, 3.0])
    controller.SetPath(path)
    with pytest.raises(RavemjError, match="a path is running"):
        controller.SetPath(path)
    controller.Reset()
    assert controller.IsDone()
    arm.SetDOFValues([0.0] * 4)
    controller.SetPath(path)  # waits for the hold
    assert sent[-1][2].any() or sent[-1][0] == 0
    controller.Reset()


def test_ctrl_c_is_a_hold(arm):
    sent = []

    def send(moment, values, velocities):
        sent.append(velocities)
        if len(sent) == 10:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    try:
        controller = ravemj.StreamingController(arm, send, rate=200)
        arm.SetController(controller)
        controller.SetPath(trajectory_to(arm, [2.0, -1.0, 0.1, 3.0]))
        with pytest.raises(KeyboardInterrupt):
            arm.WaitForController(60)
        with pytest.raises(RavemjError, match="stopped: Ctrl-C"):
            arm.WaitForController(60)
        assert not any(velocities.any() for velocities in sent[-100:])
        assert sent[-102].any()
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(
    "wrong", [{"send": 1}, {"feedback": 1}, {"rate": 0}, {"tolerance": -1}, {"stale": math.nan}], ids=str
)
def test_wrong_arguments_are_refused(arm, wrong):
    with pytest.raises(ArgumentError, match=next(iter(wrong))):
        ravemj.StreamingController(arm, **{"send": print, **wrong})
