"""Models that are written and read again: the same numbers, and the same bytes when they are written once more."""

import csv
import json
import math
import os
import re
import signal
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from agreement import CORPUS
from conftest import MODELS, REPOSITORY, one_in
from hypothesis import given
from round_trips import NAMES, check_round_trip, contents
from strategies import Taste, examples, scene_node, scenes, xml

import ravemj
from ravemj.engine.snapshot import snapshot
from ravemj.errors import Diagnostics, OutputError, SourceError
from ravemj.formats.collada.writer import write as collada_document
from ravemj.formats.openrave_xml.writer import write as openrave_document
from ravemj.formats.readers import read_data, read_file
from ravemj.formats.writers import save
from ravemj.model.comparison import compare
from ravemj.model.scene import UNLIMITED, Box, Inertial, Scene, TriMesh, View

pytestmark = pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")

INPUTS = sorted(
    path.relative_to(REPOSITORY).as_posix()
    for folder in (MODELS, REPOSITORY / "tests" / "conformance" / "cases", REPOSITORY / "tests" / "data")
    for path in folder.rglob("*")
    if path.suffix in {".xml", ".dae", ".zae"}
)
KNOWN_LOSSES = {
    ("collada", "errors-38-manipulator-unknown-link"): {"manipulators"},  # COLLADA has none without both links
    ("collada", "errors-39-manipulator-empty"): {"manipulators"},
    ("collada", "errors-46-mimic-circular"): {"follows", "follows DOFs"},  # an equation that OpenRAVE throws away
    ("openrave", "gap-58-dae-cylindrical"): {"kind", "pose"},  # OpenRAVE XML has no such joint; its first axis is kept
    ("openrave", "willowgarage-pr2.zae"): {"direction"},  # of a weld: it is z of the child
    ("collada", "willowgarage-pr2.zae"): {"direction"},
    ("openrave", "calibration_board.dae"): {"shapes"},  # OpenRAVE XML has no such shape; a box stands for it
}


def corpus() -> list[str]:
    if not (CORPUS / "index.csv").is_file():
        return []
    with open(CORPUS / "index.csv", encoding="utf8") as file:
        return [row["file"] for row in csv.DictReader(file)]


def losses(kind: str, name: str) -> set[str]:
    return next((lost for (form, part), lost in KNOWN_LOSSES.items() if form == kind and part in name), set())


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("name", one_in(4, INPUTS))
def test_inputs_survive(kind, name, tmp_path, monkeypatch):
    monkeypatch.delenv("OPENRAVE_DATA", raising=False)
    reading = read_file(REPOSITORY / name)
    if reading.failure is not None or not reading.scene.bodies:
        pytest.skip("it does not load")
    assert check_round_trip(reading.scene, kind, tmp_path) == losses(kind, name)


@pytest.mark.corpus
@pytest.mark.skipif(not CORPUS.is_dir(), reason="there are no published models in ../shared/corpus")
@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("name", one_in(32, corpus()))
def test_published_models_survive(kind, name, tmp_path, monkeypatch):
    monkeypatch.setenv("OPENRAVE_DATA", str(CORPUS / "models" / "rdiankov+openrave" / "src"))
    reading = read_file(CORPUS / "models" / name)
    if reading.failure is not None or not reading.scene.bodies:
        pytest.skip("it does not load")
    assert check_round_trip(reading.scene, kind, tmp_path) == losses(kind, name)


@pytest.mark.parametrize("kind", NAMES)
@examples(60)
@given(scene=scenes(Taste(bodies=2)))
def test_random_scenes_survive(kind, tmp_path, scene):
    (tmp_path / "model.xml").write_text(xml(scene_node(scene)))
    reading = read_file(tmp_path / "model.xml")
    if reading.failure is None:
        save(tmp_path / NAMES[kind], reading.scene, Diagnostics(), kind)
        assert compare(reading.scene, read_file(tmp_path / NAMES[kind]).scene) == []


@examples(60)
@given(scene=scenes(Taste(bodies=2)))
def test_the_format_does_not_matter(tmp_path, scene):
    """What is read of one format says the same in the other."""
    (tmp_path / "model.xml").write_text(xml(scene_node(scene)))
    reading = read_file(tmp_path / "model.xml")
    if reading.failure is None:
        save(tmp_path / "model.dae", reading.scene, Diagnostics(), "collada")
        save(tmp_path / "model.env.xml", read_file(tmp_path / "model.dae").scene, Diagnostics(), "openrave")
        seen = replace(reading.scene, view=None)  # COLLADA keeps none
        assert compare(seen, read_file(tmp_path / "model.env.xml").scene) == []


class TestComparison:
    """Each number that changes is found, so that the tests above cannot pass by overlooking it."""

    @pytest.fixture
    def body(self):
        return read_file(MODELS / "panda.xml").scene.bodies[0]

    @pytest.mark.parametrize(
        ("quantity", "change"),
        [
            ("bodies", lambda body: replace(body, name="other")),
            ("is a robot", lambda body: replace(body, is_robot=False)),
            ("description", lambda body: replace(body, description="other")),
            ("mass", lambda body: with_link(body, inertial=replace(body.links[1].inertial, mass=7.0))),
            ("centre of mass", lambda body: with_link(body, inertial=replace(body.links[1].inertial, com=(9.0, 0, 0)))),
            ("enabled", lambda body: with_link(body, enabled=False)),
            ("static", lambda body: with_link(body, static=True)),
            ("shapes", lambda body: with_link(body, geometries=())),
            ("links", lambda body: with_link(body, name="other")),
            ("upper", lambda body: with_axis(body, upper=1.0)),
            ("max velocity", lambda body: with_axis(body, max_velocity=1.0)),
            ("direction", lambda body: with_axis(body, direction=(1.0, 0.0, 0.0))),
            ("value", lambda body: with_axis(body, value=0.1)),
            ("manipulators", lambda body: replace(body, manipulators=())),
            ("adjacent links", lambda body: replace(body, adjacent=((0, 7),))),
        ],
    )
    def test_of_a_change(self, body, quantity, change):
        found = compare(Scene((body,)), Scene((change(body),)))
        assert quantity in {difference.quantity for difference in found}

    def test_of_colours_and_triangles(self):
        scene = read_file(MODELS / "scara.dae").scene
        link = scene.bodies[0].links[0]
        shape = link.geometries[0]
        moved = TriMesh(shape.shape.mesh.moved(np.diag([1.0, 1.0, 1.001, 1.0])))
        for changed, quantity in (
            (replace(shape, diffuse=(0.2, 0.22, 0.25 + 1e-8)), "diffuse"),
            (replace(shape, shape=moved), "triangles"),
        ):
            links = (replace(link, geometries=(changed, *link.geometries[1:])), *scene.bodies[0].links[1:])
            other = Scene((replace(scene.bodies[0], links=links),), gravity=scene.gravity)
            assert [difference.quantity for difference in compare(scene, other)] == [quantity]


def with_link(body, **changes):
    return replace(body, links=(body.links[0], replace(body.links[1], **changes), *body.links[2:]))


def with_axis(body, **changes):
    joint = body.joints[0]
    return replace(body, joints=(replace(joint, axes=(replace(joint.axes[0], **changes),)), *body.joints[1:]))


def test_collada_is_in_degrees_and_openrave_xml_in_radians(tmp_path):
    text = (
        '<KinBody name="k"><Body name="a"/><Body name="b"/><Joint name="j"><Body>a</Body><Body>b</Body>'
        "<axis>0 0 1</axis><limitsdeg>-90 180</limitsdeg><maxveldeg>30</maxveldeg></Joint></KinBody>"
    )
    scene = read_data(text).scene
    collada = collada_document(scene, Diagnostics())
    assert "<min>\n                <float>-90</float>" in collada
    assert "<speed>\n              <float>30</float>" in collada
    assert f"<limitsrad>{-np.pi / 2!r} {np.pi!r}</limitsrad>" in openrave_document(scene, Diagnostics()).text


TWO_LINKS = '<KinBody name="k"><Body name="a"/><Body name="b"/>{}</KinBody>'


class TestJoints:
    @pytest.mark.parametrize("kind", NAMES)
    @pytest.mark.parametrize("circular", [True, False])
    def test_axes_that_differ(self, kind, circular, tmp_path):
        """The first of the axes is circular, or has limits; the others have theirs, and other torques."""
        joint = (
            f'<Joint name="j" type="hinge2" circular="{circular}"><Body>a</Body><Body>b</Body><axis1>0 0 1</axis1>'
            "<axis2>1 0 0</axis2><limitsdeg>-10 20 -30 40</limitsdeg><maxtorque>5</maxtorque></Joint>"
        )
        scene = read_data(TWO_LINKS.format(joint)).scene
        first, second = scene.bodies[0].joints[0].axes
        assert [first.circular, second.circular] == [circular, False]
        assert [first.max_torque, second.max_torque] == [5.0, 0.0]
        assert second.upper == pytest.approx(np.radians(40))
        assert check_round_trip(scene, kind, tmp_path) == set()

    def test_circular_second_axis(self, tmp_path):
        joint = '<Joint name="j" type="hinge2"><Body>a</Body><Body>b</Body><axis1>0 0 1</axis1><axis2>1 0 0</axis2>'
        scene = read_data(TWO_LINKS.format(joint + "</Joint>")).scene
        body = scene.bodies[0]
        axes = tuple(replace(axis, lower=-UNLIMITED, upper=UNLIMITED, circular=True) for axis in body.joints[0].axes)
        changed = Scene((replace(body, joints=(replace(body.joints[0], axes=axes),)),))
        assert check_round_trip(changed, "collada", tmp_path) == set()
        assert check_round_trip(changed, "openrave", tmp_path) == {"circular"}
        assert warnings_of(changed, "openrave", tmp_path) == ["not-written"]

    def test_circular_sliders(self, tmp_path):
        joint = '<Joint name="j" type="slider" circular="true"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint>'
        scene = read_data(TWO_LINKS.format(joint)).scene
        assert check_round_trip(scene, "openrave", tmp_path) == set()
        assert check_round_trip(scene, "collada", tmp_path) == {"circular"}
        assert warnings_of(scene, "collada", tmp_path) == ["not-written"]

    def test_axes_of_welds(self, tmp_path):
        """OpenRAVE reads the axis of a weld as the z axis of its child."""
        joint = '<Joint name="{}"><Body>{}</Body><Body>{}</Body><axis>0 0 1</axis><limitsdeg>0 {}</limitsdeg></Joint>'
        joints = joint.format("weld", "a", "b", 0) + '<Body name="c"/>' + joint.format("j", "b", "c", 90)
        scene = read_data(TWO_LINKS.format(joints)).scene
        turned = Scene((with_axis(scene.bodies[0], direction=(1.0, 0.0, 0.0)),))
        assert turned.bodies[0].joints[0].static
        for kind in NAMES:
            assert warnings_of(scene, kind, tmp_path) == []
            assert check_round_trip(scene, kind, tmp_path) == set()
            assert check_round_trip(turned, kind, tmp_path) == {"direction"}
            assert warnings_of(turned, kind, tmp_path) == ["not-written"]


@pytest.mark.parametrize(("kind", "codes"), [("collada", ["not-written"]), ("openrave", [])])
def test_the_view_is_lost_in_collada(kind, codes, tmp_path):
    scene = read_file(MODELS / "panda.xml").scene
    assert warnings_of(replace(scene, view=View()), kind, tmp_path) == []
    assert warnings_of(replace(scene, view=View(background=(0.0, 0.0, 1.0))), kind, tmp_path) == codes


def warnings_of(scene: Scene, kind: str, folder: Path) -> list[str]:
    diagnostics = Diagnostics()
    save(folder / NAMES[kind], scene, diagnostics, kind)
    return [finding.code for finding in diagnostics]


class TestSave:
    @pytest.fixture
    def world(self):
        env = ravemj.Environment()
        assert env.Load(str(MODELS / "workshop.env.xml"))
        return env

    @pytest.mark.parametrize("kind", NAMES)
    def test_a_changed_world_as_it_stands(self, world, tmp_path, kind):
        robot = world.GetRobots()[0]
        robot.SetDOFValues([0.3, -0.4, 0.5], [0, 1, 2])
        robot.SetTransform(ravemj.matrixFromAxisAngle([0, 0, 0.7]))
        robot.SetDOFLimits([-1.5] * robot.GetDOF(), [1.5] * robot.GetDOF())
        robot.GetLinks()[2].Enable(False)
        body = next(body for body in world.GetBodies() if not body.IsRobot())
        moved = body.GetTransform()
        moved[:3, 3] += 0.25
        body.SetTransform(moved)
        body.GetLinks()[0].GetGeometries()[0].SetDiffuseColor([0.1, 0.2, 0.3])
        robot.Grab(body, robot.GetLinks()[-1])
        sensor = ravemj.AttachedSensorInfo(_name="eye", _linkname=robot.GetLinks()[1].GetName(), _sensorname="BaseIMU")
        robot.AddAttachedSensor(sensor).SetRelativeTransform([0.6, 0, 0, 0.8, 0.1, 0.2, 0.3])
        simulation = world.simulation
        scene = Scene(tuple(map(snapshot, simulation.bodies)), simulation.view, simulation.gravity)
        assert check_round_trip(scene, kind, tmp_path) == set()
        world.Save(tmp_path / NAMES[kind], atts={"format": kind})
        other = ravemj.load(tmp_path / NAMES[kind])
        robot2, body2 = other.GetRobot(robot.GetName()), other.GetKinBody(body.GetName())
        np.testing.assert_allclose(robot2.GetDOFValues(), robot.GetDOFValues(), atol=1e-9)
        np.testing.assert_allclose(robot2.GetLinkTransformations(), robot.GetLinkTransformations(), atol=1e-9)
        np.testing.assert_allclose(robot2.GetDOFLimits(), robot.GetDOFLimits(), atol=1e-9)
        assert not robot2.GetLinks()[2].IsEnabled()
        assert robot2.GetLinks()[1].IsEnabled()
        np.testing.assert_allclose(body2.GetTransform(), moved, atol=1e-9)
        np.testing.assert_allclose(body2.GetLinks()[0].GetGeometries()[0].GetDiffuseColor(), [0.1, 0.2, 0.3], atol=1e-9)

    @pytest.mark.parametrize("kind", NAMES)
    def test_links_that_a_script_displaced(self, env, robot, tmp_path, kind):
        displaced = robot.GetLinks()[1].GetTransform()
        displaced[:3, 3] += [0.1, 0.2, 0.3]
        robot.GetLinks()[1].SetTransform(displaced)
        env.Save(tmp_path / NAMES[kind], atts={"format": kind})
        links = ravemj.load(tmp_path / NAMES[kind]).GetRobots()[0].GetLinkTransformations()
        np.testing.assert_allclose(links, robot.GetLinkTransformations(), atol=1e-9)

    def test_selection(self, world, tmp_path):
        def saved(*arguments):
            world.Save(tmp_path / "part.dae", *arguments)
            return [body.GetName() for body in ravemj.load(tmp_path / "part.dae").GetBodies()]

        every = [body.GetName() for body in world.GetBodies()]
        robots = [robot.GetName() for robot in world.GetRobots()]
        options = ravemj.Environment.SelectionOptions
        assert saved() == every
        assert saved(options.Robots) == robots
        assert saved(options.NoRobots) == [name for name in every if name not in robots]
        assert saved(options.Body, every[1]) == [every[1]]
        assert saved(options.Body, [("target", every[0]), ("target", every[2])]) == [every[0], every[2]]
        assert saved(options.AllExceptBody, {"target": every[0]}) == every[1:]

    def test_skipwrite(self, world, tmp_path):
        world.Save(tmp_path / "bare.dae", atts={"skipwrite": "geometry manipulators"})
        for body in ravemj.load(tmp_path / "bare.dae").GetBodies():
            assert all(not link.GetGeometries() for link in body.GetLinks())
            assert not body.IsRobot() or not body.GetManipulators()

    @pytest.mark.parametrize("name", ["bare.dae", "bare.json"])
    def test_skipwrite_of_masses_and_visuals(self, world, tmp_path, name):
        world.Save(tmp_path / name, atts={"skipwrite": "physics visual readable"})
        for body in ravemj.load(tmp_path / name).GetBodies():
            assert all(not link.GetGeometries() and link.GetMass() == 1e-10 for link in body.GetLinks())

    def test_archive(self, env, tmp_path):
        env.Save(tmp_path / "a b.zae")
        assert zipfile.ZipFile(tmp_path / "a b.zae").namelist() == ["a b.dae", "manifest.xml"]
        assert ravemj.load(tmp_path / "a b.zae").GetRobots()[0].GetDOF() == 2

    @pytest.mark.parametrize("name", ["a.xml", "a.robot.xml", "a.unknown"])
    def test_other_names_hold_collada_and_load_again(self, env, tmp_path, name):
        env.Save(str(tmp_path / name))
        assert b"<COLLADA" in (tmp_path / name).read_bytes()[:200]
        assert ravemj.load(tmp_path / name).GetRobots()[0].GetDOF() == 2

    @pytest.mark.parametrize("meshes", ["stl", "obj"])
    def test_meshes_lie_beside_openrave_xml(self, tmp_path, meshes):
        env = ravemj.load(MODELS / "scara.dae")
        env.Save(tmp_path / "scara.xml", atts={"format": "openrave", "meshes": meshes})
        files = list((tmp_path / "meshes").iterdir())
        assert files
        assert {file.suffix for file in files} == {f".{meshes}"}
        first, second = (Scene((load_body(path),)) for path in (MODELS / "scara.dae", tmp_path / "scara.xml"))
        assert compare(first, second) == []

    @pytest.mark.parametrize(
        ("arguments", "words"),
        [
            ((9,), "SelectionOptions"),
            ((4, "nobody"), "no body 'nobody'"),
            ((4,), "needs the name"),
            ((3, {"skipwrite": "gravity"}), "known are"),
            ((3, {"nonsense": "x"}), "nothing reads 'nonsense'"),
            ((3, {"openravescheme": "ftp"}), "known are openrave"),
            ((3, [("target",)]), "not a pair"),
        ],
    )
    def test_wrong_arguments(self, env, tmp_path, arguments, words):
        with pytest.raises(ravemj.openrave_exception, match=words):
            env.Save(str(tmp_path / "a.dae"), *arguments)
        assert list(tmp_path.iterdir()) == []


class TestExternalReferences:
    """Bodies in the files that they were read from."""

    @pytest.fixture
    def world(self, tmp_path):
        """Two arms of one file, one of which holds a box of an archive."""
        (tmp_path / "parts" / "a b").mkdir(parents=True)
        arm = tmp_path / "parts" / "arm.dae"
        arm.write_bytes((MODELS / "scara.dae").read_bytes())
        box = ravemj.Environment()
        box.LoadData(
            '<KinBody name="box"><Body name="b"><Geom type="box"><extents>1 2 3</extents></Geom></Body></KinBody>'
        )
        box.Save(tmp_path / "parts" / "a b" / "box.zae")
        env = ravemj.Environment()
        for path in (arm, arm, tmp_path / "parts" / "a b" / "box.zae"):
            env.Load(str(path))
        first, second, held = env.GetBodies()
        second.SetTransform(ravemj.matrixFromAxisAngle([0.3, -0.2, 1.1]) @ ravemj.matrixFromPose([1, 0, 0, 0, 1, 2, 3]))
        first.SetDOFValues([0.1, -0.2, 0.03, 0.4])
        second.Grab(held, second.GetLinks()[-1])
        second.SetDOFValues([-0.3, 0.2, 0.01, 0.5])
        return env

    @pytest.mark.parametrize("name", ["scene.dae", "scene.zae"])
    def test_give_the_world_as_it_stands(self, world, tmp_path, name):
        scene = snapshots(world)
        world.Save(tmp_path / name, atts={"externalref": "*", "skipwrite": "geometry physics"})
        other = ravemj.load(tmp_path / name)
        assert compare(scene, snapshots(other)) == []
        assert len(other.GetBodies()[1].GetGrabbed()) == 1
        assert other.GetBodies()[1].GetURI() == f"file:{tmp_path / 'parts' / 'arm.dae'}"
        other.Save(tmp_path / f"second-{name}", atts={"externalref": "*"})
        contents = [document_in(tmp_path / file) for file in (name, f"second-{name}")]
        assert contents[0] == contents[1]
        assert "<p>" not in contents[0]
        assert 'url="parts/a%20b/box.zae#' in contents[0]

    def test_by_the_folders_of_openrave_data(self, world, tmp_path, monkeypatch):
        monkeypatch.setenv("OPENRAVE_DATA", str(tmp_path / "parts"))
        (tmp_path / "elsewhere").mkdir()
        target = tmp_path / "scene.dae"
        world.Save(target, atts={"externalref": "*", "openravescheme": "openrave"})
        assert set(re.findall(r"[^\"#]*(?:arm.dae|box.zae)", target.read_text())) == {
            "openrave:/arm.dae",
            "openrave:/a%20b/box.zae",
        }
        target.rename(tmp_path / "elsewhere" / "scene.dae")
        assert compare(snapshots(world), read_file(tmp_path / "elsewhere" / "scene.dae").scene) == []

    def test_by_the_folders_of_openrave_data_only_where_they_lead_there(self, world, tmp_path, monkeypatch):
        (tmp_path / "first").mkdir()
        (tmp_path / "first" / "arm.dae").write_text("another")
        monkeypatch.setenv("OPENRAVE_DATA", f"{tmp_path / 'first'}{os.pathsep}{tmp_path / 'parts'}")
        world.Save(tmp_path / "scene.dae", atts={"externalref": "*", "openravescheme": "openrave"})
        assert 'url="parts/arm.dae#' in (tmp_path / "scene.dae").read_text()
        assert 'url="openrave:/a%20b/box.zae#' in (tmp_path / "scene.dae").read_text()

    def test_follow_their_file(self, world, tmp_path):
        world.Save(tmp_path / "scene.dae", atts={"externalref": "*"})
        arm = tmp_path / "parts" / "arm.dae"
        arm.write_text(arm.read_text().replace("<mass>", "<mass>1", 1))
        first, second = (ravemj.load(path).GetBodies()[0].GetMass() for path in (MODELS / "scara.dae", arm))
        assert first != second
        assert ravemj.load(tmp_path / "scene.dae").GetBodies()[0].GetMass() == second

    def test_are_written_only_for_those_that_are_named(self, world, tmp_path):
        one, other, box = (body.GetName() for body in world.GetBodies())
        world.Save(tmp_path / "scene.dae", atts={"externalref": f"{box} {other}"})
        text = (tmp_path / "scene.dae").read_text()
        assert [f'"body{number}_origin"' in text for number in range(3)] == [False, True, True]
        assert compare(snapshots(world), read_file(tmp_path / "scene.dae").scene) == []
        with pytest.raises(ravemj.openrave_exception, match=f"names 'nobody'; saved are {one}"):
            world.Save(tmp_path / "scene.dae", atts={"externalref": "nobody"})

    @pytest.mark.parametrize(
        ("change", "words"),
        [
            (lambda body, folder: body.GetLinks()[1].SetMass(7.0), "link '.*': mass differs"),
            (lambda body, folder: body.GetLinks()[1].Enable(False), "enabled differs"),
            (lambda body, folder: body.SetDOFLimits([-1] * 4, [1] * 4), "lower differs"),
            (lambda body, folder: (folder / "parts" / "arm.dae").unlink(), "is gone"),
            (lambda body, folder: (folder / "parts" / "arm.dae").write_text("<COLLADA/>"), "no such body"),
        ],
    )
    def test_that_would_give_another_body_are_not_written(self, world, tmp_path, change, words):
        change(world.GetBodies()[0], tmp_path)
        with pytest.warns(ravemj.RavemjWarning, match=words):
            world.Save(tmp_path / "scene.dae", atts={"externalref": world.GetBodies()[0].GetName()})
        assert compare(snapshots(world), read_file(tmp_path / "scene.dae").scene) == []

    def test_of_bodies_that_come_from_no_collada(self, env, tmp_path):
        with pytest.warns(ravemj.RavemjWarning, match="comes from no COLLADA file"):
            env.Save(tmp_path / "a.dae", atts={"externalref": "*"})
        assert ravemj.load(tmp_path / "a.dae").GetRobots()[0].GetDOF() == 2

    def test_to_the_file_that_is_replaced(self, world, tmp_path):
        with pytest.warns(ravemj.RavemjWarning, match="going to be replaced"):
            world.Save(tmp_path / "parts" / "arm.dae", atts={"externalref": "*"})
        assert compare(snapshots(world), read_file(tmp_path / "parts" / "arm.dae").scene) == []


def document_in(path: Path) -> str:
    if path.suffix == ".zae":
        return zipfile.ZipFile(path).read(f"{path.stem}.dae").decode()
    return path.read_text()


class TestTrouble:
    @pytest.mark.parametrize("kind", NAMES)
    def test_names_that_no_xml_allows(self, tmp_path, kind):
        scene = read_file(MODELS / "panda.xml").scene
        named = with_link(scene.bodies[0], name="bell\a")
        (tmp_path / NAMES[kind]).write_text("before")
        with pytest.raises(OutputError, match="no XML file can hold"):
            save(tmp_path / NAMES[kind], Scene((named,)), Diagnostics(), kind)
        assert contents(tmp_path) == {NAMES[kind]: b"before"}

    @pytest.mark.parametrize("kind", NAMES)
    def test_folders_that_are_not_there(self, env, tmp_path, kind):
        with pytest.raises(OutputError, match="there is no folder"):
            env.Save(tmp_path / "gone" / NAMES[kind], atts={"format": kind})

    def test_meshes_that_cannot_be_written_leave_no_document(self, tmp_path):
        (tmp_path / "meshes").write_text("no folder")
        with pytest.raises(OutputError, match="not a folder"):
            ravemj.load(MODELS / "scara.dae").Save(tmp_path / "a.xml", atts={"format": "openrave"})
        assert contents(tmp_path) == {"meshes": b"no folder"}

    def test_two_links_that_openrave_xml_takes_for_one(self, tmp_path):
        body = read_file(MODELS / "panda.xml").scene.bodies[0]
        same = replace(body, links=tuple(replace(link, name="Link") for link in body.links))
        diagnostics = Diagnostics()
        save(tmp_path / "a.robot.xml", Scene((same,)), diagnostics, "openrave")
        assert {finding.code for finding in diagnostics} == {"renamed"}
        found = compare(Scene((same,)), read_file(tmp_path / "a.robot.xml").scene)
        assert {difference.quantity for difference in found} == {"links"}

    @pytest.mark.parametrize("kind", NAMES)
    def test_full_disks(self, tmp_path, kind):
        """An older file stays, nothing is left behind, and the error names the target."""
        resource = pytest.importorskip("resource")  # Windows has none
        env, path = ravemj.load(MODELS / "scara.dae"), tmp_path / NAMES[kind]
        path.write_text("older")
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
        try:
            with pytest.raises(OutputError, match=f"cannot write {re.escape(str(tmp_path))}.*: file too large"):
                env.Save(path, atts={"format": kind})
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
            signal.signal(signal.SIGXFSZ, handler)
        assert contents(tmp_path) == {path.name: b"older"}

    @pytest.mark.parametrize("kind", NAMES)
    def test_limits_of_circular_joints(self, env, robot, tmp_path, kind):
        assert robot.GetJoints()[0].IsCircular(0)
        robot.SetDOFLimits([-1, -2], [1, 2])
        with pytest.warns(ravemj.RavemjWarning, match="limits of the joint 'Joint0' are left out"):
            env.Save(tmp_path / NAMES[kind], atts={"format": kind})

    @pytest.mark.parametrize("kind", NAMES)
    def test_what_no_format_can_say(self, tmp_path, kind):
        body = read_file(MODELS / "panda.xml").scene.bodies[0]
        link = body.links[0]
        shape = replace(link.geometries[0], collision_mesh=Box((1.0, 1.0, 1.0)).triangulated())
        inertial = replace(link.inertial, undefined=True)
        body = replace(
            body,
            links=(replace(link, geometries=(shape,), inertial=inertial), *body.links[1:]),
            manipulators=tuple(replace(arm, gripper_name="claw") for arm in body.manipulators[:1]),
        )
        diagnostics = Diagnostics()
        save(tmp_path / NAMES[kind], Scene((body,)), diagnostics, kind)
        messages = [finding.message for finding in diagnostics if finding.code == "not-written"]
        assert [word in "".join(messages) for word in ("'claw'", "undefined", "that a script gave")] == [True] * 3
        lost = {difference.quantity for difference in compare(Scene((body,)), read_file(tmp_path / NAMES[kind]).scene)}
        assert lost == {"gripper name", "has no defined mass", "has triangles of scripts"}

    @pytest.mark.parametrize("kind", NAMES)
    def test_numbers_that_are_not_finite(self, env, robot, tmp_path, kind):
        robot.SetDOFVelocityLimits([1.0, math.inf])
        with pytest.raises(OutputError, match=r"number in '(maxvel|float)': inf"):
            env.Save(tmp_path / NAMES[kind], atts={"format": kind})
        assert contents(tmp_path) == {}

    @pytest.mark.parametrize("kind", NAMES)
    def test_an_inertia_that_is_not_finite(self, tmp_path, kind):
        body = read_file(MODELS / "panda.xml").scene.bodies[0]
        inertial = Inertial(math.inf, (0.0, 0.0, 0.0), ((math.nan,) * 3,) * 3)
        link = replace(body.links[0], inertial=inertial)
        with pytest.raises(OutputError, match=r"number in '(total|mass)': inf"):
            save(tmp_path / NAMES[kind], Scene((replace(body, links=(link, *body.links[1:])),)), Diagnostics(), kind)

    @pytest.mark.parametrize("name", ["a b", " a", "a\tb"])
    def test_names_that_are_no_words(self, tmp_path, name):
        """Lists of links and joints are words, so that OpenRAVE XML has other names for those in them."""
        body = read_file(MODELS / "panda.xml").scene.bodies[0]
        gripper = body.manipulators[0].gripper_joints[0]
        joints = [replace(joint, name=name) if place == gripper else joint for place, joint in enumerate(body.joints)]
        passive = [
            joint if joint.mimic is None else replace(joint, mimic=replace(joint.mimic, position=name, velocity=""))
            for joint in body.passive_joints
        ]
        body = with_link(replace(body, joints=tuple(joints), passive_joints=tuple(passive)), name=name)
        diagnostics = Diagnostics()
        save(tmp_path / "a.robot.xml", Scene((body,)), diagnostics, "openrave")
        reading = read_file(tmp_path / "a.robot.xml")
        assert reading.failure is None
        assert [finding.code for finding in diagnostics] == ["renamed", "renamed"]
        lost = {difference.quantity for difference in compare(Scene((body,)), reading.scene)}
        assert lost == {"links", "joints"}

    @pytest.mark.parametrize("names", [("", "joint0"), ("joint1", ""), ("", ""), ("x y", "x_y"), ("x_y", "x y")])
    def test_joints_whose_names_collada_readers_take_for_one(self, tmp_path, names):
        """They change what no name can have, and name those without a name."""
        bodies = "".join(f'<Body name="{name}"/>' for name in "abc")
        joints = "".join(f'<Joint name="{a}{b}"><Body>{a}</Body><Body>{b}</Body></Joint>' for a, b in ("ab", "bc"))
        body = read_data(f'<KinBody name="k">{bodies}{joints}</KinBody>').scene.bodies[0]
        renamed = [replace(joint, name=name) for joint, name in zip(body.joints, names, strict=True)]
        scene = Scene((replace(body, joints=tuple(renamed)),))
        assert check_round_trip(scene, "collada", tmp_path) == set()

    def test_meshes_without_triangles(self, tmp_path):
        text = '<KinBody name="k"><Body name="a"><Geom type="trimesh"/><Geom type="none"/></Body></KinBody>'
        scene = read_data(text).scene
        for kind in NAMES:
            assert check_round_trip(scene, kind, tmp_path) == set()

    @pytest.mark.parametrize("kind", NAMES)
    def test_long_chains(self, tmp_path, kind):
        """Readers take no deeper nesting than ``DEEPEST``; OpenRAVE XML nests nothing."""
        bodies = "".join(f'<Body name="l{i}"/>' for i in range(200))
        joint = '<Joint name="j{0}"><Body>l{0}</Body><Body>l{1}</Body><axis>0 0 1</axis></Joint>'
        joints = "".join(joint.format(i, i + 1) for i in range(199))
        scene = read_data(f'<KinBody name="k">{bodies}{joints}</KinBody>').scene
        if kind == "openrave":
            assert check_round_trip(scene, kind, tmp_path) == set()
            return
        with pytest.raises(OutputError, match="in a row"):
            save(tmp_path / NAMES[kind], scene, Diagnostics(), kind)


def load_body(path):
    return ravemj.load(path).simulation.bodies[0].scene


class TestState:
    """What scripts attach and do goes with the file: held bodies, groups of shapes, parameters, rare limits."""

    @pytest.fixture
    def world(self):
        env = ravemj.Environment()
        assert env.Load(str(MODELS / "workshop.env.xml"))
        robot = env.GetRobots()[0]
        held, other = [body for body in env.GetBodies() if not body.IsRobot()][:2]
        robot.Grab(held, robot.GetLinks()[-1])
        robot.Grab(other, robot.GetLinks()[1], [robot.GetLinks()[2].GetIndex()], None)
        robot.SetDOFValues([0.3, -0.4, 0.5], [0, 1, 2])
        joint, link = robot.GetJoints()[0], robot.GetLinks()[1]
        joint.SetFloatParameters("stiffness", [1.5, 1 / 3])
        joint.SetStringParameters("maker", " <Unimation> ")
        link.SetIntParameters("bolts", [3, -4])
        link.SetIgnoreSelfCollision(True)
        shapes = [ravemj.KinBody.GeometryInfo(), ravemj.KinBody.GeometryInfo()]
        shapes[0]._type, shapes[0]._vGeomData = ravemj.GeometryType.Box, [0.1, 0.2, 0.3]
        shapes[1]._type, shapes[1]._vGeomData = ravemj.GeometryType.Sphere, [0.1, 0, 0]
        shapes[1]._t = ravemj.matrixFromAxisAngle([0.1, 0.2, 0.3])
        link.SetGroupGeometries("coarse", shapes)
        joint.SetHardVelocityLimits([3])
        robot.SetDOFJerkLimits(np.full(robot.GetDOF(), 77.0))
        return env

    @pytest.mark.parametrize("name", [*NAMES.values(), "model.json"])
    def test_all_of_it_survives(self, world, tmp_path, name):
        world.Save(tmp_path / name, atts={"format": "openrave"} if name.endswith(".xml") else None)
        other = ravemj.load(tmp_path / name)
        assert compare(snapshots(world), snapshots(other)) == []
        robot = other.GetRobots()[0]
        held = robot.GetGrabbed()[0]
        T_held_robot = np.linalg.inv(held.GetTransform()) @ robot.GetLinks()[-1].GetTransform()
        robot.SetDOFValues([0.9], [0])
        moved = np.linalg.inv(held.GetTransform()) @ robot.GetLinks()[-1].GetTransform()
        np.testing.assert_allclose(moved, T_held_robot, atol=1e-12)
        assert robot.GetJoints()[0].GetStringParameters("maker") == " <Unimation> "
        assert robot.GetLinks()[1].GetGroupNumGeometries("coarse") == 2

    def test_what_is_not_saved_is_not_held(self, world, tmp_path):
        robot = world.GetRobots()[0]
        world.Save(tmp_path / "robot.dae", world.SelectionOptions.Body, robot.GetName())
        assert ravemj.load(tmp_path / "robot.dae").GetRobots()[0].GetGrabbed() == []

    @pytest.mark.parametrize("held", ["nobody", "r"])
    def test_held_bodies_that_are_not_there(self, held):
        env = ravemj.Environment()
        text = f'<Robot name="r"><KinBody><Body name="a"/></KinBody><grabbed body="{held}" link="a"/></Robot>'
        with pytest.warns(ravemj.RavemjWarning, match="no other body"):
            assert env.LoadData(text)
        with pytest.warns(ravemj.RavemjWarning, match="not above it"):
            assert env.LoadData(text.replace('"a"/></Robot>', '"b"/></Robot>').replace('"r"', '"s"', 1))


class TestDescriptions:
    @pytest.fixture
    def world(self, env, robot):
        env.SetDescription(" a <b>\n& c ")
        robot.SetDescription("seven\tjoints ")
        return env

    def test_stay_in_collada(self, world, robot, tmp_path):
        world.Save(tmp_path / "a.dae")
        other = ravemj.load(tmp_path / "a.dae")
        assert other.GetDescription() == world.GetDescription()
        assert other.GetRobots()[0].GetDescription() == robot.GetDescription()
        assert other.ReadRobotURI(str(tmp_path / "a.dae")).GetDescription() == robot.GetDescription()
        world.SetDescription("new")
        robot.SetDescription("")
        world.Save(tmp_path / "b.dae")
        assert ravemj.load(tmp_path / "b.dae").GetRobots()[0].GetDescription() == ""
        assert other.Load(str(tmp_path / "b.dae"))
        assert other.GetDescription() == "new"

    def test_of_the_environment_stay_where_a_file_has_none(self, world):
        world.LoadData('<KinBody name="k"><Body/></KinBody>')
        assert world.GetDescription() == " a <b>\n& c "

    def test_that_a_reference_does_not_give_are_written(self, tmp_path):
        env = ravemj.load(MODELS / "scara.dae")
        env.GetRobots()[0].SetDescription("picks")
        with pytest.warns(ravemj.RavemjWarning, match="description differs"):
            env.Save(tmp_path / "a.dae", atts={"externalref": "*"})
        assert ravemj.load(tmp_path / "a.dae").GetRobots()[0].GetDescription() == "picks"

    @pytest.mark.parametrize(
        ("name", "words"), [("a.xml", "descriptions are left out, of"), ("a.json", "description of")]
    )
    def test_are_missed_where_a_format_has_no_place_for_them(self, world, robot, tmp_path, name, words):
        with pytest.warns(ravemj.RavemjWarning, match=f"{words} '?{robot.GetName()}"):
            world.Save(tmp_path / name, atts={"format": "openrave"} if name.endswith("xml") else None)


class TestJson:
    """OpenRAVE's JSON: what infos say, as a file."""

    @pytest.mark.parametrize("links", ['<Body/><Body/><Body name="a"/>', "<Body/>"])
    def test_links_without_a_name(self, env, tmp_path, links):
        text = f'<KinBody name="k">{links}</KinBody>'
        env.LoadData(text)
        env.Save(tmp_path / "k.json", atts="k", options=env.SelectionOptions.Body)
        assert compare(read_data(text).scene, snapshots(ravemj.load(tmp_path / "k.json"))) == []

    def test_links_that_names_do_not_tell_apart(self, env, tmp_path):
        joint = '<Joint name="j"><Body></Body><Body>a</Body></Joint>'
        env.LoadData(f'<KinBody name="k"><Body/><Body name="a"/><Body/>{joint}</KinBody>')
        with pytest.raises(OutputError, match="several links of 'k' have no name"):
            env.Save(tmp_path / "k.json")
        assert contents(tmp_path) == {}

    def test_selection_and_what_is_skipped(self, env, tmp_path):
        env.SetDescription("words")
        env.LoadData(
            '<KinBody name="k"><Body name="a"><Geom type="box"><extents>1 1 1</extents></Geom></Body></KinBody>'
        )
        env.Save(tmp_path / "k.json", env.SelectionOptions.Body, [("target", "k"), ("skipwrite", "geometry")])
        other = ravemj.load(tmp_path / "k.json")
        assert [body.GetName() for body in other.GetBodies()] == ["k"]
        assert other.GetKinBody("k").GetLinks()[0].GetGeometries() == []
        assert other.GetDescription() == "words"
        env.Save(tmp_path / "k.txt", atts={"format": "json"})
        content = json.loads((tmp_path / "k.txt").read_text())
        assert [body["isRobot"] for body in content["bodies"]] == [True, False]

    def test_a_body_of_that_name_becomes_what_the_file_says(self, env, robot, tmp_path):
        robot.SetDOFValues([0.3, 0.4])
        env.Save(tmp_path / "a.json")
        robot.SetDOFValues([0, 0])
        assert env.Load(str(tmp_path / "a.json"))
        np.testing.assert_allclose(robot.GetDOFValues(), [0.3, 0.4], atol=1e-12)
        assert env.files[-1] == str(tmp_path / "a.json")

    @pytest.mark.parametrize("read", ["ReadRobotURI", "ReadKinBodyURI", "ReadInterfaceURI"])
    def test_a_body_is_read_without_being_added(self, env, robot, tmp_path, read):
        robot.SetDOFValues([0.3, 0.4])
        env.Save(tmp_path / "a.json", atts=robot.GetName())
        other = ravemj.Environment()
        body = getattr(other, read)(str(tmp_path / "a.json"))
        assert body.IsRobot()
        assert other.GetBodies() == []
        assert body.GetURI() == f"file:{tmp_path / 'a.json'}"
        other.Add(body)
        np.testing.assert_allclose(body.GetDOFValues(), [0.3, 0.4], atol=1e-12)
        np.testing.assert_allclose(body.GetLinkTransformations(), robot.GetLinkTransformations(), atol=1e-9)

    def test_a_body_becomes_a_robot_or_another_body(self, env, robot, tmp_path):
        env.LoadData('<KinBody name="k"><Body name="a"/></KinBody>')
        env.Save(tmp_path / "k.json", env.SelectionOptions.Body, "k")
        assert env.ReadRobotURI(str(tmp_path / "k.json")).IsRobot()
        env.Remove(robot)
        assert env.ReadRobotURI(robot, str(tmp_path / "k.json")) is robot
        assert (robot.GetName(), len(robot.GetLinks()), robot.IsRobot()) == ("k", 1, True)

    @pytest.mark.parametrize("content", ['{"bodies": []}', '{"bodies": [{"name": 7}]}', "[", None])
    def test_no_body_is_read_from_broken_files(self, env, tmp_path, content):
        if content is not None:
            (tmp_path / "a.json").write_text(content)
        assert env.ReadKinBodyURI(str(tmp_path / "a.json")) is None

    def test_what_json_cannot_say(self, env, tmp_path):
        env.LoadData('<KinBody name="k" makejoinedlinksadjacent="0"><Body name="a"/></KinBody>')
        with pytest.warns(ravemj.RavemjWarning, match="not-written"):
            env.Save(tmp_path / "k.json")

    @pytest.mark.parametrize(
        ("content", "words"),
        [
            (b"", "not well-formed"),
            (b'{"bodies": [', "not well-formed"),
            (b"[1]", "list of bodies"),
            (b'{"bodies": 1}', "list of bodies"),
            (b'{"bodies": [1]}', "bodies"),
            (b'{"bodies": [{"name": "b", "links": [{"name": "a", "mass": NaN}]}]}', "NaN"),
            (b'{"bodies": [{"name": "b", "links": [{"name": "a", "mass": "x"}]}]}', "mass"),
            (b'{"bodies": [{"name": "b", "links": [{"name": "a", "mass": 1' + b"0" * 400 + b"}]}]}", "number"),
            (b'{"bodies": [{"name": "b", "links": [{"transform": [1, 2]}]}]}', "transform"),
            (b'{"bodies": [{"name": "b", "links": [], "grabbed": [{"grabbedName": "x"}]}]}', "no body 'x'"),
            (b'{"bodies": ' + b"[" * 100_000, "nested too deep"),
            (b'{"bodies": [{"name": 7}]}', "should be a text"),
            (b'{"bodies": [], "gravity": [1]}', "wrong kind"),
            (b'{"bodies": [], "keywords": 7}', "wrong kind"),
            (b"\xff\xfe", "cannot be read"),
            (b'{"bodies": [[]]}', r"is \[\], and should be an object"),
            (b'{"bodies": [{"name": "b"}, {"name": "b"}]}', "two are called 'b'"),
            (b'{"bodies": [{"name": "b", "links": [{"name": "a"}, {"name": "a"}]}]}', "links: two are called 'a'"),
            (b'{"bodies": [{"name": "b", "dofValues": [{"value": 1}]}]}', "'jointName' is missing"),
            (b'{"bodies": [{"name": "\\ud800"}]}', "surrogates not allowed"),
        ],
    )
    def test_broken_files(self, tmp_path, content, words):
        (tmp_path / "a.json").write_bytes(content)
        with pytest.raises(SourceError, match=words):
            ravemj.load(tmp_path / "a.json")
        env = ravemj.Environment()
        assert not env.Load(str(tmp_path / "a.json"))
        assert not env.Load(str(tmp_path / "gone.json"))

    def test_marks_of_the_byte_order_are_no_content(self, tmp_path):
        (tmp_path / "a.json").write_bytes(b'\xef\xbb\xbf{"bodies": [{"name": "b", "links": [{"name": "a"}]}]}')
        assert ravemj.load(tmp_path / "a.json").GetBodies()[0].GetName() == "b"

    def test_values_of_joints_that_are_not_there(self, env, tmp_path):
        content = {"name": "b", "links": [{"name": "a"}], "dofValues": [{"jointName": "j", "value": 1}]}
        (tmp_path / "a.json").write_text(json.dumps({"bodies": [content]}))
        with pytest.warns(ravemj.RavemjWarning, match="a value is left out: 'b' has no axis 0 of a joint 'j'"):
            env.Load(str(tmp_path / "a.json"))

    def test_numbers_that_are_none_leave_the_file_alone(self, env, robot, tmp_path):
        (tmp_path / "a.json").write_text("before")
        robot.GetJoints()[0].SetFloatParameters("x", [float("inf")])
        with pytest.raises(OutputError, match="not finite"):
            env.Save(tmp_path / "a.json")
        assert contents(tmp_path) == {"a.json": b"before"}


def snapshots(env) -> Scene:
    return Scene(tuple(snapshot(body) for body in env.simulation.bodies))


@pytest.mark.parametrize(
    ("equation", "unread"),
    [
        ("sqrt(j)", {"sqrt"}),
        ("atan2(j, 2)", {"atan2"}),
        ("int(j) + cbrt(j)", {"int", "cbrt"}),
        ("SASA(3, j, 4) + SASS(3, j, 4)", {"SASA", "SASS"}),
        ("polyroots2(1, j, -1)", {"polyroots2"}),
        ("2^j", {"pow"}),
        ("j^2", set()),
        ("hypot(j, 2)", {"hypot"}),
        ("if(!(j < 1), 2, 3)", {"not"}),
        ("SSSA(3, 4, 5 + j) + 2*sin(j)", set()),
    ],
)
def test_functions_that_openrave_reads_as_0_in_collada(equation, unread, tmp_path):
    follower = f'<Joint name="m" enable="false" mimic_pos="{equation.replace("<", "&lt;")}">'
    joints = '<Joint name="j"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint><Body name="c"/>'
    scene = read_data(
        TWO_LINKS.format(f"{joints}{follower}<Body>b</Body><Body>c</Body><axis>0 0 1</axis></Joint>")
    ).scene
    diagnostics = Diagnostics()
    save(tmp_path / "model.dae", scene, diagnostics, "collada")
    told = " ".join(finding.message for finding in diagnostics if finding.code == "openrave-bug")
    assert {name for name in ("sqrt", "atan2", "int", "cbrt", "SASA", "SASS", "polyroots2", "pow", "hypot", "not")
            if f"{name}" in told.partition(" in the ")[0].replace(",", "").split()} == unread  # fmt: skip
    text = (tmp_path / "model.dae").read_text()
    assert ("<degree><cn>2</cn></degree>" in " ".join(text.split()).replace("> <", "><")) == ("sqrt" in unread)
    assert 'encoding="text"' not in text


def test_roots_come_back_as_roots(tmp_path):
    joints = '<Joint name="j"><Body>a</Body><Body>b</Body><axis>0 0 1</axis></Joint><Body name="c"/>'
    joints += '<Joint name="m" enable="false" mimic_pos="sqrt(j+1) + SSSA(3,4,5)"><Body>b</Body><Body>c</Body>'
    scene = read_data(TWO_LINKS.format(joints + "<axis>0 0 1</axis></Joint>")).scene
    assert check_round_trip(scene, "collada", tmp_path) == set()


def test_of_derivatives_in_collada_only_wrong_ones_are_left_out(tmp_path):
    joints = "".join(
        f'<Body name="{after}"/><Joint name="{name}"><Body>{before}</Body><Body>{after}</Body>'
        "<axis>0 0 1</axis></Joint>"
        for name, before, after in (("j", "b", "c"), ("k", "c", "d"))
    )
    joints += '<Body name="e"/><Joint name="m" enable="false" mimic_pos="j*k" mimic_vel="|j sin( |k j"><Body>d</Body>'
    scene = read_data(TWO_LINKS.format(joints + "<Body>e</Body><axis>0 0 1</axis></Joint>")).scene
    diagnostics = Diagnostics()
    save(tmp_path / "model.dae", scene, diagnostics, "collada")
    assert [finding.message for finding in diagnostics if finding.code == "not-written"] == [
        "joint 'm': cannot write the derivative 'sin(' by 'j'; left out"
    ]
    assert (tmp_path / "model.dae").read_text().count('type="first_partial"') == 1
