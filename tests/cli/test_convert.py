"""``ravemj convert``: results that MuJoCo opens anywhere, and that cost the user nothing."""

import importlib.util
import json
import os
import re
import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest
from command_line import ravemj_command
from conftest import REPOSITORY

import ravemj
from ravemj.cli import main

CASES = REPOSITORY / "tests" / "conformance" / "cases"
TETRAHEDRON = "0 0 0 0 1 0 1 0 0  0 0 0 1 0 0 0 0 1  0 0 0 0 0 1 0 1 0  1 0 0 0 1 0 0 0 1"
ARM = f"""<Robot name="r"><KinBody>
<Body name="a"><Geom type="trimesh"><Vertices>{TETRAHEDRON}</Vertices></Geom></Body>
<Body name="b"><Geom type="box"><Extents>.1 .1 .1</Extents></Geom></Body>
<Joint name="j" type="hinge"><Body>a</Body><Body>b</Body><axis>0 0 1</axis><limits>-1 2</limits><maxtorque>5</maxtorque>
<maxvel>3</maxvel></Joint></KinBody></Robot>
"""


def mesh_cases() -> list[Path]:
    """Return the models of the conformance suite that have meshes and load."""
    return [
        case
        for case in sorted(CASES.glob("*/case.xml"))
        if any(path.suffix in {".stl", ".obj"} for path in case.parent.rglob("*"))
        and json.loads((case.parent / "expected.json").read_text())["loads"]
    ]


@pytest.fixture
def folder(tmp_path) -> Path:
    (tmp_path / "arm.xml").write_text(ARM)
    (tmp_path / "plain.xml").write_text(
        ARM.replace("trimesh", "sphere").replace(f"<Vertices>{TETRAHEDRON}</Vertices>", "<Radius>1</Radius>")
    )
    return tmp_path


def listing(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def convert(folder: Path, *words: str) -> str:
    done = ravemj_command(folder, "convert", *words)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def refused(folder: Path, *words: str, code: int = 1) -> str:
    """Check that a command fails in one line and changes nothing."""
    before = listing(folder)
    done = ravemj_command(folder, "convert", *words)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (code, "", 1), done.stderr
    assert listing(folder) == before
    assert not list(folder.rglob(".ravemj-*"))
    return done.stderr


@pytest.mark.parametrize("target", ["out", "out/", "new.dir/"])
def test_a_folder_opens_in_mujoco_wherever_it_is(folder, target):
    assert (
        convert(folder, "arm.xml", "-o", target) == f"wrote {Path(target, 'arm.xml')} and 1 mesh in assets/ beside it\n"
    )
    moved = folder / "moved" / "here"
    moved.parent.mkdir()
    shutil.move(folder / target, moved)
    assert re.fullmatch(r"arm\.xml assets/mesh-[0-9a-f]{16}\.obj scene\.xml", " ".join(listing(moved)))
    model = mujoco.MjModel.from_xml_path(str(moved / "arm.xml"))
    assert [model.body(index).name for index in range(model.nbody)] == ["world", "a", "b"]
    assert model.nmesh == 1
    assert str(folder) not in (moved / "arm.xml").read_text()


def test_a_file_has_its_meshes_beside_it(folder):
    (folder / "there" / "assets").mkdir(parents=True)
    (folder / "there" / "assets" / "notes.txt").write_text("mine")
    convert(folder, "arm.xml", "-o", "there/arm.mjcf.xml")
    convert(folder, "plain.xml", "-o", "there/plain.xml")
    shutil.move(folder / "there", folder / "else")
    assert mujoco.MjModel.from_xml_path(str(folder / "else" / "arm.mjcf.xml")).nmesh == 1
    assert mujoco.MjModel.from_xml_path(str(folder / "else" / "plain.xml")).nmesh == 0
    assert (folder / "else" / "assets" / "notes.txt").read_text() == "mine"
    convert(folder, "plain.xml", "-o", "alone.xml")
    assert not (folder / "assets").exists()


def test_meshes_that_are_there_stay(folder):
    """Another model may need those of an older result, and the user's are the user's."""
    convert(folder, "arm.xml", "-o", "out.mjcf")
    (folder / "assets" / "mesh-of-mine.obj").write_text("mine")
    before = set((folder / "assets").iterdir())
    convert(folder, "plain.xml", "-o", "out.mjcf")
    assert set((folder / "assets").iterdir()) == before


def test_standard_output_is_for_models_without_meshes(folder):
    text = convert(folder, "plain.xml")
    assert convert(folder, "plain.xml", "-o", "-") == text
    assert mujoco.MjModel.from_xml_string(text).nq == 1
    assert "standard output" in refused(folder, "arm.xml")
    assert "-o FOLDER" in refused(folder, "arm.xml", "-o", "-")


def test_a_former_result_is_replaced_and_nothing_else_is(folder):
    convert(folder, "arm.xml", "-o", "out")
    (folder / "arm.xml").write_text(ARM.replace("1 0 1 0 0 ", "2 0 1 0 0 "))
    convert(folder, "arm.xml", "-o", "out")
    assert len(list((folder / "out" / "assets").iterdir())) == 1, "the old mesh is gone"
    (folder / "empty").mkdir()
    convert(folder, "arm.xml", "-o", "empty")
    assert (folder / "empty" / "arm.xml").is_file()
    assert "arm.xml" in refused(folder, "plain.xml", "-o", "out")
    (folder / "out" / "assets" / "notes.txt").write_text("mine")
    assert "assets/notes.txt" in refused(folder, "arm.xml", "-o", "out")
    (folder / "mine").mkdir()
    (folder / "mine" / "arm.xml").write_text("<mujoco/>")
    assert "did not make arm.xml" in refused(folder, "arm.xml", "-o", "mine")


def test_what_was_read_is_never_written(folder):
    (folder / "env.xml").write_text('<Environment><Robot file="arm.xml"/></Environment>')
    (folder / "link.xml").symlink_to("arm.xml")
    os.link(folder / "arm.xml", folder / "hard.xml")
    for target in ("env.xml", "arm.xml", "./arm.xml", "link.xml", "hard.xml", str(folder / "arm.xml")):
        assert "the model was read from" in refused(folder, "env.xml", "-o", target)
    refused(folder, "env.xml", "-o", ".")
    convert(folder, "arm.xml", "-o", "out")
    (mesh,) = (folder / "out" / "assets").iterdir()
    (folder / "again.xml").write_text(ARM.replace("<Vertices>", f"<Data>{mesh}</Data><Vertices>"))
    shutil.copy(folder / "again.xml", folder / "out.xml")
    (folder / "out" / "arm.xml").rename(folder / "out" / "again.xml")
    assert "the model was read from" in refused(folder, "again.xml", "-o", "out")


def test_a_target_that_cannot_be_written_is_one_line(folder):
    (folder / "assets").write_text("a file")
    assert "not a folder" in refused(folder, "arm.xml", "-o", "out.xml")
    assert "gone" in refused(folder, "arm.xml", "-o", "gone/out.xml")
    assert "gone" in refused(folder, "arm.xml", "-o", "gone/out/")
    assert "not a folder" in refused(folder, "arm.xml", "-o", "assets")
    assert "empty" in refused(folder, "arm.xml", "-o", "", code=2)
    assert "'floating'" in refused(folder, "arm.xml", "--base", "floating", code=2)


def test_json_of_openrave_and_back(folder):
    (folder / "k.env.xml").write_text("<Environment>" + ARM + "</Environment>")
    convert(folder, "k.env.xml", "-o", "k.json")
    assert "bodies" in json.loads((folder / "k.json").read_text())
    assert "no differences" in ravemj_command(folder, "diff", "k.env.xml", "k.json").stdout
    convert(folder, "k.json", "-o", "again.robot.xml")
    (folder / "broken.json").write_text("{")
    assert "not well-formed" in refused(folder, "broken.json", "-o", "x.dae")


def test_openrave_bases_fall_unless_they_are_static(folder):
    convert(folder, "plain.xml", "-o", "free.xml", "--base", "openrave")
    assert mujoco.MjModel.from_xml_path(str(folder / "free.xml")).nq == 8
    (folder / "static.xml").write_text((folder / "plain.xml").read_text().replace('name="a"', 'name="a" type="static"'))
    convert(folder, "static.xml", "-o", "fixed.xml", "--base", "openrave")
    assert mujoco.MjModel.from_xml_path(str(folder / "fixed.xml")).nq == 1
    convert(folder, "plain.xml", "-o", "hung.xml")
    assert mujoco.MjModel.from_xml_path(str(folder / "hung.xml")).nq == 1


@pytest.mark.parametrize(("kind", "range_"), [("position", [-1, 2]), ("velocity", [-3, 3]), ("torque", [-5, 5])])
def test_actuators_are_bounded_as_the_joints_are(folder, kind, range_):
    convert(folder, "plain.xml", "-o", "driven.xml", "--actuators", kind)
    model = mujoco.MjModel.from_xml_path(str(folder / "driven.xml"))
    assert (model.nu, model.actuator(0).name) == (1, "j")
    assert np.array_equal(model.actuator_ctrlrange[0], range_)


@pytest.mark.parametrize("base", ["fixed", "openrave"])
def test_joint_values_of_the_file_are_a_keyframe(folder, base):
    model = (folder / "plain.xml").read_text().replace("</Robot>", "<jointvalues>0.7</jointvalues></Robot>")
    (folder / "bent.xml").write_text(model)
    written = mujoco.MjModel.from_xml_string(convert(folder, "bent.xml", "-o", "-", "--base", base))
    data = mujoco.MjData(written)
    mujoco.mj_resetDataKeyframe(written, data, written.key("home").id)
    assert data.joint("j").qpos == [0.7]
    mujoco.mj_kinematics(written, data)
    (body,) = ravemj.load(folder / "bent.xml").GetBodies()
    np.testing.assert_allclose(data.body("b").xmat.reshape(3, 3), body.GetLinkTransformations()[1][:3, :3], atol=1e-12)
    assert written.nkey == 1


@pytest.mark.skipif(importlib.util.find_spec("coacd") is None, reason="needs CoACD")
def test_meshes_are_cut_where_that_is_asked_for(folder):
    case = next(case for case in mesh_cases() if "stl" in case.parent.name)
    assert main(["convert", str(case), "-o", str(folder / "cut"), "--decompose"]) == 0
    mujoco.MjModel.from_xml_path(str(folder / "cut" / "case.xml"))


def test_the_gravity_of_the_file_goes_with_it(folder):
    physics = '<PhysicsEngine type="ode"><odeproperties><gravity>0 0 -1.6</gravity></odeproperties></PhysicsEngine>'
    (folder / "moon.xml").write_text(f'<Environment>{physics}<Robot file="plain.xml"/></Environment>')
    convert(folder, "moon.xml", "-o", "moon.mjcf.xml")
    assert mujoco.MjModel.from_xml_path(str(folder / "moon.mjcf.xml")).opt.gravity.tolist() == [0, 0, -1.6]


@pytest.mark.filterwarnings("ignore::ravemj.RavemjWarning")
@pytest.mark.parametrize("case", mesh_cases(), ids=lambda case: case.parent.name)
def test_models_with_meshes_open_after_moving(case, tmp_path, capsys):
    assert main(["convert", str(case), "-o", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    shutil.move(tmp_path / "out", tmp_path / "moved")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "moved" / "case.xml"))
    env = ravemj.load(case)
    assert model.nmesh == env.model.nmesh
    assert np.allclose(model.geom_rbound, env.model.geom_rbound)
