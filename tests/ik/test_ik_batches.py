"""All solutions of many goals: those of ``FindIKSolutions``, in its order."""

import numpy as np
import pytest
from conftest import MODELS
from ravemj.databases.inversekinematics import InverseKinematicsModel

import ravemj
from ravemj import IkFilterOptions, IkParameterization

Type = IkParameterization.Type


def arm_of(name, kind=Type.Transform6D):
    env = ravemj.load(MODELS / name)
    robot = env.GetRobots()[0]
    assert InverseKinematicsModel(robot, kind).load()
    block = ravemj.RaveCreateKinBody(env, "")
    block.InitFromBoxes([[0.35, 0.1, 0.5, 0.1, 0.1, 0.2]])
    block.SetName("block")
    env.Add(block)
    return robot.GetActiveManipulator()


def goals_of(arm, count=24, seed=3):
    """Return poses, of which some are out of reach, and one is that of a singular configuration."""
    robot = arm.GetRobot()
    lower, upper = np.clip(robot.GetDOFLimits(), -3, 3)
    values = np.random.default_rng(seed).uniform(lower, upper, (count, robot.GetDOF()))
    values[2] = 0
    poses = robot.batch_link_transforms(values)[:, arm.GetEndEffector().GetIndex()] @ arm.GetLocalToolTransform()
    poses[5, :3, 3] += 9
    poses[7, :3, 3] *= 1.2
    return poses


@pytest.mark.parametrize("name", ["puma560.xml", "panda.xml", "scara.dae"])
@pytest.mark.parametrize(
    ("collisions", "limits", "options"),
    [
        (False, True, IkFilterOptions.IgnoreSelfCollisions),
        (False, False, IkFilterOptions.IgnoreSelfCollisions | IkFilterOptions.IgnoreJointLimits),
        (True, True, IkFilterOptions.CheckEnvCollisions),
    ],
)
def test_as_one_by_one(name, collisions, limits, options):
    arm = arm_of(name)
    goals, before = goals_of(arm), arm.GetRobot().GetDOFValues()
    values, valid = arm.batch_solutions(goals, limits=limits, collisions=collisions)
    np.testing.assert_array_equal(arm.GetRobot().GetDOFValues(), before)
    assert values.shape == (*valid.shape, arm.GetArmDOF())
    assert np.isnan(values[~valid]).all()
    assert 0 < valid.any(axis=1).sum() < len(goals)
    for goal, rows, good in zip(goals, values, valid, strict=True):
        assert good[: good.sum()].all()
        expected = arm.FindIKSolutions(goal, options).reshape(-1, arm.GetArmDOF())
        if collisions and not good.any() and arm.ik_solver().free:
            continue  # FindIKSolutions goes on between the samples
        np.testing.assert_allclose(rows[good], expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", ["puma560.xml", "panda.xml"])
def test_rows_do_not_depend_on_others(name):
    arm = arm_of(name)
    goals = goals_of(arm)
    values, valid = arm.batch_solutions(goals)
    for number, goal in enumerate(goals[:8]):
        alone = arm.batch_solutions(goal)
        np.testing.assert_array_equal(alone.values[0][alone.valid[0]], values[number][valid[number]])


def test_chosen_values_of_the_free_joint():
    arm = arm_of("panda.xml")
    goals, robot = goals_of(arm), arm.GetRobot()
    values, valid = arm.batch_solutions(goals, free=[[0.3], [0.5]])
    (free,) = arm.ik_solver().free
    assert set(values[valid][:, free]) == {0.3, 0.5}
    configurations = np.tile(robot.GetDOFValues(), (valid.sum(), 1))
    configurations[:, arm.GetArmIndices()] = values[valid]
    effector = robot.batch_link_transforms(configurations)[:, arm.GetEndEffector().GetIndex()]
    np.testing.assert_allclose(effector @ arm.GetLocalToolTransform(), goals[np.nonzero(valid)[0]], atol=1e-8)


def test_other_types_and_no_goals():
    arm = arm_of("puma560.xml")
    places = goals_of(arm)[:, :3, 3]
    values, valid = arm.batch_solutions(places, iktype=Type.Translation3D, free=[[0, 0, 0]])
    assert 0 < valid.any(axis=1).sum() < len(places)
    values, valid = arm.batch_solutions(np.zeros((0, 4, 4)))
    assert (values.shape, valid.shape) == ((0, 0, 6), (0, 0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([np.eye(3)], "should have shape"),
        ([np.full((4, 4), np.nan)], "finite"),
        ([2 * np.eye(4)], "batch_solutions: poses"),
        ([np.eye(4), [0.1]], "batch_solutions: free: has shape"),
    ],
)
def test_wrong_arguments(arguments, message):
    with pytest.raises(ravemj.openrave_exception, match=message):
        arm_of("panda.xml").batch_solutions(*arguments)
