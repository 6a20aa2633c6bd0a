"""``ravemj grasp``: what is printed, the page, exit codes."""

import re

import pytest
from command_line import ravemj_command

WALL = """<KinBody name="wall"><Body name="w"><Geom type="box"><Extents>0.06 0.06 0.06</Extents></Geom></Body>
</KinBody>"""
TWO = """<Environment><KinBody name="a"><Body><Geom type="box"><Extents>1 1 1</Extents></Geom></Body></KinBody>
<KinBody name="b"><Body><Geom type="box"><Extents>1 1 1</Extents></Geom></Body></KinBody></Environment>"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "wall.xml").write_text(WALL)
    (tmp_path / "two.env.xml").write_text(TWO)
    return tmp_path


def test_a_box_on_the_floor_and_the_page(folder):
    done = ravemj_command(folder, "grasp", "panda", "box", "-o", "grasps.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert "Grasps of 'box' by 'arm' of 'Panda', the best first" in done.stdout
    rows = re.findall(
        r"^ +(\d+) +(0\.\d+) +0\.\d+ +\d+ +(?:turns about|slides along) .*held", done.stdout, re.MULTILINE
    )
    assert len(rows) > 3
    assert float(rows[0][1]) > 0
    assert re.search(r"^ *\d+ +touches 'floor' first$", done.stdout, re.MULTILINE)
    assert "shaken: 0.2 kg, friction 0.4, fingers press with 20 N" in done.stdout
    page = (folder / "grasps.html").read_text()
    for text in ("grasps of", "1: quality", "the arm is number 1", "red ones limit the quality"):
        assert text in page


@pytest.mark.stress
def test_out_of_reach_are_grasps_of_the_hand_alone(folder):
    done = ravemj_command(folder, "grasp", "panda", "box", "--at", "3,0,0.2", "--method", "antipodal", "-o", "x.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert re.search(r"^out of reach: .* so these are grasps of the hand alone$", done.stdout, re.MULTILINE)
    assert "the arm is" not in (folder / "x.html").read_text()


@pytest.mark.stress
def test_the_manipulator_with_a_gripper_is_taken(folder):
    camera = "<Manipulator name='camera'><base>bar</base><effector>bar</effector></Manipulator></Robot>"
    text = BALL.replace("</Robot>", camera).replace('<Manipulator name="hand">', "<Manipulator name='arm'>")
    first, second = re.findall(r"<Manipulator.*?</Manipulator>", text, re.DOTALL)
    (folder / "two.xml").write_text(text.replace(first, "").replace(second, second + first))
    done = ravemj_command(folder, "grasp", "two.xml", "box", "--method", "antipodal")
    assert (done.returncode, done.stderr) == (0, "")
    assert "by 'arm' of 'post'" in done.stdout
    done = ravemj_command(folder, "grasp", "two.xml", "box", "--manip", "camera")
    assert "'camera' has no gripper joints that close, and arm has some" in done.stderr


BALL = """<Robot name="post"><KinBody>
  <Body name="base"/>
  <Body name="bar"><offsetfrom>base</offsetfrom><Translation>0 0 0.4</Translation></Body>
  <Body name="left"><offsetfrom>bar</offsetfrom>
    <Geom type="box"><Translation>0.006 0 0</Translation><Extents>0.005 0.01 0.03</Extents></Geom></Body>
  <Body name="right"><offsetfrom>bar</offsetfrom>
    <Geom type="box"><Translation>-0.006 0 0</Translation><Extents>0.005 0.01 0.03</Extents></Geom></Body>
  <Joint name="ball" type="spherical"><Body>base</Body><Body>bar</Body></Joint>
  <Joint name="l" type="slider"><Body>bar</Body><Body>left</Body><axis>1 0 0</axis><limits>0 0.04</limits></Joint>
  <Joint name="r" type="slider"><Body>bar</Body><Body>right</Body><axis>-1 0 0</axis><limits>0 0.04</limits></Joint>
</KinBody>
<Manipulator name="hand"><base>base</base><effector>bar</effector><direction>0 0 1</direction>
  <joints>l r</joints><closingdirection>-1 -1</closingdirection></Manipulator></Robot>"""


@pytest.mark.stress
def test_where_no_pose_can_be_solved_are_grasps_of_the_hand_alone(folder):
    (folder / "post.xml").write_text(BALL)
    done = ravemj_command(folder, "grasp", "post.xml", "box", "--method", "antipodal")
    assert (done.returncode, done.stderr) == (0, "")
    assert re.search(r"^joint .ball. .*; so these are grasps of the hand alone$", done.stdout, re.MULTILINE)


def test_a_wall_is_too_wide_for_the_jaws(folder):
    done = ravemj_command(
        folder, "grasp", "panda", "wall.xml", "--at", "0.6,0,0.4", "--method", "antipodal", "-o", "x.html"
    )
    assert (done.returncode, done.stderr) == (1, "")
    assert re.search(r"^ *\d+ +too wide$", done.stdout, re.MULTILINE)
    assert not (folder / "x.html").exists()


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        ("panda", 2, "TARGET"),
        ("panda nothing", 1, "TARGET: 'nothing' is no body of the model (Panda), no shipped model and no file"),
        ("panda Panda", 1, "'Panda' is the robot that grasps"),
        ("panda two.env.xml", 1, "two.env.xml has 2 bodies; expected one"),
        ("panda box --at 1,2", 1, "--at: found 2, expected x,y,z or x,y,z,qw,qx,qy,qz"),
        ("panda box --at 0,0,0,0,0,0,0", 1, "--at: the quaternion is 0 0 0 0"),
        ("panda box --friction 0", 2, "--friction"),
        ("panda box --method magic", 2, "--method"),
        ("panda box -o grasps.png", 1, "'.png' is none of .html"),
        ("panda box --manip leg", 1, "there is no manipulator 'leg'"),
        ("puma560 box", 1, "no gripper joints that close"),
        ("pendulum box", 1, "has no manipulator"),
        ("gone.xml box", 1, "gone.xml"),
    ],
)
def test_bad_input_is_one_line(folder, words, code, message):
    done = ravemj_command(folder, "grasp", *words.split())
    assert done.returncode == code
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
