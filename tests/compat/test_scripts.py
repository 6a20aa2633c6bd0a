"""Scripts as users of OpenRAVE wrote them, of its version 0.9 and later ones: each runs, and its answer is right.

What a script prints is compared with what follows from the sizes of its models: words as they are, numbers at 1e-6.
"""

import ast
import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import ravemj_command
from conftest import MODELS, TESTS, one_in

SCRIPTS = TESTS / "scripts"
NAMES = sorted(path.stem for path in SCRIPTS.glob("*.py"))
NEIGHBOURS = {"homework2_utils"}
UPPER, FORE, TOOL, HEIGHT = 0.4, 0.3, 0.08, 0.3
"""Lengths of the arm, and how high it is [m]."""


def tip(shoulder: float, elbow: float, beyond: float = FORE + TOOL) -> str:
    """Where the arm's tool is, or another point so far beyond the elbow."""
    x, y = (UPPER * f(shoulder) + beyond * f(shoulder + elbow) for f in (math.cos, math.sin))
    return f"{x} {y} {HEIGHT}"


def inertia_of_pendulum(elbow: float) -> tuple[float, float, float]:
    """The inertia matrix of two uniform boxes of 8 kg, 0.2 m long and 0.02 m wide; at the first one hangs a disk."""
    arm = 8 / 12 * (0.2**2 + 0.02**2)
    second = arm + 8 * 0.1**2
    coupling = second + 8 * 0.2 * 0.1 * math.cos(elbow)
    first = arm + 8 * 0.1**2 + 8 * 0.2**2 + 2 * coupling - second
    return first, coupling, second


M11, M12, M22 = inertia_of_pendulum(0)
GRAVITY = 8 * 9.81 * 0.1 * abs(math.sin(0.3 + 0.4))
DEEPER = math.hypot(0.5, 0.2)
STEP = 0.001

EXPECTED = {
    "camera": "camera 0.4 -2 0.2",
    "clone_parallel": "checked 33 first collision True\nhere 0\nsame True",
    "collision_report": """collision True\nlinks arm | wall wall\nall 'hand' 'left' 'right'\ncontacts True True 3
        fore alone False\nself False False""",
    "data_strings": """loaded True\nloaded True\nloaded True\ntwice BodyNameConflict\nbodies box0 box00 box 4
        robot arm 6 None\nrobot True 4\nbroken False False""",
    "example_main": "options data/room.env.xml True GenericPhysicsEngine mujoco\nlevel 3",
    "exceptions": """load False None None\nopenrave_exception InvalidArguments True
        openrave_exception InvalidArguments True\nopenrave_exception Assert True
        nothing\nopenrave_exception CommandNotSupported True
        openrave_exception InvalidArguments True\nopenrave_exception BodyNameConflict True
        lookups None None -1 None\nplugins False None None""",
    "fly": f"mug 0 0\nmug 0.5 {math.pi / 4}\nmug 1 {math.pi / 2}",
    "grasp": f"""open False False\nclosed True\ngrab True 'mug'\ncarried {tip(-1, 0, 0.4)}\nwall True True
        left {tip(-1, 0, 0.4)} 0""",
    "homework1": f"hand {tip(0.5, -0.9)} collision False\nhand {tip(1.3, 0.2)} collision True",
    "homework2_py2": """grid 5 half 2 2.5\nfree 23 of 25\nnames 'COLLISION', 'FREE'\nerror: InvalidArguments""",
    "ik": """no solver yet: Failed\ngoal 0.78 0.78\nmodel gripper Transform6D
        goal again True True\nback True""",
    "inertia_matrix": f"""M {M11} {M12} {M12} {M22}
        coupling {inertia_of_pendulum(0.4)[1]} gravity {GRAVITY}\nvalues 0 0""",
    "jacobian_control": f"reached 0.5 0.2 0.3 True\nspeed {0.5 * DEEPER}\nturning 1 1 0 0",
    "limits": "clamped True 5 0.04\nas is 3\nthrown InvalidArguments\nlimits True 3\nspeed 1\ngripper True",
    "link_data": """0 base 10 arm\n1 upper 2 arm\n2 fore 1 arm\n3 hand 0.2 arm\n4 left 0.05 arm\n5 right 0.05 arm
        total 13.3 com True\njoints ('shoulder', 0) ('elbow', 1) ('wrist', 2) ('finger', 3) 'other'
        chain 'shoulder' 'elbow' 'wrist'\naffects 1 0\nparent upper 0.4 0 0.3\nhash 32""",
    "link_statistics": f"weights 2 True\nresolutions {math.hypot(0.2, 0.01)}",
    "mobile_base": f"""base 1 2 0 {math.pi / 2}\nlimits -100 -100 100 100\ndofs 4 0 True
        tool {1 - 0.78 * math.sin(0.1)} {2 + 0.78 * math.cos(0.1)} 0.3
        spec ('joint_values', 1), ('affine_transform', 3)""",
    "multi_controller": "values 0.2 -0.3 0 0.03 True True\nvalues 0 0 0 0 True",
    "myrobot_py2": "x=0.380 y=0.400 z=0.300\n'no robot leg' 2 2.5\n4",
    "new_names": """renamed True 5\nhit True 1\nstatus True\nbody True\ninfos arm 2
        RaveGetEnvironment(1).GetKinBody('arm').GetLink('hand') True""",
    "old_boxes": """box 0.5 0.5 0.1 0.1 True\nbox 0.1 0.1 0.3 0.5 True\naabb 0 0 0.4 0.5 0.5 0.4
        collision False False\ncollision False\nnames 'boxes', 'ball', 'mesh'\nnames""",
    "old_names": """manip 1 elbow\narm 0 1 2 3 -1 1 0 0\nlimits 1 2 2 4 50 20\njacobians 1 1 (4, 4)
        quat -1 0 0 0 1 0 0\naffine 3 True\nstatus True True robot\nnames 'other', 'ball' 0.03""",
    "physics_fall": f"""fallen {9.8 / 2 * 0.2 * (0.2 + STEP):.2f} time 200000\nspeed {-9.8 * 0.2:.2f}
        rests 0.10 gravity 0 0 -9.8""",
    "plan": """basemanip worked\ntaskmanip worked\nplanner worked\nparameters worked\nretime worked\nsmooth worked
        grasping worked\nreachability - maps of what arms reach\nNone""",
    "play_trajectory": "points 3 duration 0.3\nmiddle 0.1 -0.05\narrived True\nvalues 0.1 0.3 True",
    "plotting": "without None None\nhandles 9 0\nwrong Failed\ncamera (4, 4)",
    "rays": """hit 0.4 -1 0 0\nhit 0.7 0 -1 0\ndown True 0.6 0 0.2 0 0 1\nrange False False""",
    "robot_in_code": "dofs 1 -1 2 3\ntool 0.5 0 0.1\nmass 2 0.05 0.05 0.2 0",
    "rotations": f"""quat {"0.70710678 0 0 0.70710678 " * 2}\npoint 1 3 3 1 3 3\ninverse 1 0 0 0 1 2 3
        slerp {math.pi / 4}\naxis angle 0 0 {math.pi / 2} 0 0 {math.pi}\nturned 0 1 0""",
    "sensors": """sensor eye arm:eye hand\ncamera 320 320 240\nlooks 0 1 0 0 0.7 0.35\nunknown None None 1
        image (240, 320, 3) uint8 160\nmade baselaser2d""",
    "stack": "box0 0.301 False\nbox1 0.452 False\nbox2 0.523 False",
    "state_saving": f"""inner 1 1\ncaught out\nouter 0 0 4 True\nheld 0 moved {0.8 * math.sin(1)}
        mug {tip(1, 0, 0.4)}\nmug {tip(1, 0, 0.4)}\noptions 4\noptions 0""",
    "threads": "wrong 0\nlocked False",
    "torques": "accelerations 0.5 -1",
    "trajectory_file": f"""{"at 0.5 0.125 0.5" + chr(10)}{"at 0.5 0.125 0.5" + chr(10)}at 0.5 0.125 0.5
        at 0.5 0.875 -0.5""",
    "uncaught": "before",
    "missing_plugin": "no plugin\nInvalidArguments\nInvalidArguments\n\nbasemanipulation",
    "whole_body": "feet stay True\nhand follows True\nover the feet True\nagain True 32",
    "velocity_play": "values 0.5 -0.25",
}
STATUS = {"exceptions": 3, "uncaught": 1}
ERRORS = {
    "homework2_py2": "^done$",
    "old_names": "fine",
    "uncaught": r'File "uncaught.py", line 4, in move\n    robot.SetDOFValues\(\[0.5\]\)',
}
"""What stands in the standard error output; a traceback only where there is one here."""


@pytest.fixture
def folder(tmp_path) -> Path:
    """The scripts with their models, to run in."""
    (tmp_path / "data").mkdir()
    for path in MODELS.glob("*.xml"):
        shutil.copy(path, tmp_path / "data")
    shutil.copytree(SCRIPTS, tmp_path, dirs_exist_ok=True)  # last: its mug is another one than that of ravemj
    return tmp_path


def words(text: str) -> list[list[str]]:
    """The words of each line, without brackets and commas around them."""
    return [re.sub(r"[\[\](),]", " ", line).split() for line in text.splitlines()]


def number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None


def same(word: str, expected: str) -> bool:
    found, wanted = number(word), number(expected)
    if found is None or wanted is None:
        return word == expected
    return abs(found - wanted) <= 1e-6


def agree(text: str, expected: str) -> bool:
    """Whether a text has the lines, words and numbers of another."""
    found, wanted = words(text), words(expected)
    return [len(line) for line in found] == [len(line) for line in wanted] and all(
        same(*pair) for lines in zip(found, wanted, strict=True) for pair in zip(*lines, strict=True)
    )


@pytest.mark.parametrize("name", one_in(2, [name for name in NAMES if name not in NEIGHBOURS]))
def test_script(name, folder):
    options = ["--py2"] if name.endswith("_py2") else []
    done = ravemj_command(folder, "run", *options, f"{name}.py")
    assert done.returncode == STATUS.get(name, 0), done.stderr
    assert agree(done.stdout, EXPECTED[name]), done.stdout
    assert re.search(ERRORS.get(name, ""), done.stderr, re.MULTILINE)
    assert ("Traceback" in done.stderr) == (STATUS.get(name) == 1)
    assert "AttributeError" not in done.stderr


def test_there_are_enough_scripts_and_each_says_what_it_prints():
    assert len(EXPECTED) >= 30
    assert set(EXPECTED) == set(NAMES) - NEIGHBOURS
    assert set(STATUS) | set(ERRORS) <= set(EXPECTED)


def test_texts_agree_when_words_and_numbers_do():
    assert agree("[1.  2.0000001] True\n", "1 2 True")
    for wrong in ("1 2", "1 2.1 True", "1 2 False", "1 2 True\nmore", "1 2 True 3", "True 2 True"):
        assert not agree("[1.  2.0000001] True\n", wrong)


def test_the_picture_is_one(folder):
    assert ravemj_command(folder, "run", "camera.py").returncode == 0
    picture = np.load(folder / "picture.npy")
    assert (picture.shape, picture.dtype) == ((120, 160, 3), np.uint8)
    assert picture[0, 0].tolist() == [0, 0, 0]  # the background
    row, column = 60 + 160 * (0.2 - 0.15) / 1.7, 80 + 160 * (0.7 - 0.4) / 1.7  # on the front of the table
    assert picture[round(row), round(column)].max() > 0


def test_examples_take_options(folder):
    options = ["--viewer=", "--physics", "ode", "--collision", "fcl_", "-l", "Warn", "--scene", "data/env.xml"]
    done = ravemj_command(folder, "run", "example_main.py", *options)
    assert agree(done.stdout, "options data/env.xml False ode fcl_\nlevel 2")


def test_the_files_of_trajectories_are_openraves(folder):
    assert ravemj_command(folder, "run", "trajectory_file.py").returncode == 0
    assert (folder / "mine.xml").read_text().startswith("<trajectory")
    assert b"joint_velocities" in (folder / "mine.traj").read_bytes()


def test_scripts_of_python_2_say_so(folder):
    done = ravemj_command(folder, "run", "homework2_py2.py")
    assert done.returncode == 1
    assert "--py2" in done.stderr


def test_no_script_knows_what_ravemj_calls_things():
    for path in SCRIPTS.glob("*.py"):
        if not path.stem.endswith(("_py2", "utils")):
            names = {node.attr for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Attribute)}
            assert "ravemj" not in path.read_text()
            assert not names & {"simulation_state", "model", "mjcf"}
