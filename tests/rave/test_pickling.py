"""Environments and robots that are sent to other processes."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from conftest import MODELS
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj import CollisionOptions, DOFAffine, IkFilterOptions, IkParameterization
from ravemj.rave import environment


def sent(thing):
    return pickle.loads(pickle.dumps(thing))


def a_used_workshop():
    """Return an environment in which a script has changed about everything that a state has."""
    env = ravemj.load(MODELS / "workshop.env.xml")
    puma, panda = env.GetRobot("puma"), env.GetRobot("panda")
    env.GetPhysicsEngine().SetGravity([0, 0, -1.62])
    puma.SetDOFValues([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    puma.SetDOFLimits(*(np.array(puma.GetDOFLimits()) * 0.9))
    panda.SetTransform(ravemj.matrixFromPose([1, 0, 0, 0, 0.1, 0.2, 0.3]))
    panda.SetActiveDOFs([2, 0], DOFAffine.X)
    panda.GetLinks()[3].Enable(False)
    cup = ravemj.RaveCreateKinBody(env, "")
    cup.InitFromBoxes([[0, 0, 0, 0.03, 0.03, 0.05]])
    cup.SetName("cup")
    env.Add(cup)
    cup.SetTransform(puma.GetActiveManipulator().GetTransform())
    puma.Grab(cup)
    puma.SetAdjacentLinks(0, 3)
    finger = panda.GetLinks()[-1]
    finger.SetTransform(finger.GetTransform() @ ravemj.matrixFromPose([1, 0, 0, 0, 0, 0, 0.02]))
    puma.SetDOFVelocities(np.arange(6) / 10)
    env.GetCollisionChecker().SetCollisionOptions(CollisionOptions.Distance)
    return env


def test_the_copy_is_in_the_same_state():
    env = a_used_workshop()
    twin = sent(env)
    assert [body.GetName() for body in twin.GetBodies()] == [body.GetName() for body in env.GetBodies()]
    for body, other in zip(env.GetBodies(), twin.GetBodies(), strict=True):
        assert body.GetEnvironmentBodyIndex() == other.GetEnvironmentBodyIndex()
        np.testing.assert_array_equal(other.GetLinkTransformations(), body.GetLinkTransformations())
        np.testing.assert_array_equal(other.GetLinkVelocities(), body.GetLinkVelocities())
        np.testing.assert_array_equal(other.GetDOFValues(), body.GetDOFValues())
        np.testing.assert_array_equal(other.GetDOFLimits(), body.GetDOFLimits())
        np.testing.assert_array_equal(other.GetLinkEnableStates(), body.GetLinkEnableStates())
        assert other.GetNonAdjacentLinks() == body.GetNonAdjacentLinks()
        assert other.GetKinematicsGeometryHash() == body.GetKinematicsGeometryHash()
    assert [body.GetName() for body in twin.GetRobot("puma").GetGrabbed()] == ["cup"]
    panda, other = env.GetRobot("panda"), twin.GetRobot("panda")
    np.testing.assert_array_equal(other.GetActiveDOFValues(), panda.GetActiveDOFValues())
    np.testing.assert_array_equal(twin.GetPhysicsEngine().GetGravity(), [0, 0, -1.62])
    assert twin.GetCollisionChecker().GetCollisionOptions() == CollisionOptions.Distance
    assert twin.files == env.files
    assert not twin.IsSimulationRunning()


def test_the_copy_collides_and_reaches_as_the_original():
    env = a_used_workshop()
    twin = sent(env)
    for robot, other in zip(env.GetRobots(), twin.GetRobots(), strict=True):
        values = np.random.default_rng(1).uniform(*robot.GetDOFLimits(), (60, robot.GetDOF()))
        np.testing.assert_array_equal(other.batch_collides(values), robot.batch_collides(values))
        np.testing.assert_array_equal(other.batch_distances(values[:5]), robot.batch_distances(values[:5]))
    puma, other = env.GetRobot("puma"), twin.GetRobot("puma")
    goal = puma.GetActiveManipulator().GetTransform()
    found = [robot.GetActiveManipulator().batch_solutions([goal], collisions=True) for robot in (puma, other)]
    np.testing.assert_array_equal(found[0].values, found[1].values)
    puma.Release(env.GetKinBody("cup"))
    assert len(other.GetGrabbed()) == 1


def test_ik_solvers_and_sensors_go_along():
    env = ravemj.load(MODELS / "puma560.xml")
    arm = env.GetRobots()[0].GetActiveManipulator()
    arm.SetIkSolver(ravemj.RaveCreateIkSolver(env, "ikfast Transform6D"))
    sensor = ravemj.RaveCreateSensor(env, "BaseLaser2D")
    sensor.SetName("scanner")
    env.Add(sensor)
    goal = arm.GetTransform()
    twin = sent(env)
    other = twin.GetRobots()[0].GetActiveManipulator()
    for answers in (IkFilterOptions.IgnoreSelfCollisions, IkFilterOptions.CheckEnvCollisions):
        np.testing.assert_array_equal(other.FindIKSolutions(goal, answers), arm.FindIKSolutions(goal, answers))
    assert other.GetIkSolver().Supports(IkParameterization.Type.Transform6D)
    assert [one.GetName() for one in twin.GetSensors()] == ["scanner"]


def test_a_robot_brings_its_environment(env, robot):
    twin, world = sent((robot, env))
    assert world.GetRobots()[0] is twin
    assert twin.GetEnv() is world is not env
    assert copy.deepcopy(env).GetRobots()[0].GetName() == robot.GetName()
    env.Remove(robot)
    with pytest.raises(ravemj.openrave_exception, match="is not in an environment; add it first"):
        pickle.dumps(robot)


def test_another_version_is_refused(env, monkeypatch):
    content = pickle.dumps(env)
    monkeypatch.setattr(environment, "__version__", "0.2.0")
    with pytest.raises(ravemj.openrave_exception, match=r"0\.1\.0 pickled cannot be read by ravemj 0\.2\.0: install"):
        pickle.loads(content)


def test_a_destroyed_environment_is_refused(env):
    env.Destroy()
    with pytest.raises(ravemj.openrave_exception, match="destroyed"):
        pickle.dumps(env)


@given(st.lists(st.floats(-2, 2), min_size=2, max_size=2))
def test_values_survive_the_trip(values):
    env = ravemj.load(MODELS / "env.xml")
    env.GetRobots()[0].SetDOFValues(values)
    twin = sent(env)
    np.testing.assert_array_equal(twin.GetRobots()[0].GetDOFValues(), env.GetRobots()[0].GetDOFValues())


def collides(robot, values):
    ravemj.set_batch_threads(1)
    return robot.batch_collides(values)


@pytest.mark.stress
def test_in_another_process():
    robot = a_used_workshop().GetRobot("puma")
    values = np.random.default_rng(2).uniform(*robot.GetDOFLimits(), (200, robot.GetDOF()))
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        np.testing.assert_array_equal(pool.submit(collides, robot, values).result(), robot.batch_collides(values))
