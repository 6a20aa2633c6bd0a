"""The command ``ravemj view``: a window where there is a display, else a page."""

import json
import signal
import socket
import urllib.request

import pytest
from command_line import Served, ravemj_command
from screens import NEEDS_A_SCREEN, Started
from waiting import PATIENCE
from websockets.frames import CloseCode
from websockets.sync.client import connect

import ravemj
from ravemj.cli.models import hold_bases


def served(folder, *options) -> Served:
    return Served(folder, "view", *options, "env.xml")


@pytest.mark.parametrize(
    ("options", "number", "end"),
    [
        (["--web"], signal.SIGINT, (0, "", "")),
        pytest.param([], signal.SIGINT, (0, "", ""), marks=pytest.mark.stress),
        pytest.param(["--web"], signal.SIGTERM, (143, "", "ravemj: ended by SIGTERM\n"), marks=pytest.mark.stress),
    ],
    ids=["web", "without a display", "terminated"],
)
def test_one_address_is_printed_and_a_signal_ends_it(folder, options, number, end):
    with served(folder, *options) as page:
        with urllib.request.urlopen(page.url, timeout=PATIENCE) as answer:
            assert b"<canvas" in answer.read()
        address = page.url.replace("http", "ws", 1) + "socket"
        with connect(address, origin=page.url.rsplit("/", 2)[0], compression=None) as connection:
            connection.send('{"type": "ready"}')
            assert json.loads(connection.recv(PATIENCE))["mode"] == "camera"
            assert page.end(number) == end
            list(connection)  # what was on its way
            assert connection.protocol.close_code == CloseCode.GOING_AWAY, "the page is told"


@pytest.mark.stress
def test_the_port_is_the_one_that_is_asked_for_or_an_error(folder):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        refused = ravemj_command(folder, "view", "--web", "--port", port, "env.xml")
        assert (refused.returncode, refused.stdout) == (1, "")
        assert refused.stderr.startswith(f"ravemj: error: no page can be served at port {port} of 127.0.0.1: address")
        assert refused.stderr.count("\n") == 1
    with served(folder, "--web", "--port", port) as page:
        assert page.url.startswith(f"http://127.0.0.1:{port}/")


@pytest.mark.stress
def test_another_host_is_served_with_a_warning(folder):
    with served(folder, "--web", "--host", "0.0.0.0") as page:
        port = page.url.split(":")[2].split("/")[0]
        token = page.url.split("/")[3]
        request = urllib.request.Request(f"http://127.0.0.1:{port}/{token}/", headers={"Host": "robots.example"})
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            assert b"<canvas" in answer.read()
        code, _, warning = page.end(signal.SIGINT)
        assert code == 0
        assert "ravemj: warning: browsers of other machines can come here" in warning


@pytest.mark.stress
def test_the_robot_of_the_option_is_looked_at_and_selected(folder):
    with Served(folder, "view", "--web", "workshop", "--robot", "scara") as page:
        address = page.url.replace("http", "ws", 1) + "socket"
        with connect(address, origin=page.url.rsplit("/", 2)[0], compression=None) as connection:
            connection.send('{"type": "ready"}')
            assert "Robot scara" in json.loads(connection.recv(PATIENCE))["lines"]


def test_physics_runs_from_the_start_and_can_be_paused(folder):
    with served(folder, "--web", "--physics") as page:
        address = page.url.replace("http", "ws", 1) + "socket"
        with connect(address, origin=page.url.rsplit("/", 2)[0], compression=None) as connection:

            def is_running() -> bool:
                connection.send('{"type": "ready"}')
                news = {}
                while "controls" not in news:
                    message = connection.recv(PATIENCE)
                    news = json.loads(message) if isinstance(message, str) else {}
                return next(control["is_on"] for control in news["controls"] if control["name"] == "run")

            assert is_running()
            connection.send('{"type": "operate", "name": "run", "value": 0}')
            while is_running():
                connection.recv(PATIENCE)
        assert page.end(signal.SIGINT) == (0, "", "")


def test_with_physics_robots_fall_only_where_something_is_static(folder):
    env = ravemj.load(folder / "env.xml")
    hold_bases(env)
    assert [link.IsStatic() for link in env.GetRobots()[0].GetLinks()] == [True, False, False]
    on_floor = ravemj.load(folder / "env.xml")
    floor = ravemj.RaveCreateKinBody(on_floor, "")
    floor.InitFromBoxes([[0, 0, -1, 1, 1, 0.1]])
    floor.SetName("floor")
    floor.GetLinks()[0].SetStatic(True)
    on_floor.Add(floor)
    hold_bases(on_floor)
    assert not any(link.IsStatic() for link in on_floor.GetRobots()[0].GetLinks())


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--port", "70000", "env.xml"], 2, "'70000' is not the number of a port, from 0 to 65535"),
        (["--web", "--host", "no.such.host.invalid", "env.xml"], 1, "no page can be served at no.such.host"),
        (["missing.xml"], 1, "missing.xml"),
    ],
)
def test_what_cannot_be_shown_is_one_line(folder, options, code, message):
    done = ravemj_command(folder, "view", *options)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (code, "", 1)
    assert message in done.stderr


@pytest.mark.parametrize(
    "how",
    [
        pytest.param("closed", marks=NEEDS_A_SCREEN),
        pytest.param("interrupted", marks=[*NEEDS_A_SCREEN, pytest.mark.stress]),
    ],
)
def test_a_window_where_there_is_a_display(display, folder, how):
    with Started(display, folder, "-m", "ravemj", "view", "env.xml") as command:
        window = display.await_window()
        if how == "closed":
            display.close(window)
        else:
            command.process.send_signal(signal.SIGINT)
        assert command.end() == ((0, "", "") if how == "closed" else (130, "", "ravemj: interrupted\n"))
