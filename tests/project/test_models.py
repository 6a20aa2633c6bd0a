"""The robots in models/: tool poses by the published parameters, written once more, and what makes a good model."""

import math
import re
import runpy
import zipfile

import numpy as np
import pytest
from conftest import MODELS

import ravemj
from ravemj.errors import Diagnostics
from ravemj.formats import mjcf
from ravemj.formats.readers import read_file
from ravemj.formats.shipped import SHIPPED_MODELS

ROBOTS = ["puma560.xml", "panda.xml", "scara.dae"]
RIGHT = math.pi / 2


def turned(axis: int, angle: float) -> np.ndarray:
    """Return the matrix of a turn about x (0) or z (2)."""
    matrix, (i, j) = np.eye(4), [(1, 2), (0, 2), (0, 1)][axis]
    matrix[i, i] = matrix[j, j] = math.cos(angle)
    matrix[i, j], matrix[j, i] = -math.sin(angle), math.sin(angle)
    return matrix


def moved(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def classic(theta: float, d: float, a: float, alpha: float) -> np.ndarray:
    """Return Denavit's and Hartenberg's own transform."""
    return turned(2, theta) @ moved(a, 0, d) @ turned(0, alpha)


def craig(alpha: float, a: float, d: float, theta: float) -> np.ndarray:
    """Return the transform in Craig's form."""
    return turned(0, alpha) @ moved(a, 0, 0) @ turned(2, theta) @ moved(0, 0, d)


def puma(q) -> list[np.ndarray]:
    rows = [(0, 0, 90), (0, 0.4318, 0), (0.15005, 0.0203, -90), (0.4318, 0, 90), (0, 0, -90), (0, 0, 0)]
    steps = [classic(angle, d, a, math.radians(alpha)) for angle, (d, a, alpha) in zip(q, rows, strict=True)]
    return [moved(0, 0, 0.6718), *steps, moved(0, 0, 0.05625)]


def panda(q) -> list[np.ndarray]:
    a = [0, 0, 0, 0.0825, -0.0825, 0, 0.088]
    d = [0.333, 0, 0.316, 0, 0.384, 0, 0]
    alpha = [0, -RIGHT, RIGHT, RIGHT, -RIGHT, RIGHT, RIGHT]
    arm = [craig(*row) for row in zip(alpha, a, d, q[:7], strict=True)]
    return [*arm, moved(0, 0, 0.107), turned(2, -math.pi / 4), moved(0, 0, 0.1034)]


def scara(q) -> list[np.ndarray]:
    return [
        classic(q[0], 0.877, 0.425, math.pi),
        classic(q[1], 0, 0.375, 0),
        classic(0, q[2], 0, 0),
        classic(q[3], 0.2, 0, 0),
    ]


KINEMATICS = {"puma560.xml": puma, "panda.xml": panda, "scara.dae": scara}


def load(name: str) -> ravemj.Robot:
    return ravemj.load(MODELS / name).GetRobots()[0]


def configurations(robot, count: int) -> np.ndarray:
    lower, upper = robot.GetDOFLimits()
    return np.random.default_rng(560).uniform(lower, upper, (count, len(lower)))


@pytest.mark.parametrize("name", ROBOTS)
def test_tools_are_where_the_published_parameters_say(name):
    robot = load(name)
    for q in configurations(robot, 50):
        robot.SetDOFValues(q)
        expected = np.linalg.multi_dot(KINEMATICS[name](q))
        np.testing.assert_allclose(robot.GetManipulators()[0].GetTransform(), expected, atol=1e-12)


@pytest.mark.parametrize("name", ["puma560.xml", "scara.dae"])
def test_links_have_the_frames_of_denavit_and_hartenberg(name):
    robot = load(name)
    q = configurations(robot, 1)[0]
    robot.SetDOFValues(q)
    steps = KINEMATICS[name](q)
    before = len(steps) - len(q) - (name == "puma560.xml")
    for index, link in enumerate(robot.GetLinks()[1:], 1):
        expected = np.linalg.multi_dot([np.eye(4), *steps[: before + index]])
        np.testing.assert_allclose(link.GetTransform(), expected, atol=1e-12)


@pytest.mark.parametrize("name", [*ROBOTS, "workshop.env.xml"])
def test_nothing_is_reported(name):
    reading = read_file(MODELS / name)
    translating = Diagnostics()
    mjcf.write(reading.scene, translating)
    assert [*map(str, reading.diagnostics), *map(str, translating)] == []


@pytest.mark.parametrize("name", ROBOTS)
def test_numbers_are_those_of_real_robots(name):
    robot = load(name)
    for link in robot.GetLinks():
        tensor = link.GetLocalInertia()
        np.testing.assert_allclose(tensor, tensor.T)
        moments = np.linalg.eigvalsh(tensor)
        assert link.GetMass() > 0
        assert 0 < moments[2] <= moments[0] + moments[1]
        assert link.GetGeometries()
    lower, upper = robot.GetDOFLimits()
    assert (lower < upper).all()
    assert (robot.GetDOFMaxVel() > 0).all()
    assert 10 < robot.GetMass() < 100
    (arm,) = robot.GetManipulators()
    assert len(arm.GetArmIndices()) + len(arm.GetGripperIndices()) == robot.GetDOF()
    assert arm.GetLocalToolDirection().tolist() == [0, 0, 1]


@pytest.mark.parametrize("name", ROBOTS)
def test_no_links_touch_as_loaded(name):
    assert not load(name).CheckSelfCollision()


def test_the_fingers_follow_each_other():
    robot = load("panda.xml")
    (arm,) = robot.GetManipulators()
    (finger,) = arm.GetGripperIndices()
    hand = robot.GetLink("hand").GetTransform()
    for opening in (0, 0.013, 0.04):
        robot.SetDOFValues([opening], [finger])
        for name, side in (("left_finger", 1), ("right_finger", -1)):
            place = np.linalg.inv(hand) @ robot.GetLink(name).GetTransform()
            np.testing.assert_allclose(place, moved(0, side * opening, 0.0584), atol=1e-12)
    assert arm.GetClosingDirection().tolist() == [-1]
    assert arm.GetEndEffector().GetName() == "hand"


def test_masses_are_those_of_the_papers():
    panda, puma = load("panda.xml"), load("puma560.xml")
    moving = [puma.GetLink(f"link{number}").GetMass() for number in range(2, 7)]
    assert moving == pytest.approx([17.4, 4.8, 0.82, 0.34, 0.09])
    moving = [panda.GetLink(f"link{number}").GetMass() for number in range(1, 8)]
    assert moving == pytest.approx([4.970684, 0.646926, 3.228604, 3.587895, 1.225946, 1.666555, 0.735522])


def test_the_collada_robot_is_what_its_script_writes(tmp_path):
    script = runpy.run_path(str(MODELS.parent / "scripts" / "models" / "scara.py"))
    script["main"](tmp_path / "scara.dae")
    assert (tmp_path / "scara.dae").read_text() == (MODELS / "scara.dae").read_text()


def test_the_collada_robot_is_the_same_in_an_archive(tmp_path):
    with zipfile.ZipFile(tmp_path / "scara.zae", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("manifest.xml", "<dae_root>./scara.dae</dae_root>")
        archive.write(MODELS / "scara.dae", "scara.dae")
    plain, packed = (
        mjcf.write(read_file(path).scene, Diagnostics()) for path in (MODELS / "scara.dae", archive.filename)
    )
    place = re.compile("<!-- .* -->")
    assert place.sub("", plain.text) == place.sub("", packed.text)
    assert plain.meshes == packed.meshes


@pytest.mark.parametrize("name", ["base", "inner", "outer", "quill", "tool"])
def test_meshes_of_the_collada_robot_are_closed_and_face_outwards(name):
    for geometry in load("scara.dae").GetLink(name).GetGeometries():
        mesh = geometry.GetCollisionMesh()
        a, b, c = np.moveaxis(mesh.vertices[mesh.indices], 1, 0)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
        np.testing.assert_allclose(np.cross(b - a, c - a).sum(axis=0), 0, atol=1e-9)


@pytest.mark.parametrize("name", SHIPPED_MODELS)
def test_models_that_come_with_ravemj_load_by_their_name(name):
    assert ravemj.load(ravemj.model_path(name)).GetBodies()


def test_a_model_that_does_not_come_with_ravemj():
    with pytest.raises(ravemj.ArgumentError, match=r"'wam'.*pendulum, panda"):
        ravemj.model_path("wam")
