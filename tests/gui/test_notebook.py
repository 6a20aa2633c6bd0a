"""Viewers in notebooks: the page in the cell, also through the notebook's server."""

import contextlib
import re
import socket
import socketserver
import sys
import threading
from types import SimpleNamespace

import pytest
from browsers import NEEDS_A_BROWSER
from conftest import MODELS
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from waiting import PATIENCE
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import ravemj
from ravemj.gui.viewers import notebook
from ravemj.gui.viewers.web import WebViewer


@pytest.fixture
def kernel(monkeypatch):
    """IPython as notebooks have it."""
    shell = InteractiveShell.instance()
    monkeypatch.setattr(shell, "kernel", SimpleNamespace(), raising=False)
    yield shell
    InteractiveShell.clear_instance()


@pytest.fixture
def proxied(monkeypatch, kernel):
    """And with the package that lets browsers through to other ports."""
    found = notebook.importlib.util.find_spec
    monkeypatch.setattr(
        notebook.importlib.util, "find_spec", lambda name: name if name == "jupyter_server_proxy" else found(name)
    )
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/maria/")


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    yield env
    env.Destroy()


def shown(env, name):
    with capture_output() as captured:
        env.SetViewer(name)
    assert captured.stdout == ""
    return [output.data for output in captured.outputs]


@pytest.mark.parametrize("name", ["web", "qtcoin", "qtosg"])
def test_the_page_is_shown_in_the_cell(kernel, env, name, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    (data,) = shown(env, name)
    viewer = env.GetViewer(name)
    assert isinstance(viewer, WebViewer)
    assert f'<iframe src="{viewer.url}"' in data["text/html"]
    assert data["text/plain"] == f"<viewer:{name}>"


def test_what_is_asked_for_otherwise_is_not_shown_there(kernel, env, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    assert shown(env, "offscreen") == []
    assert shown(env, "window") == []
    assert not isinstance(env.GetViewer(), WebViewer)


def test_no_cell_without_a_kernel(env, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    assert shown(env, "web") == []
    assert shown(env, "qtcoin") == []
    assert "IPython" in sys.modules


def test_the_notebooks_server_leads_to_the_page(proxied, env):
    (data,) = shown(env, "web")
    server = env.GetViewer().server
    source = re.search(r'<iframe src="([^"]*)"', data["text/html"])[1]
    assert source == f"/user/maria/proxy/{server.port}/{server.token}/"


@pytest.mark.parametrize(
    ("headers", "origin", "is_let_in"),
    [
        ({"Host": "hub.example"}, "https://hub.example", True),
        ({"Host": "hub.example:8000"}, "http://hub.example:8000", True),
        ({"X-Forwarded-Host": "hub.example, inner"}, "https://hub.example", True),
        ({"Host": "hub.example"}, "https://evil.example", False),
        ({"X-Forwarded-Host": "hub.example"}, "https://evil.example", False),
        ({}, "https://hub.example", False),
        ({"X-Forwarded-Host": ""}, "null", False),
    ],
)
def test_pages_of_the_notebooks_server_only_are_let_in(proxied, env, headers, origin, is_let_in):
    shown(env, "web")
    server = env.GetViewer().server
    host = headers.pop("Host", f"127.0.0.1:{server.port}")
    address = f"ws://{host}/{server.token}/socket"

    def come():
        sock = socket.create_connection(("127.0.0.1", server.port))
        return connect(address, sock=sock, origin=origin, additional_headers=headers, compression=None)

    if is_let_in:
        with come() as connection:
            connection.send('{"type": "ready"}')
            assert "camera" in connection.recv(PATIENCE)
    else:
        with pytest.raises(InvalidStatus, match="403"):
            come()


class Proxy(socketserver.ThreadingTCPServer):
    """Hands what comes for a prefix on to ports of this machine, as jupyter-server-proxy does."""

    daemon_threads = True

    class RequestHandlerClass(socketserver.StreamRequestHandler):
        def handle(self):
            method, path, *rest = self.rfile.readline().decode().split(" ")
            port, inner = re.fullmatch(r"/user/maria/proxy/(\d+)(/.*)", path).groups()
            with socket.create_connection(("127.0.0.1", int(port))) as upstream:
                upstream.sendall(" ".join([method, inner, *rest]).encode())
                threading.Thread(target=self.pump, args=(self.rfile.read1, upstream.sendall), daemon=True).start()
                self.pump(upstream.recv, self.wfile.write)

        def pump(self, receive, send):
            with contextlib.suppress(OSError, ValueError):
                while data := receive(65536):
                    send(data)

    def __init__(self):
        super().__init__(("127.0.0.1", 0), self.RequestHandlerClass)


@NEEDS_A_BROWSER[0]
@NEEDS_A_BROWSER[1]
@NEEDS_A_BROWSER[2]
def test_the_page_works_behind_the_notebooks_server(proxied, env, browser):
    (data,) = shown(env, "web")
    source = re.search(r'<iframe src="([^"]*)"', data["text/html"])[1]
    with Proxy() as proxy:
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{proxy.server_address[1]}{source}")
        page.wait_for_selector("[data-crisp=true]")
        page.keyboard.press("Escape")
        page.wait_for_selector("[data-mode=interaction]")
        page.close()
        proxy.shutdown()
