"""Mistakes that scripts make: each error says what was found, and what was expected."""

import math

import numpy as np
import pytest

import ravemj

MISTAKES = {
    "values": (lambda env, robot: robot.SetDOFValues(None), "SetDOFValues: is None, and should be numbers"),
    "pose": (lambda env, robot: robot.SetTransform(None), "SetTransform: transform: is None"),
    "rotation": (lambda env, robot: robot.SetTransform(np.ones((4, 4))), "the rotation .* is not one"),
    "goal": (lambda env, robot: robot.ik(np.eye(3)), r"goals: has shape \(3, 3\), .* \(N, 4, 4\) for .*Transform6D"),
    "point": (
        lambda env, robot: robot.ik([1, 2], ravemj.IkParameterizationType.Translation3D),
        r"goals: has shape \(2,\), .* \(N, 3\) for .*Translation3D",
    ),
    "nothing": (lambda env, robot: env.render(0, 0), "picture size 0 x 0: expected whole pixels"),
    "half a pixel": (lambda env, robot: env.render(640.5, 480), "picture size 640.5 x 480: expected whole pixels"),
    "no video": (
        lambda env, robot: ravemj.record(env, "a.mp4", ravemj.Motion.line(np.zeros(6), np.full(6, 0.5), 1), width=-1),
        "picture size -1 x 480: expected whole pixels",
    ),
    "itself": (lambda env, robot: robot.Grab(robot), "'PUMA560' cannot hold itself"),
    "no step": (lambda env, robot: env.StepSimulation(None), "StepSimulation: timestep"),
    "endless step": (lambda env, robot: env.StepSimulation(math.inf), "StepSimulation: timestep"),
    "backwards": (lambda env, robot: env.StepSimulation(-1), "timestep is -1, .* 0 s or more"),
    "engine": (lambda env, robot: env.SetPhysicsEngine("newton"), "no physics engine 'newton'; there are ode, bullet"),
}


@pytest.fixture(scope="module")
def scene():
    env = ravemj.Environment()
    env.Load(ravemj.model_path("puma560"))
    yield env, env.GetRobots()[0]
    env.Destroy()


@pytest.mark.parametrize("name", MISTAKES)
def test_errors_say_what_was_expected(scene, name):
    env, robot = scene
    before = robot.GetDOFValues(), robot.GetTransform()
    mistake, message = MISTAKES[name]
    with pytest.raises(ravemj.openrave_exception, match=message):
        mistake(env, robot)
    assert (robot.GetDOFValues() == before[0]).all()
    assert (robot.GetTransform() == before[1]).all()
    assert env.GetBodies() == [robot]
