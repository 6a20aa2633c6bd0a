"""The viewer in a browser, as its page talks to it: pictures, gestures, and what strangers and broken pages send."""

import contextlib
import gc
import io
import json
import math
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import environment
from conftest import MODELS
from PIL import Image
from waiting import PATIENCE, await_that, time_limit
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

import ravemj
from ravemj.errors import RenderingError
from ravemj.graphics.rendering import Camera
from ravemj.gui.interaction import Button, Fingers, Key, Leave, Move, Press, Release, Use, ViewButton, Wheel
from ravemj.gui.interaction.joint_handle import JointHandle
from ravemj.gui.viewers.sharpness import LEVELS, Sharpness
from ravemj.gui.viewers.viewer import LOCKED
from ravemj.gui.viewers.web import WebViewer, server
from ravemj.gui.viewers.web import viewer as viewers
from ravemj.gui.viewers.web.client import Client
from ravemj.gui.viewers.web.frame_pacing import ConnectionPacing
from ravemj.gui.viewers.web.messages import DrawingSide, PageSize, Ready, parse

FROM_FRONT = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
SIZE = 400, 300


class Clocks:
    """What the tests turn, so that neither a slow nor a quick machine makes a difference.

    Attributes:
        way: Tells how long pictures are under way.
        rest: Tells how long nothing has changed.
    """

    way = rest = 0.0


class UntimedSharpness(Sharpness):
    """Time that is turned on while a picture is drawn is no time that drawing takes."""

    def add_measurement(self, level, seconds):
        super().add_measurement(level, 0.0)


class ClockedClient(Client):
    def __init__(self, *parts):
        super().__init__(*parts, clock=lambda: Clocks.rest)
        self._pacing = ConnectionPacing(lambda: Clocks.way)
        self._sharpness = UntimedSharpness()


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    env.SetViewer("web")
    env.GetViewer()._new_client = ClockedClient
    env.GetViewer().SetCamera(FROM_FRONT)
    yield env
    env.Destroy()


@pytest.fixture
def viewer(env):
    return env.GetViewer()


class Page:
    """What the page in a browser does."""

    def __init__(self, viewer, tab="", is_there=True, **more):
        origin = viewer.url.rsplit("/", 2)[0]
        url = viewer.url.replace("http", "ws", 1) + "socket" + (f"?tab={tab}" if tab else "")
        self._connection = connect(url, **{"origin": origin, "compression": None, **more})
        self.socket = self._connection.__enter__()
        self.overlay = None
        self.send(type="shape", width=SIZE[0], height=SIZE[1], ratio=1)
        if is_there:
            self.send(type="ready")

    def __enter__(self):
        return self

    def __exit__(self, *reason):
        self._connection.__exit__(*reason)

    def send(self, **message):
        self.socket.send(json.dumps(message))

    def receive(self, timeout=PATIENCE) -> Image.Image:
        """Wait for a picture."""
        self.overlay = json.loads(self.socket.recv(timeout))
        return Image.open(io.BytesIO(self.socket.recv(timeout)))

    def picture(self) -> np.ndarray:
        """Wait for a picture and say that it is shown."""
        picture = np.asarray(self.receive())
        self.send(type="ready")
        return picture

    def settled(self) -> np.ndarray:
        """Show pictures until one is crisp, since nothing changes any more."""
        self.overlay = {"crisp": False}
        while not self.overlay["crisp"]:
            Clocks.rest += 1
            picture = self.picture()
        return picture

    def hears_nothing(self):
        """Check that no message comes, for as long as a server that looks for changes 30 times a second would take."""
        with pytest.raises(TimeoutError):
            self.socket.recv(0.2)

    def read_to_the_end(self):
        while True:
            self.socket.recv(PATIENCE)

    def mouse(self, type, at, **more):
        self.send(type=type, x=at[0], y=at[1], **more)

    def drag(self, *stops, ctrl=False):
        self.mouse("press", stops[0], button="left", ctrl=ctrl, shift=False, touch=False)
        for stop in stops[1:]:
            self.mouse("move", stop)
        self.mouse("release", stops[-1], button="left")

    def escape(self):
        self.send(type="key", name="Escape", pressed=True)
        self.send(type="key", name="Escape", pressed=False)


def at(point):
    ((x, y),), _ = Camera(FROM_FRONT).project([point], *SIZE)
    return x, y


def test_the_page_needs_nothing_else(viewer):
    with urllib.request.urlopen(viewer.url, timeout=PATIENCE) as answer:
        page = answer.read().decode()
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    assert "<canvas" in page
    assert "http://" not in page
    assert "https://" not in page


def test_strangers_are_sent_away(viewer):
    root = viewer.url.rsplit("/", 2)[0]
    for url in (root + "/", root + "/socket", viewer.url + "other", viewer.url[:-2] + "/", viewer.url[:-1]):
        with pytest.raises(urllib.error.HTTPError) as caught:
            urllib.request.urlopen(url, timeout=PATIENCE)
        assert caught.value.code == 404
        caught.value.close()
    request = urllib.request.Request(viewer.url, headers={"Host": "evil.example"})
    with pytest.raises(urllib.error.HTTPError) as caught:
        urllib.request.urlopen(request, timeout=PATIENCE)
    assert caught.value.code == 404
    caught.value.close()
    for origin in (None, "http://evil.example", "null", root.replace("http", "https")):
        with pytest.raises(InvalidStatus, match="403"):
            Page(viewer, origin=origin)
    assert viewer.url.startswith("http://127.0.0.1:")


def test_pictures_come_when_something_changes_and_the_page_shows_them(env, viewer):
    robot = env.GetRobots()[0]
    with Page(viewer, is_there=False) as page:
        page.hears_nothing()
        page.send(type="ready")
        assert page.receive().format == "JPEG"
        page.send(type="ready")
        page.hears_nothing()
        Clocks.rest += 1
        crisp = page.receive()
        assert crisp.format == "PNG"
        expected = viewer.render(*SIZE, shadows=False)
        assert np.array_equal(np.asarray(crisp), expected)
        page.send(type="ready")
        page.hears_nothing()
        robot.SetDOFValues([math.pi / 2, 0])
        level = page.receive()
        assert level.format == "JPEG"
        assert np.abs(np.asarray(level).astype(int) - viewer.render(*SIZE, shadows=False)).mean() < 3
        robot.SetDOFValues([0, 0])
        page.receive()  # two may be under way, but no more
        robot.SetDOFValues([1, 0])
        page.hears_nothing()
        for _ in range(3):
            page.send(type="ready")
        assert np.abs(page.settled().astype(int) - viewer.render(*SIZE, shadows=False)).mean() < 0.5


def test_pictures_have_the_pixels_of_the_screen(viewer):
    with Page(viewer) as page:
        page.send(type="shape", width=300, height=200, ratio=2)
        await_that(lambda: page.picture().shape == (400, 600, 3))
        page.send(type="shape", width=8000, height=8000, ratio=3)
        await_that(lambda: page.picture().shape[0] > 600)
        assert page.settled().size <= 3 * 1920 * 1440


class TestLink:
    """Times are those of a clock that the tests turn."""

    @pytest.fixture
    def clock(self):
        return [0.0]

    @pytest.fixture
    def link(self, clock):
        link = ConnectionPacing(lambda: clock[0])
        link.shown()
        return link

    def show(self, link, clock, delay, is_moving=True):
        link.sent(is_moving=is_moving)
        clock[0] += delay
        link.shown()

    def test_two_pictures_are_under_way(self, link):
        assert not ConnectionPacing().is_free
        for _ in range(2):
            assert link.is_free
            link.sent(is_moving=True)
        assert not link.is_free
        link.shown()
        assert link.is_free

    def test_a_way_that_is_long_but_not_narrow_takes_the_best(self, link, clock):
        for _ in range(20):
            self.show(link, clock, 0.4)
        assert (link.quality, link.is_good, link.is_halved) == (85, True, False)

    def test_quality_falls_on_narrow_ways_and_comes_back(self, link, clock):
        self.show(link, clock, 0.02)
        for _ in range(6):
            self.show(link, clock, 0.5)
        assert link.quality < 40
        assert link.is_halved
        assert not link.is_good
        for _ in range(40):
            self.show(link, clock, 0.02)
        assert (link.quality, link.is_good, link.is_halved) == (85, True, False)

    def test_crisp_pictures_may_take_their_time(self, link, clock):
        self.show(link, clock, 0.02)
        self.show(link, clock, 5, is_moving=False)
        assert link.is_good


def test_pages_that_are_slow_are_sent_less(env, viewer):
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        page.settled()
        robot.SetDOFValues([0.1, 0])
        quick = page.picture()
        for step in range(2, 8):
            robot.SetDOFValues([0.1 * step, 0])
            picture = page.receive()
            Clocks.way += 0.25
            page.send(type="ready")
        assert quick.shape == (*SIZE[::-1], 3)
        assert picture.size == (SIZE[0] // 2, SIZE[1] // 2)
        while not page.overlay["crisp"]:
            Clocks.rest += 1
            picture = page.receive()
            page.send(type="ready")
        assert (picture.format, picture.size) == ("JPEG", SIZE)  # crisp, but as few bytes as can be
        assert np.abs(np.asarray(picture).astype(int) - viewer.render(*SIZE, shadows=False)).mean() < 1


def test_points_are_as_wide_in_coarse_pictures_as_in_crisp_ones(env, viewer, monkeypatch):
    half = next(level for level in LEVELS if level.scale == 0.5)
    monkeypatch.setattr(Sharpness, "level_while_moving", lambda self, now: half)
    point = env.plot3([0.3, 0, 0], 20, [0, 1, 0])
    with Page(viewer) as page:
        for scale, picture in ((0.5, page.picture()), (1, page.settled())):
            green = picture[:, :, 1] > picture[:, :, 0].astype(int) + 128
            assert green.any(axis=0).sum() == green.any(axis=1).sum() == pytest.approx(20 * scale, abs=1)
    del point


def test_gestures_move_what_the_script_reads(env, viewer):
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        page.escape()
        page.drag(at([0.01, 0, -0.3]), at([0.01, 0, -0.3]), ctrl=True)
        await_that(lambda: viewer.GetSelectedJoint() == robot.GetJoints()[1])
        page.settled()
        assert page.overlay["lines"][1:] == ["Robot Pendulum", "Joint Joint1, DOF 1: 0.000 rad, 0.0 deg"]
        assert page.overlay["mode"] == "interaction"
        handle = JointHandle.at(robot.simulation_state, 1)
        top = handle.center[0] + handle.height / 2
        stops = [[top, 0.02 * math.cos(angle), handle.center[2] + 0.02 * math.sin(angle)] for angle in (0, 0.4, 0.8)]
        page.drag(*map(at, stops))
        await_that(lambda: abs(abs(robot.GetDOFValues()[1]) - 0.8) < 1e-6)


def test_pages_have_cameras_of_their_own_and_share_what_is_selected(env, viewer):
    with Page(viewer) as one, Page(viewer) as other:
        one.settled()
        still = other.settled()
        one.send(type="wheel", steps=3)
        await_that(lambda: viewer.GetCameraTransform()[0, 3] < 0.9)
        other.hears_nothing()
        one.escape()
        one.drag((200, 160), (200, 160))
        await_that(lambda: viewer.GetSelectedBody() is not None)
        seen = other.settled()
        assert other.overlay["lines"][-1] == "Robot Pendulum"
        assert np.abs(seen.astype(int) - still).max() > 50
        one.send(type="move", x=-1, y=-1)  # what is under the pointer is brighter
        one.settled()
        viewer.SetCamera([[0, 0, -1, 3], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
        expected = viewer.render(*SIZE, shadows=False)
        for page in (one, other):  # an earlier picture may still be under way
            await_that(lambda page=page: np.abs(page.settled().astype(int) - expected).mean() < 0.1)


@pytest.mark.stress
def test_a_page_that_comes_back_has_the_view_that_it_had(viewer):
    with Page(viewer, "one") as page:
        page.escape()
        page.send(type="use", tool="Dolly", amount=50)
        await_that(lambda: viewer.GetCameraTransform()[0, 3] < 0.9)
        seen = page.settled()
        page.send(type="key", name="s", pressed=True)
        page.socket.socket.close()  # the connection is lost while a key is held
    viewer.interaction.look_from(Camera(FROM_FRONT))
    with Page(viewer, "one") as page, Page(viewer, "one") as duplicate, Page(viewer, "other") as other:
        assert np.array_equal(page.settled(), seen)
        assert page.overlay["mode"] == "interaction"
        assert np.array_equal(duplicate.settled(), seen)
        assert not np.array_equal(other.settled(), seen)
        assert other.overlay["mode"] == "camera"
        duplicate.send(type="use", tool="Dolly", amount=-50)
        assert not np.array_equal(duplicate.settled(), seen)
        page.hears_nothing()


def test_scripts_can_wait_until_pages_were_sent_everything(env, viewer, monkeypatch):
    monkeypatch.setattr(viewers, "_LONGEST_SYNC", math.inf)
    with time_limit():
        viewer.EnvironmentSync()  # there are no pages
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        for angle in (0.5, 1.0, 1.5):
            page.settled()
            robot.SetDOFValues([angle, 0])
            with time_limit():
                viewer.EnvironmentSync()
            expected = viewer.render(*SIZE, shadows=False)
            robot.SetDOFValues([angle - 0.5, 0])  # too late for the picture that was sent
            picture = page.picture()
            shrunk = Image.fromarray(expected).resize(picture.shape[1::-1])
            assert np.abs(picture.astype(int) - shrunk).mean() < 3


def test_scripts_do_not_wait_for_pages_that_show_nothing(env, viewer):
    with Page(viewer) as page:
        page.settled()
        for angle in (0.5, 1.0, 1.5):  # two pictures may be under way
            env.GetRobots()[0].SetDOFValues([angle, 0])
            with time_limit():
                viewer.EnvironmentSync()


def test_scripts_do_not_wait_for_tabs_that_nobody_sees(env, viewer, monkeypatch):
    monkeypatch.setattr(viewers, "_LONGEST_SYNC", math.inf)
    robot = env.GetRobots()[0]
    with Page(viewer) as page:
        page.settled()
        for angle in (0.5, 1.0):  # two pictures may be under way
            robot.SetDOFValues([angle, 0])
            page.receive()
        Clocks.way += 1
        robot.SetDOFValues([1.5, 0])
        with time_limit():
            viewer.EnvironmentSync()


def test_the_title_is_the_viewers(viewer):
    with Page(viewer) as page:
        page.settled()
        assert page.overlay["title"] == "web"
        viewer.SetTitle("My robot")
        page.settled()
        assert page.overlay["title"] == "My robot"


def test_pictures_of_pages_are_handed_to_callbacks(env, viewer):
    pictures = []
    handle = viewer.RegisterViewerImageCallback(pictures.append)
    with Page(viewer) as page:
        assert np.array_equal(page.settled(), pictures[-1])
    handle.Close()


def test_deep_messages_do_not_let_finalizers_fail():
    finalized = []

    class Circle:
        def __init__(self):
            self.itself = self

        def __del__(self):
            finalized.append(json.dumps([0]))

    thresholds = gc.get_threshold()
    rounds = range(500, 1000, 5)  # the collection begins at one depth of the parser after the other
    try:
        for threshold in rounds:
            Circle()
            gc.set_threshold(threshold)
            with pytest.raises(ValueError, match="not a message"):
                parse("[" * 1000)
    finally:
        gc.set_threshold(*thresholds)
    gc.collect()
    assert len(finalized) == len(rounds)


@pytest.mark.stress
def test_broken_pages_harm_nobody(viewer, caplog):
    with Page(viewer) as page, Page(viewer) as other:
        page.settled()
        for nonsense in ("", "{", "[]", "7", '{"type": "dance"}', '{"type": []}', b"\xff\xfe", "[" * 1000) * 20:
            page.socket.send(nonsense)
        for text in ('{"type": "move", "x": NaN, "y": 0}', '{"type": "use", "tool": [], "amount": 0}'):
            page.socket.send(text)
        page.send(type="key", name="Escape", pressed=True)
        page.settled()
        assert page.overlay["mode"] == "interaction"
        assert caplog.text.count("not a message of a viewer's page") == 1
        assert caplog.text.count("further cases") == 3
        page.socket.send("x" * 2000)
        with pytest.raises(ConnectionClosed):
            page.read_to_the_end()
        assert other.settled().shape == (*SIZE[::-1], 3)
        await_that(lambda: "a message is too long" in caplog.text)
    with Page(viewer) as page:
        page.socket.socket.close()  # the browser is gone in the middle of it
    with Page(viewer) as page:
        assert page.settled().shape == (*SIZE[::-1], 3)


def test_a_page_may_say_much_while_the_script_holds_the_environment(env, viewer):
    with Page(viewer) as page:
        page.settled()
        with env:
            for _ in range(1000):
                page.send(type="wheel", steps=0.01)
        await_that(lambda: viewer.GetCameraDistanceToFocus() == pytest.approx(1.2 * 0.9**10, rel=0.2))
        page.settled()


@pytest.mark.parametrize("backend", ["", "disable"])
def test_the_view_moves_while_the_script_has_the_environment_and_says_so(env, viewer, backend, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", backend)
    with Page(viewer) as page:
        before = page.settled()
        with env:
            page.send(type="use", tool="RotY", amount=90)
            assert np.abs(page.settled().astype(int) - before).max() > 50
            if LOCKED not in page.overlay["lines"]:
                Clocks.rest += 5
                page.picture()
            assert LOCKED in page.overlay["lines"]
        page.settled()
        assert LOCKED not in page.overlay["lines"]


def test_a_motion_is_shown_while_the_script_has_the_environment_and_no_search_of_a_planner_is(env, viewer):
    """Steps of time are shown, and what the script publishes; not what moves in between."""
    robot = env.GetRobots()[0]
    env.StopSimulation()
    with Page(viewer) as page:
        before = page.settled().astype(int)
        with env:
            await_that(lambda: env.simulation.published.is_wanted)
            values = robot.GetDOFValues()
            robot.SetDOFValues(values + 0.8)
            for amount in (90, -90):  # the view has to be drawn again
                page.send(type="use", tool="RotY", amount=amount)
                again = page.settled()
            assert np.abs(again.astype(int) - before).max() < 10
            robot.SetDOFValues(values)
            trajectory = ravemj.RaveCreateTrajectory(env, "")
            trajectory.Init(robot.GetActiveConfigurationSpecification("linear"))
            trajectory.Insert(0, [*values, *(values + 0.8)])
            ravemj.planningutils.RetimeActiveDOFTrajectory(trajectory, robot)
            robot.GetController().SetPath(trajectory)
            env.StepSimulation(trajectory.GetDuration() / 2)
            env.StepSimulation(trajectory.GetDuration() / 2)
            await_that(lambda: np.abs(page.settled() - before).max() > 50)
            robot.SetDOFValues(values)
            env.UpdatePublishedBodies()
            await_that(lambda: np.abs(page.settled() - before).max() < 10)


def test_a_page_that_comes_while_the_script_has_the_environment_keeps_nobody_waiting(env, viewer):
    with env, Page(viewer), time_limit():
        await_that(lambda: viewer._clients)
        viewer.SetCamera(FROM_FRONT)


def test_a_body_is_removed_while_it_is_selected(env, viewer):
    viewer.SetBkgndColor([1, 1, 1])
    with Page(viewer) as page:
        page.escape()
        page.drag((200, 160), (200, 160))
        await_that(lambda: viewer.GetSelectedBody() is not None)
        page.settled()
        env.Remove(env.GetRobots()[0])
        empty = page.settled()
        assert (empty == 255).all()
        assert page.overlay["lines"] == []
        assert viewer.GetSelectedBody() is None


def test_a_second_viewer_takes_the_place_of_the_first(env, viewer):
    with Page(viewer) as page:
        page.settled()
        env.SetViewer("web")
        with pytest.raises(ConnectionClosed) as caught:
            page.socket.recv(PATIENCE)
        assert caught.value.rcvd.code == 1001
        with Page(env.GetViewer()) as other:
            other.settled()
    assert not viewer.is_open


@pytest.mark.stress
def test_strangers_that_say_nothing_do_not_keep_a_viewer_open(env, monkeypatch):
    monkeypatch.setattr(server, "_HANDSHAKE", 10 * PATIENCE)
    env.SetViewer("web")
    viewer = env.GetViewer()
    with socket.create_connection(("127.0.0.1", viewer.server.port)), Page(viewer) as page:
        page.settled()
        with time_limit():
            env.Destroy()


@pytest.mark.stress
def test_a_page_that_stands_still_does_not_keep_a_viewer_open(env, viewer):
    """It takes nothing more from its socket, and does not answer when it is told that the viewer closes."""
    connection = socket.create_connection(("127.0.0.1", viewer.server.port))
    token = viewer.url.split("/")[3]
    lines = (
        f"GET /{token}/socket HTTP/1.1",
        f"Host: 127.0.0.1:{viewer.server.port}",
        f"Origin: http://127.0.0.1:{viewer.server.port}",
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
    )
    connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
    assert b"101 Switching" in connection.recv(1000)
    with time_limit():
        env.Destroy()
    connection.close()


@pytest.mark.parametrize(
    ("port", "reason"),
    [("taken", "address already in use"), ("name", "name or service not known|not known|resolution")],
)
def test_a_port_that_cannot_be_had_is_an_error(env, viewer, port, reason):
    where = {"port": viewer.server.port} if port == "taken" else {"host": "no.such.host.invalid"}
    with pytest.raises(RenderingError, match=f"no page can be served at .*({reason})"):
        WebViewer(env.simulation, env.renderer, "web", **where)


def test_a_script_ends_although_a_page_is_open(tmp_path):
    code = f"""
import ravemj
env = ravemj.load({str(MODELS / "env.xml")!r})
env.SetViewer("web")
print(env.GetViewer().url, flush=True)
input()
"""
    variables = environment(tmp_path)
    script = subprocess.Popen([sys.executable, "-c", code], env=variables, stdin=-1, stdout=-1, stderr=-1, text=True)
    with script, Page(SimpleNamespace(url=script.stdout.readline().strip())) as page:
        page.settled()
        script.stdin.write("\n")
        script.stdin.flush()
        assert script.wait(PATIENCE) == 0
        with pytest.raises(ConnectionClosed):
            page.read_to_the_end()
        assert "Traceback" not in script.stderr.read()


def test_a_page_leaves_with_a_forgotten_environment():
    def show():
        env = ravemj.load(MODELS / "env.xml")
        env.SetViewer("web")
        page = Page(env.GetViewer())
        page.settled()
        return page

    def is_gone(page):
        gc.collect()
        try:
            page.socket.recv(0.1)
        except ConnectionClosed:
            return True
        except TimeoutError:
            return False

    with show() as page:
        await_that(lambda: is_gone(page))


def test_closing_ends_all_pages_and_main(env, viewer):
    with Page(viewer) as page:
        page.settled()
        assert viewer.is_open
        with env:  # nobody waits for who holds the environment
            env.SetViewer("")
        assert not viewer.is_open
        assert viewer.main() == 0
        with pytest.raises(ConnectionClosed):
            page.socket.recv(PATIENCE)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(viewer.url, timeout=PATIENCE)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            '{"type":"press","x":1,"y":2.5,"button":"middle","ctrl":true,"shift":false,"touch":true}',
            Press(1, 2.5, Button.MIDDLE, True, touch=True),
        ),
        ('{"type":"release","x":1,"y":2,"button":"left"}', Release(1, 2)),
        ('{"type":"move","x":1,"y":2}', Move(1, 2)),
        ('{"type":"wheel","steps":-1}', Wheel(-1)),
        ('{"type":"fingers","x":5,"y":6,"right":1,"down":-2,"spread":1.5}', Fingers(5, 6, 1, -2, 1.5)),
        ('{"type":"use","tool":"RotX","amount":-3}', Use(ViewButton.ROT_X, -3)),
        ('{"type":"key","name":"s","pressed":true}', Key("s")),
        ('{"type":"leave"}', Leave()),
        ('{"type":"ready"}', Ready()),
        ('{"type":"draws","itself":false}', DrawingSide(False)),
        ('{"type":"shape","width":3,"height":4,"ratio":1.5}', PageSize(3, 4, 1.5)),
    ],
)
def test_messages(text, message):
    assert parse(text) == message
    fields = json.loads(text)
    for name in fields:
        for wrong in (None, [], "?", True, 1e9, float("inf"), {}):
            if name in ("name", "pressed", "ctrl", "shift", "touch", "itself") and wrong in ("?", True):
                continue
            with pytest.raises(ValueError):  # noqa: PT011 - whatever it says
                parse(json.dumps({**fields, name: wrong}))
        with pytest.raises(ValueError):  # noqa: PT011 - whatever it says
            parse(json.dumps({key: value for key, value in fields.items() if key != name}))


@pytest.mark.stress
@pytest.mark.parametrize("pictures", [3, pytest.param(1000, marks=pytest.mark.stress)])
def test_a_script_a_hand_and_an_onlooker_share_one_environment(env, viewer, pictures):
    """The script turns one joint, the hand another one, until all have been served; nothing is torn."""
    robot = env.GetRobots()[0]
    shown, ending = Counter(), threading.Event()

    def look(page):
        while not ending.is_set():
            with contextlib.suppress(TimeoutError):
                page.receive(0.5)
                page.send(type="ready")
                shown[page] += 1

    with Page(viewer) as page, Page(viewer) as onlooker:
        page.escape()
        page.drag(at([0.01, 0, -0.3]), at([0.01, 0, -0.3]), ctrl=True)
        await_that(lambda: viewer.GetSelectedJoint() is not None)
        x, y = at(JointHandle.at(robot.simulation_state, 1).center)
        page.mouse("press", (x + 5, y), button="left", ctrl=False, shift=False, touch=False)
        lookers = [threading.Thread(target=look, args=[one]) for one in (page, onlooker)]
        for looker in lookers:
            looker.start()
        count, turned = 0, set()
        end = time.monotonic() + PATIENCE + pictures
        while len(turned) <= 10 or min(shown[page], shown[onlooker]) < pictures:
            assert time.monotonic() < end, (count, turned, shown)
            robot.SetDOFValues([0.001 * count], [0])
            page.mouse("move", (x + 5 * math.cos(count / 20), y + 5 * math.sin(count / 20)))
            T_base, T_arm0, T_arm1 = robot.link_transforms()
            np.testing.assert_allclose(T_arm0 @ [0.2, 0, 0, 1], T_arm1[:, 3], atol=1e-12)
            assert np.array_equal(T_base[:3, 3], [0, 0, 0])
            first, second = robot.GetDOFValues()
            assert first == pytest.approx(0.001 * count)
            turned.add(round(second, 2))
            count += 1
            time.sleep(0.01)
        ending.set()
        for looker in lookers:
            looker.join(PATIENCE)
            assert not looker.is_alive()


# --- the secret in the address


def test_a_page_finds_a_viewer_again_that_was_started_anew(env):
    viewer = env.serve_viewer(token="robots-2026")
    port = viewer.server.port
    assert viewer.url == f"http://127.0.0.1:{port}/robots-2026/"
    with Page(viewer) as page:
        page.settled()
    env.SetViewer("")
    again = env.serve_viewer(port=port, token="robots-2026")
    assert again.url == viewer.url
    with Page(again) as page:
        page.settled()


@pytest.mark.parametrize("token", ["", "short", "with space", "a/b/c/d/e", "x" * 65, "äöüäöüäö"])
def test_a_token_that_is_no_part_of_an_address_is_refused(env, viewer, token):
    with pytest.raises(ravemj.errors.ArgumentError, match="token"):
        env.serve_viewer(token=token)
    assert env.GetViewer() is viewer


def test_strangers_that_say_nothing_do_not_keep_others_out(env, viewer):
    with contextlib.ExitStack() as strangers:
        for _ in range(80):
            strangers.enter_context(socket.create_connection(("127.0.0.1", viewer.server.port)))
        with Page(viewer) as page, Page(viewer) as other:
            page.settled()
            other.settled()
