"""Robots in URDF on the command line."""

import re

import pytest
from command_line import ravemj_command

from ravemj.formats.readers import read_file

BOX = '<collision><geometry><box size="0.1 0.1 {}"/></geometry></collision>'
LIMIT = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'


def arm(tool_length):
    """An arm of three joints about z, whose links lie over each other; its tool may reach down to the first link."""
    shapes = {"a": BOX.format(0.1), "b": "", "c": "", "tool0": BOX.format(tool_length)}
    links = "".join(f'<link name="{name}">{shape}</link>' for name, shape in shapes.items())
    joints = "".join(
        f'<joint name="j{child}" type="revolute"><origin xyz="0 0 0.1"/><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="0 0 1"/>{LIMIT}</joint>'
        for parent, child in (("a", "b"), ("b", "c"), ("c", "tool0"))
    )
    return f'<robot name="r">{links}{joints}</robot>'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "touching.urdf").write_text(arm(1.0))
    (tmp_path / "apart.urdf").write_text(arm(0.1))
    return tmp_path


def test_links_that_always_touch_are_listed_and_written(folder):
    done = ravemj_command(folder, "check", "touching.urdf", "--self", "--write-srdf", "touching.srdf")
    assert done.returncode == 0, done.stderr
    assert "links 'a' and 'tool0' touch at the start, and in 100 % of 1000 random configurations" in done.stdout
    reading = read_file(folder / "touching.urdf")
    assert reading.scene.bodies[0].adjacent == ((0, 3),)
    again = ravemj_command(folder, "check", "touching.urdf", "--self", "--write-srdf", "more.srdf")
    assert "no links of 'r' touch" in again.stdout
    assert (folder / "more.srdf").read_text() == (folder / "touching.srdf").read_text()
    assert ravemj_command(folder, "check", "--self", "--strict", "touching.urdf").returncode == 0


def test_links_that_are_apart_are_not_listed(folder):
    done = ravemj_command(folder, "check", "apart.urdf", "--self")
    assert (done.returncode, done.stdout) == (0, "apart.urdf: no links of 'r' touch at the start or almost always\n")
    assert ravemj_command(folder, "check", "touching.urdf", "--self", "--strict").returncode == 1


def test_a_start_in_collision_with_itself_names_the_command(folder):
    bent = arm(0.1).replace('<origin xyz="0 0 0.1"/>', '<origin xyz="0.2 0 0"/>')
    (folder / "bent.urdf").write_text(bent)
    (folder / "start.json").write_text("[2.1, 2.1, 0]")
    done = ravemj_command(folder, "plan", "bent.urdf", "--from", "start.json", "--to=0,0,0")
    assert done.returncode == 1
    wanted = r"no motion: start: .*link 'a' of 'r' with link 'tool0' of 'r'.*ravemj check bent.urdf --self lists"
    reverse = r"no motion: start: .*link 'tool0' of 'r' with link 'a' of 'r'.*ravemj check bent.urdf --self lists"
    assert re.search(f"{wanted}|{reverse}", done.stderr), done.stderr


def test_guesses_are_one_line(folder):
    done = ravemj_command(folder, "info", "apart.urdf")
    (line,) = done.stderr.splitlines()
    assert "a guessed manipulator: 'tool0' (3 joints)" in line


@pytest.mark.parametrize(
    ("words", "pattern"),
    [
        (["info", "desk_arm", "--state", "redy"], "there is no group state 'redy'; did you mean 'ready'"),
        (["info", "desk_arm", "--package", "x=/nowhere"], "'/nowhere' is no folder"),
        (["info", "desk_arm", "--package", "x"], "should be NAME=FOLDER"),
        (["info", "desk_arm", "--arg", "x=1"], "should be NAME:=VALUE"),
        (["ik", "desk_arm", "--to", "0.3,0,0.1,1,0.3,0,0"], "a pose has six parts, and the arm 5 joints"),
        (["plan", "desk_arm", "--pose", "0.3,0,0.1,1,0.3,0,0"], "TranslationDirection5D"),
    ],
)
def test_mistakes_say_what_to_do(folder, words, pattern):
    done = ravemj_command(folder, *words)
    assert done.returncode in {1, 2}
    assert pattern in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_states_are_listed_and_taken(folder):
    done = ravemj_command(folder, "info", "desk_arm", "--state", "ready")
    assert "Named configurations" in done.stdout
    assert re.search(r"elbow +-0.2 to 2.6 rad +1.5 ", done.stdout)


def test_a_urdf_converts_to_the_same_robot(folder):
    done = ravemj_command(folder, "convert", "desk_arm", "-o", "arm.dae")
    assert (done.returncode, done.stderr) == (0, "")
    done = ravemj_command(folder, "diff", "desk_arm", "arm.dae")
    assert done.returncode == 0, done.stdout
