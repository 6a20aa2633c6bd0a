"""Pages that draw by themselves: what they are sent while robots move, and what that takes of the processor."""

import contextlib
import itertools
import json
import threading
import time
import warnings
from collections.abc import Generator
from pathlib import Path

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

import ravemj
from benchmarks.kinematics import PR2
from benchmarks.measure import ROOT, Row
from benchmarks.reading import CORPUS
from ravemj.gui.viewers.web import WebViewer
from ravemj.gui.viewers.web.feed import FRAME

_RATE = 60.0
_SECONDS = 3.0
_SETTLING = 1.0
_TABS = 3
_MOST = {"arm": 20.0, "PR2": 150.0}
"""Most kilobytes a second."""

_SHARE = 20.0
"""Most of a processor that three tabs take while a PR2 moves [%]."""


class Tab(threading.Thread):
    """A page that says it has drawn whatever it is sent.

    Attributes:
        received: Bytes.
        frames: How many frames these were.
        used: What this thread took of the processor [s].
    """

    def __init__(self, url: str) -> None:
        super().__init__(daemon=True)
        self.received, self.frames, self.used = 0, 0, 0.0
        address, origin = url.replace("http", "ws", 1) + "socket", url.rsplit("/", 2)[0]
        self._connection = connect(address, origin=origin, compression=None)
        for message in (
            {"type": "shape", "width": 800, "height": 600, "ratio": 1},
            {"type": "draws", "itself": True},
            {"type": "ready"},
        ):
            self._connection.send(json.dumps(message))
        self.start()

    def run(self) -> None:
        """Take messages until the connection ends."""
        frame = FRAME.to_bytes(4, "little")
        try:
            for message in self._connection:
                self.received += len(message)
                if isinstance(message, bytes) and message[:4] == frame:
                    self.frames += 1
                    self._connection.send('{"type": "ready"}')
                self.used = time.thread_time()
        except ConnectionClosed:
            pass

    def leave(self) -> None:
        """End the connection."""
        self._connection.close()


def rows() -> list[Row]:
    """Measure robots all of whose joints move 60 times a second."""
    return [row for name, path in _robots() for row in _rows(name, path)]


def _robots() -> Generator[tuple[str, Path]]:
    yield "arm", ROOT / "models" / "panda.xml"
    if (CORPUS / PR2).exists():
        yield "PR2", CORPUS / PR2


def _rows(name: str, path: Path) -> Generator[Row]:
    with opened(path) as (robot, viewer):
        tabs = [Tab(viewer.url)]
        time.sleep(_SETTLING)
        moving, _ = _measured(robot, tabs, _SECONDS)
        rate = tabs[0].frames / _SECONDS
        time.sleep(_SETTLING)
        before = tabs[0].received
        time.sleep(_SETTLING)
        rest = (tabs[0].received - before) / _SETTLING
        note = f"{robot.GetDOF()} DOFs, {rate:.0f} frames/s; {rest:g} bytes at rest"
        yield Row(f"bytes to a page while the {name} moves : most", "kB/s", moving, _MOST[name], 1.0, note=note)
        tabs += [Tab(viewer.url) for _ in range(_TABS - 1)]
        time.sleep(_SETTLING)
        _, share = _measured(robot, tabs, _SECONDS)
        yield Row(f"processor for {_TABS} pages while the {name} moves : most", "% of one", share, _SHARE, 1.0)
        for tab in tabs:
            tab.leave()


@contextlib.contextmanager
def opened(path: Path) -> Generator[tuple[ravemj.Robot, WebViewer]]:
    """Load a model and serve its page; yield the robot and the viewer."""
    with warnings.catch_warnings(action="ignore"):
        env = ravemj.load(path)
    try:
        yield env.GetRobots()[0], env.serve_viewer()
    finally:
        env.Destroy()


def _measured(robot: ravemj.Robot, tabs: list[Tab], seconds: float) -> tuple[float, float]:
    """Move all joints; return what the first page was sent [kB/s] and what the server took of a processor [%]."""
    lower, upper = robot.GetDOFLimits()
    middle, half = (lower + upper) / 2, np.minimum((upper - lower) / 2, 1.0)

    def used() -> float:
        return time.process_time() - time.thread_time() - sum(tab.used for tab in tabs)

    received, before, begin = tabs[0].received, used(), time.monotonic()
    for number in itertools.count():
        if number / _RATE >= seconds:
            break
        robot.SetDOFValues(middle + 0.9 * half * np.sin(2 * number / _RATE))
        time.sleep(max(begin + (number + 1) / _RATE - time.monotonic(), 0.0))
    took = time.monotonic() - begin
    return (tabs[0].received - received) / took / 1e3, 100 * (used() - before) / took
