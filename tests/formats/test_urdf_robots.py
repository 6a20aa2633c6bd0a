"""The robots of the wheel ``example-robot-data``, against Pinocchio's numbers."""

import json
import lzma
import os
import sysconfig
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA, one_in

import ravemj

TRUTH = json.loads(lzma.decompress((DATA / "urdf" / "truth.json.xz").read_bytes()))
_INSTALLED = Path(sysconfig.get_paths()["purelib"], "cmeel.prefix/share/example-robot-data/robots")
ROBOTS = Path(os.environ.get("RAVEMJ_ROBOT_DATA") or _INSTALLED)

pytestmark = pytest.mark.skipif(
    not ROBOTS.is_dir(),
    reason="the robots are not here: pip install example-robot-data==6.0.0, or name their folder in RAVEMJ_ROBOT_DATA",
)


@cache
def loaded(name: str) -> ravemj.Environment:
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert env.Load(ROBOTS / name)
    return env


def rows(pose) -> np.ndarray:
    return np.asarray(pose)[:3].ravel()


@pytest.mark.parametrize("name", one_in(2, list(TRUTH)))
def test_poses_agree(name):
    robot = loaded(name).GetRobots()[0]
    assert robot.GetName() == TRUTH[name]["robot"]
    assert {link.GetName() for link in robot.GetLinks()} == set(TRUTH[name]["links"])
    for config in TRUTH[name]["configs"]:
        values = [config["values"][joint.GetName()] for joint in robot.GetJoints()]
        robot.SetDOFValues(values, checklimits=0)
        for link, pose in config["poses"].items():
            np.testing.assert_allclose(rows(robot.GetLink(link).GetTransform()), pose, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", one_in(2, list(TRUTH)))
def test_masses_agree(name):
    robot = loaded(name).GetRobots()[0]
    for link, truth in TRUTH[name]["links"].items():
        found = robot.GetLink(link)
        assert found.GetMass() == pytest.approx(truth["mass"], abs=1e-8)
        if "com" in truth:
            np.testing.assert_allclose(found.GetLocalCOM(), truth["com"], rtol=0, atol=1e-9)
            np.testing.assert_allclose(found.GetLocalInertia().ravel(), truth["inertia"], rtol=0, atol=1e-9)
    assert sum(link.GetMass() for link in robot.GetLinks()) == pytest.approx(TRUTH[name]["total"], abs=1e-8)


@pytest.mark.parametrize("name", TRUTH)
def test_joints_agree(name):
    robot = loaded(name).GetRobots()[0]
    joints = TRUTH[name]["joints"]
    moving = {one for one, truth in joints.items() if truth["type"] != "fixed" and not truth["mimic"]}
    assert {joint.GetName() for joint in robot.GetJoints()} == moving
    for one, truth in joints.items():
        joint = robot.GetJoint(one)
        ends = joint.GetHierarchyParentLink().GetName(), joint.GetHierarchyChildLink().GetName()
        assert ends == (truth["parent"], truth["child"])
        if truth["mimic"] and truth["type"] != "fixed":
            leader, factor, offset = truth["mimic"]
            assert joint.GetMimicEquation() == f"{leader}*{factor!r}+{offset!r}"
        if truth["type"] in {"revolute", "prismatic"}:
            limits = sorted([truth["lower"], truth["upper"]])
            np.testing.assert_allclose(np.ravel(joint.GetLimits()), limits, rtol=0, atol=1e-12)
        if truth["type"] == "continuous":
            assert joint.IsCircular(0)
        if truth["type"] != "fixed":
            assert joint.GetMaxVel() == (truth["velocity"] or 10.0)
            assert joint.GetMaxTorque() == (truth["effort"] or 0.0)


@pytest.mark.parametrize("name", one_in(2, [name for name in TRUTH if TRUTH[name]["boxes"]]))
def test_boxes_of_shapes_agree(name):
    """So COLLADA's up axis is ignored, scales and units act, and cylinders lie along z."""
    scene = loaded(name).GetRobots()[0].simulation_state.scene
    for link in scene.links:
        shapes = {
            "visual": dict(link.groups)["visual"],
            "collision": [shape for shape in link.geometries if not shape.visible],
        }
        for kind, boxes in TRUTH[name]["boxes"].get(link.name, {}).items():
            assert len(shapes[kind]) == len(boxes)
            for shape, box in zip(shapes[kind], boxes, strict=True):
                found = np.concatenate(shape.shape.bounds(np.array(shape.T_link_geometry.matrix())))
                np.testing.assert_allclose(found, box, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("name", [name for name in TRUTH if "gravity_torques" in TRUTH[name]["configs"][0]])
def test_gravity_torques_agree(name):
    env = loaded(name)
    robot = env.GetRobots()[0]
    env.GetPhysicsEngine().SetGravity([0, 0, -9.81])
    for config in TRUTH[name]["configs"]:
        joints = robot.GetJoints()
        robot.SetDOFValues([config["values"][joint.GetName()] for joint in joints], checklimits=0)
        torques = robot.ComputeInverseDynamics(np.zeros(robot.GetDOF()))
        for joint, torque in zip(joints, torques, strict=True):
            if not joint.IsStatic():  # of equal limits: a weld, as in OpenRAVE
                assert torque == pytest.approx(config["gravity_torques"][joint.GetName()], rel=1e-7, abs=1e-7)


def test_a_leader_that_is_missing_is_an_error():
    """The robot is there, and its followers without leaders move on their own."""
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert not env.Load(ROBOTS / "alex_description/urdf/alex_psyonic_hands.urdf")
    errors = [finding for finding in env.diagnostics if finding.severity == "error"]
    assert {finding.code for finding in errors} == {"bad-mimic"}
    assert len(errors) == 8
    assert env.GetRobots()[0].GetDOF()
