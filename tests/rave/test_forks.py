"""What works in a fork, and what raises an error there."""

import copy
import multiprocessing
import os
import pickle
import random
import subprocess
import sys
import threading
import time
import urllib.request
import warnings

import mujoco
import numpy as np
import pytest
from waiting import PATIENCE

import ravemj

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")

BELONGS = "belongs to the parent: .*multiprocessing.get_context"


def answer_in_child(function):
    """Return what a function says in a fork, or the error that it raises; the fork ends as a script does."""
    reader, writer = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # there are other threads: that is what is tested
        child = os.fork()
    if child == 0:
        os.close(reader)
        try:
            text = str(function())
        except BaseException as error:
            text = f"{type(error).__name__}: {error}"
        os.write(writer, text.encode())
        os._exit(0)
    os.close(writer)
    with open(reader) as pipe:
        text = pipe.read()
    assert os.waitpid(child, 0)[1] == 0
    return text


@pytest.fixture
def env():
    env = ravemj.load(ravemj.model_path("pendulum"))
    yield env
    env.Destroy()


@pytest.fixture
def robot(env):
    return env.GetRobots()[0]


CALLS = {
    "SetDOFValues": lambda env, robot: robot.SetDOFValues([0.1, 0.2]),
    "GetDOFValues": lambda env, robot: robot.GetDOFValues(),
    "GetName of a robot": lambda env, robot: robot.GetName(),
    "GetTransform of a link": lambda env, robot: robot.GetLinks()[0].GetTransform(),
    "with robot": lambda env, robot: robot.__enter__(),
    "CheckCollision": lambda env, robot: env.CheckCollision(robot),
    "GetName": lambda env, robot: env.GetName(),
    "GetRobots": lambda env, robot: env.GetRobots(),
    "with env": lambda env, robot: env.__enter__(),
    "Lock": lambda env, robot: env.Lock(),
    "Load": lambda env, robot: env.Load("nothing.xml"),
    "render": lambda env, robot: env.render(40, 30),
    "StartSimulation": lambda env, robot: env.StartSimulation(0.01),
    "SetViewer": lambda env, robot: env.SetViewer("web"),
    "simulation": lambda env, robot: env.simulation,
}


@pytest.mark.parametrize("name", CALLS)
def test_what_a_fork_inherits_says_what_to_do(env, robot, name):
    answer = answer_in_child(lambda: CALLS[name](env, robot))
    assert answer.startswith("RavemjError: the environment was made before os.fork and belongs to the parent")
    assert 'multiprocessing.get_context("spawn")' in answer


def test_each_kind_of_object_raises_the_error(env, robot):
    loose, saver = ravemj.RaveCreateKinBody(env, ""), robot.CreateRobotStateSaver()
    physics, controller, sensor = env.GetPhysicsEngine(), robot.GetController(), env.GetCollisionChecker()
    arm, joint, shape = robot.GetLinks()[1], robot.GetJoints()[0], robot.GetLinks()[0].GetGeometries()[0]
    for call in (
        loose.GetTransform,
        saver.Restore,
        physics.GetGravity,
        lambda: controller.SetDesired([0, 0]),
        lambda: sensor.CheckCollision(robot),
        arm.GetTransform,
        joint.GetValues,
        shape.GetTransform,
        env.CloneSelf,
    ):
        assert "belongs to the parent" in answer_in_child(call)


def work_in_child():
    """Do all that a script does with an environment of its own."""
    env = ravemj.load(ravemj.model_path("pendulum"))
    robot = env.GetRobots()[0]
    with robot:
        robot.SetDOFValues([0.1, 0.2])
        assert not env.CheckCollision(robot)
    assert robot.GetDOFValues().tolist() == [0, 0]
    env.StartSimulation(0.001, realtime=False)
    end = time.monotonic() + PATIENCE
    while not env.GetSimulationTime() and time.monotonic() < end:
        time.sleep(0.001)
    env.StopSimulation()
    env.SetViewer("web")
    page = urllib.request.urlopen(env.GetViewer().url).read()
    picture = env.render(64, 48)
    env.Destroy()
    assert (len(page) > 1000, picture.shape) == (True, (48, 64, 3))
    return ravemj.RaveGetEnvironments()


def test_an_environment_of_the_fork_works(env):
    env.SetViewer("web")
    env.StartSimulation(0.001)
    assert answer_in_child(work_in_child) == "[]"
    assert urllib.request.urlopen(env.GetViewer().url).status == 200


def test_arrays_and_models_work(env, robot):
    model, data, pose = env.model, env.data, robot.GetTransform()
    assert answer_in_child(lambda: (mujoco.mj_step(model, data), data.time, pose.shape)) == "(None, 0.002, (4, 4))"


def squared(values):
    return (values**2).sum()


def test_pools_of_forks_take_arrays(env, robot):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            assert pool.map(squared, [robot.GetDOFValues() + 1, np.ones(3)]) == [2, 3]


@pytest.mark.parametrize("send", [pickle.dumps, copy.deepcopy])
def test_what_cannot_be_pickled_says_what_to_do(robot, send):
    with pytest.raises(
        ravemj.openrave_exception, match=r"cannot be pickled: send the environment or one of its bodies"
    ):
        send(robot.GetLinks()[0])


def test_a_fork_inside_a_block(env, robot):
    with env, robot:
        assert "belongs to the parent" in answer_in_child(robot.GetDOFValues)
        assert answer_in_child(work_in_child) == "[]"
    assert robot.GetDOFValues().tolist() == [0, 0]


def test_a_lock_that_another_thread_holds_does_not_stop_the_fork(env, robot):
    held, done = threading.Event(), threading.Event()

    def hold():
        with env:
            held.set()
            done.wait(PATIENCE)

    thread = threading.Thread(target=hold)
    thread.start()
    held.wait(PATIENCE)
    try:
        assert "belongs to the parent" in answer_in_child(robot.GetDOFValues)
    finally:
        done.set()
        thread.join()


def end_as_a_script(script, tmp_path):
    """Return what a script prints, which runs in a process of its own."""
    (tmp_path / "script.py").write_text(script)
    run = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert run.returncode == 0
    assert run.stderr.splitlines()[1:] == []  # after the address of the page
    return run.stdout


@pytest.mark.stress
def test_the_end_of_a_fork_leaves_the_parent_its_things(tmp_path):
    """A fork that ends as scripts do runs the functions of ``atexit``, which close pages and remove files."""
    script = """
import gc, os, sys, urllib.request, warnings
warnings.simplefilter("ignore")
import ravemj
from ravemj.core.output import new_file, temporary_folder
from ravemj.gui.viewers.dropping import Upload

env = ravemj.load(ravemj.model_path("pendulum"))
env.SetViewer("web")
env.StartSimulation(0.001)
env.render(40, 30)
page, upload = env.GetViewer().url, Upload()
with new_file("a.txt") as path, temporary_folder() as folder:
    for number in range(3):
        child = os.fork()
        if child == 0 and number == 0:
            ravemj.RaveDestroy()
            env.Destroy()
        if child == 0 and number == 1:
            del env
            gc.collect()
        if child == 0:
            sys.exit(3)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
    path.write_text("written")
    print(os.path.isdir(folder), os.path.isdir(upload._folder))
print(open("a.txt").read(), urllib.request.urlopen(page).status, env.GetRobots()[0].GetDOFValues())
env.Destroy()
"""
    assert end_as_a_script(script, tmp_path) == "3\n3\n3\nTrue True\nwritten 200 [0. 0.]\n"


def test_a_fork_lets_go_of_ports(env):
    """Else nobody could have the port again while a fork lives."""
    env.SetViewer("web")
    port = env.GetViewer().server.port
    awake, asleep = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        os.close(asleep)
        os.read(awake, 1)
        os._exit(0)
    env.SetViewer("")
    again = ravemj.load(ravemj.model_path("pendulum"))
    viewer = again.serve_viewer(port=port)
    assert viewer.server.port == port
    again.Destroy()
    os.close(asleep)
    os.close(awake)
    os.waitpid(child, 0)


@pytest.mark.stress
def test_forks_while_threads_load_plan_and_draw(env, robot):
    """Forks at random moments do not hang, whatever the other threads do; seed 3."""
    ended = threading.Event()

    def load():
        other = ravemj.load(ravemj.model_path("puma560"))
        other.CheckCollision(other.GetRobots()[0])
        other.render(40, 30)
        other.Destroy()

    def plan():
        ravemj.interfaces.BaseManipulation(robot).MoveActiveJoints(goal=[0.3, 0.2], execute=False, outputtrajobj=True)

    def repeat(action):
        while not ended.is_set():
            action()

    threads = [threading.Thread(target=repeat, args=(action,), daemon=True) for action in (load, plan)]
    for thread in threads:
        thread.start()
    moments = random.Random(3)
    for _ in range(100):
        time.sleep(moments.uniform(0, 0.05))
        assert answer_in_child(work_in_child) == "[]"
    ended.set()
    for thread in threads:
        thread.join()
