"""Functions and executors for sweeps, in a module that processes import."""

import os
import signal
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np


def sums(env, items, random):
    """Return numbers that depend on items, state and random generator."""
    (body, *_) = env.GetBodies()
    body.SetDOFValues(items[0])
    return {
        "sum": items.sum(axis=1) + random.normal(size=len(items)),
        "pose": np.tile(body.GetTransform(), (len(items), 1, 1)),
    }


def scaled(env, items, random, factor, shift=0.0):
    return {"scaled": factor * items + shift}


def paint(env, values, random):
    """Give a link another colour, and return another camera."""
    del values
    (robot,) = env.GetRobots()
    robot.GetLinks()[1].GetGeometries()[0].SetDiffuseColor(random.uniform(size=3))
    camera = env.default_camera().T_world_camera.copy()
    camera[0, 3] += random.uniform(-0.1, 0.1)
    return camera


def fails_at_300(env, items, random):
    del env, random
    if (items[:, 0] == 300).any():
        raise ValueError("no 300\nplease")
    return {"twice": 2 * items}


def dies_once(env, items, random):
    """End the process at the first call with the item 300, as a lack of memory does."""
    del env, random
    mark = Path(os.environ["SWEEP_MARK"])
    if (items[:, 0] == 300).any() and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"twice": 2 * items}


def dies_always(env, items, random):
    del env, random
    if (items[:, 0] == 300).any():
        os.kill(os.getpid(), signal.SIGKILL)
    return {"twice": 2 * items}


def hangs_at_300(env, items, random):
    del env, random
    if (items[:, 0] == 300).any():
        time.sleep(1000)
    return {"twice": 2 * items}


def slow(env, items, random):
    del env
    time.sleep(0.05)
    return {"random": random.normal(size=len(items)), "twice": 2 * items}


def wrong_rows(env, items, random):
    del env, random
    return {"rows": items[1:]}


def no_arrays(env, items, random):
    del env, random
    return items


class Reordering(Executor):
    """Runs calls in threads, the last ones first."""

    def __init__(self):
        self._waiting = []
        self._pool = ThreadPoolExecutor(1)

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        self._waiting.append((future, fn, args, kwargs))
        self._pool.submit(self._run)
        return future

    def _run(self):
        time.sleep(0.01)
        future, fn, args, kwargs = self._waiting.pop()
        if future.set_running_or_notify_cancel():
            future.set_result(fn(*args, **kwargs))


class Failing(Executor):
    """Breaks after some calls."""

    def __init__(self, count, refuses=False):
        self._left, self._refuses = count, refuses

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        self._left -= 1
        if self._left >= 0:
            future.set_result(fn(*args, **kwargs))
        elif self._refuses:
            raise RuntimeError("it is closed")
        else:
            future.set_exception(BrokenExecutor("a node is gone"))
        return future


class Losing(Failing):
    """Has an error of its own for each call after some."""

    def submit(self, fn, /, *args, **kwargs):
        future = super().submit(fn, *args, **kwargs)
        if isinstance(future.exception(), BrokenExecutor):
            future.set_exception = None
            future = Future()
            future.set_exception(ConnectionError("lost"))
        return future


class Hanging(Executor):
    """Never ends a call."""

    def submit(self, fn, /, *args, **kwargs):
        return Future()


def reordering():
    return Reordering()


def not_an_executor():
    return 3
