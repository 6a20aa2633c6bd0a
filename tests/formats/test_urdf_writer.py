"""URDF out: the same robot when it is read back, and the same file when that is written."""

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravemj
from ravemj.core.transforms import Pose, wxyz_from_axis_angle
from ravemj.formats.urdf.rpy import numbers, roll_pitch_yaw

ROOT = Path(__file__).parents[2]
MODELS = ("models/puma560.xml", "models/panda.xml", "models/biped.robot.xml", "models/scara.dae",
          "models/desk_arm/urdf/desk_arm.urdf")  # fmt: skip


def loaded(path: Path) -> ravemj.Environment:
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert env.Load(path)
    return env


def save(env: ravemj.Environment, path: Path) -> list[str]:
    """Write a URDF; return the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        env.Save(path)
    return [str(one.message) for one in caught if issubclass(one.category, ravemj.RavemjWarning)]


def robot_of(env: ravemj.Environment) -> ravemj.Robot:
    return env.GetRobots()[0]


@pytest.mark.parametrize("model", MODELS)
def test_what_is_written_comes_back(model, tmp_path):
    first = loaded(ROOT / model)
    save(first, tmp_path / "robot.urdf")
    second = loaded(tmp_path / "robot.urdf")
    robot, other = robot_of(first), robot_of(second)
    base = np.linalg.inv(robot.GetTransform())
    random = np.random.default_rng(1)
    assert [joint.GetName() for joint in robot.GetJoints()] == [joint.GetName() for joint in other.GetJoints()]
    for quantity in ("GetDOFLimits", "GetDOFVelocityLimits", "GetDOFTorqueLimits"):
        np.testing.assert_allclose(getattr(robot, quantity)(), getattr(other, quantity)(), atol=1e-12)
    for _ in range(3):
        values = random.uniform(*robot.GetDOFLimits())
        robot.SetDOFValues(values)
        other.SetDOFValues(values)
        for link in robot.GetLinks():
            there = other.GetLink(link.GetName())
            pose = np.linalg.inv(other.GetTransform()) @ there.GetTransform()
            np.testing.assert_allclose(base @ link.GetTransform(), pose, atol=1e-9)
            assert link.GetMass() == pytest.approx(there.GetMass(), abs=1e-9)
        for arm in robot.GetManipulators():
            pose = np.linalg.inv(other.GetTransform()) @ other.GetManipulator(arm.GetName()).GetTransform()
            np.testing.assert_allclose(base @ arm.GetTransform(), pose, atol=1e-9)
    (tmp_path / "again").mkdir()
    save(loaded(tmp_path / "robot.urdf"), tmp_path / "again" / "robot.urdf")
    for name in ("robot.urdf", "robot.srdf", *(f"meshes/{path.name}" for path in tmp_path.glob("meshes/*"))):
        assert (tmp_path / name).read_bytes() == (tmp_path / "again" / name).read_bytes()


def test_self_collisions_are_the_same(tmp_path):
    first = loaded(ROOT / "models/desk_arm/urdf/desk_arm.urdf")
    save(first, tmp_path / "arm.urdf")
    robot, other = robot_of(first), robot_of(loaded(tmp_path / "arm.urdf"))
    random = np.random.default_rng(2)
    found = set()
    for _ in range(40):
        values = random.uniform(*robot.GetDOFLimits())
        robot.SetDOFValues(values)
        other.SetDOFValues(values)
        assert robot.CheckSelfCollision() == other.CheckSelfCollision()
        found.add(robot.CheckSelfCollision())
    assert found == {True, False}


def read(text: str, path: Path) -> ravemj.Environment:
    (path / "model.xml").write_text(text)
    return loaded(path / "model.xml")


TWO_AXES = """<Robot name="r"><KinBody>
<Body name="a"><Geom type="box"><extents>0.1 0.1 0.1</extents></Geom></Body>
<Body name="b"><offsetfrom>a</offsetfrom><Translation>0 0 0.5</Translation>
<Geom type="capsule"><radius>0.1</radius><height>0.2</height></Geom></Body>
<Joint name="j" type="universal"><Body>a</Body><Body>b</Body><offsetfrom>a</offsetfrom>
<axis>1 0 0</axis><limits>-1 1</limits></Joint>
</KinBody></Robot>""".replace('type="universal"', 'type="{kind}"')


@pytest.mark.parametrize("kind", ["hinge", "hinge2", "spherical"])
def test_joints_with_several_axes_become_chains(kind, tmp_path):
    text = TWO_AXES.format(kind=kind)
    if kind == "hinge2":
        text = text.replace("<axis>1 0 0</axis>", "<axis1>1 0 0</axis1><axis2>0 1 0</axis2>")
    env = read(text, tmp_path)
    found = save(env, tmp_path / "r.urdf")
    other = robot_of(loaded(tmp_path / "r.urdf"))
    assert other.GetDOF() == robot_of(env).GetDOF()
    assert any("have one axis" in message for message in found) == (kind != "hinge")
    assert other.GetLink("b").GetTransform()[2, 3] == pytest.approx(0.5)
    other.SetDOFValues([0.5] + [0.0] * (other.GetDOF() - 1))
    np.testing.assert_allclose(other.GetLink("b").GetTransform()[:3, 3], (0, -0.5 * math.sin(0.5), 0.5 * math.cos(0.5)))


def test_losses_are_said_once_for_each_kind(tmp_path):
    env = loaded(ROOT / "models/panda.xml")
    found = save(env, tmp_path / "panda.urdf")
    assert len(found) == 1
    assert "the value of a joint is left out; it starts at 0: 'joint2' (and 4 more)" in found[0]


def test_several_bodies(tmp_path):
    env = loaded(ROOT / "models/workshop.env.xml")
    found = save(env, tmp_path / "w.urdf")
    assert any("URDF holds one robot; other bodies are left out" in message for message in found)
    assert robot_of(loaded(tmp_path / "w.urdf")).GetName() == robot_of(env).GetName()


def test_an_empty_environment_is_refused(tmp_path):
    with pytest.raises(ravemj.OutputError, match="no body with links"):
        ravemj.Environment().Save(tmp_path / "x.urdf")
    assert not list(tmp_path.iterdir())


ANGLES = st.floats(-math.pi, math.pi) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])


@given(ANGLES, ANGLES, ANGLES)
def test_angles_that_were_written_stay(roll, pitch, yaw):
    def pose(angles):
        x, y, z = (Pose(wxyz=wxyz_from_axis_angle(axis, angle)) for axis, angle in
                   zip(((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)), angles, strict=True))  # fmt: skip
        return z @ y @ x

    first = pose((roll, pitch, yaw))
    written = numbers(roll_pitch_yaw(first))
    again = pose(tuple(map(float, written.split())))
    np.testing.assert_allclose(first.matrix(), again.matrix(), atol=1e-9)
    if abs(math.cos(pitch)) > 0.1 or abs(abs(pitch) - math.pi / 2) < 1e-12:  # beside the poles angles are not exact
        assert numbers(roll_pitch_yaw(again)) == written
