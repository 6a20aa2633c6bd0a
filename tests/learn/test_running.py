"""Checks in processes of their own: what students' code may do, and what is said about it."""

import dataclasses
import json
import os

import pytest

from ravemj.learn.course import Course, our_course, start, start_again
from ravemj.learn.grading import Grade, as_csv, grades
from ravemj.learn.running import MOST_OUTPUT, PROGRESS, Progress, run_check

RIGHT = "return [l1 * np.cos(q1) + l2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 * np.sin(q1 + q2)]"
EXERCISE = our_course().exercise("fk-1")


@pytest.fixture
def write(tmp_path):
    """Writes the student's file, with some lines in the hole."""

    def write(lines, folder=tmp_path):
        folder.mkdir(exist_ok=True)
        file = folder / "fk_1.py"
        file.write_text(EXERCISE.original.read_text().replace("    ...\n", f"    {lines}\n"))
        return file

    return write


@pytest.mark.parametrize(
    ("lines", "status", "says"),
    [
        (RIGHT, "solved", ""),
        (f"{RIGHT.replace('return ', 'return np.float32(')})", "solved", ""),
        ("pass", "wrong", "it returns None"),
        ("return float('nan'), 0", "wrong", "NaN or infinity"),
        ("return 'here'", "wrong", "a str, and should return an array of shape (2,)"),
        ("return [1, 2, 3]", "wrong", "an array of shape (3,), and should return an array of shape (2,)"),
        ("return 1 / 0", "error", "line 17, `return 1 / 0`: ZeroDivisionError"),
        ("return here", "error", "NameError: name 'here' is not defined"),
        ("return (", "error", "line 17: SyntaxError: '(' was never closed"),
        ("import sys; sys.exit(0)", "error", "ends Python"),
        ("import os; os._exit(0)", "error", "ended its process without an answer"),
        ("while True: pass", "error", "it was in line 17; is there a loop that never ends?"),
        ("return np.zeros(10**11)", "error", "MemoryError"),
    ],
    ids=lambda value: value if len(value) < 30 else "",
)
def test_what_students_write(write, lines, status, says):
    verdict = run_check(EXERCISE, write(lines), seconds=3.0)
    assert (verdict.status, says in verdict.message) == (status, True), verdict


@pytest.mark.stress
def test_letters_of_any_language_in_paths_and_prints(write, tmp_path):
    file = write("while True: pass", tmp_path / "Übung é")
    assert "it was in line 17" in run_check(EXERCISE, file, seconds=3.0).message
    printed = run_check(EXERCISE, write(f"print('é ≤ ü'); {RIGHT}", tmp_path / "Übung é"))
    assert (printed.status, "é ≤ ü" in printed.output) == ("solved", True)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_a_fork_gives_no_second_verdict(write):
    assert run_check(EXERCISE, write(f"import os; os.fork(); {RIGHT}")).status == "solved"


def test_output_is_cut(write):
    verdict = run_check(EXERCISE, write(f"print('x' * 9999); {RIGHT}"))
    assert verdict.status == "solved"
    assert len(verdict.output) < MOST_OUTPUT + 20


def test_another_name_is_asked_for(tmp_path):
    (tmp_path / "fk_1.py").write_text("def hand(): return 1\n")
    assert "must keep this name" in run_check(EXERCISE, tmp_path / "fk_1.py").message


def test_verdicts_are_kept_while_file_and_check_stay(write, tmp_path, monkeypatch):
    write(RIGHT)
    assert Progress(tmp_path).check(EXERCISE).status == "solved"
    known = Progress(tmp_path)
    monkeypatch.setattr("ravemj.learn.running.run_check", lambda *_: pytest.fail("was checked again"))
    assert [verdict.status for _, verdict in known.check_all([EXERCISE])] == ["solved"]
    write("pass")
    assert Progress(tmp_path).known(EXERCISE) is None


@pytest.mark.parametrize("content", ["", "{", "[1]", '{"fk-1": 3}', '{"fk-1": ["key", {"status": "solved", "x": 1}]}'])
def test_damaged_progress_is_none(tmp_path, content):
    (tmp_path / PROGRESS).write_text(content)
    assert Progress(tmp_path).known(EXERCISE) is None


def test_starting_never_overwrites(tmp_path):
    course = our_course()
    assert len(start(course, tmp_path / "new folder")) == len(course.exercises)
    own = tmp_path / "new folder" / "fk_1.py"
    own.write_text("mine")
    assert start(course, own.parent) == []
    assert own.read_text() == "mine"
    for _ in range(2):
        kept = start_again(EXERCISE, own.parent)
        assert own.read_text() == EXERCISE.original.read_text()
    assert sorted(path.name for path in own.parent.glob("fk_1*")) == ["fk_1.old1.py", "fk_1.old2.py", "fk_1.py"]
    assert kept.read_text() == EXERCISE.original.read_text()


def test_grading_many_folders(write, tmp_path):
    write(RIGHT, tmp_path / "anna")
    write("import os; os._exit(1)", tmp_path / "ben")
    (tmp_path / "carl").mkdir()
    (tmp_path / "carl" / "check_fk_1.py").write_text("CHECK = 'always right'")
    course = Course(our_course().folder)
    names = [tmp_path / name for name in ("anna", "ben", "carl")]
    rows = {(row.student, row.exercise): row.status for row in grades(course, names)}
    assert len(rows) == 3 * len(course.exercises)
    assert [rows[student, "fk-1"] for student in ("anna", "ben", "carl")] == ["solved", "error", "missing"]


def test_cells_are_no_formulas():
    rows = [Grade("=1+1", "fk-1", "wrong", "-1, and should be +1"), Grade("a", "fk-1", "wrong", "@x")]
    lines = as_csv(rows).splitlines()
    assert lines[1:] == ["'=1+1,fk-1,wrong,\"'-1, and should be +1\"", "a,fk-1,wrong,'@x"]
    assert list(json.loads(json.dumps(dataclasses.asdict(rows[0])))) == lines[0].split(",")
