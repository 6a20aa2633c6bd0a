"""The end of Python while daemon threads compute, which crashed the process now and then."""

import subprocess
import sys

import pytest
from waiting import PATIENCE

BEGIN = """
import atexit, threading, time
out = []
atexit.register(lambda: print(out[0]()))  # runs last: the first one
import ravemj
env = ravemj.load(ravemj.model_path("pendulum"))
robot = env.GetRobots()[0]
begun = threading.Event()
"""


def run(tmp_path, script):
    """Run a script and return its exit code and what it prints."""
    (tmp_path / "script.py").write_text(BEGIN + script)
    done = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert done.stderr == ""
    return done.returncode, done.stdout


@pytest.mark.stress
def test_no_thread_computes_any_more(tmp_path):
    script = """
count = 0
def work():
    global count
    while True:
        env.CheckCollision(robot)
        begun.set()
        count += 1
def counts():
    before = -1
    for _ in range(100):  # the thread may still have to count its last call
        if before == count:
            return "none"
        before = count
        time.sleep(0.3)
    return "more and more"
out.append(counts)
threading.Thread(target=work, daemon=True).start()
begun.wait()
raise SystemExit(3)
"""
    assert run(tmp_path, script) == (3, "none\n")


@pytest.mark.stress
def test_a_thread_that_keeps_the_lock_is_ended(tmp_path):
    script = """
ended = []
def work():
    try:
        with env:
            while True:
                robot.SetDOFValues([0.1, 0.2])
                begun.set()
    except SystemExit:
        ended.append("ended")
        raise
out.append(lambda: (ended, env.simulation.lock.is_held))
threading.Thread(target=work, daemon=True).start()
begun.wait()
"""
    assert run(tmp_path, script) == (0, "(['ended'], True)\n")


@pytest.mark.stress
def test_environments_that_threads_make_later_do_not_compute(tmp_path):
    script = """
made = []
def work():
    while True:
        made.append(ravemj.load(ravemj.model_path("pendulum")).render(40, 30).shape)
        made.clear()
        begun.set()
def counts():
    made.clear()
    time.sleep(0.5)
    return made
out.append(counts)
threading.Thread(target=work, daemon=True).start()
begun.wait()
"""
    assert run(tmp_path, script) == (0, "[]\n")


def test_a_script_that_keeps_the_lock_ends(tmp_path):
    assert run(tmp_path, "env.Lock(); out.append(env.TryLock)") == (0, "True\n")


@pytest.mark.stress
@pytest.mark.parametrize("call", ["env.CheckCollision(robot)", "env.render(40, 30)", "env.StepSimulation(0.01)"])
def test_ends_at_any_moment(tmp_path, call):
    script = f"""
import random
out.append(lambda: "over")
def work():
    with env:
        while True:
            {call}
            begun.set()
for _ in range(2):
    threading.Thread(target=work, daemon=True).start()
begun.wait()
time.sleep(random.uniform(0, 0.1))
"""
    for _ in range(20):
        assert run(tmp_path, script) == (0, "over\n")
