"""``ravemj learn`` as students and teachers use it, and ``%learn`` in IPython."""

import json
import os
import re
import signal
import subprocess
import sys

import numpy as np
import pytest
from command_line import environment, ravemj_command
from IPython.core.interactiveshell import InteractiveShell
from PIL import Image
from waiting import PATIENCE, time_limit

import ravemj
from ravemj.learn.course import our_course
from ravemj.learn.magic import learn, notebook

RIGHT = "return [l1 * np.cos(q1) + l2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 * np.sin(q1 + q2)]"
ABSOLUTE = RIGHT.replace("q1 + q2", "q2")


@pytest.fixture
def fill(tmp_path):
    """Starts a folder, and writes lines into the hole of fk-1."""
    assert ravemj_command(tmp_path, "learn", "start", ".").returncode == 0

    def fill(lines):
        file = tmp_path / "fk_1.py"
        original = our_course().exercise("fk-1").original.read_text()
        file.write_text(original.replace("    ...\n", f"    {lines}\n"))

    return fill


def test_a_student_solves_one(fill, tmp_path):
    assert "still has ... in it" in ravemj_command(tmp_path, "learn", "check", "fk-1").stdout
    fill(ABSOLUTE)
    wrong = ravemj_command(tmp_path, "learn", "check", "fk-1")
    assert wrong.returncode == 1
    assert re.search(r"tried +hand_position\(.*\n +yours +\[.*\n +expected +\[.*\n +off by", wrong.stdout)
    assert "the second link points along q1 + q2" in wrong.stdout
    assert "3. x is l1 cos(q1)" in ravemj_command(tmp_path, "learn", "hint", "fk-1", "--number", "3").stdout
    fill(RIGHT)
    assert ravemj_command(tmp_path, "learn", "check", "fk_1.py").returncode == 0
    files = {exercise.original.name for exercise in our_course().exercises}
    assert {path.name for path in tmp_path.iterdir()} == {".ravemj-learn.json", *files}
    for name in files - {"fk_1.py", "fk_2.py"}:
        (tmp_path / name).unlink()  # each one takes a moment to check
    listed = ravemj_command(tmp_path, "learn").stdout
    assert f"1 of {len(files)} solved" in listed


def test_files_are_watched(fill, tmp_path):
    for exercise in our_course().exercises:  # fk-1 is the next one then
        if exercise.name != "fk-1":
            (tmp_path / exercise.original.name).unlink()
    words = [sys.executable, "-m", "ravemj", "learn", "check", "--watch"]  # ravemj learn check --watch
    made = environment(tmp_path)
    with subprocess.Popen(words, cwd=tmp_path, env=made, stdout=subprocess.PIPE, text=True) as watching:

        def await_line(text):
            with time_limit():
                assert any(text in line for line in iter(watching.stdout.readline, ""))

        try:
            await_line("next: fk_1.py: Where is the hand")
            fill("return (")
            await_line("SyntaxError")
            (tmp_path / "fk_1.py").unlink()
            await_line("fk_1.py is not in")
            fill(RIGHT)
            await_line("Solved")
            await_line("all exercises in this folder are solved")
        finally:
            watching.send_signal(signal.SIGINT)
        assert watching.wait(PATIENCE) == 130


def test_the_answer_is_drawn_beside_the_right_one(fill, tmp_path):
    fill(ABSOLUTE)
    assert ravemj_command(tmp_path, "learn", "show", "fk-1", "-o", "answer.png").returncode == 0
    pixels = np.asarray(Image.open(tmp_path / "answer.png").convert("RGB")).reshape(-1, 3).astype(int)
    red, green, blue = pixels.T
    assert ((red > 1.5 * green) & (red > 1.5 * blue)).any()
    assert ((green > 1.5 * red) & (green > 1.5 * blue)).any()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a script in place of a browser")
def test_the_answer_is_a_page_in_the_browser(fill, tmp_path):
    fill(ABSOLUTE)
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/opened\n')
    browser.chmod(0o755)
    done = ravemj_command(tmp_path, "learn", "show", "fk-1", "--web", BROWSER=f"{browser} %s")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "opened").read_text() == (tmp_path / "fk-1.html").as_uri() + "\n"


def test_mistakes_in_commands(tmp_path):
    for words, says in (
        (("check", "nope"), "there is no exercise 'nope'; there are "),
        (("check", "fk-1"), "ravemj learn start"),
        (("hint",), "needs the name of one exercise"),
        (("grade",), "needs folders"),
        (("--course", "."), "is no course"),
    ):
        done = ravemj_command(tmp_path, "learn", *words)
        assert (done.returncode, says in done.stderr, "Traceback" in done.stderr) == (1, True, False), done.stderr
    assert ravemj_command(tmp_path, "learn", "teach").returncode == 2


def test_a_course_of_ones_own(tmp_path):
    page = (our_course().folder / "index.md").read_text(encoding="utf-8")
    exercise, check = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    lesson = tmp_path / "mine" / "01-areas"
    lesson.mkdir(parents=True)
    (lesson / "index.md").write_text("# Areas\n")
    (lesson / "area_1.py").write_text(exercise, encoding="utf-8")
    (lesson / "check_area_1.py").write_text(check, encoding="utf-8")
    assert ravemj_command(tmp_path, "learn", "--course", "mine", "start", "anna").returncode == 0
    (tmp_path / "anna" / "area_1.py").write_text("def area(r): return 2 * 3.141592653589793 * r\n")
    graded = ravemj_command(tmp_path, "learn", "--course", "mine", "grade", "anna", "ben", "--json")
    (row,) = json.loads(graded.stdout)
    assert row["message"].startswith("That is the circumference")
    assert (graded.returncode, "ben is no folder" in graded.stderr) == (1, True)
    (lesson / "check_area_1.py").write_text(check.replace("question=question", "question=3"), encoding="utf-8")
    broken = ravemj_command(tmp_path, "learn", "--course", "mine", "check", "area-1", "--folder", "anna")
    assert "check_area_1.py does not work: TypeError" in broken.stdout


def test_notebooks(capsys):
    shell = InteractiveShell()
    shell.run_line_magic("load_ext", "ravemj")
    shell.run_cell(
        "from math import cos, sin\nimport numpy as np\ndef point(l, q):\n    return np.array([l * cos(q), l * sin(q)])"
    )
    shell.run_cell("def hand_position(q1, q2, l1, l2):\n    return point(l1, q1) + point(l2, q2)")
    before = {name: value for name, value in shell.user_ns.items() if name[0] != "_"}
    picture = shell.run_line_magic("learn", "check fk-1")
    assert "the second link points along q1 + q2" in capsys.readouterr().out
    assert picture.data[1:4] == b"PNG"
    assert {name: value for name, value in shell.user_ns.items() if name[0] != "_"} == before
    shell.run_cell("def hand_position(q1, q2, l1, l2):\n    return point(l1, q1) + point(l2, q1 + q2)")
    assert shell.run_line_magic("learn", "check fk-1") is None
    assert "Solved: 20 of 20" in capsys.readouterr().out
    shell.run_line_magic("learn", "check nope")
    assert "there is no exercise" in capsys.readouterr().out
    with pytest.raises(ravemj.ArgumentError, match="no function hand_position yet"):
        learn("check fk-1", {})


def test_lessons_are_notebooks_too():
    for lesson in our_course().lessons:
        cells = json.loads(notebook(lesson))["cells"]
        assert "".join(cells[0]["source"]).startswith("# ")
        checked = ["".join(cell["source"]) for cell in cells if "%learn" in "".join(cell["source"])]
        assert checked == [f"%learn check {one.name}" for one in lesson.exercises if one.original.suffix == ".py"]
