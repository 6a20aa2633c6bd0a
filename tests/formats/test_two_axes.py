"""Joints with two axes of which one slides, or both: in COLLADA a joint may turn and slide."""

from dataclasses import replace

import numpy as np
import pytest

import ravemj
from ravemj.errors import Diagnostics
from ravemj.formats.readers import read_data, read_file
from ravemj.formats.writers import save
from ravemj.model.comparison import compare, poses_in
from ravemj.model.motion_bounds import motion_bounds
from ravemj.model.scene import AXES, Scene

ARM = """<Robot name="r"><KinBody>
<Body name="a"/>
<Body name="b"><Translation>0.3 0.1 0</Translation><RotationAxis>1 2 3 40</RotationAxis>
<Geom type="box"><extents>.1 .2 .3</extents></Geom></Body>
<Body name="c"><offsetfrom>b</offsetfrom><Translation>0 0.4 0.2</Translation>
<Geom type="sphere"><radius>.1</radius></Geom></Body>
<Joint name="j" type="hinge2"><Body>a</Body><Body>b</Body><offsetfrom>b</offsetfrom><anchor>0.05 0.1 0</anchor>
<axis1>1 0.5 0</axis1><axis2>0 0.2 1</axis2><limits>-0.5 0.6 -0.7 0.8</limits></Joint>
<Joint name="k"><Body>b</Body><Body>c</Body><offsetfrom>c</offsetfrom><axis>0 1 0</axis></Joint>
</KinBody></Robot>"""


@pytest.fixture(params=["rp", "pr", "pp", "hinge2"])
def scene(request) -> Scene:
    (body,) = read_data(ARM).scene.bodies
    first, other = body.joints
    return Scene((replace(body, joints=(replace(first, kind=request.param), other)),))


@pytest.fixture
def robot(scene, tmp_path):
    save(tmp_path / "arm.dae", scene, Diagnostics())
    return ravemj.load(tmp_path / "arm.dae").GetRobots()[0]


def test_they_survive_collada(scene, tmp_path):
    found = Diagnostics()
    save(tmp_path / "arm.dae", scene, found)
    assert not list(found)
    assert compare(scene, read_file(tmp_path / "arm.dae").scene) == []


def test_openrave_xml_keeps_the_first_axis(scene, tmp_path):
    found = Diagnostics()
    save(tmp_path / "arm.xml", scene, found, "openrave")
    kind = scene.bodies[0].joints[0].kind
    assert [one.code for one in found] == ([] if kind == "hinge2" else ["not-written"])
    joint = read_file(tmp_path / "arm.xml").scene.bodies[0].joints[0]
    assert AXES[joint.kind] == (AXES[kind] if kind == "hinge2" else AXES[kind][0])


def test_the_second_axis_is_carried_by_the_first(scene):
    """The child's pose is the product of the two motions about and along the axes of the poses at 0."""
    (body,) = scene.bodies
    joint = body.joints[0]

    def motion(index, value):
        axis, T = np.array(joint.axes[index].direction), np.eye(4)
        if AXES[joint.kind][index] == "P":
            T[:3, 3] = value * axis
        else:
            T = ravemj.matrixFromAxisAngle(axis, value)
            T[:3, 3] = joint.anchor - T[:3, :3] @ joint.anchor
        return T

    wanted = motion(0, 0.3) @ motion(1, -0.4) @ joint.T_parent_child.matrix()
    np.testing.assert_allclose(poses_in(body, [0.3, -0.4, 0.0])[1].matrix(), wanted, atol=1e-12)


def test_mujoco_moves_them_as_the_scene_says(scene, robot):
    values = [0.31, -0.42, 0.9]
    robot.SetDOFValues(values)
    wanted = [pose.matrix() for pose in poses_in(scene.bodies[0], values)]
    np.testing.assert_allclose(robot.GetLinkTransformations(), wanted, atol=1e-9)


def test_jacobians_and_velocities(robot):
    values, rates, step = np.array([0.31, -0.42, 0.9]), np.array([0.7, -0.2, 0.4]), 1e-6

    def place(way):
        robot.SetDOFValues(values + way * rates)
        return robot.GetLinks()[2].GetTransform()[:3, 3]

    seen = (place(step) - place(-step)) / (2 * step)
    robot.SetDOFValues(values)
    jacobian = robot.ComputeJacobianTranslation(2, robot.GetLinks()[2].GetTransform()[:3, 3])
    np.testing.assert_allclose(jacobian @ rates, seen, atol=1e-8)
    robot.SetDOFVelocities(rates, [0, 0, 0], [0, 0, 0], False)
    np.testing.assert_allclose(robot.GetDOFVelocities(), rates, atol=1e-9)
    np.testing.assert_allclose(robot.GetLinks()[2].GetVelocity()[:3], seen, atol=1e-8)


def test_what_is_said_about_their_axes(scene, robot):
    joint, kinds = robot.GetJoints()[0], AXES[scene.bodies[0].joints[0].kind]
    assert [joint.IsPrismatic(axis) for axis in range(2)] == [kind == "P" for kind in kinds]
    assert [joint.IsRevolute(axis) for axis in range(2)] == [kind == "R" for kind in kinds]
    assert joint.GetType().name.lower() == scene.bodies[0].joints[0].kind
    info = joint.GetInfo()
    other = ravemj.Environment()
    body = ravemj.RaveCreateKinBody(other, "")
    body.Init([link.GetInfo() for link in robot.GetLinks()[:2]], [info])
    body.SetName("copy")
    other.Add(body)
    body.SetDOFValues([0.2, 0.3])
    robot.SetDOFValues([0.2, 0.3, 0.0])
    np.testing.assert_allclose(body.GetLinkTransformations()[1], robot.GetLinkTransformations()[1], atol=1e-9)


def test_bounds_of_motion_hold(scene):
    (body,) = scene.bodies
    bounds, random = motion_bounds(body), np.random.default_rng(0)
    corners = np.array([[x, y, z, 1] for x in (-0.1, 0.1) for y in (-0.2, 0.2) for z in (-0.3, 0.3)])
    low, high = np.array([(axis.lower, axis.upper) for axis in body.dof_axes]).T
    for _ in range(50):
        values, step = random.uniform(low, high), 1e-6
        for dof in range(3):
            moved = values + step * np.eye(3)[dof]
            first, second = (poses_in(body, list(one))[1].matrix() @ corners.T for one in (values, moved))
            assert np.linalg.norm(second - first, axis=0).max() / step <= bounds[dof] + 1e-6
