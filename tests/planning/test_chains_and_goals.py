"""``openravepy.planningutils``: Denavit-Hartenberg parameters, and goals of inverse kinematics."""

import numpy as np
import pytest

import ravemj
from ravemj import planningutils

WRIST = """<Environment><KinBody name="arm">
  <Body name="base"/><Body name="shoulder"/><Body name="upper"/><Body name="fore"/>
  <Joint name="pan"><Body>base</Body><Body>shoulder</Body><axis>0 0 1</axis><anchor>.3 .4 .1</anchor></Joint>
  <Joint name="lift"><Body>shoulder</Body><Body>upper</Body><axis>0 1 0</axis><anchor>.3 .4 .1</anchor></Joint>
  <Joint name="turn"><Body>upper</Body><Body>fore</Body><axis>0 0 1</axis><anchor>.2 .4 .6</anchor></Joint>
</KinBody></Environment>"""


def test_dh_turns_x_by_at_most_a_right_angle(env):
    # The common normal has two directions; OpenRAVE takes that which is nearer to x of the frame before, so that the
    # distance along it can be negative.
    assert env.LoadData(WRIST)
    pan, lift, turn = planningutils.GetDHParameters(env.GetKinBody("arm"))
    angle = np.arctan2(0.4, 0.3)
    assert (pan.d, pan.a, pan.theta, pan.alpha) == pytest.approx((0.1, 0.5, angle, 0))
    assert (lift.d, lift.a, lift.theta, lift.alpha) == pytest.approx((0, 0, -angle, -np.pi / 2))
    assert (turn.d, turn.a, turn.theta, turn.alpha) == pytest.approx((0, -0.1, 0, np.pi / 2))
    assert turn.transform == pytest.approx(np.array([[1, 0, 0, 0.2], [0, 1, 0, 0.4], [0, 0, 1, 0.1], [0, 0, 0, 1]]))
    for record in (pan, lift, turn):
        start = np.eye(4) if record.parentindex < 0 else [pan, lift, turn][record.parentindex].transform
        about_z = ravemj.matrixFromAxisAngle([0, 0, record.theta])
        about_z[:3, 3] = [0, 0, record.d]
        about_x = ravemj.matrixFromAxisAngle([record.alpha, 0, 0])
        about_x[:3, 3] = [record.a, 0, 0]
        assert start @ about_z @ about_x == pytest.approx(record.transform, abs=1e-12)


def test_goals_that_collide_are_tried_aside(models):
    """A box touches the hand at the goal, and leaves it room beside it."""
    env = ravemj.load(models / "puma560.xml")
    robot = env.GetRobots()[0]
    model = ravemj.databases.inversekinematics.InverseKinematicsModel(
        robot, iktype=ravemj.IkParameterizationType.Transform6D
    )
    assert model.load() or model.autogenerate() is None
    arm = robot.GetActiveManipulator()
    robot.SetDOFValues([0.3, 0.4, -0.8, 0.2, 0.6, 0.1], arm.GetArmIndices())
    box = ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes(np.array([[0, 0, 0, 0.05, 0.05, 0.05]]), True)
    box.SetName("box")
    env.Add(box)
    goal = arm.GetIkParameterization(ravemj.IkParameterizationType.Transform6D)
    beside = goal.GetTransform6D()
    low, high = 0.0, 1.0
    while high - low > 1e-3:  # where the box just touches the hand
        beside[0, 3] = goal.GetTransform6D()[0, 3] + (low + high) / 2
        box.SetTransform(beside)
        low, high = (
            ((low + high) / 2, high) if env.CheckCollision(arm.GetEndEffector(), box) else (low, (low + high) / 2)
        )
    beside[0, 3] = goal.GetTransform6D()[0, 3] + low
    box.SetTransform(beside)
    free = []
    for jitter in (0, 0.03):
        sampler = planningutils.ManipulatorIKGoalSampler(arm, [goal], nummaxtries=30, jitter=jitter)
        values = sampler.Sample()
        free.append(values is not None)
    assert free == [False, True]
    robot.SetDOFValues(values, arm.GetArmIndices())
    assert not env.CheckCollision(robot)
    assert np.abs(arm.GetTransform()[:3, 3] - goal.GetTransform6D()[:3, 3]).max() <= 0.03
