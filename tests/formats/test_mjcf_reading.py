"""MJCF in: models of MuJoCo as bodies, with MuJoCo's own numbers."""

import json
import lzma
import os
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA
from hypothesis import given
from hypothesis import strategies as st
from mjcf_truth import check_model, loaded
from strategies import examples

import ravemj
from ravemj.formats.file_access import FileAccess
from ravemj.formats.readers import read_file

EDGES = json.loads((DATA / "mjcf" / "edges.json").read_text())
TRUTH = json.loads(lzma.decompress((DATA / "mjcf" / "truth.json.xz").read_bytes()))
MODELS = Path(os.environ.get("RAVEMJ_MJCF_DATA", ""))
needs_models = pytest.mark.skipif(
    not os.environ.get("RAVEMJ_MJCF_DATA"),
    reason="the models are not here: RAVEMJ_MJCF_DATA names the folder of the unpacked wheels",
)

ARM = """<mujoco model="arm"><compiler angle="radian"/>
<worldbody>
<geom name="floor" type="plane" size="0 0 1"/>
<body name="base"><geom type="box" size="0.1 0.1 0.05" contype="0" conaffinity="0" group="2"/>
 <geom type="box" size="0.1 0.1 0.05" group="3"/>
<body name="upper" pos="0 0 0.1"><joint name="shoulder" axis="0 1 0" range="-2 2" ref="0.5"/>
 <geom type="capsule" size="0.03" fromto="0 0 0 0 0 0.4"/>
<body name="fore" pos="0 0 0.4"><joint name="elbow" axis="0 1 0" range="0.2 2.5"/>
 <geom type="capsule" size="0.02" fromto="0 0 0 0 0 0.3"/>
<body name="hand" pos="0 0 0.3"><joint name="twist" axis="0 0 1"/><geom size="0.03" rgba="1 0 0 0.5"/>
 <site name="attachment_site" pos="0 0 0.05"/><site name="target1_site"/></body></body></body></body>
</worldbody>
<actuator><motor joint="shoulder" gear="20" ctrlrange="-2 2"/><position joint="elbow" forcerange="-9 9"/></actuator>
<keyframe><key name="other" qpos="0 1 0"/><key name="home" qpos="0.7 1.5 0.1"/></keyframe>
</mujoco>"""


def read(text: str, folder: Path, name: str = "model.xml", **files: str) -> ravemj.Environment:
    for file, content in files.items():
        (folder / f"{file}.xml").write_text(content)
    (folder / name).write_text(text)
    return loaded(folder / name)


def findings(env: ravemj.Environment, code: str) -> list[str]:
    return [finding.message for finding in env.diagnostics if finding.code == code]


@pytest.mark.parametrize("name", EDGES)
def test_edge_cases_have_the_numbers_of_mujoco(name, tmp_path):
    for file, text in {**EDGES[name].get("files", {}), f"{name}.xml": EDGES[name]["xml"]}.items():
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_text(text)
    check_model(loaded(tmp_path / f"{name}.xml"), EDGES[name]["mujoco"])


@needs_models
@pytest.mark.parametrize("name", TRUTH["models"])
def test_models_have_the_numbers_of_mujoco(name):
    check_model(loaded(MODELS / name), TRUTH["models"][name])


@needs_models
@pytest.mark.parametrize("name", TRUTH["refused_by_mujoco"])
def test_what_mujoco_refuses_is_refused_with_a_place(name):
    env = ravemj.Environment()
    with pytest.raises(ravemj.SourceError) as caught:
        ravemj.load(MODELS / name, into=env)
    assert caught.value.source.file.startswith(str(MODELS))


def test_a_model_becomes_a_robot(tmp_path):
    env = read(ARM, tmp_path)
    robot, world = env.GetBodies()
    assert (world.GetName(), world.IsRobot(), world.GetLinks()[0].IsStatic()) == ("world", False, True)
    assert robot.IsRobot()
    assert [joint.GetName() for joint in robot.GetJoints()] == ["shoulder", "elbow", "twist"]
    np.testing.assert_allclose(robot.GetDOFValues(), (0.7, 1.5, 0.1), atol=1e-12)  # the keyframe home
    np.testing.assert_allclose(robot.GetDOFTorqueLimits(), (40, 9, 0))
    assert robot.GetJoint("twist").IsCircular(0)
    arm = robot.GetManipulators()[0]
    assert (arm.GetName(), arm.GetBase().GetName(), arm.GetEndEffector().GetName()) == (
        "attachment_site",
        "base",
        "hand",
    )
    np.testing.assert_allclose(arm.GetLocalToolTransform()[:3, 3], (0, 0, 0.05))
    assert len(robot.GetManipulators()) == 1
    np.testing.assert_allclose(env.GetPhysicsEngine().GetGravity(), (0, 0, -9.81))


def test_what_is_drawn_and_what_collides(tmp_path):
    robot = read(ARM, tmp_path).GetRobots()[0]
    drawn, collides = robot.GetLink("base").GetGeometries()
    assert (drawn.IsVisible(), collides.IsVisible()) == (True, False)
    assert collides.GetType() == ravemj.GeometryType.Box
    (hand,) = robot.GetLink("hand").GetGeometries()
    np.testing.assert_allclose(hand.GetDiffuseColor(), (1, 0, 0))
    assert hand.GetTransparency() == 0.5


def test_a_text_is_read_like_a_file():
    env = ravemj.Environment()
    assert env.LoadData(ARM)
    assert env.GetRobots()[0].GetDOF() == 3


def test_names_and_prefixes_that_are_given(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    env = ravemj.Environment()
    robot = env.ReadRobotURI(tmp_path / "arm.xml", {"prefix": "left_"})
    assert {link.GetName() for link in robot.GetLinks()} == {"left_base", "left_upper", "left_fore", "left_hand"}


def test_masks_that_forbid_pairs_make_them_adjacent(tmp_path):
    text = ARM.replace('name="shoulder"', 'name="shoulder" armature="0.1"')
    text = text.replace("<worldbody>", '<default><geom contype="2" conaffinity="1"/></default><worldbody>', 1)
    robot = read(text, tmp_path).GetRobots()[0]
    pairs = {frozenset(pair) for pair in robot.GetAdjacentLinks()}
    assert pairs == {frozenset(pair) for pair in ((0, 1), (1, 2), (2, 3), (0, 2), (0, 3), (1, 3))}
    assert not robot.CheckSelfCollision()


def test_excluded_pairs_are_adjacent(tmp_path):
    text = ARM.replace("<actuator>", '<contact><exclude body1="base" body2="hand"/></contact><actuator>')
    pairs = set(read(text, tmp_path).GetRobots()[0].GetAdjacentLinks())
    assert (0, 3) in pairs
    assert (1, 3) not in pairs


def test_what_is_lost_is_said_once_for_each_kind(tmp_path):
    env = read(ARM.replace('name="elbow"', 'name="elbow" stiffness="3"'), tmp_path)
    assert sorted(findings(env, "left-out")) == [
        "actuators are left out but for the limits that they give joints, 2 in the model",
        "sites that mark no tool are left out, 1 in the model",
        "springs of joints are left out, 1 in the model",
    ]


def test_loops_are_left_out_with_a_warning(tmp_path):
    env = read(EDGES["loops"]["xml"], tmp_path)
    messages = findings(env, "left-out")
    assert "<connect> is left out, 1 in the model: closed loops stay open" in messages
    assert "<weld> is left out, 1 in the model: bodies that it holds together move apart" in messages


def test_values_outside_limits_are_one_finding(tmp_path):
    text = ARM[: ARM.index("<keyframe>")].replace('range="-2 2" ref="0.5"', 'range="1 2"') + "</mujoco>"
    env = read(text, tmp_path)
    (message,) = findings(env, "value-outside-limits")
    assert message.endswith("(and 1 more joints of it)")


def test_a_follower_is_not_clamped_by_its_own_limits(tmp_path):
    text = ARM.replace("<actuator>", '<equality><joint joint1="elbow" joint2="shoulder" polycoef="0 2 0.5 0 0"/>'
                       "</equality><actuator>")  # fmt: skip
    robot = read(text, tmp_path).GetRobots()[0]
    robot.SetDOFValues([-1.5, 0])
    joint = next(joint for joint in robot.GetPassiveJoints() if joint.GetName() == "elbow")
    moved = -1.5 - 0.5
    assert joint.GetValue(0) == pytest.approx(2 * moved + 0.5 * moved**2)


BROKEN = {
    "a number": ('size="0.03" fromto', 'size="x" fromto', 7, "bad format in attribute 'size'"),
    "a mass": ('<geom size="0.03" rgba="1 0 0 0.5"/>', "", 10, "mass and inertia of moving bodies"),
    "a name": ('joint="elbow"', 'joint="elbo"', 13, "elbo"),
    "a mesh": ('<geom size="0.03" ', '<geom type="mesh" mesh="m" ', 10, "mesh"),
    "a plugin": ("<worldbody>", '<extension><plugin plugin="mujoco.pid"/></extension><worldbody>', 2, "plugins"),
    "copies": ("<worldbody>", '<worldbody><replicate count="99999999"/>', 2, "99,999,999 copies"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_errors_have_a_place(kind, tmp_path):
    old, new, line, words = BROKEN[kind]
    (tmp_path / "model.xml").write_text(ARM.replace(old, new, 1))
    with pytest.raises(ravemj.SourceError, match=words) as caught:
        ravemj.load(tmp_path / "model.xml")
    assert caught.value.source == (str(tmp_path / "model.xml"), line, None)


def test_errors_in_included_files_have_their_place(tmp_path):
    start, end = ARM.index("<body"), ARM.index("</worldbody>")
    part = f"<mujocoinclude>\n{ARM[start:end]}</mujocoinclude>"
    (tmp_path / "part.xml").write_text(part.replace('<geom size="0.03" rgba="1 0 0 0.5"/>', ""))
    (tmp_path / "model.xml").write_text(f'{ARM[:start]}<include file="part.xml"/>{ARM[end:]}')
    with pytest.raises(ravemj.SourceError) as caught:
        ravemj.load(tmp_path / "model.xml")
    source = caught.value.source
    assert (source.file, source.line) == (str(tmp_path / "part.xml"), 8)
    assert source.included_from.file == str(tmp_path / "model.xml")


def test_a_part_of_a_model_names_the_file_that_includes_it(tmp_path):
    (tmp_path / "part.xml").write_text("<mujocoinclude/>")
    (tmp_path / "whole.xml").write_text('<mujoco><include file="part.xml"/></mujoco>')
    with pytest.raises(ravemj.SourceError, match=r"open whole\.xml, which includes it"):
        ravemj.load(tmp_path / "part.xml")


def test_a_missing_mesh_is_named_where_it_stands(tmp_path):
    text = ARM.replace("<worldbody>", '<asset>\n<mesh file="nowhere.stl"/></asset><worldbody>', 1)
    (tmp_path / "model.xml").write_text(text)
    with pytest.raises(ravemj.SourceError, match=r"nowhere\.stl") as caught:
        ravemj.load(tmp_path / "model.xml")
    assert caught.value.source.line == 3


def test_a_model_that_includes_itself_is_refused(tmp_path):
    (tmp_path / "model.xml").write_text('<mujoco><include file="other.xml"/></mujoco>')
    (tmp_path / "other.xml").write_text('<mujoco><include file="model.xml"/></mujoco>')
    with pytest.raises(ravemj.SourceError, match="includes itself"):
        ravemj.load(tmp_path / "model.xml")


def test_a_model_inside_of_xml_says_what_to_do(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    (tmp_path / "env.xml").write_text('<Environment file="arm.xml"/>')
    with pytest.raises(ravemj.SourceError, match="load it in addition"):
        ravemj.load(tmp_path / "env.xml")


def test_dropped_models_read_only_what_was_dropped(tmp_path):
    dropped, outside = tmp_path / "dropped", tmp_path / "outside"
    dropped.mkdir()
    outside.mkdir()
    (outside / "part.xml").write_text("<mujocoinclude><option/></mujocoinclude>")
    (outside / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    for element in ('<include file="../outside/part.xml"/>', '<asset><mesh file="../outside/mesh.obj"/></asset>'):
        (dropped / "model.xml").write_text(ARM.replace("<worldbody>", f"{element}<worldbody>", 1))
        path = str(dropped / "model.xml")
        assert read_file(path).failure is None  # its user opens it
        failure = read_file(path, access=FileAccess.dropped(path)).failure
        assert failure is not None
        assert "is not read: it is outside of what was dropped" in failure.message


def test_named_files_are_those_of_the_model(tmp_path):
    (tmp_path / "part.xml").write_text("<mujocoinclude><option/></mujocoinclude>")
    (tmp_path / "model.xml").write_text(ARM.replace("<worldbody>", '<include file="part.xml"/><worldbody>', 1))
    reading = read_file(str(tmp_path / "model.xml"))
    assert reading.files == (str(tmp_path / "model.xml"), str(tmp_path / "part.xml"))


@examples(100)
@given(
    name=st.sampled_from(sorted(EDGES)),
    place=st.integers(0, 10**6),
    length=st.integers(0, 40),
    new=st.sampled_from(["", "0", '"', "<", "nan"]),
)
def test_damaged_models_are_read_or_refused(tmp_path, name, place, length, new):
    text = EDGES[name]["xml"]
    place %= len(text)
    (tmp_path / "model.xml").write_text(text[:place] + new + text[place + length :])
    failure = read_file(str(tmp_path / "model.xml")).failure
    assert failure is None or failure.source.file.startswith(str(tmp_path))
