"""What stands around a run of tests: gaps of the machine before, and one line for newcomers after."""

import re
from pathlib import Path

import pytest
from command_line import run
from conftest import TESTS

CONFTEST = f"import sys\nsys.path.append({str(TESTS)!r})\nfrom newcomers import *\n"
PROGRAM = """
import pytest

@pytest.mark.parametrize("number", range(3))
def test_number(number):
    assert number < 3 - FAILURES

@pytest.mark.parametrize("number", range(4))
def test_colour(number):
    pytest.skip("there is no blue" if number else "there is no red")
"""
DONE = r"ravemj works here: 3 tests passed; 4 were skipped, for the reasons above\."
FAILED = r"ravemj does not work here as it should: 2 of 3 tests failed\. .* FAILED .* .venv/bin/ravemj doctor prints\."


@pytest.fixture
def folder(tmp_path) -> Path:
    (tmp_path / "conftest.py").write_text(CONFTEST)
    (tmp_path / "pytest.ini").write_text("[pytest]\ntestpaths = .\naddopts = -m 'not stress'\nmarkers = stress")
    return tmp_path


@pytest.mark.parametrize(
    ("failures", "words", "line"),
    [
        (0, [], DONE),
        (2, [], FAILED),
        (0, ["-k", "number"], None),  # no word about all of it
        (0, ["test_it.py"], None),
        (0, ["-m", "stress or not stress"], None),
    ],
)
def test_a_run_ends_with_a_line_for_everybody_and_pytests_own(folder, failures, words, line):
    (folder / "test_it.py").write_text(PROGRAM.replace("FAILURES", str(failures)))
    done = run(folder, "-m", "pytest", "-p", "no:cacheprovider", "--no-header", *words)
    *_, last, closing = filter(None, done.stdout.splitlines())
    assert re.fullmatch("=+ .*(3 passed|2 failed, 1 passed).* =+", closing)
    assert re.fullmatch(line, last) if line else "ravemj" not in last
    if "number" not in words:
        assert "\n    3 there is no blue\n    1 there is no red\n" in done.stdout


def test_a_run_begins_with_what_this_machine_cannot_test(folder):
    done = run(folder, "-m", "pytest", "--collect-only", variables={"PATH": "/nowhere", "MUJOCO_GL": "disable"})
    assert "\ncannot test OpenGL here: MUJOCO_GL chooses rays\n" in done.stdout
    assert "\ncannot test windows here: there is no Xvfb: apt-get install xvfb\n" in done.stdout
    assert "\ncannot test pages in browsers here: there is no Chromium: apt-get install chromium\n" in done.stdout
    assert "ravemj works" not in done.stdout
