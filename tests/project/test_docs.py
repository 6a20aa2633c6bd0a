"""What the documents show works, and the files that they point at are there."""

import re
import shlex
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
import tutorial
from command_line import Served, ravemj_command
from conftest import REPOSITORY, one_in

import ravemj
import ravemj.compat.openravepy

PAGES = [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(
    "page",
    [
        *one_in(5, [page for page in PAGES if page.stem not in {*tutorial.PAGES, "regions", "sensors"}]),
        *(pytest.param(REPOSITORY / "docs" / name, marks=pytest.mark.stress) for name in ("regions.md", "sensors.md")),
    ],
    ids=lambda page: page.name,
)
def test_python_runs(page, tmp_path, monkeypatch, capsys):
    """The tutorials have tests of their own."""
    for name in ("env.xml", "double-pendulum.xml"):  # which readers have from the tutorial
        (tmp_path / name).write_bytes((REPOSITORY / "models" / name).read_bytes())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "openravepy", ravemj.compat.openravepy)  # as in `ravemj run`
    session: dict[str, object] = {"__name__": "__main__"}  # a page is read from its top
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), session)
    if page.name == "README.md":
        assert capsys.readouterr().out.startswith("2 [0. 0.]\n[[")
        assert (tmp_path / "swing.mp4").stat().st_size > 1000


ROBOT = """<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="continuous"><parent link="a"/>
<child link="b"/><limit effort="1" velocity="1"/></joint></robot>"""

EXECUTED_BY = {
    "./scripts/play": ".ci/bare",
    "./scripts/test": ".ci/bare",
    "pip install .": ".ci/wheel",
    "ravemj alias --install": "tests/compat/test_sessions.py",  # which has an environment to spoil
    "ravemj alias --remove": "tests/compat/test_sessions.py",
    "ravemj learn check --watch": "tests/learn/test_commands.py",
    "python docs/examples/hanoi.py": "tests/project/test_examples.py",
    "python docs/examples/hanoi.py towers.mp4": "tests/project/test_examples.py",
}
"""What executes the commands that are not executed here."""

LONG = (
    "doctor",
    "grasp",
    "ik puma560 --to",
    "mirror robot.urdf",
    "plan",
    "play pendulum -o",
    "sweep",
    "view --web --port",
    "view models",
    "view workshop",
)
"""How commands begin that take longer than most; ``tests/cli`` has shorter tests of each."""

SEVERAL = {"README.md", "cli.md"}
"""Pages whose commands do not need one another."""


CLEARANCE = """
def measure(env, items, random):
    return {"distance": env.GetRobots()[0].batch_distances(items, itself_too=True)}
"""
"""A module with a function for ``ravemj sweep``."""


def commands(page: Path) -> list[str]:
    """Return the commands of a page, without comments and what shells do with their output."""
    lines = "".join(blocks(page, "(?:console|sh|bash)")).splitlines()
    return [re.split(r" +#| [|>] ", line)[0].strip() for line in lines if line.strip()]


def sequences() -> list[object]:
    """Return the commands to execute, those of one folder together, none of them twice."""
    found: dict[tuple[str, ...], str] = {}
    for page in PAGES:
        shown = [] if page.stem in tutorial.PAGES else [line for line in commands(page) if line not in EXECUTED_BY]
        for lines in [[line] for line in shown] if page.name in SEVERAL else [shown]:
            found.setdefault(tuple(line for line in lines if (line,) not in found), page.name)
    found.pop((), None)
    first = {"README.md", "CONTRIBUTING.md"}  # the commands of other pages take minutes
    few = [lines for lines, page in found.items() if page == "cli.md" and not lines[0].startswith("ravemj grasp")][::6]

    def is_quick(lines: tuple[str, ...], page: str) -> bool:
        return (page in first or lines in few) and not lines[0].removeprefix("ravemj ").startswith(LONG)

    return [
        pytest.param(lines, id=" & ".join(lines), marks=[] if is_quick(lines, page) else [pytest.mark.stress])
        for lines, page in found.items()
    ]


@pytest.mark.parametrize("lines", sequences())
def test_commands_work(tmp_path, lines):
    (tmp_path / "models").symlink_to(REPOSITORY / "models")
    for folder in ("docs/pictures", "docs/motions", "robots"):
        (tmp_path / folder).mkdir(parents=True)
    for name, source in {
        "env.xml": "env.xml",
        "double-pendulum.xml": "double-pendulum.xml",
        "arm.xml": "puma560.xml",
        "robot.xml": "panda.xml",
        "robots/arm.robot.xml": "panda.xml",
        "old.robot.xml": "panda.xml",
        "new.robot.xml": "panda.xml",
        "camera.json": "tutorial-camera.json",
        "table.env.xml": "env.xml",
        "en_1.xml": "env.xml",
    }.items():
        (tmp_path / name).write_bytes((REPOSITORY / "models" / source).read_bytes())
    (tmp_path / "swing.csv").write_text("time,Joint0,Joint1\n0,0,0\n0.2,1,-1\n")
    np.save(tmp_path / "goals.npy", np.tile(ravemj.matrixFromPose([1, 0, 0, 0, 0.4, 0.2, 0.6]), (5, 1, 1)))
    (tmp_path / "clearance.py").write_text(CLEARANCE)
    for robot in ("robot.urdf", "ur5.urdf"):
        (tmp_path / robot).write_text(ROBOT)
    (tmp_path / "plan.csv").write_text("time,j\n0,0\n1,0.5\n")
    (tmp_path / "measured.json").write_text('{"j": 0.001}')
    for script in ("myscript.py", "oldscript.py"):
        (tmp_path / script).write_text("import openravepy\nassert openravepy.Environment().Load('env.xml')\n")
    solved = (REPOSITORY / "tests" / "learn" / "solutions" / "fk_1.py").read_bytes()
    for folder in (tmp_path, tmp_path / "students" / "anna"):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "fk_1.py").write_bytes(solved)
    for line in lines:
        program, *words = shlex.split(line)
        assert program == "ravemj"
        if words[0] in {"view", "mirror"}:
            with Served(tmp_path, *words) as page:
                code, *printed = page.end(signal.SIGINT)
                assert (code, printed) == (0, ["", ""]) or (code, words[0]) == (0, "mirror"), line
            continue
        expanded = [
            path for word in words for path in ([*tmp_path.glob(word)] if "*" in word else [word])
        ]  # as shells do
        done = ravemj_command(tmp_path, *expanded)
        assert (done.returncode, done.stderr) == (0, ""), line


@pytest.mark.parametrize(("command", "place"), EXECUTED_BY.items())
def test_the_others_are_executed_elsewhere(command, place):
    words = {"hanoi.py": "examples", "pip": "pip"}
    text = (REPOSITORY / place).read_text()
    assert next((word for part, word in words.items() if part in command), command.split()[-1].strip("./")) in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), target


def test_the_first_screen_has_the_picture_and_the_commands():
    first_screen = "\n".join((REPOSITORY / "README.md").read_text().splitlines()[:30])
    pictures = ("swing.webp", "arms.png", "plan.webp")
    for piece in (*pictures, "URDF", "MJCF", "./scripts/play", "./scripts/test", "import ravemj"):
        assert piece in first_screen
    shown = "\n".join(blocks(REPOSITORY / "README.md", "sh"))
    for command in re.findall(r"`(ravemj (?:play|ik|plan) [^`]+)`", first_screen):
        assert command in shown, "commands of the blocks are executed"


@pytest.mark.parametrize("package", ["mink", "gymnasium", "mujoco.mjx"])
def test_the_model_works_elsewhere(package, tmp_path, monkeypatch):
    """Blocks of the page that need packages of their own."""
    pytest.importorskip(package)
    page = REPOSITORY / "docs" / "simulation.md"
    monkeypatch.chdir(tmp_path)
    session: dict[str, object] = {"__name__": "__main__"}
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), session)
    (shown,) = (block for block in blocks(page, "py") if package.rpartition(".")[2] in block)
    exec(compile(shown, str(page), "exec"), {"__name__": "__main__"})
