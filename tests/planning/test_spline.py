"""Motions along near waypoints without stops, as those on constraints are."""

import numpy as np
import pytest
import strategies
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj.planning.retiming.segments import OutsideLimitsError, PathLimits, RetimingError
from ravemj.planning.retiming.spline import Spline
from ravemj.planning.space import Coordinates


def limits(dof: int, **more) -> PathLimits:
    numbers = {"lower": -9.0, "upper": 9.0, "velocity": 1.5, "acceleration": 3.0, "jerk": 99.0} | more
    circular = np.zeros(dof, dtype=bool)
    return PathLimits(Coordinates(circular), *(np.full(dof, numbers[name]) for name in list(numbers)[:5]))


def sampled(timed, parts: int = 20) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return values, velocities and accelerations of the cubic polynomials between rows, in steps of each."""
    points, rates = timed.orders
    found: list[list[np.ndarray]] = [[], [], []]
    for index, time in enumerate(timed.deltas[1:].tolist()):
        step, first, last = points[index + 1] - points[index], rates[index], rates[index + 1]
        square, cube = 3 * step / time**2 - (2 * first + last) / time, (first + last) / time**2 - 2 * step / time**3
        for part in np.linspace(0, time, parts + 1):
            found[0].append(points[index] + (first + (square + cube * part) * part) * part)
            found[1].append(first + (2 * square + 3 * cube * part) * part)
            found[2].append(2 * square + 6 * cube * part)
    return tuple(np.array(one) for one in found)


@given(st.integers(1, 4), st.integers(3, 40), st.integers(0, 1000))
@strategies.examples(60)
def test_limits_are_kept_and_waypoints_are_passed(dof, count, seed):
    numbers = np.random.default_rng(seed)
    points = np.cumsum(numbers.normal(0, 0.05, (count, dof)), axis=0)
    given = limits(dof)
    timed = Spline().timed(points, given)
    np.testing.assert_allclose(timed.orders[0], points, atol=1e-12)
    assert not timed.orders[1][[0, -1]].any()
    assert (timed.deltas[1:] > 0).all()
    values, velocities, accelerations = sampled(timed)
    assert (np.abs(values) <= 9).all()
    assert (np.abs(velocities) <= given.velocity * (1 + 1e-9)).all()
    assert (np.abs(accelerations) <= given.acceleration * (1 + 1e-9)).all()


def test_a_straight_line_takes_little_longer_than_it_has_to():
    points = np.linspace([0.0, 0.0], [3.0, 1.0], 200)
    shortest = 3 / 1.5 + 1.5 / 3  # trapezoid
    assert Spline().timed(points, limits(2)).deltas.sum() < 1.3 * shortest


@pytest.mark.parametrize(
    ("points", "error"),
    [
        ([[0.0], [20.0], [0.0]], OutsideLimitsError),
        ([[0.0], [1.0]], RetimingError),
        (np.zeros((0, 1)), RetimingError),
    ],
)
def test_what_has_no_times(points, error):
    with pytest.raises(error):
        Spline().timed(np.array(points), limits(1))


def test_a_joint_without_speed():
    with pytest.raises(RetimingError, match="limit is 0"):
        Spline().timed(np.linspace([0.0], [1.0], 5), limits(1, velocity=0.0))


def test_repeated_waypoints_are_one():
    points = np.repeat(np.linspace([0.0], [1.0], 5), 2, axis=0)
    assert len(Spline().timed(points, limits(1)).deltas) == 5
    still = Spline().timed(np.zeros((3, 1)), limits(1))
    assert still.deltas.tolist() == [0.0]


def test_a_glass_is_carried_upright_without_jumps_of_velocity():
    env = ravemj.Environment()
    env.Load(str(MODELS / "puma560.xml"))
    robot = env.GetRobots()[0]
    manip = robot.GetActiveManipulator()
    robot.SetDOFValues([0.2, -0.6, -0.4, 0.0, 0.6, 0.1], manip.GetArmIndices())
    T_world_start = manip.GetTransform()
    T_world_goal = T_world_start.copy()
    T_world_goal[:3, 3] += [-0.05, 0.3, 0.05]
    ravemj.databases.inversekinematics.InverseKinematicsModel(robot, ravemj.IkParameterization.Type.Transform6D).load()
    base = ravemj.interfaces.BaseManipulation(robot)
    traj = base.MoveToHandPosition(
        matrices=[T_world_goal], constraintfreedoms=[1, 1, 0, 0, 0, 0], execute=False, outputtrajobj=True
    )
    assert traj.GetConfigurationSpecification().GetGroupFromName("joint_values").interpolation == "cubic"
    times = np.arange(0, traj.GetDuration(), 1e-3)
    spec = manip.GetArmConfigurationSpecification()
    rows, rates = traj.SamplePoints2D(times, spec), traj.SamplePoints2D(times, spec.ConvertToVelocitySpecification())
    acceleration = robot.GetDOFAccelerationLimits()[manip.GetArmIndices()]
    assert (np.abs(np.diff(rates, axis=0)) <= 1e-3 * acceleration * (1 + 1e-6)).all()
    with robot:
        for row in rows:
            robot.SetDOFValues(row, manip.GetArmIndices())
            turned = manip.GetTransform()[:3, :3] @ T_world_start[:3, :3].T
            assert np.arccos(np.clip(turned[2, 2], -1, 1)) <= 1.001e-3
