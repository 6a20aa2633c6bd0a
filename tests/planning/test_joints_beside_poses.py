"""Joints and the pose of the base as one configuration: parameters, planners, retimers, smoothers, controllers."""

import itertools

import numpy as np
import pytest
from conftest import one_in

import ravemj
from ravemj import DOFAffine, PlannerStatusCode, planningutils

TRANSLATIONS = range(8)
ROTATIONS = (DOFAffine.NoTransform, DOFAffine.RotationAxis, DOFAffine.Rotation3D, DOFAffine.RotationQuat)
JOINTS = ([], [0], [3, 1], [0, 1, 2, 3, 4, 5])
CHOICES = [choice for choice in itertools.product(TRANSLATIONS, ROTATIONS, JOINTS) if any(choice)]
SIZES = ("Resolutions", "Weights", "MaxVel", "MaxAccel", "Velocities", "Values")


@pytest.fixture(scope="module")
def base():
    env = ravemj.load(ravemj.model_path("puma560"))
    env.StopSimulation()
    yield env.GetRobots()[0]
    env.Destroy()


@pytest.fixture(params=one_in(5, CHOICES), ids=str)
def robot(request, base):
    translation, rotation, joints = request.param
    base.SetTransform(np.eye(4))
    base.SetDOFValues(np.zeros(6))
    axis = [[0, 0, 1]] if rotation == DOFAffine.RotationAxis else []
    base.SetActiveDOFs(joints, translation | rotation, *axis)
    return base


def start_and_goal(robot):
    lower, upper = robot.GetActiveDOFLimits()
    start = robot.GetActiveDOFValues()
    goal = np.clip(start + 0.2 * np.random.default_rng(1).uniform(-1, 1, len(start)), lower, upper)
    if robot.GetAffineDOF() & DOFAffine.RotationQuat:
        goal[-4:] /= np.linalg.norm(goal[-4:])
    return start, goal


def check_ends(robot, trajectory, start, goal):
    spec = robot.GetActiveConfigurationSpecification("linear")
    np.testing.assert_allclose(trajectory.Sample(0, spec), start, atol=1e-9)
    np.testing.assert_allclose(trajectory.Sample(trajectory.GetDuration(), spec), goal, atol=1e-6)


def test_all_parts_have_the_same_size(robot):
    size = robot.GetActiveDOF()
    assert robot.GetActiveConfigurationSpecification().GetDOF() == size
    assert {len(getattr(robot, f"GetActiveDOF{name}")()) for name in SIZES} == {size}
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    assert params.GetConfigurationSpecification().GetDOF() == size


def test_planned_motions_lead_to_the_goal_and_are_played(robot):
    start, goal = start_and_goal(robot)
    params = ravemj.Planner.PlannerParameters()
    params.SetRobotActiveJoints(robot)
    params.SetGoalConfig(goal)
    made = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    planner = ravemj.RaveCreatePlanner(robot.GetEnv(), "BiRRT")
    assert planner.InitPlan(robot, params)
    assert planner.PlanPath(made).statusCode == PlannerStatusCode.HasSolution
    check_ends(robot, made, start, goal)
    moved = ravemj.interfaces.BaseManipulation(robot).MoveActiveJoints(goal, execute=False, outputtrajobj=True)
    check_ends(robot, moved, start, goal)
    check_ends(robot, planningutils.ReverseTrajectory(moved), goal, start)
    again = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
    again.deserialize(moved.serialize(0))
    check_ends(robot, again, start, goal)
    planningutils.VerifyTrajectory(params, moved, 0.01)
    robot.GetController().SetPath(moved)
    for _ in range(int(moved.GetDuration() / 0.01) + 3):
        robot.GetEnv().StepSimulation(0.01)
    np.testing.assert_allclose(robot.GetActiveDOFValues(), goal, atol=1e-5)


def test_retimers_and_smoothers(robot):
    start, goal = start_and_goal(robot)
    has_pose, in_space = robot.GetAffineDOF(), robot.GetAffineDOF() & (DOFAffine.Rotation3D | DOFAffine.RotationQuat)
    retimers = ("LinearTrajectoryRetimer", "ParabolicTrajectoryRetimer", "CubicTrajectoryRetimer")
    for name in (*retimers, "LinearSmoother", "ParabolicSmoother"):
        made = ravemj.RaveCreateTrajectory(robot.GetEnv(), "")
        made.Init(robot.GetActiveConfigurationSpecification(""))
        made.Insert(0, np.append(start, goal))
        is_smoother = "Smoother" in name
        function = planningutils.SmoothActiveDOFTrajectory if is_smoother else planningutils.RetimeActiveDOFTrajectory
        status = function(made, robot, plannername=name, plannerparameters="")
        if "Linear" in name or not (in_space if is_smoother else has_pose):
            assert status, name
            check_ends(robot, made, start, goal)
        else:
            assert "by the Linear" in status.description
            assert made.GetNumWaypoints() == 2
