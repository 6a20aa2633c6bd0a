"""``openravepy.planningutils``: trajectories backwards, together, and in another layout."""

import numpy as np
import pytest

import ravemj
from ravemj import ConfigurationSpecification, planningutils
from ravemj.planning.ramps import fit_from_rest


def trajectory(rows, *groups):
    """A trajectory with groups of one number each, and delta times in the last column."""
    spec = ConfigurationSpecification()
    for name in groups:
        spec.AddGroup(name, 1, "linear")
    spec.AddDeltaTimeGroup()
    made = ravemj.RaveCreateTrajectory(ravemj.Environment(), "")
    made.Init(spec)
    made.Insert(0, np.array(rows, float).ravel())
    return made


def test_backwards_and_back():
    rows = [[0, 0, 9, 0], [1, 2, 8, 0.5], [4, 3, 7, 1.5]]
    there = trajectory(rows, "joint_values a 0", "joint_velocities a 0", "joint_accelerations a 0")
    back = planningutils.ReverseTrajectory(there)
    assert back.GetAllWaypoints2D().tolist() == [[4, -3, 7, 0], [1, -2, 8, 1.5], [0, 0, 9, 0.5]]
    assert there.GetAllWaypoints2D().tolist() == rows
    assert planningutils.ReverseTrajectory(back).GetAllWaypoints2D().tolist() == rows
    assert back.GetDuration() == there.GetDuration()


def test_together_each_is_where_it_would_be_alone():
    one = trajectory([[0, 0], [2, 1]], "joint_values a 0")
    two = trajectory([[5, 0], [6, 0.5], [3, 1.5]], "joint_values a 1")
    both = planningutils.MergeTrajectories([one, two])
    assert both.GetDuration() == 2
    for time in np.linspace(0, 2, 9).tolist():
        for alone in (one, two):
            group = alone.GetConfigurationSpecification().GetGroupFromName("joint_values")
            expected = alone.Sample(time)[group.offset]
            part = ConfigurationSpecification()
            part.AddGroup(group.name, 1, "linear")
            assert both.Sample(time, part)[0] == pytest.approx(expected)
    assert planningutils.MergeTrajectories([]) is None


def test_converted_in_place():
    made = trajectory([[1, 2, 0], [3, 4, 1]], "joint_values a 0", "joint_values b 0")
    spec = ConfigurationSpecification()
    spec.AddDeltaTimeGroup()
    spec.AddGroup("joint_values b 0", 1, "linear")
    planningutils.ConvertTrajectorySpecification(made, spec)
    assert made.GetConfigurationSpecification() == spec
    assert made.GetAllWaypoints2D().tolist() == [[0, 2], [1, 4]]


def test_backwards_is_the_mirror_image_in_time_of_a_motion_whose_velocities_hold_for_segments():
    env = ravemj.load(ravemj.model_path("puma560"))
    robot = env.GetRobots()[0]
    robot.SetActiveDOFs([0, 1])
    there = ravemj.RaveCreateTrajectory(env, "")
    there.Init(robot.GetActiveConfigurationSpecification())
    there.Insert(0, [0, 0, 0.5, 1.2, 0.6, 1])
    planningutils.RetimeActiveDOFTrajectory(there, robot, plannername="lineartrajectoryretimer")
    back = planningutils.ReverseTrajectory(there)
    planningutils.VerifyTrajectory(None, back, 0.002)
    values = robot.GetActiveConfigurationSpecification("linear")
    for time in np.linspace(0.01, 0.99, 7) * there.GetDuration():
        for spec, sign in ((values, 1), (values.ConvertToVelocitySpecification(), -1)):
            mirrored = sign * there.Sample(there.GetDuration() - time, spec)
            assert back.Sample(time, spec) == pytest.approx(mirrored)


def test_poses_of_no_body_get_times():
    env = ravemj.Environment()
    made = ravemj.RaveCreateTrajectory(env, "")
    made.Init(ravemj.RaveGetAffineConfigurationSpecification(ravemj.DOFAffine.Transform))
    made.Insert(0, [0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 1, 0, 0, 0])
    limits = np.full(7, 2.0)
    status = planningutils.RetimeAffineTrajectory(made, limits, limits, plannername="lineartrajectoryretimer")
    assert status == ravemj.PlannerStatus.HasSolution
    assert made.GetDuration() == pytest.approx(1.5)  # 3 m at 2 m/s
    with pytest.raises(ravemj.openrave_exception, match="there is no body 'who'"):
        planningutils.RetimeAffineTrajectory(trajectory([[0, 0], [1, 0]], "joint_values who 0"), [1], [1])


def test_a_planner_that_is_none_is_named():
    env = ravemj.load(ravemj.model_path("puma560"))
    made = trajectory([[0, 0], [1, 1]], "joint_values PUMA560 0")
    with pytest.raises(ravemj.openrave_exception, match="ExtendWaypoint: planner"):
        planningutils.ExtendWaypoint(2, [1], [0], made, env.GetRobots()[0])


def test_the_linear_retimer_interpolates_the_numbers_of_quaternions():
    """From q to -q, which is the same rotation, the numbers pass through 0, as in OpenRAVE (test_affinetraj)."""
    spec = ravemj.RaveGetAffineConfigurationSpecification(ravemj.DOFAffine.Transform)
    traj = ravemj.RaveCreateTrajectory(ravemj.Environment(), "")
    traj.Init(spec)
    for w, x in ((1, 2), (-1, -2)):
        traj.Insert(traj.GetNumWaypoints(), [x, 0, 0, w, 0, 0, 0])
    speeds = np.array([1.0] * 3 + [100] * 4)
    assert planningutils.RetimeAffineTrajectory(traj, speeds, 1e6 * np.ones(7), False, "LinearTrajectoryRetimer")
    assert traj.GetDuration() == pytest.approx(4, abs=1e-12)
    np.testing.assert_allclose(traj.Sample(1, spec), [1, 0, 0, 0.5, 0, 0, 0], atol=1e-12)
    derivative = traj.Sample(1, spec.ConvertToVelocitySpecification())
    np.testing.assert_allclose(derivative, [-1, 0, 0, -0.5, 0, 0, 0], atol=1e-12)


def test_a_pose_of_zeros_is_refused_by_name():
    spec = ravemj.RaveGetAffineConfigurationSpecification(ravemj.DOFAffine.Transform)
    with pytest.raises(ravemj.openrave_exception, match="the quaternion is 0 0 0 0"):
        spec.ExtractTransform(np.eye(4), np.zeros(7), None)


@pytest.mark.parametrize("duration", [1e200, 1e-200])
def test_no_duration_is_too_long_or_short_for_ramps(duration):
    step, limit = np.array([1.0]), np.array([1e10])
    ramps = fit_from_rest(step, duration, limit, limit)
    assert ramps is None if duration < 1 else ramps.duration == duration
