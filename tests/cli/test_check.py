"""``ravemj check``: what it says of models, in which form, and how it exits."""

import json
import re
from pathlib import Path

import pytest
from command_line import ravemj_command
from conftest import MODELS

from ravemj.cli.checking import check

ROBOT = """<Robot name="r">
  <Body name="lost"/>
  <KinBody>
    <diffuseColor>1 0 0</diffuseColor>
    <Mass type="mimicgeom"><total>9</total></Mass>
    <Body name="a"><Geom type="box"><Extent>1 1 1</Extent></Geom></Body>
    <Body name="b"><Geom type="box"><Extent>1 1 1</Extent></Geom></Body>
    <Body name="c"><Geom type="trimesh"><Data>gone.stl</Data></Geom></Body>
  </KinBody>
</Robot>
"""


@pytest.fixture
def folder(tmp_path) -> Path:
    files = {
        "robot.xml": ROBOT,
        "env.xml": '<Environment>\n<Robot file="robot.xml"/>\n</Environment>',
        "broken.xml": "<Robot>\n<KinBody>\n</Robot>\n",
        "missing.xml": '<Environment>\n<Robot file="gone.xml"/>\n</Environment>',
        "word.xml": '<KinBody name="k"><Body name="a"><Mass><total>1</total></Mass>\n'
        "<Translation>0 zero 0</Translation></Body></KinBody>",
        "light.xml": '<KinBody name="k"><Body name="a"/>\n<Body name="b"/><Body name="c" type="static"/></KinBody>',
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def codes(path: Path) -> list[tuple[str, str, int]]:
    return [(finding.severity, finding.code, finding.source.line) for finding in check(path)]


def test_a_clean_model_has_no_findings(folder):
    done = ravemj_command(folder, "check", MODELS / "env.xml", "--strict")
    assert (done.returncode, done.stdout, done.stderr) == (0, "0 errors, 0 warnings in 1 file\n", "")


def test_models_that_come_with_ravemj_are_checked_by_their_names(tmp_path):
    assert ravemj_command(tmp_path, "check", "pendulum").stdout == "0 errors, 0 warnings in 1 file\n"


def test_what_openrave_swallows_is_found_where_it_is(folder):
    found = codes(folder / "robot.xml")
    for finding in [
        ("warning", "unknown-tag", 2),
        ("warning", "ignored-tag", 4),
        ("warning", "openrave-bug", 5),
        ("warning", "unknown-tag", 6),
        ("warning", "unknown-tag", 7),
        ("warning", "missing-file", 8),
    ]:
        assert finding in found
    hints = {(finding.source.line, finding.code): finding.hint for finding in check(folder / "robot.xml")}
    assert hints[2, "unknown-tag"] == "<Body> belongs in <KinBody>"
    assert hints[5, "openrave-bug"] == "write <density>"
    assert hints[6, "unknown-tag"] == "did you mean 'extents'?"
    assert "OPENRAVE_DATA" in hints[8, "missing-file"]


def test_findings_of_the_translation_are_there(folder):
    (folder / "twins.xml").write_text(
        '<Environment><KinBody name="k"><Body name="a"/></KinBody>\n'
        '<KinBody name="l"><Body name="a"/></KinBody></Environment>'
    )
    assert ("warning", "renamed", 2) in codes(folder / "twins.xml")


def test_moving_links_without_a_mass_are_noted_and_are_no_warnings(folder):
    assert codes(folder / "light.xml") == [("note", "default-mass", 1), ("note", "default-mass", 2)]
    done = ravemj_command(folder, "check", "light.xml", "--strict")
    assert done.returncode == 0
    assert re.fullmatch(
        r"light.xml:1: note\[default-mass\]: .*1 kg.*<Mass.*\(and 1 more: line 2\)\n0 errors, 0 warnings in 1 file\n",
        done.stdout,
    )


def test_the_same_message_is_one_line_with_a_count(folder):
    lines = ravemj_command(folder, "check", "robot.xml").stdout.splitlines()
    (misspelt,) = (line for line in lines if "<Extent>" in line)
    assert misspelt.startswith("robot.xml:6: warning[unknown-tag]: ")
    assert misspelt.endswith("did you mean 'extents'? (and 1 more: line 7)")


def test_files_that_do_not_load_are_reported_and_stop_nothing(folder):
    names = ("broken.xml", "gone.xml", "missing.xml", "word.xml", ".", "robot.xml")
    done = ravemj_command(folder, "check", *names)
    assert (done.returncode, done.stderr) == (1, "")
    assert "Traceback" not in done.stdout
    for pattern in (
        r"broken.xml:3: error\[fatal\]: not well-formed",
        r"gone.xml: error\[fatal\]: there is no such file",
        r"missing.xml:2: warning\[missing-file\]: .*gone.xml",
        r"missing.xml:2: error\[fatal\]: .*; that comes of the missing-file above",
        r"word.xml:2: error\[bad-number\]: .*0 zero 0",
        r"\.: error\[fatal\]: this is a folder",
        r"robot.xml:2: warning",
    ):
        assert re.search(f"^{pattern}", done.stdout, re.MULTILINE), pattern
    assert re.search(r"^5 errors, \d+ warnings in 6 files\n\Z", done.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("words", "code"), [("robot.xml", 0), ("--strict robot.xml", 1), ("broken.xml", 1), ("light.xml", 0), ("", 2)]
)
def test_the_exit_code_says_how_bad_it_is(folder, words, code):
    assert ravemj_command(folder, "check", *words.split()).returncode == code


def test_json_has_stable_keys_and_where_a_file_was_included(folder):
    done = ravemj_command(folder, "check", "--json", "env.xml", "robot.xml", "broken.xml")
    assert (done.returncode, done.stderr) == (1, "")
    found = json.loads(done.stdout)
    keys = ["file", "line", "code", "severity", "message", "hint", "included_from"]
    assert all(list(entry) == keys for entry in found)
    first = found[0]
    assert (first["file"], first["line"], first["code"], first["severity"]) == (
        "robot.xml",
        2,
        "unknown-tag",
        "warning",
    )
    assert first["hint"] == "<Body> belongs in <KinBody>"
    assert first["included_from"] == {"file": "env.xml", "line": 2, "included_from": None}
    assert sum(entry["line"] == 2 and entry["code"] == "unknown-tag" for entry in found) == 1, "once for both models"
    assert found[-1]["code"] == "fatal"
    assert found[-1]["included_from"] is None
    assert json.loads(ravemj_command(folder, "check", "--json", MODELS / "env.xml").stdout) == []


@pytest.mark.parametrize(
    ("shape", "mass", "told"),
    [
        ('<Geom type="sphere"><radius>0</radius></Geom>', "<density>1000</density>", True),
        ('<Geom type="trimesh"><data>flat.off</data></Geom>', "<density>1000</density>", True),
        ('<Geom type="box"><extents>1 1 0</extents></Geom>', "<density>1000</density>", True),
        ('<Geom type="box"><extents>1 1 1</extents></Geom>', "<density>1000</density>", False),
        ('<Geom type="box"><extents>1 1 0</extents></Geom>', "<density>0</density>", False),
        ("", "<density>1000</density>", False),
    ],
)
def test_a_density_that_fills_nothing_is_reported(shape, mass, told, tmp_path):
    (tmp_path / "flat.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    body = f'<Body name="a">{shape}<Mass type="mimicgeom">{mass}</Mass></Body>'
    (tmp_path / "thin.xml").write_text(f'<KinBody name="k">{body}</KinBody>')
    assert ("no-volume" in {code for _, code, _ in codes(tmp_path / "thin.xml")}) == told
