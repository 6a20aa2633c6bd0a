"""MJCF that ``convert`` wrote comes back as it was: bodies without a difference, text byte for byte."""

import json
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import one_in
from hypothesis import given
from hypothesis import strategies as st
from strategies import examples

import ravemj
from ravemj.formats.readers import read_file
from ravemj.model.comparison import compare

MODELS = ("models/puma560.xml", "models/panda.xml", "models/workshop.env.xml", "models/biped.robot.xml",
          "models/scara.dae", "models/desk_arm/urdf/desk_arm.urdf", "models/double-pendulum.xml")  # fmt: skip
ROOT = Path(__file__).parents[2]

OPTIONS = {
    "nothing": {},
    "free": {"base": "free"},
    "servos": {"actuators": "position", "sensors": True},
    "motors": {"actuators": "torque", "timestep": 0.01},
    "no self collision": {"self_collision": False},
    "no excludes": {"exclude": "none"},
    "small hulls": {"hull_vertices": 12},
}


def convert(model: Path, target: Path, **options) -> str:
    env = ravemj.Environment()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ravemj.RavemjWarning)
        assert env.Load(model)
        env.write_mjcf(target, **options)
    return target.read_text()


def read(path: Path):
    reading = read_file(path)
    assert reading.failure is None
    return reading


@pytest.mark.parametrize("options", one_in(2, list(OPTIONS)))
@pytest.mark.parametrize(
    "model", [pytest.param(model, marks=[pytest.mark.stress] if "workshop" in model else []) for model in MODELS]
)
def test_what_is_converted_comes_back(model, options, tmp_path):
    (tmp_path / "again").mkdir()
    first = convert(ROOT / model, tmp_path / "model.xml", **OPTIONS[options])
    assert compare(read(ROOT / model).scene, read(tmp_path / "model.xml").scene) == []
    again = convert(tmp_path / "model.xml", tmp_path / "again" / "model.xml", **OPTIONS[options])
    assert again == first
    names = sorted(path.name for path in tmp_path.glob("assets/*"))
    assert names == sorted(path.name for path in tmp_path.glob("again/assets/*"))


@pytest.fixture(scope="module")
def puma(tmp_path_factory) -> str:
    return convert(ROOT / "models" / "puma560.xml", tmp_path_factory.mktemp("puma") / "puma.xml")


def differences(text: str, edited: str, folder: Path) -> list[tuple[str, str]]:
    assert text != edited
    (folder / "first.xml").write_text(text)
    (folder / "second.xml").write_text(edited)
    found = compare(read(folder / "first.xml").scene, read(folder / "second.xml").scene)
    return [(one.part, one.quantity) for one in found]


EDITS = {
    "mass": (r'mass="30"', 'mass="31"', ("'PUMA560' link 'base'", "mass")),
    "limits": (r'range="-2\.79\S* [\d.]+"', 'range="-1 2"', ("'PUMA560' joint 'joint1'", "upper")),
    "torque": (r'actuatorfrcrange="-97\.6 97\.6"', 'actuatorfrcrange="-5 5"',
               ("'PUMA560' joint 'joint1'", "max torque")),
    "axis": (r'axis="0 1 0"', 'axis="1 0 0"', ("'PUMA560' joint 'joint1'", "direction")),
    "pose": (r'(name="link2") pos="0\.4318 0 0"', r'\1 pos="0.5 0 0"', ("'PUMA560' link 'link2'", "pose")),
    "tool": (r'(<site name="arm") pos="[^"]*"', r'\1 pos="0 0 0.3"', ("'PUMA560' manipulator 'arm'", "tool")),
    "size": (r'size="0\.16 0\.015"', 'size="0.2 0.015"', ("'PUMA560' link 'base' shape 0", "radius")),
    "shape": (r' *<geom class="geom1" [^>]*size="0\.16 0\.015"[^>]*>\n', "", ("'PUMA560' link 'base'", "shapes")),
    "pairs": ("  <custom>", '  <contact><exclude body1="base" body2="link5"/></contact>\n  <custom>',
              ("'PUMA560'", "adjacent links")),
}  # fmt: skip


@pytest.mark.parametrize("what", EDITS)
def test_an_edited_model_wins_over_its_text(what, puma, tmp_path):
    pattern, new, expected = EDITS[what]
    assert expected in differences(puma, re.sub(pattern, new, puma, count=1), tmp_path)


DAMAGES = {
    "json": ('data=\'{"body"', "data='{\"body"),
    "types": ('"links":[', '"links":[3,'),
    "parts": ('"is_robot":true', '"is_robot":"yes"'),
    "joints": ('<joint name="joint1"', '<joint name="other"'),
}


@pytest.mark.parametrize("what", DAMAGES)
def test_a_damaged_text_is_a_warning(what, puma, tmp_path):
    (tmp_path / "model.xml").write_text(puma.replace(*DAMAGES[what], 1))
    reading = read(tmp_path / "model.xml")
    assert [found.code for found in reading.diagnostics if found.severity == "warning"] == ["damaged-text"]
    (body,) = reading.scene.bodies
    assert len(body.joints) == 6


def test_mujoco_keeps_the_text(puma):
    mujoco = pytest.importorskip("mujoco")
    texts = {text.name: text.data for text in mujoco.MjSpec.from_string(puma).texts}
    assert list(texts) == ["ravemj/PUMA560", "ravemj"]
    assert json.loads(texts["ravemj/PUMA560"])["body"]["name"] == "PUMA560"


def test_sites_mark_the_tools(puma):
    assert re.search(r'<site name="arm" pos="0 0 [\d.]+" group="4"/>', puma)


def test_places_of_the_first_file_are_kept(puma, tmp_path):
    (tmp_path / "model.xml").write_text(puma)
    source = read(tmp_path / "model.xml").scene.bodies[0].links[0].source
    assert source.file == "puma560.xml"
    assert source.included_from is not None
    assert source.included_from.file == str(tmp_path / "model.xml")


@examples(30)
@given(st.integers(0, 10**6), st.sampled_from(["", "0", '"', "]", "9", "-"]))
def test_texts_damaged_anywhere_are_read_or_left_out(puma, tmp_path, place, new):
    start, end = puma.index("data='") + 6, puma.index("'/>")
    place = start + place % (end - start)
    (tmp_path / "model.xml").write_text(puma[:place] + new + puma[place + 1 :])
    reading = read(tmp_path / "model.xml")
    assert len(reading.scene.bodies[0].links) == 7


def test_edited_numbers_are_near_those_that_were_written(puma, tmp_path):
    (tmp_path / "model.xml").write_text(puma.replace('mass="13"', 'mass="13.5"', 1))
    body = read(tmp_path / "model.xml").scene.bodies[0]
    np.testing.assert_allclose([link.inertial.mass for link in body.links[:2]], (30, 13.5))
