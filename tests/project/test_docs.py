"""What the documents show works, and the files that they point at are there."""

import re
import shlex
import sys
from pathlib import Path

import pytest
import tutorial
from command_line import ravemj_command
from conftest import REPOSITORY

import ravemj
import ravemj.compat.openravepy
from ravemj.cli.parser import make_parser

PAGES = [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.stem not in tutorial.PAGES], ids=lambda page: page.name
)
def test_python_runs(page, tmp_path, monkeypatch, capsys):
    """The tutorials have tests of their own."""
    (tmp_path / "models").symlink_to(REPOSITORY / "models")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "openravepy", ravemj.compat.openravepy)  # as in `ravemj run`
    session: dict[str, object] = {"__name__": "__main__"}  # a page is read from its top
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), session)
    if page.name == "README.md":
        assert capsys.readouterr().out.startswith("2 [0. 0.]\n[[")
        assert (tmp_path / "swing.mp4").stat().st_size > 1000


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_are_understood(page):
    for block in [*blocks(page, "sh"), *blocks(page, "console")]:
        for line in block.splitlines():
            words = shlex.split(re.split(r" [|>] ", line)[0], comments=True)
            if words[:1] == ["ravemj"]:
                make_parser().parse_args(words[1:])
            elif words and words[0].startswith("./"):
                assert (REPOSITORY / words[0]).is_file()


def commands_that_end():
    """Return the commands of README and of the help, but for those that wait for a user or change this Python."""
    shown = [*blocks(REPOSITORY / "README.md", "sh"), *blocks(REPOSITORY / "docs" / "cli.md", "console")]
    commands = [shlex.split(re.split(r" [|>] ", line)[0], comments=True) for line in "".join(shown).splitlines()]
    ending = (words for words in commands if words[0] == "ravemj" and words[1] not in {"view", "shell", "alias"})
    return [words[1:] for words in ending if "-i" not in words]


@pytest.mark.parametrize("words", commands_that_end(), ids=" ".join)
def test_commands_work(tmp_path, words):
    (tmp_path / "models").symlink_to(REPOSITORY / "models")
    for name, source in {
        "env.xml": "env.xml",
        "double-pendulum.xml": "double-pendulum.xml",
        "arm.xml": "puma560.xml",
        "robot.xml": "panda.xml",
        "old.robot.xml": "panda.xml",
        "new.robot.xml": "panda.xml",
        "camera.json": "tutorial-camera.json",
    }.items():
        (tmp_path / name).write_bytes((REPOSITORY / "models" / source).read_bytes())
    (tmp_path / "swing.csv").write_text("time,Joint0,Joint1\n0,0,0\n0.2,1,-1\n")
    for script in ("myscript.py", "oldscript.py"):
        (tmp_path / script).write_text("import openravepy\nassert openravepy.Environment().Load('env.xml')\n")
    expanded = [path for word in words for path in ([*tmp_path.glob(word)] if "*" in word else [word])]  # as shells do
    done = ravemj_command(tmp_path, *expanded)
    assert (done.returncode, done.stderr) == (0, "")


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
