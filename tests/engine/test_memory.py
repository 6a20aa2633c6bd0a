"""Memory: nothing grows with the number of calls, and what is dropped goes, threads and windows included."""

import ctypes
import gc
import itertools
import sys
import threading
import warnings
import weakref

import numpy as np
import pytest
from conftest import one_in
from waiting import await_that

import ravemj

ARM = """<Robot name="{0}"><KinBody><Body name="base"><Geom type="sphere"><radius>.1</radius></Geom></Body>
<Body name="link"><offsetfrom>base</offsetfrom><Translation>0 0 .3</Translation><Geom type="sphere"><radius>.1</radius>
</Geom></Body><Joint name="joint" type="hinge"><Body>base</Body><Body>link</Body><offsetfrom>link</offsetfrom>
<axis>1 0 0</axis><limitsrad>-2 2</limitsrad></Joint></KinBody></Robot>"""


@pytest.fixture
def env(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "disable")
    env = ravemj.Environment()
    env.LoadData(ARM.format("arm"))
    env.SetViewer("offscreen")
    env.StopSimulation()
    yield env
    env.Destroy()


@pytest.fixture
def shown():
    """The warnings that a user would see, in Python's own way of showing each text once."""
    texts = []
    with warnings.catch_warnings(action="default"):
        warnings.showwarning = lambda message, *_: texts.append(str(message))
        yield texts


def make_calls(env, number):
    arm = env.GetRobot("arm")
    arm.SetDOFValues([0.1 * (number % 7)])
    arm.GetLinkTransformations()
    arm.GetTransform()
    env.CheckCollision(arm)
    env.plot3([0, 0, 1], 5)


def exceed_limits(env, number):
    """Every call warns with a text of its own."""
    env.GetRobot("arm").SetDOFValues([3 + 1e-3 * number])


def add_and_remove(env, number):
    arm, box = env.GetRobot("arm"), ravemj.RaveCreateKinBody(env, "")
    box.InitFromBoxes([[0, 0, 0, 0.1, 0.1, 0.1]])
    box.SetName(f"box{number}")
    env.Add(box)
    arm.Grab(box, arm.GetLinks()[1])
    with arm:
        arm.SetDOFValues([0.2])
        env.CheckCollision(arm)
        arm.CheckSelfCollision()
    arm.CreateRobotStateSaver().Restore()
    arm.ComputeJacobianTranslation(1, [0, 0, 0])
    arm.batch_link_transforms([[0.1], [0.2]])
    env.Remove(box)


def load_and_remove(env, number):
    env.LoadData(ARM.format(f"arm{number}"))
    env.Remove(env.GetRobot(f"arm{number}"))


def copy(env, number):
    other = env.CloneSelf(1)
    other.GetRobots()[0].SetDOFValues([0.1])
    if number % 2:
        other.Destroy()


def draw_anew(env, number):
    add_and_remove(env, number)
    env.render(8, 6)


def fall(env, number):
    env.SetPhysicsEngine("ode")
    add_and_remove(env, number)
    env.StepSimulation(0.002)
    env.GetRobot("arm").GetController().SetDesired([0.1])


class Mallinfo2(ctypes.Structure):
    """glibc's `struct mallinfo2`."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in [
            "arena",
            "ordblks",
            "smblks",
            "hblks",
            "hblkhd",
            "usmblks",
            "fsmblks",
            "uordblks",
            "fordblks",
            "keepcost",
        ]
    ]


def memory():
    """What is in use: megabytes of C's heap and the number of Python's small blocks.

    The size of the process would say less: it also has what the allocators keep for later.
    """
    gc.collect()
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = Mallinfo2
    heap = mallinfo2()
    return np.array([(heap.uordblks + heap.hblkhd) / 2**20, sys.getallocatedblocks()])


CYCLES = {
    make_calls: 20000,
    exceed_limits: 20000,
    add_and_remove: 1000,
    load_and_remove: 1000,
    copy: 1000,
    draw_anew: 300,
    fall: 300,
}


@pytest.mark.stress
@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallinfo2"), reason="only glibc tells what is in use")
@pytest.mark.parametrize("work", CYCLES, ids=lambda work: work.__name__)
def test_memory_does_not_grow(env, work, shown):
    """The first round fills caches; of two others the smaller growth counts. One object a call is too much."""
    numbers, growths = iter(range(10**9)), []
    for _ in range(3):
        before = memory()
        for number in itertools.islice(numbers, CYCLES[work]):
            work(env, number)
        shown.clear()
        growths.append(memory() - before)
    assert np.all(np.min(growths[1:], axis=0) < [0.1, CYCLES[work] / 2]), growths


@pytest.mark.stress
@pytest.mark.parametrize(
    "work", one_in(3, [work for work in CYCLES if work is not exceed_limits]), ids=lambda work: work.__name__
)
def test_objects_do_not_pile_up(env, work):
    """Counts what the collector knows, which no allocator blurs."""

    def count(rounds):
        for number in rounds:
            work(env, number)
        gc.collect()
        return len(gc.get_objects())

    count(range(3))
    before = count(range(10))
    assert count(range(10, 50)) < before + 40


def test_each_warning_is_shown_once(env, shown):
    for number in (0, 0, 1, 0):
        exceed_limits(env, number)
    assert [text.split("set to ")[1][:5] for text in shown] == ["3, ou", "3.001"]


def test_loading_again_reports_again_but_keeps_one_finding(env):
    def read():
        with pytest.warns(ravemj.RavemjWarning, match="unknown"):
            env.ReadKinBodyData("<KinBody name='b'><Unknown/><Body name='b'/></KinBody>")
        return env.diagnostics

    assert read() == read()


def test_forgotten_environments_go_with_their_threads(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "disable")

    def use():
        env = ravemj.Environment()
        env.LoadData(ARM.format("arm"))
        arm = env.GetRobot("arm")
        env.SetViewer("offscreen")
        env.render(8, 6)
        arm.GetController().SetDesired([0.1])
        with arm:
            arm.CheckSelfCollision()
        assert any(thread.name == "simulation time" for thread in threading.enumerate())
        return weakref.ref(env), weakref.ref(env.simulation)

    before = set(threading.enumerate())
    references = use()

    def are_gone():
        gc.collect()
        return not set(threading.enumerate()) - before

    await_that(are_gone, "threads stay")
    assert [reference() for reference in references] == [None, None]
