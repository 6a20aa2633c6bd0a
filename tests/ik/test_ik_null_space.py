"""Motions of arms that leave a goal reached, as manipulators offer them."""

import numpy as np
import pytest

import ravemj

TYPE = ravemj.IkParameterization.Type


@pytest.fixture
def arm():
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    turned = ravemj.matrixFromAxisAngle([0.4, -0.2, 0.9])
    turned[:3, 3] = 0.3, -0.1, 0.2
    robot.SetTransform(turned)
    robot.SetDOFValues([0.3, -0.5, 0.2, -2.2, 0.4, 1.8, 0.7], range(7))
    yield robot.GetActiveManipulator()
    env.Destroy()


@pytest.mark.parametrize(("iktype", "count"), [(TYPE.Transform6D, 1), (TYPE.Translation3D, 4), (TYPE.Lookat3D, 5)])
def test_the_null_space_leaves_the_goal_reached(arm, iktype, count):
    robot, goal = arm.GetRobot(), arm.GetIkParameterization(iktype)
    values, basis = arm.GetArmDOFValues(), arm.null_space(iktype)
    assert basis.shape == (7, count)
    np.testing.assert_allclose(basis.T @ basis, np.eye(count), atol=1e-12)
    for velocity in basis.T:
        robot.SetDOFValues(values + 1e-5 * velocity, arm.GetArmIndices())
        assert goal.ComputeDistanceSqr(arm.GetIkParameterization(goal)) < 1e-16


def test_a_path_keeps_the_tool_where_it_is_until_a_limit(arm):
    robot, pose, values = arm.GetRobot(), arm.GetTransform(), arm.GetArmDOFValues()
    rows = arm.null_space_path([1, 0, 0, 0, 0, 0, 0], step=0.1)
    np.testing.assert_array_equal(rows[0], values)
    np.testing.assert_array_equal(arm.GetArmDOFValues(), values)
    assert rows[1, 0] > values[0]
    lower, upper = robot.GetDOFLimits(arm.GetArmIndices())
    assert min((upper - rows[-1]).min(), (rows[-1] - lower).min()) < 0.1
    for row in rows:
        robot.SetDOFValues(row, arm.GetArmIndices())
        np.testing.assert_allclose(arm.GetTransform(), pose, atol=1e-8)


def test_what_makes_no_sense_is_refused(arm):
    puma = ravemj.load(ravemj.model_path("puma560")).GetRobots()[0].GetActiveManipulator()
    puma.GetRobot().SetDOFValues([0.3, 0.4, -1.0, 0.5, 0.6, 0.7])
    assert puma.null_space().shape == (6, 0)
    with pytest.raises(ravemj.ArgumentError, match="cannot move along"):
        puma.null_space_path(np.ones(6))
    with pytest.raises(ravemj.ArgumentError, match="along"):
        arm.null_space_path([1, 2])
    with pytest.raises(ravemj.ArgumentError, match="step"):
        arm.null_space_path(np.ones(7), step=0)
