"""``ravemj sweep``: what is printed, exit codes, executors and functions by name."""

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import environment, run

import ravemj

JOBS = Path(__file__).parents[1] / "sweeps" / "jobs.py"


@pytest.fixture
def folder(tmp_path):
    shutil.copy(JOBS, tmp_path / "clusters.py")
    return tmp_path


def sweep(folder, *words):
    return run(folder, "-m", "ravemj", "sweep", *words)


def test_it_goes_on_where_it_ended(folder):
    done = sweep(folder, "panda", "collides", "--count", "3e3", "--seed", "3", "--shard", "1000", "-o", "labels")
    assert (done.returncode, done.stdout, done.stderr) == (0, "3 of 3 shards, 3000 items in labels\n", "")
    expected = ravemj.Sweep.open(folder / "labels").arrays("collides")
    next((folder / "labels" / "shards").glob("*1000-*")).unlink()
    again = sweep(folder, "panda", "collides", "-o", "labels", "--json")
    (line,) = again.stdout.splitlines()
    assert {name: json.loads(line)[name] for name in ("start", "stop", "error")} == {
        "start": 1000, "stop": 2000, "error": ""
    }  # fmt: skip
    np.testing.assert_array_equal(ravemj.Sweep.open(folder / "labels").arrays("collides"), expected)
    damaged = next((folder / "labels" / "shards").glob("*-000000001000.npz"))
    damaged.write_bytes(damaged.read_bytes()[:-1])
    assert sweep(folder, "panda", "collides", "-o", "labels", "--check").returncode == 0
    np.testing.assert_array_equal(ravemj.Sweep.open(folder / "labels").arrays("collides"), expected)


def test_functions_and_executors_of_the_working_folder(folder):
    words = ("workshop", "clusters:sums", "--robot", "puma", "--count", "50")
    done = sweep(folder, *words, "-o", "here")
    assert (done.returncode, done.stderr) == (0, "")
    done = sweep(folder, *words, "-o", "there", "--executor", "clusters:reordering")
    assert (done.returncode, done.stderr) == (0, "")
    here, there = (ravemj.Sweep.open(folder / name).arrays("sum") for name in ("here", "there"))
    np.testing.assert_array_equal(here, there)


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (
            ("panda", "nope", "--count", "3"),
            1,
            "WHAT: found 'nope', expected collides, poses, ik, plan, pictures or",
        ),
        (("panda", "nope:f", "--count", "3"), 1, "WHAT: cannot import nope:f: No module named 'nope'"),
        (("panda", "clusters:f", "--count", "3"), 1, "WHAT: cannot import clusters:f: module 'clusters' has no attr"),
        (("panda", "poses"), 1, "sweep: one of --items and --count says what the items are"),
        (("panda", "poses", "--items", "missing.npy"), 1, "cannot read missing.npy"),
        (("panda", "poses", "--count", "1.5"), 2, "'1.5' is not a whole number from 1 on"),
        (("panda", "poses", "--count", "inf"), 2, "'inf' is not a whole number from 1 on"),
        (("panda", "poses", "--count", "3", "--jobs", "0"), 2, "'0' is not a whole number from 1 on"),
        (
            ("panda", "poses", "--count", "3", "--executor", "clusters:not_an_executor"),
            1,
            "returned int, expected an Ex",
        ),
        (("panda", "poses", "--count", "3", "--collisions"), 1, "options: found collisions; expected none"),
        (("missing.xml", "poses", "--count", "3"), 1, "missing.xml"),
        (("panda", "clusters:wrong_rows", "--count", "3"), 1, "shard 0-3 failed; the first error: ArgumentError"),
    ],
)
def test_mistakes_are_one_line(folder, words, code, message):
    done = sweep(folder, *words, "-o", "out")
    assert (done.returncode, done.stdout) == (code, "")
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.stress
def test_ctrl_c_ends_processes_too(folder):
    words = ("pendulum", "clusters:slow", "--count", "100000", "--shard", "1000", "--jobs", "2", "-o", "out")
    command = [sys.executable, "-m", "ravemj", "sweep", *words]
    with subprocess.Popen(command, cwd=folder, env=environment(folder), stderr=subprocess.PIPE, text=True) as driver:
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not list(folder.glob("out/shards/*.npz")):
            time.sleep(0.05)
        begin = time.monotonic()
        driver.send_signal(signal.SIGINT)
        _, errors = driver.communicate(timeout=30)
    assert driver.returncode == 130
    assert time.monotonic() - begin < 5
    assert "Traceback" not in errors
    assert list(folder.glob("out/shards/*.npz"))
