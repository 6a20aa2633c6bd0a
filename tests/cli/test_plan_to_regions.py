"""``ravemj plan`` to regions: near a point, upright, from files; and what it says of wrong ones."""

import html
import json
import re

import numpy as np
import pytest
from command_line import ravemj_command

import ravemj


def said(done):
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.fixture
def folder(tmp_path):
    return tmp_path


def panda_after(folder):
    """The hand of the Panda along the motion that was written."""
    env = ravemj.load(ravemj.model_path("panda"))
    robot = env.GetRobots()[0]
    names = [joint.GetName() for joint in robot.GetJoints()]
    poses = [robot.GetActiveManipulator().GetTransform()]
    for values in ravemj.read_motion(folder / "plan.csv", names, robot.GetDOFValues()).values:
        robot.SetDOFValues(values)
        poses.append(robot.GetActiveManipulator().GetTransform())
    return poses


def test_near_a_point_and_upright(folder):
    words = ("--near", "0.4,0.3,0.5", "--within", "0.02", "--upright", "3", "-o", "plan.csv")
    said(ravemj_command(folder, "plan", "panda", *words))
    first, *poses = panda_after(folder)
    assert np.abs(poses[-1][:3, 3] - [0.4, 0.3, 0.5]).max() <= 0.021
    upright = first[:3, :3].T[:, 2]  # the vertical, in the hand
    leans = [np.degrees(np.arccos(np.clip((pose[:3, :3] @ upright)[2], -1, 1))) for pose in poses]
    assert max(leans) <= 3.1


def test_regions_of_a_file(folder):
    regions = [
        {"T0_w": [1, 0, 0, 0, 0, 0, 9], "name": "sky"},
        {
            "T0_w": [0, 1, 0, 0, 0.4, 0.2, 0.5],
            "Bw": [[0, 0]] * 5 + [[-3.2, 3.2]],
            "name": "top",
            "frame": "Panda/link0",
        },
    ]
    (folder / "goals.json").write_text(json.dumps(regions))
    printed = said(ravemj_command(folder, "plan", "panda", "--region", "goals.json", "-o", "plan.csv"))
    assert ", to region 'top'\n" in printed
    assert panda_after(folder)[-1][:3, 3] == pytest.approx([0.4, 0.2, 0.5], abs=1e-3)


@pytest.mark.stress
def test_a_region_out_of_reach_says_so(folder):
    done = ravemj_command(folder, "plan", "panda", "--near", "2,0,0", "-o", "plan.png")
    why = r"ravemj: error: no motion: no goal: out of reach: 200 of 200 poses \(.* 1.1\d* m away\) \(region 'near'\)\n"
    assert (done.returncode, done.stdout) == (1, "")
    assert re.fullmatch(why, done.stderr)
    assert not (folder / "plan.png").exists()


def notes_of(page):
    return re.findall(r"<p>(.*?)</p>", html.unescape(page.read_text()))


def test_the_page_of_a_plan_has_its_reasons_and_its_certificate(folder):
    words = ("plan", "workshop", "--manip", "panda_arm", "--near", "0.5,-0.2,0.3", "--within", "0.1")
    printed = said(ravemj_command(folder, *words, "-o", "plan.html"))
    found, certified, reasons = notes_of(folder / "plan.html")
    assert printed.startswith(f"{found}\n{certified}\n")
    assert certified.startswith("certified: smallest gap")
    drawn, parts = re.fullmatch(r"(\d+) poses of region 'near': (.+)", reasons).groups()
    assert sum(int(part.split()[0]) for part in parts.split(", ")) == int(drawn)


def test_a_failed_plan_has_a_page_of_its_reasons_with_examples(folder):
    done = ravemj_command(folder, "plan", "workshop", "--manip", "panda_arm", "--near", "0.5,0,0", "-o", "plan.html")
    assert done.returncode == 1
    why, reasons = notes_of(folder / "plan.html")
    assert why in done.stderr
    assert re.fullmatch(r"200 poses of region 'near': .*\d+ in collision.*", reasons)
    assert (folder / "plan.html").stat().st_size > 50_000


def test_a_page_without_notes_has_none(folder):
    said(ravemj_command(folder, "play", "panda", "--to", "0,0,0,-1,0,1,0,0", "-o", "play.html"))
    assert notes_of(folder / "play.html") == []


WRONG = [
    ("{", "not JSON"),
    ("[]", "the list of regions is empty"),
    ("[3]", "region 0 is 3"),
    ('{"T0w": 3}', "there is no field 'T0w'"),
    ('{"Bw": [[0, 1]]}', "shape (6, 2)"),
    ('{"Bw": [[1, 0], [0, 0], [0, 0], [0, 0], [0, 0], [0, 0]]}', "x has the lower bound 1 above the upper one 0"),
    ('{"T0_w": "there"}', "could not convert"),
    ('{"lean": "little"}', "lean"),
    ('{"frame": "cup"}', "there is no body or link 'cup'"),
]


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_wrong_files_are_named(folder, text, message):
    (folder / "goals.json").write_text(text)
    done = ravemj_command(folder, "plan", "panda", "--region", "goals.json")
    assert done.returncode == 1
    assert done.stderr.startswith("goals.json: error: ")
    assert message in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--near", "1,2"), "--near: found 2 numbers, expected x,y,z"),
        (("--within", "0.1", "--to", "0,0,0,0,0,0,0"), "give the point as --near x,y,z"),
        (("--near", "1,2,3", "--within", "-1"), "-1 is not above 0"),
        (("--region", "gone.json"), "gone.json: error: cannot read the file: no such file"),
    ],
)
def test_wrong_options_are_named(folder, words, message):
    done = ravemj_command(folder, "plan", "panda", *words)
    assert done.returncode
    assert message in done.stderr
