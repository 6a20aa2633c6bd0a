"""Pages that draw by themselves: what they are sent while robots move, and what that takes of the processor."""

import asyncio
import importlib.util
import itertools
import json
import shutil
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
from benchmarks.viewer import NOTE_FIRST_FRAME, robots
from ravemj.gui.viewers.web import WebViewer
from ravemj.gui.viewers.web.feed import FRAME

_RATE = 60.0
_SECONDS = 3.0
_SETTLING = 1.0
_TABS = 3
_MOST = {"arm": 20.0, "PR2": 150.0}
"""Most kilobytes a second."""

_FIRST = {"pendulum": 1.0, "PR2": 3.0}
"""Longest time to the first picture [s], over a connection with this throughput [bytes/s] and delay [s]."""

_THROUGHPUT, _DELAY = 10e6 / 8, 0.05
_FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]

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


class SlowPort:
    """A port that leads to another one, slowly.

    Attributes:
        port: Its number.
    """

    def __init__(self, target: int) -> None:
        self._target = target
        self._free_at = 0.0
        self._loop = asyncio.new_event_loop()
        threading.Thread(target=self._loop.run_forever, daemon=True).start()
        starting = asyncio.start_server(self._join, "127.0.0.1", 0)
        self._server = asyncio.run_coroutine_threadsafe(starting, self._loop).result()
        self.port = self._server.sockets[0].getsockname()[1]

    async def _join(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await asyncio.sleep(2 * _DELAY)  # of the handshake
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._target)
        ways = (reader, far_writer), (far_reader, writer)
        await asyncio.gather(*(self._carry(*way) for way in ways), return_exceptions=True)

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while content := await reader.read(16384):
            now = self._loop.time()
            self._free_at = max(self._free_at, now) + len(content) / _THROUGHPUT
            self._loop.call_at(self._free_at + _DELAY, writer.write, content)
        self._loop.call_at(max(self._free_at, self._loop.time()) + _DELAY, writer.close)


def rows() -> list[Row]:
    """Measure robots all of whose joints move 60 times a second, and how soon the first picture is seen."""
    moving = [row for name, path in _robots() for row in _rows(name, path)]
    return [*moving, *_first_rows()]


def _first_rows() -> Generator[Row]:
    program = shutil.which("chromium")
    if program is None or importlib.util.find_spec("playwright") is None:
        return
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - optional

    with sync_playwright() as playwright, playwright.chromium.launch(executable_path=program, args=_FLAGS) as browser:
        for name, env in robots():
            viewer = WebViewer(env.simulation, env.renderer, "web", any_name=True)
            port = SlowPort(viewer.server.port).port
            page = browser.new_page(viewport={"width": 800, "height": 600})
            page.add_init_script(NOTE_FIRST_FRAME)
            page.goto(f"http://127.0.0.1:{port}/{viewer.server.token}/")
            page.wait_for_selector("[data-crisp=true]")
            first = page.evaluate("firstFrame") / 1e3
            note = "10 Mbit/s, 50 ms; Chromium without a graphics card"
            yield Row(f"first picture of the {name} on a slow way : most", "s", first, _FIRST[name], 1.0, note=note)
            page.close()
            viewer.close()


def _robots() -> Generator[tuple[str, Path]]:
    yield "arm", ROOT / "models" / "panda.xml"
    if (CORPUS / PR2).exists():
        yield "PR2", CORPUS / PR2


def _rows(name: str, path: Path) -> Generator[Row]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env = ravemj.load(path)
    robot = env.GetRobots()[0]
    viewer = env.serve_viewer()
    try:
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
