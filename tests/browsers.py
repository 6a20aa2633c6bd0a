"""A browser without a window, pages of viewers in it, and hands on them."""

import contextlib
import functools
import importlib.util
import io
import itertools
import shutil
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from PIL import Image
from waiting import PATIENCE, await_that

import ravemj
from ravemj.graphics.rendering import Camera
from ravemj.graphics.simulation_renderer import Format
from ravemj.gui.interaction import Button, Fingers, Interaction, Key, Leave, Move, Press, Release, Use, Wheel
from ravemj.gui.viewers.web.client import Client
from ravemj.gui.viewers.web.frame_pacing import ConnectionPacing

CHROMIUM = shutil.which("chromium")
FLAGS = [
    f"--{flag}"
    for flag in (
        "no-sandbox",
        "disable-gpu",
        "disable-webgl",
        "disable-quic",
        "no-first-run",
        "disable-background-networking",
        "disable-component-update",
        "disable-sync",
    )
]
WEBGL_FLAGS = [flag for flag in FLAGS if flag not in ("--disable-gpu", "--disable-webgl")]
WEBGL_FLAGS += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
NEEDS_A_BROWSER = [
    pytest.mark.gui,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: apt-get install chromium"),
    pytest.mark.skipif(importlib.util.find_spec("playwright") is None, reason="there is no Playwright"),
]
SIZE = 640, 480
ASLANT = np.array(
    [[-0.643, 0.324, -0.694, 0.943], [0.766, 0.272, -0.583, 0.792], [0, -0.906, -0.423, 0.474], [0, 0, 0, 1]]
)
CLEAR = slice(90, 390), slice(60, 510)
"""Rows and columns where neither text nor buttons are."""


@pytest.fixture(scope="module")
def chromium():
    """What starts browsers."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield playwright.chromium


@contextlib.contextmanager
def launched(chromium, *flags: str) -> Iterator:
    """Start a browser whose pages wait as long as a busy machine needs."""
    with chromium.launch(executable_path=CHROMIUM, args=flags) as browser:
        for opening in ("new_context", "new_page"):
            setattr(browser, opening, functools.partial(_open_patiently, getattr(browser, opening)))
        yield browser


def _open_patiently(opening: Callable, **options):
    opened = opening(**options)
    opened.set_default_timeout(1000 * PATIENCE)
    return opened


@pytest.fixture(scope="module")
def browser(chromium):
    with launched(chromium, *FLAGS) as browser:
        yield browser


@pytest.fixture(scope="module")
def webgl_browser(chromium):
    """A browser that has WebGL, without a graphics card."""
    with launched(chromium, *WEBGL_FLAGS) as browser:
        yield browser


def unlike(picture: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Return the pixels (N, 2) that are brighter or darker than all that are at most two pixels away in the other."""
    wrong = np.zeros(picture.shape[:2], dtype=bool)
    for one, other in ((picture.astype(int), expected.astype(int)), (expected.astype(int), picture.astype(int))):
        wrong |= (one < around(other, np.minimum) - 40).any(axis=2) | (one > around(other, np.maximum) + 40).any(axis=2)
    return np.argwhere(wrong)


def around(picture: np.ndarray, choose: np.ufunc) -> np.ndarray:
    """Return the least or the greatest numbers that are at most two pixels away."""
    height, width = picture.shape[:2]
    padded = np.pad(picture, ((2, 2), (2, 2), (0, 0)), mode="edge")
    rows = choose.reduce([padded[shift : shift + height] for shift in range(5)])
    return choose.reduce([rows[:, shift : shift + width] for shift in range(5)])


def await_equal(picture: Callable[[], np.ndarray], expected: Callable[[], np.ndarray]) -> None:
    """Wait until a picture is as expected, but for what JPEG does to it where the machine is busy."""
    end = time.monotonic() + PATIENCE
    while (away := np.abs(picture() - expected())).max() > 40 or away.mean() > 0.5:
        wrong = f"it is wrong by up to {away.max()} and on average by {away.mean()} of 255"
        assert time.monotonic() < end, wrong


def assert_apart(page, selector: str, count: int) -> None:
    """Check that so many elements or more are whole on a page, and none on another."""
    shown = page.locator(selector)  # all at once: some come and go
    boxes = shown.evaluate_all(
        "all => all.map((one) => one.getBoundingClientRect().toJSON()).filter((box) => box.width)"
    )
    size = page.viewport_size
    for box in boxes:
        assert 0 <= box["left"] < box["right"] <= size["width"], box
        assert 0 <= box["top"] < box["bottom"] <= size["height"], box
    for pair in itertools.combinations(boxes, 2):
        orders = pair, pair[::-1]
        assert any(a["right"] <= b["left"] or a["bottom"] <= b["top"] for a, b in orders), pair
    assert len(boxes) >= count


class NearClient(Client):
    """Sends all pictures in full quality, also to a browser that shows them late because the machine is busy."""

    def __init__(self, *parts) -> None:
        super().__init__(*parts)
        self._pacing = ConnectionPacing(lambda: 0.0)


class Desk:
    """A page that is driven by real events, and the core on its own that is driven by the same ones."""

    def __init__(self, browser, load: Callable[[], ravemj.Environment], **context) -> None:
        self.env, self.other_env = load(), load()
        self.env.SetViewer("web")
        self.viewer = self.env.GetViewer()
        self.viewer._new_client = NearClient
        self.viewer.SetCamera(ASLANT, 0.8)
        self.robot, self.other_robot = self.env.GetRobots()[0], self.other_env.GetRobots()[0]
        self._start = self.robot.GetTransform()
        self.core = self.fresh_core()
        self.context = browser.new_context(viewport={"width": SIZE[0], "height": SIZE[1]}, has_touch=True, **context)
        self.troubles: list[str] = []
        self.page = self.open_page()

    def open_page(self):
        page = self.context.new_page()
        page.on("pageerror", lambda error: self.troubles.append(str(error)))
        page.on("console", lambda message: self.troubles.append(message.text))
        page.goto(self.viewer.url)
        page.wait_for_selector("[data-crisp]")
        return page

    def fresh_core(self) -> Interaction:
        """Return the core as the page's was at first."""
        core = Interaction.first_view(self.other_env.simulation, Camera(ASLANT), SIZE)
        core.look_from(Camera(ASLANT), 0.8)
        return core

    def reset(self) -> None:
        """Bring everything back to how it was at first."""
        for page in self.context.pages[1:]:
            page.close()
        self.page.set_viewport_size({"width": SIZE[0], "height": SIZE[1]})
        if self.viewer.GetSelectedBody() is not None:
            self.page.get_by_role("button", name="Interaction mode").click()
            self.page.mouse.click(SIZE[0] - 80, 10)
        self.page.get_by_role("button", name="Camera mode").click()
        self.page.mouse.move(SIZE[0] / 2, 60)
        for robot in (self.robot, self.other_robot):
            robot.SetTransform(self._start)
            robot.SetDOFValues(np.zeros(robot.GetDOF()))
        self.viewer.SetBkgndColor([1, 1, 1])
        self.viewer.SetCamera(ASLANT, 0.8)
        self.core = self.fresh_core()
        await_that(
            lambda: (
                self.viewer.GetSelectedBody() is None
                and np.array_equal(self.viewer.GetCameraTransform(), ASLANT)
                and self.page.get_attribute("body", "data-mode") == "camera"
            ),
            "something stays",
        )

    def close(self) -> None:
        self.context.close()
        self.env.Destroy()
        self.other_env.Destroy()

    # --- what is seen

    def picture(self, page=None) -> np.ndarray:
        """Return the pixels of the page, (height, width, 3)."""
        return np.asarray(Image.open(io.BytesIO((page or self.page).screenshot())).convert("RGB")).astype(int)

    def at(self, point) -> tuple[int, int]:
        """Where a point of the world is on the page."""
        ((x, y),), _ = self.core.view.camera.project([point], *SIZE)
        return round(x), round(y)

    def point(self, link: int, *local) -> np.ndarray:
        return (self.robot.GetLinks()[link].GetTransform() @ [*local, 1])[:3]

    @property
    def lines(self) -> list[str]:
        return self.page.inner_text("#text").split("\n")

    def await_picture(self, page=None) -> None:
        """Wait until the page shows what the core's camera would see of the environment, pixel by pixel."""

        def look():
            return self.picture(page)[CLEAR], self.expected(page)[CLEAR]

        if (page or self.page).evaluate("drawing === null"):
            await_equal(lambda: self.picture(page)[CLEAR], lambda: self.expected(page)[CLEAR])
        else:
            await_that(lambda: len(unlike(*look())) < 20, "the page does not show what the camera sees")

    def expected(self, page=None, *, shadows=None) -> np.ndarray:
        over = self.viewer._views[(page or self.page).evaluate("tab")].overlay()
        look = {"gizmos": over.primitives, "style": over.style}
        return self.viewer._renderer.render(self.core.view.camera, self.viewer.look, Format(*SIZE, shadows), **look)

    def await_camera(self) -> None:
        """Wait until the page's camera is the core's, in numbers and in pixels."""
        expected = self.core.view.camera.T_world_camera
        await_that(
            lambda: np.allclose(self.viewer.GetCameraTransform(), expected, atol=1e-9),
            f"the camera does not come to {expected}",
        )
        self.await_picture()

    def await_robot(self) -> None:
        """Wait until the robot is where the core's is, in numbers and in pixels."""
        other = self.other_robot
        await_that(
            lambda: (
                np.allclose(self.robot.GetDOFValues(), other.GetDOFValues(), atol=1e-9)
                and np.allclose(self.robot.GetTransform(), other.GetTransform(), atol=1e-9)
            ),
            f"the robot does not come to {other.GetDOFValues()}, {other.GetTransform()}",
        )
        self.await_picture()

    # --- hands

    def move(self, x, y):
        self.page.mouse.move(x, y)
        self.core.handle(Move(x, y))

    def press(self, at, button=Button.LEFT, keys=()):
        self.move(*at)
        for key in keys:
            self.page.keyboard.down(key)
            self.core.handle(Key(key))
        self.page.mouse.down(button=button.value)
        self.core.handle(Press(*at, button, "Control" in keys, "Shift" in keys))

    def release(self, at, button=Button.LEFT, keys=()):
        self.page.mouse.up(button=button.value)
        self.core.handle(Release(*at, button))
        for key in keys:
            self.page.keyboard.up(key)
            self.core.handle(Key(key, False))

    def drag(self, *stops, button=Button.LEFT, keys=()):
        self.press(stops[0], button, keys)
        for stop in stops[1:]:
            self.move(*stop)
        self.release(stops[-1], button, keys)

    def click(self, at, keys=()):
        self.drag(at, at, keys=keys)

    def wheel(self, steps):
        self.page.mouse.wheel(0, -100 * steps)
        self.core.handle(Wheel(steps))

    def escape(self):
        self.page.keyboard.press("Escape")
        self.core.handle(Key("escape"))
        self.core.handle(Key("escape", False))

    def roll(self, tool, amount):
        """Drag one of the wheels on the page."""
        box = self.page.locator(f"[role=slider][data-tool={tool.value}]").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        aside = box["width"] > box["height"]
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        for part in (0.4, 1):
            self.page.mouse.move(x + part * amount * aside, y + part * amount * (not aside))
        self.page.mouse.up()
        self.core.handle(Leave())
        self.core.handle(Use(tool, amount))

    def touch(self, *moments):
        """Put fingers on the page, one list of points for each moment; the last fingers leave."""
        session = self.context.new_cdp_session(self.page)
        before: list[tuple[float, float]] = []
        for points in (*moments, []):
            kind = "touchStart" if len(points) > len(before) else "touchMove" if points else "touchEnd"
            fingers = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})
            before = points
        session.detach()

    def touched(self, *events: Press | Move | Release | Fingers):
        """Have the core do what fingers should do."""
        for event in (*events, Leave()):
            self.core.handle(event)

    def pinched(self, *moments):
        """Have the core do what two fingers should do, one after the other in each moment."""
        fingers = [np.array(point, dtype=float) for point in moments[0]]
        for points in moments[1:]:
            for number, point in enumerate(points):
                before = sum(fingers) / 2, np.linalg.norm(fingers[0] - fingers[1])
                fingers[number] = np.array(point, dtype=float)
                middle = sum(fingers) / 2
                spread = np.linalg.norm(fingers[0] - fingers[1]) / before[1]
                self.core.handle(Fingers(*middle, *(middle - before[0]), spread))
