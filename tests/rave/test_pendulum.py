"""The numbers of the tutorial's double pendulum, worked out by hand: through the API and through plain MuJoCo.

Geometry: a disc of radius 0.03 and height 0.02 about the world's x axis and two boxes of 0.2 x 0.02 x 0.02, all of
density 1e5; both joints turn about x; at zero everything hangs along -z.
"""

import math

import mujoco
import numpy as np
import pytest

import ravemj
from ravemj.cli import main

DENSITY = 1e5
DISC_MASS = math.pi * 0.03**2 * 0.02 * DENSITY
DISC_ACROSS = DISC_MASS * (0.03**2 / 4 + 0.02**2 / 12)
DISC_ALONG = DISC_MASS * 0.03**2 / 2
ARM_ALONG = 8 / 3 * (0.01**2 + 0.01**2)
ARM_ACROSS = 8 / 3 * (0.1**2 + 0.01**2)

HANGING = (0.0, 0.0)
BENT = (math.pi / 4, math.pi / 4)
UPRIGHT = (math.pi, 0.0)
CONFIGURATIONS = [HANGING, BENT, UPRIGHT, (0.3, -1.2), (-2.0, 5.0)]
ROBOT_TURN = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])  # 90 degrees about y


def turn_x(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def down(angle, length):
    """A vector that hangs along -z at zero and has turned by an angle about x."""
    return length * np.array([0, math.sin(angle), -math.cos(angle)])


def expected_poses(q):
    """T_world_link of Base, Arm0 and Arm1, by hand."""
    poses = np.tile(np.eye(4), (3, 1, 1))
    for pose, angle in zip(poses, (0.0, q[0], q[0] + q[1]), strict=True):
        pose[:3, :3] = turn_x(angle) @ ROBOT_TURN
    poses[2, :3, 3] = down(q[0], 0.2)
    return poses


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The converted file, loaded and settled at g = 9.81 by MuJoCo alone."""
    path = tmp_path_factory.mktemp("mjcf") / "pendulum.mjcf.xml"
    assert main(["convert", "models/env.xml", "-o", str(path)]) == 0
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.gravity[:] = (0, 0, -9.81)
    return model, mujoco.MjData(model)


@pytest.fixture(autouse=True)
def _in_the_repository(monkeypatch, request):
    monkeypatch.chdir(request.config.rootpath)


class TestApi:
    def test_names(self, env, robot):
        assert env.GetBodies() == [robot]
        assert robot.GetName() == "Pendulum"
        assert [link.GetName() for link in robot.GetLinks()] == ["Base", "Arm0", "Arm1"]
        assert [joint.GetName() for joint in robot.GetJoints()] == ["Joint0", "Joint1"]

    def test_masses(self, robot):
        masses = [link.GetMass() for link in robot.GetLinks()]
        assert masses == pytest.approx([5.654866776, 8, 8], abs=1e-9)
        assert masses[0] == pytest.approx(DISC_MASS, rel=1e-12)
        assert sum(masses) == pytest.approx(21.654866776, abs=1e-9)

    def test_centres_of_mass(self, robot):
        coms = [link.GetLocalCOM() for link in robot.GetLinks()]
        np.testing.assert_allclose(coms, [[0, 0, 0], [0.1, 0, 0], [0.1, 0, 0]], atol=1e-15)

    def test_inertias(self, robot):
        base, *arms = (link.GetLocalInertia() for link in robot.GetLinks())
        np.testing.assert_allclose(base, np.diag([DISC_ACROSS, DISC_ACROSS, DISC_ALONG]), atol=1e-15)
        np.testing.assert_allclose(np.diag(base), [0.00146084058, 0.00146084058, 0.00254469005], atol=1e-11)
        for arm in arms:
            np.testing.assert_allclose(arm, np.diag([ARM_ALONG, ARM_ACROSS, ARM_ACROSS]), atol=1e-15)
            np.testing.assert_allclose(np.diag(arm), [0.000533333333, 0.0269333333, 0.0269333333], atol=1e-10)

    def test_joints(self, robot):
        first, second = robot.GetJoints()
        assert [joint.GetDOFIndex() for joint in (first, second)] == [0, 1]
        for joint, weight, max_velocity in ((first, 4, 3.42), (second, 3, 5.42)):
            assert joint.IsCircular(0)
            assert joint.GetLimits() == ([-10000], [10000])
            assert joint.GetWeights() == [weight]
            assert joint.GetMaxVel() == max_velocity
            assert joint.GetMaxAccel() == 50
            assert joint.GetMaxTorque() == 0
            assert joint.GetResolution(0) == pytest.approx(0.0174533, abs=1e-7)
        assert first.GetHierarchyParentLink() == robot.GetLink("Base")
        assert first.GetHierarchyChildLink() == second.GetHierarchyParentLink() == robot.GetLink("Arm0")

    def test_loads_at_zero(self, robot):
        values = robot.GetDOFValues()
        assert values.tolist() == [0.0, 0.0]
        assert not np.signbit(values).any()

    @pytest.mark.parametrize("q", CONFIGURATIONS)
    def test_poses(self, robot, q):
        robot.SetDOFValues(q)
        expected = expected_poses(q)
        np.testing.assert_allclose(robot.GetLinkTransformations(), expected, atol=1e-12)
        for link, pose in zip(robot.GetLinks(), expected, strict=True):
            np.testing.assert_allclose(link.GetTransform(), pose, atol=1e-12)
        np.testing.assert_allclose(robot.GetTransform(), expected[0], atol=1e-15)

    @pytest.mark.parametrize("q", CONFIGURATIONS)
    def test_joint_frames(self, robot, q):
        robot.SetDOFValues(q)
        first, second = robot.GetJoints()
        np.testing.assert_allclose(first.GetAnchor(), [0, 0, 0], atol=1e-12)
        np.testing.assert_allclose(second.GetAnchor(), down(q[0], 0.2), atol=1e-12)
        for joint in (first, second):
            np.testing.assert_allclose(joint.GetAxis(), [1, 0, 0], atol=1e-12)

    def test_published_numbers(self, robot):
        robot.SetDOFValues(BENT)
        arm0, arm1 = robot.GetLinkTransformations()[1:]
        r = math.sqrt(0.5)
        np.testing.assert_allclose(arm0[:3, :3], [[0, 0, 1], [r, r, 0], [-r, r, 0]], atol=1e-12)
        np.testing.assert_allclose(arm1[:3, :3], [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-12)
        np.testing.assert_allclose(arm1[:3, 3], [0, 0.141421356, -0.141421356], atol=1e-9)
        tip = arm1 @ [0.2, 0, 0, 1]
        np.testing.assert_allclose(tip[:3], [0, 0.341421356, -0.141421356], atol=1e-9)
        robot.SetDOFValues(UPRIGHT)
        tip = robot.GetLinkTransformations()[2] @ [0.2, 0, 0, 1]
        np.testing.assert_allclose(tip[:3], [0, 0, 0.4], atol=1e-12)


class TestPlainMujoco:
    def place(self, plain, q):
        model, data = plain
        data.qpos[:] = q
        data.qvel[:] = 0
        mujoco.mj_forward(model, data)
        return model, data

    def test_is_what_the_environment_runs(self, env, plain, tmp_path):
        path = tmp_path / "again.xml"
        path.write_text(env.mjcf)
        again = mujoco.MjModel.from_xml_path(str(path))
        np.testing.assert_array_equal(again.body_inertia, plain[0].body_inertia)
        np.testing.assert_allclose(
            again.body_quat, plain[0].body_quat, atol=1e-15
        )  # vectors have no digits of rounding

    @pytest.mark.parametrize("q", CONFIGURATIONS)
    def test_poses(self, plain, q):
        model, data = self.place(plain, q)
        assert [model.body(i).name for i in range(1, 4)] == ["Base", "Arm0", "Arm1"]
        np.testing.assert_allclose(data.xpos[1:], expected_poses(q)[:, :3, 3], atol=1e-12)
        np.testing.assert_allclose(data.xmat[1:].reshape(-1, 3, 3), expected_poses(q)[:, :3, :3], atol=1e-12)
        np.testing.assert_allclose(data.xanchor, [[0, 0, 0], down(q[0], 0.2)], atol=1e-12)
        np.testing.assert_allclose(data.xaxis, [[1, 0, 0]] * 2, atol=1e-12)

    @pytest.mark.parametrize("q", CONFIGURATIONS)
    def test_centres_of_mass(self, plain, q):
        _, data = self.place(plain, q)
        com0, com1 = down(q[0], 0.1), down(q[0], 0.2) + down(sum(q), 0.1)
        np.testing.assert_allclose(data.xipos[1:], [[0, 0, 0], com0, com1], atol=1e-12)
        whole = (8 * com0 + 8 * com1) / (DISC_MASS + 16)
        np.testing.assert_allclose(data.subtree_com[1], whole, atol=1e-12)

    @pytest.mark.parametrize(("q", "whole"), [(HANGING, (0, 0, -0.147772786)), (BENT, (0, 0.115311551, -0.078368354))])
    def test_published_centre_of_mass(self, plain, q, whole):
        _, data = self.place(plain, q)
        np.testing.assert_allclose(data.subtree_com[1], whole, atol=1e-9)

    @pytest.mark.parametrize(
        ("q", "body", "inertia"),
        [
            (HANGING, 1, np.diag([0.00254469005, 0.00146084058, 0.00146084058])),
            (HANGING, 2, np.diag([0.0269333333, 0.0269333333, 0.000533333333])),
            (HANGING, 3, np.diag([0.0269333333, 0.0269333333, 0.000533333333])),
            (BENT, 2, [[0.0269333333, 0, 0], [0, 0.0137333333, 0.0132], [0, 0.0132, 0.0137333333]]),
            (BENT, 3, np.diag([0.0269333333, 0.000533333333, 0.0269333333])),
        ],
    )
    def test_world_inertias(self, plain, q, body, inertia):
        model, data = self.place(plain, q)
        axes = data.ximat[body].reshape(3, 3)
        np.testing.assert_allclose((axes * model.body_inertia[body]) @ axes.T, inertia, atol=1e-10)

    @pytest.mark.parametrize(
        ("q", "expected"),
        [
            (HANGING, [[0.853866667, 0.266933333], [0.266933333, 0.106933333]]),
            (BENT, [[0.760140837, 0.220070418], [0.220070418, 0.106933333]]),
        ],
    )
    def test_joint_space_inertia(self, plain, q, expected):
        model, data = self.place(plain, q)
        matrix = np.zeros((2, 2))
        mujoco.mj_fullM(model, data, matrix)
        np.testing.assert_allclose(matrix, expected, atol=1e-9)

    @pytest.mark.parametrize(("q", "torques"), [(HANGING, (0, 0)), (BENT, (24.496122056, 7.848))])
    def test_holding_torques(self, plain, q, torques):
        model, data = self.place(plain, q)
        data.qacc[:] = 0
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(data.qfrc_inverse, torques, atol=1e-9)

    def test_nothing_touches(self, plain):
        assert self.place(plain, HANGING)[1].ncon == 0

    def test_simulates(self, plain):
        """Released half way up it swings, and keeps its energy."""
        model, data = self.place(plain, BENT)
        model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
        mujoco.mj_forward(model, data)
        before = data.energy.sum()
        travel = 0.0
        for _ in range(500):
            mujoco.mj_step(model, data)
            travel = max(travel, abs(data.qpos[0] - BENT[0]))
        assert travel > 0.5
        mujoco.mj_forward(model, data)
        assert data.energy.sum() == pytest.approx(before, rel=1e-4)


def test_limits_are_written_for_limited_joints_only(plain):
    assert not plain[0].jnt_limited.any()


def test_version_is_that_of_the_package():
    assert ravemj.__version__ == "0.1.0"
