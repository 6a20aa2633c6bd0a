"""Time-optimal motions by TOPP-RA, and what is said where it is not installed."""

import importlib.util

import numpy as np
import pytest
from test_planners import env, line, robot

import ravemj
from ravemj import planningutils
from ravemj.planning.retiming.polynomials import Parabolic
from ravemj.planning.retiming.segments import OutsideLimitsError, PathLimits, RetimingError, retime
from ravemj.planning.retiming.topp_ra import ToppRa
from ravemj.planning.space import Coordinates

__all__ = ["env", "robot"]  # fixtures

NAME = "ToppraTrajectoryRetimer"
needs_toppra = pytest.mark.skipif(
    importlib.util.find_spec("toppra") is None, reason='toppra is not installed: pip install "ravemj[retiming]"'
)


def limits(dof, velocity=1.0, acceleration=2.0, bound=4.0):
    ones, circular = np.ones(dof), np.zeros(dof, dtype=bool)
    return PathLimits(
        Coordinates(circular), -bound * ones, bound * ones, velocity * ones, acceleration * ones, np.inf * ones
    )


@needs_toppra
@pytest.mark.parametrize("seed", range(4))
def test_no_limit_is_exceeded_anywhere(seed):
    random = np.random.default_rng(seed)
    dof = 1 + seed * 2
    points = random.uniform(-2, 2, (3 + 4 * seed, dof))
    bounds = limits(dof)
    timed = ToppRa().timed(points, bounds)
    values, velocities = timed.orders
    assert values[timed.is_point] == pytest.approx(points)
    assert not velocities[[0, -1]].any()
    fastest, strongest = 0.0, 0.0
    for row, time in enumerate(timed.deltas[1:]):  # the polynomials by themselves, each at many moments
        t = np.linspace(0, time, 50)[:, None]
        step, v0, v1 = values[row + 1] - values[row], velocities[row], velocities[row + 1]
        c2 = 3 * step / time**2 - (2 * v0 + v1) / time
        c3 = (v0 + v1) / time**2 - 2 * step / time**3
        fastest = max(fastest, np.abs(v0 + 2 * c2 * t + 3 * c3 * t**2).max())
        strongest = max(strongest, np.abs(2 * c2 + 6 * c3 * t).max())
    assert fastest <= 1.0 + 1e-9
    assert strongest <= 2.0 + 1e-9
    assert max(fastest / 1.0, strongest / 2.0) > 0.99, "and one is reached"
    stops = retime(Parabolic(), points, bounds)
    assert timed.deltas.sum() < 1.1 * stops.deltas.sum()


@needs_toppra
def test_a_straight_line_takes_the_time_of_a_trapezoid():
    points = np.array([[0.0, 0.0], [2.0, 1.0]])
    best = retime(Parabolic(), points, limits(2)).deltas.sum()
    assert best <= ToppRa().timed(points, limits(2)).deltas.sum() <= best * 1.02


@needs_toppra
def test_trajectories_are_retimed_by_name_and_pass_the_strict_check(robot):
    trajectory = line(robot, [[-1.2, 0.2], [-0.8, 0.3], [-0.8, 0.3], [-1.0, 1.0]])
    assert planningutils.RetimeActiveDOFTrajectory(trajectory, robot, plannername=NAME)
    planningutils.VerifyTrajectory(None, trajectory, 0.003)
    assert trajectory.GetConfigurationSpecification().GetGroupFromName("joint_values").interpolation == "cubic"
    quick = trajectory.GetDuration()
    assert planningutils.RetimeActiveDOFTrajectory(trajectory, robot, maxvelmult=0.5, plannername="toppra")
    assert trajectory.GetDuration() > quick
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetStepLength(0.25)
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), NAME)
    planner.InitPlan(robot, params)
    trajectory = line(robot, [[-1.2, 0.2], [-0.8, 0.3]])
    assert planner.PlanPath(trajectory)
    assert trajectory.GetDuration() / 0.25 == pytest.approx(round(trajectory.GetDuration() / 0.25))


@needs_toppra
def test_what_topp_ra_cannot_retime_says_why(robot):
    with pytest.raises(RetimingError, match="no waypoints"):
        ToppRa().timed(np.zeros((0, 2)), limits(2))
    with pytest.raises(RetimingError, match="velocity or acceleration limit is 0"):
        ToppRa().timed(np.array([[0.0, 0.0], [0.0, 1.0]]), limits(2, velocity=0.0))
    with pytest.raises(OutsideLimitsError):
        ToppRa().timed(np.array([[0.0, 0.0], [0.0, 5.0]]), limits(2))
    with pytest.raises(RetimingError, match=r"value 0 swings to .*, outside its limits \[-1, 1\]; more waypoints"):
        ToppRa().timed(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), limits(2, bound=1.0))
    assert ToppRa().timed(np.ones((3, 2)), limits(2)).deltas.tolist() == [0.0]
    trajectory = line(robot, [[-1.2, 0.2], [-0.8, 0.3]])
    planningutils.RetimeActiveDOFTrajectory(trajectory, robot)
    status = planningutils.RetimeActiveDOFTrajectory(trajectory, robot, True, plannername=NAME)
    assert "TOPP-RA keeps neither times nor velocities" in status.description


def test_without_toppra_there_is_no_such_planner_and_a_warning_names_the_extra(env, monkeypatch, caplog):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert ravemj.RaveCreatePlanner(env, NAME) is None
    assert 'pip install "ravemj[retiming]"' in caplog.text
