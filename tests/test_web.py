"""The viewer in a browser, as its page talks to it: pictures, gestures, and what strangers and broken pages send."""

import io
import json
import math
import time
import urllib.error
import urllib.request

import numpy as np
import pytest
from conftest import MODELS
from PIL import Image
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

import ravemj
from ravemj.interaction import Button, Key, Leave, Move, Press, Release, Resize, Wheel
from ravemj.interaction.joint_handle import JointHandle
from ravemj.rendering import Camera
from ravemj.viewers.web.messages import Ready, Shape, parse

FROM_FRONT = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
SIZE = 400, 300


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    env.SetViewer("web")
    env.GetViewer().SetCamera(FROM_FRONT)
    yield env
    env.Destroy()


@pytest.fixture
def viewer(env):
    return env.GetViewer()


class Page:
    """What the page in a browser does."""

    def __init__(self, viewer, **more):
        origin = viewer.url.rsplit("/", 2)[0]
        url = viewer.url.replace("http", "ws", 1) + "socket"
        self._connection = connect(url, **{"origin": origin, "compression": None, **more})
        self.socket = self._connection.__enter__()
        self.overlay = None
        self.send(type="shape", width=SIZE[0], height=SIZE[1], ratio=1)

    def __enter__(self):
        return self

    def __exit__(self, *reason):
        self._connection.__exit__(*reason)

    def send(self, **message):
        self.socket.send(json.dumps(message))

    def picture(self, timeout=10) -> np.ndarray:
        """Ask for a picture and wait for it."""
        self.send(type="ready")
        self.overlay = json.loads(self.socket.recv(timeout))
        return np.asarray(Image.open(io.BytesIO(self.socket.recv(timeout))))

    def read_to_the_end(self):
        while True:
            self.socket.recv(10)

    def crisp_picture(self) -> np.ndarray:
        self.picture()
        return self.picture()

    def mouse(self, type, at, **more):
        self.send(type=type, x=at[0], y=at[1], **more)

    def drag(self, *stops, ctrl=False):
        self.mouse("press", stops[0], button="left", ctrl=ctrl, shift=False)
        for stop in stops[1:]:
            self.mouse("move", stop)
        self.mouse("release", stops[-1], button="left", ctrl=ctrl, shift=False)

    def escape(self):
        self.send(type="key", name="Escape", pressed=True)
        self.send(type="key", name="Escape", pressed=False)


def at(point):
    ((x, y),), _ = Camera(FROM_FRONT).project([point], *SIZE)
    return x, y


def await_that(condition, seconds=10):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_the_page_needs_nothing_else(viewer):
    with urllib.request.urlopen(viewer.url, timeout=10) as answer:
        page = answer.read().decode()
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    assert "<canvas" in page
    assert "http://" not in page
    assert "https://" not in page


def test_strangers_are_sent_away(viewer):
    root = viewer.url.rsplit("/", 2)[0]
    for url in (root + "/", root + "/socket", viewer.url + "other", viewer.url[:-2] + "/", viewer.url[:-1]):
        with pytest.raises(urllib.error.HTTPError) as caught:
            urllib.request.urlopen(url, timeout=10)
        assert caught.value.code == 404
        caught.value.close()
    request = urllib.request.Request(viewer.url, headers={"Host": "evil.example"})
    with pytest.raises(urllib.error.HTTPError) as caught:
        urllib.request.urlopen(request, timeout=10)
    assert caught.value.code == 404
    caught.value.close()
    for origin in (None, "http://evil.example", "null", root.replace("http", "https")):
        with pytest.raises(InvalidStatus, match="403"):
            Page(viewer, origin=origin)
    assert viewer.url.startswith("http://127.0.0.1:")


def test_pictures_come_when_something_changes_and_the_page_is_ready(env, viewer):
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        first = page.crisp_picture()
        assert first.shape == (*SIZE[::-1], 3)
        expected = viewer.render(*SIZE)
        assert np.abs(first.astype(int) - expected).mean() < 2
        page.send(type="ready")
        with pytest.raises(TimeoutError):
            page.socket.recv(0.7)
        robot.SetDOFValues([math.pi / 2, 0])
        page.overlay = json.loads(page.socket.recv(10))
        level = np.asarray(Image.open(io.BytesIO(page.socket.recv(10))))
        assert np.abs(level.astype(int) - viewer.render(*SIZE)).mean() < 3
        robot.SetDOFValues([0, 0])
        with pytest.raises(TimeoutError):
            page.socket.recv(0.5)  # it has not said that it has shown the last one
        assert np.abs(page.picture().astype(int) - expected).mean() < 3
        page.send(type="shape", width=300, height=200, ratio=2)
        await_that(lambda: page.picture().shape == (400, 600, 3))
        page.send(type="shape", width=8000, height=8000, ratio=3)
        await_that(lambda: page.picture().shape[0] > 600)
        assert page.picture().size <= 3 * 1920 * 1440


def test_gestures_move_what_the_script_reads(env, viewer):
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        page.escape()
        page.drag(at([0.01, 0, -0.3]), at([0.01, 0, -0.3]), ctrl=True)
        await_that(lambda: viewer.GetSelectedJoint() == robot.GetJoints()[1])
        page.picture()
        assert page.overlay["lines"][1:] == ["Robot Pendulum", "Joint Joint1, DOF 1: 0.000 rad, 0.0 deg"]
        handle = JointHandle.at(robot._state, 1)
        top = handle.center[0] + handle.height / 2
        stops = [[top, 0.02 * math.cos(angle), handle.center[2] + 0.02 * math.sin(angle)] for angle in (0, 0.4, 0.8)]
        page.drag(*map(at, stops))
        await_that(lambda: abs(abs(robot.GetDOFValues()[1]) - 0.8) < 1e-6)


def test_pages_have_cameras_of_their_own_and_share_what_is_selected(env, viewer):
    with Page(viewer) as one, Page(viewer) as other:
        one.crisp_picture()
        still = other.crisp_picture()
        one.send(type="wheel", steps=3)
        await_that(lambda: viewer.GetCameraTransform()[0, 3] < 0.9)
        other.send(type="ready")
        with pytest.raises(TimeoutError):
            other.socket.recv(0.5)
        one.escape()
        one.drag((200, 160), (200, 160))
        await_that(lambda: viewer.GetSelectedBody() is not None)
        other.overlay = json.loads(other.socket.recv(10))
        assert other.overlay["lines"][-1] == "Robot Pendulum"
        assert np.abs(np.asarray(Image.open(io.BytesIO(other.socket.recv(10)))).astype(int) - still).max() > 50
        viewer.SetCamera([[0, 0, -1, 3], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        time.sleep(0.2)
        for page in (one, other):
            await_that(lambda page=page: np.abs(page.picture().astype(int) - viewer.render(*SIZE)).mean() < 3)


def test_broken_pages_harm_nobody(viewer, caplog):
    with Page(viewer) as page, Page(viewer) as other:
        for nonsense in ("", "{", "[]", "7", '{"type": "dance"}', '{"type": "move", "x": NaN, "y": 0}', b"\xff\xfe"):
            page.socket.send(nonsense)
        page.socket.send("[" * 1000)
        assert page.picture().shape == (*SIZE[::-1], 3)
        assert 0 < caplog.text.count("is ignored") <= 5
        page.socket.send("x" * 2000)
        with pytest.raises(ConnectionClosed):
            page.read_to_the_end()
        assert other.picture().shape == (*SIZE[::-1], 3)
    with Page(viewer) as page:
        page.socket.socket.close()  # the browser is gone in the middle of it
    with Page(viewer) as page:
        assert page.picture().shape == (*SIZE[::-1], 3)


def test_closing_ends_all_pages_and_main(env, viewer):
    with Page(viewer) as page:
        page.picture()
        assert viewer.is_open
        with env:  # nobody waits for who holds the environment
            env.SetViewer("")
        assert not viewer.is_open
        assert viewer.main() == 0
        with pytest.raises(ConnectionClosed):
            page.socket.recv(10)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(viewer.url, timeout=10)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            '{"type":"press","x":1,"y":2.5,"button":"middle","ctrl":true,"shift":false}',
            Press(1, 2.5, Button.MIDDLE, True),
        ),
        ('{"type":"release","x":1,"y":2,"button":"left"}', Release(1, 2)),
        ('{"type":"move","x":1,"y":2}', Move(1, 2)),
        ('{"type":"wheel","steps":-1}', Wheel(-1)),
        ('{"type":"key","name":"s","pressed":true}', Key("s")),
        ('{"type":"leave"}', Leave()),
        ('{"type":"ready"}', Ready()),
        ('{"type":"shape","width":3,"height":4,"ratio":1.5}', Shape(Resize(3, 4), 1.5)),
    ],
)
def test_messages(text, message):
    assert parse(text) == message
    fields = json.loads(text)
    for name in fields:
        for wrong in (None, [], "?", True, 1e9, float("inf"), {}):
            if name in ("name", "pressed", "ctrl", "shift") and wrong in ("?", True):
                continue
            with pytest.raises(ValueError):  # noqa: PT011 - whatever it says
                parse(json.dumps({**fields, name: wrong}))
        with pytest.raises(ValueError):  # noqa: PT011 - whatever it says
            parse(json.dumps({key: value for key, value in fields.items() if key != name}))


def test_a_script_a_hand_and_an_onlooker_share_one_environment(env, viewer):
    """The script turns one joint, the hand another one; nobody waits for long and nothing is torn."""
    robot = env.GetRobots()[0]
    with Page(viewer) as page, Page(viewer) as onlooker:
        page.escape()
        page.drag(at([0.01, 0, -0.3]), at([0.01, 0, -0.3]), ctrl=True)
        await_that(lambda: viewer.GetSelectedJoint() is not None)
        centre = at(JointHandle.at(robot._state, 1).center)
        page.mouse("press", (centre[0] + 5, centre[1]), button="left", ctrl=False, shift=False)
        start = time.monotonic()
        for step in range(100):
            robot.SetDOFValues([0.001 * step], [0])
            page.mouse("move", (centre[0] + 5 * math.cos(step / 20), centre[1] + 5 * math.sin(step / 20)))
            if step % 20 == 0:
                page.picture()
                onlooker.picture()
            T_base, T_arm0, T_arm1 = robot.link_transforms()
            np.testing.assert_allclose(T_arm0 @ [0.2, 0, 0, 1], T_arm1[:, 3], atol=1e-12)
            assert np.array_equal(T_base[:3, 3], [0, 0, 0])
        assert time.monotonic() - start < 10
        await_that(lambda: abs(robot.GetDOFValues()[1]) > 1)
        assert robot.GetDOFValues()[0] == pytest.approx(0.099)
