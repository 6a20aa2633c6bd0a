"""What pymanoid, a library for walking robots, does with the API."""

import threading

import api_coverage
import numpy as np
import pytest
from api_names import PYMANOID
from conftest import MODELS

import ravemj

FLYING = [
    ("TRANS_X", "slider", "1 0 0"),
    ("TRANS_Y", "slider", "0 1 0"),
    ("TRANS_Z", "slider", "0 0 1"),
    ("ROT_Y", "hinge", "0 0 1"),
    ("ROT_P", "hinge", "0 1 0"),
    ("ROT_R", "hinge", "1 0 0"),
]
"""The joints that carry a robot through the world, and their axes."""

FREE = [name for name, _, _ in FLYING]
GRAVITY = 9.81


def flying_robot_xml(path, root: str) -> str:
    """A robot of six empty bodies and as many joints around that of a file, made on the fly."""
    bodies = "".join(f'<body name="{name}_LINK"/>\n' for name in FREE)
    joints = ""
    for (name, kind, axis), child in zip(FLYING, [f"{name}_LINK" for name in FREE[1:]] + [root], strict=True):
        limits = "<limits>-10000 10000</limits>" if kind == "slider" else ""
        circular = ' circular="true"' if kind == "hinge" else ""
        joints += (
            f'<joint name="{name}" type="{kind}"{circular}><body>{name}_LINK</body><body>{child}</body>'
            f"<axis>{axis}</axis>{limits}</joint>\n"
        )
    return (
        f'<environment><robot name="walker"><kinbody>{bodies}</kinbody>'
        f'<robot file="{path}"><kinbody>{joints}</kinbody></robot></robot></environment>'
    )


@pytest.fixture
def env():
    env = ravemj.Environment()
    assert env.LoadData(flying_robot_xml(MODELS / "double-pendulum.xml", "Base"))
    env.GetPhysicsEngine().SetGravity([0, 0, -GRAVITY])
    return env


@pytest.fixture
def robot(env):
    return env.GetRobots()[0]


@pytest.fixture
def moving(robot):
    """The robot somewhere on its way, with its velocities."""
    numbers = np.random.default_rng(1)
    robot.SetDOFValues(numbers.uniform(-1, 1, 8))
    velocities = numbers.uniform(-2, 2, 8)
    robot.SetDOFVelocities(velocities)
    return robot, velocities


def ahead(robot, compute, step=1e-6):
    """The derivative by time of what is computed, by differences along the present velocities."""
    values, velocities, found = robot.GetDOFValues(), robot.GetDOFVelocities(), []
    for sign in (1, -1):
        robot.SetDOFValues(values + sign * step * velocities)
        robot.SetDOFVelocities(velocities)
        found.append(np.array(compute()))
    robot.SetDOFValues(values)
    robot.SetDOFVelocities(velocities)
    return (found[0] - found[1]) / (2 * step)


def test_all_names_are_there():
    assert [name for name in PYMANOID if not any(not place.capability for place in api_coverage.find(name))] == []


# The robot


def test_joints_of_the_file_come_first_and_those_made_on_the_fly_last(robot):
    assert [robot.GetJointFromDOFIndex(i).GetName() for i in range(robot.GetDOF())] == ["Joint0", "Joint1", *FREE]
    assert [link.GetIndex() for link in robot.GetLinks()] == list(range(9))
    lower, upper = robot.GetDOFLimits()
    assert upper[2:].tolist() == (-lower[2:]).tolist() == [10000.0] * 6
    base = robot.GetLink("Base")
    assert base.GetName() == "Base"
    before = base.GetTransform()
    robot.SetDOFValues([1, 2, 3], [2, 3, 4])
    np.testing.assert_allclose(base.GetTransform()[:3, 3], before[:3, 3] + [1, 2, 3])
    yaw = robot.GetLink("ROT_Y_LINK").GetTransform()[:3, :3]
    robot.SetDOFValues([np.pi / 2], [5])
    turned = ravemj.rotationMatrixFromAxisAngle([0, 0, np.pi / 2]) @ yaw
    np.testing.assert_allclose(robot.GetLink("ROT_P_LINK").GetTransform()[:3, :3], turned, atol=1e-12)


def test_arrays_of_limits_are_the_users_own(robot):
    limits = robot.GetDOFLimits()
    for array in (*limits, robot.GetDOFVelocityLimits(), robot.GetDOFValues()):
        array.flags.writeable = False
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
        array.flags.writeable = True
        array[:] = 7
    assert robot.GetDOFVelocityLimits()[0] == pytest.approx(3.42)
    robot.SetDOFLimits([-1, -2], [1, 2], [0, 1])
    robot.SetDOFVelocityLimits([5] * 8)
    assert robot.GetDOFLimits()[0][:2].tolist() == [-1, -2]
    assert robot.GetDOFVelocityLimits().tolist() == [5] * 8


def test_velocities_of_some_dofs_come_without_names(robot):
    robot.SetDOFVelocities(np.arange(8.0), 0)
    robot.SetDOFVelocities([100.0, -1.0], 0, [2, 0])
    # As OpenRAVE has it, only as many DOFs count as there are indices, the first ones, and all others stop.
    assert robot.GetDOFVelocities().tolist() == pytest.approx([-1, 1, 0, 0, 0, 0, 0, 0])
    assert robot.GetDOFVelocities([1, 0]).tolist() == pytest.approx([1, -1])


# Derivatives


def centre_of_mass(robot):
    masses = np.array([link.GetMass() for link in robot.GetLinks()])
    return masses @ [link.GetGlobalCOM() for link in robot.GetLinks()] / masses.sum()


def test_the_jacobian_of_the_centre_of_mass(moving):
    robot, velocities = moving
    mass, J = 0.0, np.zeros((3, 8))
    for link in robot.GetLinks():
        J += link.GetMass() * robot.ComputeJacobianTranslation(link.GetIndex(), link.GetGlobalCOM())
        mass += link.GetMass()
    np.testing.assert_allclose(J @ velocities / mass, ahead(robot, lambda: centre_of_mass(robot)), atol=1e-6)


def test_angular_momentum_from_jacobians_and_from_link_velocities(moving):
    robot, velocities = moving
    G, J, momentum = centre_of_mass(robot), np.zeros((3, 8)), np.zeros(3)
    for link in robot.GetLinks():
        R, m = link.GetTransform()[:3, :3], link.GetMass()
        np.testing.assert_allclose(R @ link.GetLocalCOM() + link.GetTransform()[:3, 3], link.GetGlobalCOM())
        inertia, arm = R @ link.GetLocalInertia() @ R.T, link.GetGlobalCOM() - G
        translation = robot.ComputeJacobianTranslation(link.GetIndex(), link.GetGlobalCOM())
        J += m * np.cross(arm, translation, axisb=0, axisc=0)
        J += inertia @ robot.ComputeJacobianAxisAngle(link.GetIndex())
        velocity = link.GetVelocity()
        at_com = velocity[:3] + np.cross(velocity[3:], link.GetGlobalCOM() - link.GetTransform()[:3, 3])
        momentum += m * np.cross(arm, at_com) + inertia @ velocity[3:]
    np.testing.assert_allclose(J @ velocities, momentum, atol=1e-9)


def test_hessians_with_the_velocity_on_both_sides(moving):
    robot, qd = moving
    index, tip = 8, np.array([0.2, 0, 0, 1])

    def point():
        return (robot.GetLinks()[index].GetTransform() @ tip)[:3]

    H = robot.ComputeHessianTranslation(index, point())
    assert H.shape == (8, 3, 8)
    acceleration = np.dot(qd, np.dot(H, qd))
    change = ahead(robot, lambda: robot.ComputeJacobianTranslation(index, point()) @ qd)
    np.testing.assert_allclose(acceleration, change, atol=1e-6)
    H = robot.ComputeHessianAxisAngle(index)
    change = ahead(robot, lambda: robot.ComputeJacobianAxisAngle(index) @ qd)
    np.testing.assert_allclose(np.dot(qd, np.dot(H, qd)), 2 * change, atol=1e-6)


def test_quaternions_turn_with_links(moving):
    robot, velocities = moving
    link = robot.GetLinks()[8]
    J = robot.CalculateRotationJacobian(8, link.GetTransformPose()[:4])
    change = ahead(robot, lambda: ravemj.quatFromRotationMatrix(link.GetTransform()))
    assert abs(abs(J @ velocities @ change) - change @ change) < 1e-6
    np.testing.assert_allclose(robot.CalculateJacobian(8, [1, 2, 3]), robot.ComputeJacobianTranslation(8, [1, 2, 3]))


def test_accelerations_are_the_change_of_velocities(moving):
    robot, _ = moving
    found = robot.GetLinkAccelerations(np.zeros(8))
    np.testing.assert_allclose(found, ahead(robot, robot.GetLinkVelocities), atol=1e-5)


def test_sliders_carry_what_is_beyond_them(moving):
    """Newton's law for the links that each slider moves, along its axis."""
    robot, _ = moving
    accelerations = np.linspace(-1, 1, 8)
    parts = robot.ComputeInverseDynamics(accelerations, returncomponents=True)
    np.testing.assert_allclose(sum(parts), robot.ComputeInverseDynamics(accelerations), atol=1e-9)
    np.testing.assert_allclose(parts[1] + parts[2], robot.ComputeInverseDynamics(None), atol=1e-9)
    forces = np.zeros((9, 3))
    for link, (*a, wx, wy, wz) in zip(robot.GetLinks(), robot.GetLinkAccelerations(accelerations), strict=True):
        w, arm = link.GetVelocity()[3:], link.GetTransform()[:3, :3] @ link.GetLocalCOM()
        at_com = a + np.cross([wx, wy, wz], arm) + np.cross(w, np.cross(w, arm))
        forces[link.GetIndex()] = link.GetMass() * at_com
    beyond = [forces[1:, 0].sum(), forces[2:, 1].sum(), forces[3:, 2].sum()]
    np.testing.assert_allclose((parts[0] + parts[1])[2:5], beyond, atol=1e-8)
    weight = GRAVITY * sum(link.GetMass() for link in robot.GetLinks()[3:])
    np.testing.assert_allclose(parts[2][2:5], [0, 0, weight], atol=1e-9)


# Boxes


def test_boxes_are_added_without_names(env):
    boxes = []
    for i in range(3):
        with env:
            box = ravemj.RaveCreateKinBody(env, "")
            box.InitFromBoxes(np.array([[0, 0, 0, 0.1, 0.2, 0.01 * (i + 1)]]), True)
            env.Add(box, True)
        boxes.append(box)
    assert len({box.GetName() for box in boxes} - {""}) == 3
    assert len(env.GetBodies()) == 4
    boxes[0].SetName("contact")
    for geometry in boxes[0].GetLinks()[0].GetGeometries():
        geometry.SetAmbientColor([1, 0, 0])
        geometry.SetDiffuseColor([0, 1, 0])
        geometry.SetTransparency(0.5)
    boxes[0].SetTransform([1, 0, 0, 0, 1, 2, 3])
    np.testing.assert_allclose(boxes[0].GetTransformPose(), [1, 0, 0, 0, 1, 2, 3])
    for link in boxes[0].GetLinks():
        link.SetVisible(False)
    env.Remove(boxes[0])
    assert env.GetKinBody("contact") is None


def test_angles_of_the_base_from_its_quaternion():
    quat = ravemj.quatFromRotationMatrix(ravemj.matrixFromPose([0.5, 0.5, 0.5, 0.5, 0, 0, 0])[:3, :3])
    np.testing.assert_allclose(ravemj.rotationMatrixFromQuat(quat) @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(ravemj.axisAngleFromQuat(quat), np.full(3, 2 * np.pi / 3 / 3**0.5))
    half = ravemj.InterpolateQuatSlerp([1, 0, 0, 0], quat, 0.5)
    np.testing.assert_allclose(ravemj.axisAngleFromQuat(half), np.full(3, np.pi / 3 / 3**0.5))


# The viewer


@pytest.fixture
def viewer(env, monkeypatch):
    """As pymanoid sets it: without asking whether there is one."""
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    env.SetViewer("qtcoin")
    viewer = env.GetViewer()
    viewer.SetBkgndColor([0.6, 0.6, 0.8])
    viewer.SetCamera(np.array([[0.0, 0, -1, 1.1], [1, 0, 0, 0], [0, -1, 0, 0.3], [0, 0, 0, 1]]))
    return viewer


def test_the_camera_goes_where_it_is_put(viewer):
    T = viewer.GetCameraTransform()
    assert T[:3, 3].tolist() == pytest.approx([1.1, 0, 0.3])
    T[0, 3] += 1
    viewer.SetCamera(T)
    np.testing.assert_allclose(viewer.GetCameraTransform(), T)


def test_a_thread_draws_while_the_robot_moves(env, robot, viewer):
    handles, wrong = {}, []

    def tick(number):
        points = np.random.default_rng(number).uniform(-1, 1, (4, 3))
        handles["points"] = [env.plot3(point, pointsize=0.01, drawstyle=1, colors=[1, 0, 0, 1]) for point in points]
        handles["lines"] = env.drawlinelist(points, linewidth=2, colors=[0, 1, 0])
        handles["arrow"] = env.drawarrow(points[0], points[1], linewidth=0.01, color=[0, 0, 1])
        triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int64)
        handles["mesh"] = env.drawtrimesh(points, indices=triangles, colors=np.array([0.5, 0.5, 0, 0.3]))
        with env:
            robot.SetDOFValues(robot.GetDOFValues() + 0.01)

    def simulate():
        try:
            for number in range(100):
                tick(number)
        except Exception as error:  # to be shown by the test
            wrong.append(error)

    thread = threading.Thread(target=simulate)
    thread.start()
    while thread.is_alive():
        centre_of_mass(robot)
        env.simulation.drawings.primitives()
    thread.join()
    assert wrong == []
    np.testing.assert_allclose(robot.GetDOFValues(), np.full(8, 1.0))
    handles["arrow"].Close()
    assert None not in handles.values()
