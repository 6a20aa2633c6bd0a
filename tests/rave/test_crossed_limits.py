"""Limits that scripts set without room between them: only files make welds (random api-91001-19, -36, -135)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj

ARM = """<Environment><Robot name="r"><KinBody>
<Body name="a" type="static"><Geom type="box"><extents>.1 .1 .1</extents></Geom></Body>
<Body name="b"><Translation>0 0 .3</Translation><Geom type="box"><extents>.05 .05 .2</extents></Geom></Body>
<Body name="c"><Translation>0 0 .8</Translation><Geom type="box"><extents>.05 .05 .2</extents></Geom></Body>
<Body name="d"><Translation>0 0 1.2</Translation><Geom type="box"><extents>.05 .05 .1</extents></Geom></Body>
<Joint name="j0" type="hinge"><Body>a</Body><Body>b</Body><axis>0 1 0</axis><limits>-2 2</limits></Joint>
<Joint name="j1" type="hinge"><Body>b</Body><Body>c</Body><axis>0 1 0</axis><anchor>0 0 .55</anchor>
 <limits>-2 2</limits></Joint>
<Joint name="j2" type="hinge"><Body>c</Body><Body>d</Body><axis>1 0 0</axis><anchor>0 0 1.05</anchor>
 <limits>-2 2</limits></Joint>
</KinBody><Manipulator name="m"><base>a</base><effector>d</effector></Manipulator></Robot></Environment>"""


@pytest.fixture
def arm() -> ravemj.Robot:
    env = ravemj.Environment()
    assert env.LoadData(ARM)
    return env.GetRobots()[0]


@given(value=st.floats(-2, 2), lower=st.floats(-2, 2), upper=st.floats(-2, 2))
def test_a_value_below_the_lower_limit_moves_there_first(value, lower, upper):
    env = ravemj.Environment()
    env.LoadData(ARM)
    robot = env.GetRobots()[0]
    robot.SetDOFLimits([lower], [upper], [0])
    robot.SetDOFValues([value], [0], ravemj.KinBody.CheckLimitsAction.CheckLimitsSilent)
    expected = lower if value < lower else upper if value > upper else value
    assert robot.GetDOFValues()[0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("limits", [([1.0], [-1.0]), ([0.5], [0.5])])
def test_jacobians_pairs_and_arms_stay(arm, limits):
    jacobian, pairs = arm.ComputeJacobianAxisAngle(2), arm.GetNonAdjacentLinks()
    arm.GetJoint("j0").SetLimits(*limits)
    assert arm.GetJoint("j0").IsStatic()
    assert arm.ComputeJacobianAxisAngle(2) == pytest.approx(jacobian)
    assert arm.GetNonAdjacentLinks() == pairs
    assert arm.GetManipulator("m").GetArmIndices().tolist() == [0, 1, 2]


def test_inverse_kinematics_finds_nothing_between_them(arm):
    model = ravemj.databases.inversekinematics.InverseKinematicsModel(
        arm, iktype=ravemj.IkParameterizationType.Translation3D
    )
    assert model.load()
    manipulator = arm.GetManipulator("m")
    arm.SetDOFValues([0.3, 0.4, 0.2])
    goal = manipulator.GetIkParameterization(ravemj.IkParameterizationType.Translation3D)
    assert len(manipulator.FindIKSolutions(goal, 0))
    arm.SetDOFLimits([0.5], [0.3], [0])
    assert len(manipulator.FindIKSolutions(goal, 0)) == 0
    arm.SetDOFLimits([0.3], [0.3], [0])
    assert manipulator.FindIKSolution(goal, 0) == pytest.approx(np.array([0.3, 0.4, 0.2]), abs=1e-6)


def test_a_joint_that_a_script_locks_stays_locked_in_physics(arm):
    env = arm.GetEnv()
    arm.SetDOFLimits([0.5], [0.5], [0])
    arm.SetDOFValues([0.5, 1.0, 0.0])
    env.SetPhysicsEngine(ravemj.RaveCreatePhysicsEngine(env, "ode"))
    env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
    for _ in range(100):
        env.StepSimulation(0.005)
    locked, free, _ = arm.GetDOFValues()
    assert locked == pytest.approx(0.5, abs=1e-3)
    assert abs(free - 1.0) > 0.1


def test_an_option_in_the_place_of_indices_is_refused(arm):
    """Random api-91001-120: taken as the index 2 it moved that joint alone."""
    with pytest.raises(TypeError, match="give options by their name"):
        arm.SetDOFValues([0.1, 0.2, 0.3], ravemj.KinBody.CheckLimitsAction.CheckLimitsSilent)
    assert not arm.GetDOFValues().any()


def test_links_that_are_not_there_are_indices_out_of_range(arm):
    with pytest.raises(IndexError, match="link indices are"):
        arm.IsDOFInChain(0, 7, 1)


def test_corners_of_boxes_come_in_openraves_order(arm):
    corners = arm.GetEnv().Triangulate(arm).vertices[:8]
    signs = [[x, y, z] for x in (1, -1) for y in (1, -1) for z in (1, -1)]
    assert corners == pytest.approx(0.1 * np.array(signs))
