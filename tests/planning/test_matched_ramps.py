"""Parabolic retimers with ``<multidofinterp>2``: all joints change their accelerations at the same times."""

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import planningutils

SPEED = np.array([7.854, 7.854, 5.236, 9.4248, 10.8747, 12.5664])
ACCELERATION = np.array([26.18, 19.635, 14.96, 47.124, 36.249, 41.888])
MATCHED = "<multidofinterp>2</multidofinterp>"


@pytest.fixture
def robot():
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs(range(6))
    robot.SetDOFLimits(np.full(6, -7.0), np.full(6, 7.0))
    robot.SetDOFVelocityLimits(SPEED)
    robot.SetDOFAccelerationLimits(ACCELERATION)
    yield robot
    env.Destroy()


def retimed(robot, rows, text):
    made = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    made.Init(robot.GetActiveConfigurationSpecification())
    made.Insert(0, np.ravel(rows))
    assert planningutils.RetimeActiveDOFTrajectory(made, robot, False, 1, 1, "ParabolicTrajectoryRetimer", text)
    return made


def test_the_duration_of_openraves_own_test(robot):
    start = [-1.5707962927971486, -0.51156440, 2.7255228159, 3.1415927831636017, 0.6431620887, 6.2831852909169683]
    end = [1.5707962849435657, 0.29701411, 2.3875409345, -3.1415927489387800, 1.1137587187, 1.2949949709057725e-07]
    made = retimed(robot, [start, end], MATCHED + "<_fsteplength>7.11111111111e-3</_fsteplength>")
    assert made.GetDuration() == pytest.approx(0.910222222222, abs=1e-11)
    assert made.GetNumWaypoints() == 4


@pytest.mark.parametrize("seed", one_in(4, range(100)))
def test_accelerations_change_together_within_the_limits(robot, seed):
    random = np.random.default_rng(seed)
    rows = random.uniform(-3, 3, (2, 6)) * (random.random(6) < 0.7)
    made, fastest = retimed(robot, rows, MATCHED), retimed(robot, rows, "")
    assert made.GetNumWaypoints() <= 4
    assert made.GetDuration() >= fastest.GetDuration() - 1e-12
    assert made.GetWaypoint(-1)[:6] == pytest.approx(rows[1])
    spec = robot.GetActiveConfigurationSpecification("linear")
    times = np.linspace(0, made.GetDuration(), 60)
    speeds = np.array([made.Sample(t, spec.ConvertToVelocitySpecification()) for t in times])
    assert (np.abs(speeds) <= SPEED * (1 + 1e-9)).all()
    assert (np.abs(np.diff(speeds, axis=0)) <= ACCELERATION * (times[1] - times[0]) * (1 + 1e-9) + 1e-9).all()


def test_a_motion_of_one_joint_is_the_fastest(robot):
    for way in (1e-3, 0.1, 1.0, 6.0):
        rows = [np.zeros(6), [0, way, 0, 0, 0, 0]]
        assert retimed(robot, rows, MATCHED).GetDuration() == pytest.approx(retimed(robot, rows, "").GetDuration())
