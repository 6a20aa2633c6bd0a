"""Does a little of the work of every command with an installed ravemj: ``PYTHON commands.py`` in a folder of models."""

import json
import re
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Callable
from pathlib import Path

import av
import mujoco
import numpy as np
from PIL import Image

import ravemj
from ravemj.cli.parser import make_parser

PROGRAM = Path(sys.executable).with_name("ravemj")
SCRIPT = "import openravepy\nenv = openravepy.Environment()\nenv.Load('env.xml')\nprint(env.GetRobots()[0].GetDOF())\n"


def main() -> None:
    """Try every command that the parser knows."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # a shell's background jobs ignore Ctrl-C
        signal.signal(signal.SIGINT, signal.default_int_handler)
    assert Path(ravemj.__file__).is_relative_to(sys.prefix), f"{ravemj.__file__} is not in {sys.prefix}"
    for trial in trials():
        trial()


def trials() -> list[Callable[[], None]]:
    """Return the trial of each command that the parser knows: the function of its name."""
    commands = make_parser()._actions[-1].choices  # argparse has no public way to them
    return [globals()[name] for name in commands or ()]


def printed(*words: str | Path, typed: str = "") -> str:
    """Run a program that succeeds, and return what it prints."""
    done = subprocess.run(words, input=typed, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return done.stdout


def do(*words: str, typed: str = "") -> str:
    """Run a command of ravemj, and return what it prints."""
    return printed(PROGRAM, *words, typed=typed)


def view() -> None:
    """Serve a page."""
    with subprocess.Popen([PROGRAM, "view", "--web", "env.xml"], stdout=subprocess.PIPE, text=True) as viewing:
        assert viewing.stdout
        try:
            with urllib.request.urlopen(viewing.stdout.readline().strip(), timeout=60) as page:
                assert b"<canvas" in page.read()
        finally:
            viewing.terminate()


def mirror() -> None:
    """Save the state that lines of text have."""
    words = [PROGRAM, "mirror", "--web", "env.xml", "--csv", "state.txt", "--save-state", "state.json"]
    Path("state.txt").write_text("Joint0=0.5 Joint1=-1\n")
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as mirroring:
        assert mirroring.stdout
        assert mirroring.stdout.readline().startswith("http")
        mirroring.send_signal(signal.SIGINT)
        assert mirroring.stdout.read() == "wrote state.json\n"
    assert json.loads(Path("state.json").read_text()) == {"Joint0": 0.5, "Joint1": -1}


def play() -> None:
    """Play the pendulum, from hanging to upright."""
    do("play", "env.xml", "-o", "pendulum.mp4", "--camera", "tutorial-camera.json")
    with av.open("pendulum.mp4") as video:
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
    assert len(frames) == 31
    hanging, upright = (frame.min(axis=2) < 128 for frame in (frames[0], frames[-1]))
    assert np.mean(hanging[:240]) < np.mean(hanging[240:])
    assert np.mean(upright[:240]) > np.mean(upright[240:])


def render() -> None:
    """Draw a robot on the background that is asked for."""
    do("render", "panda.xml", "-o", "panda.png", "--size", "320x240", "--background", "0,0,1")
    picture = np.asarray(Image.open("panda.png"))
    assert picture.shape == (240, 320, 3)
    assert 0.1 < np.mean((picture == [0, 0, 255]).all(axis=2)) < 0.99


def convert() -> None:
    """Write what MuJoCo loads."""
    do("convert", "panda.xml", "-o", "panda/")
    assert mujoco.MjModel.from_xml_path("panda/panda.xml").njnt > 7


def check() -> None:
    """Find nothing wrong."""
    assert do("check", "env.xml") == "0 errors, 0 warnings in 1 file\n"


def diff() -> None:
    """Find no difference between a robot and what is saved of it."""
    do("convert", "puma560.xml", "-o", "puma560.dae")
    assert do("diff", "puma560.xml", "puma560.dae") == "no differences in 1 body\n"


def info() -> None:
    """Tell the numbers of a COLLADA file, and of a model that the wheel brings."""
    assert [body["dof"] for body in json.loads(do("info", "scara.dae", "--json"))["bodies"]] == [4]
    assert Path(ravemj.model_path("puma560")).is_relative_to(sys.prefix)
    assert [body["dof"] for body in json.loads(do("info", "puma560", "--json"))["bodies"]] == [6]


def ik() -> None:
    """Find all joint values for a pose."""
    solutions = json.loads(do("ik", "puma560", "--to", "0.3,0.3,0.9,0.7071,0,0.7071,0", "--json"))
    assert len(solutions) > 1
    assert any(solution["valid"] for solution in solutions)


def plan() -> None:
    """Find a motion from hanging to upright."""
    do("plan", "pendulum", "--to", "3,0", "-o", "plan.csv")
    assert Path("plan.csv").read_text().startswith("time,")


def grasp() -> None:
    """Find grasps of a box of the wheel, by its parallel jaws."""
    assert "grasps of" in do("grasp", "panda.xml", "box", "--method", "antipodal", "-o", "grasps.html")
    assert Path("grasps.html").read_text().startswith("<!doctype html>")


def learn() -> None:
    """Solve an exercise."""
    do("learn", "start", "robotics")
    file = Path("robotics", "fk_1.py")
    file.write_text(file.read_text().replace("    ...\n", "    return [l1 * np.cos(q1), 0]\n"))
    words = [PROGRAM, "learn", "check", "fk-1", "--folder", "robotics"]
    wrong = subprocess.run(words, text=True, capture_output=True, check=False)
    assert wrong.returncode == 1
    assert "0 of 20 answers are right" in wrong.stdout


def sweep() -> None:
    """Label configurations in two processes."""
    do("sweep", "panda.xml", "collides", "--count", "2000", "--jobs", "2", "-o", "labels")
    labels = ravemj.Sweep.open("labels").arrays("collides")
    assert 0 < labels.sum() < len(labels) == 2000


def run() -> None:
    """Run a script that imports openravepy."""
    Path("script.py").write_text(SCRIPT)
    assert do("run", "script.py") == "2\n"


def shell() -> None:
    """Answer a question about the robot."""
    question = "robot.SetDOFValues([np.pi, 0])\nprint('pi is', robot.GetDOFValues()[0])\n"
    assert "pi is 3.14" in do("shell", "env.xml", typed=question)


def alias() -> None:
    """Let the script run by itself, and no longer."""
    do("alias", "--install")
    assert printed(sys.executable, "script.py") == "2\n"
    assert do("alias", "--remove").startswith("removed ")


def doctor() -> None:
    """Say that rays draw at least."""
    assert re.search(r"^ *ray +yes", do("doctor"), re.MULTILINE)


def completion() -> None:
    """Print what bash runs."""
    assert "ravemj" in do("completion", "bash")


if __name__ == "__main__":
    main()
