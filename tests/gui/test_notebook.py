"""Viewers in notebooks: the page in the cell, also through the notebook's server."""

import base64
import contextlib
import functools
import http.server
import io
import re
import socket
import socketserver
import sys
import threading
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER
from conftest import MODELS, one_in
from IPython.core.formatters import HTMLFormatter
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from PIL import Image
from waiting import PATIENCE
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import ravemj
from ravemj.gui.viewers import notebook
from ravemj.gui.viewers.web import WebViewer

REMOTE = ["SSH_CONNECTION", "JUPYTERHUB_SERVICE_PREFIX", "CODESPACES", "VSCODE_IPC_HOOK_CLI", "KAGGLE_KERNEL_RUN_TYPE"]


@pytest.fixture
def kernel(monkeypatch):
    """IPython as notebooks have it, on the machine of the browser."""
    for variable in REMOTE:
        monkeypatch.delenv(variable, raising=False)
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


@pytest.mark.parametrize("name", one_in(3, ["web", "qtcoin", "qtosg"]))
def test_the_page_is_shown_in_the_cell(kernel, env, name, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    (data,) = shown(env, name)
    viewer = env.GetViewer(name)
    assert isinstance(viewer, WebViewer)
    assert f'<object data="{viewer.url}" type="text/html"' in data["text/html"]
    assert '</object><img src="data:image/webp;base64,' in data["text/html"]
    png = Image.open(io.BytesIO(base64.b64decode(data["image/png"])))
    assert np.array_equal(np.asarray(png), viewer.render())
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
    source = re.search(r'<object data="([^"]*)"', data["text/html"])[1]
    assert source == f"/user/maria/proxy/{server.port}/{server.token}/"


@pytest.mark.parametrize(
    ("headers", "origin", "is_let_in"),
    [
        ({"Host": "hub.example"}, "https://hub.example", True),
        pytest.param({"Host": "hub.example:8000"}, "http://hub.example:8000", True, marks=pytest.mark.stress),
        ({"X-Forwarded-Host": "hub.example, inner"}, "https://hub.example", True),
        ({"Host": "hub.example"}, "https://evil.example", False),
        pytest.param({"X-Forwarded-Host": "hub.example"}, "https://evil.example", False, marks=pytest.mark.stress),
        pytest.param({}, "https://hub.example", False, marks=pytest.mark.stress),
        pytest.param({"X-Forwarded-Host": ""}, "null", False, marks=pytest.mark.stress),
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
    source = re.search(r'<object data="([^"]*)"', data["text/html"])[1]
    with Proxy() as proxy:
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{proxy.server_address[1]}{source}")
        page.wait_for_selector("[data-crisp=true]")
        page.keyboard.press("Escape")
        page.wait_for_selector("[data-mode=interaction]")
        page.close()
        proxy.shutdown()


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.mark.stress
@NEEDS_A_BROWSER[0]
@NEEDS_A_BROWSER[1]
@NEEDS_A_BROWSER[2]
def test_a_saved_notebook_shows_the_page_while_its_server_answers_and_a_picture_afterwards(
    kernel, env, browser, tmp_path, monkeypatch
):
    monkeypatch.delenv("DISPLAY", raising=False)
    (data,) = shown(env, "web")

    cell = f'<div style="content-visibility: auto">{data["text/html"]}</div>'  # as JupyterLab has it
    (tmp_path / "saved.html").write_text(cell)
    handler = functools.partial(Quiet, directory=tmp_path)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = browser.new_page()
        page.goto(f"http://127.0.0.1:{server.server_port}/saved.html")
        page.wait_for_function("window.frames.length === 1")
        page.frames[1].wait_for_selector("[data-crisp=true]")
        view, below = page.locator("object").bounding_box(), page.locator("img").bounding_box()
        assert view["height"] == 480
        assert below["y"] >= view["y"] + 480, "the picture is where nobody sees it"
        env.SetViewer("")
        page.reload()
        page.wait_for_function("document.querySelector('object').getBoundingClientRect().height < 30")
        assert page.locator("img").bounding_box()["y"] < 40
        assert page.evaluate("document.querySelector('img').naturalWidth") == 640
        page.close()
        server.shutdown()


@pytest.mark.parametrize("variable", one_in(4, list(REMOTE)))
def test_where_no_port_reaches_the_browser_the_scene_draws_itself(kernel, env, monkeypatch, variable):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setenv(variable, "/user/maria/")
    (data,) = shown(env, "qtcoin")
    viewer = env.GetViewer()
    assert f'<object data="{viewer.url}"' in data["text/html"], "a port may be forwarded"
    instead = data["text/html"].partition("</object>")[2]
    assert '<iframe srcdoc="' in instead
    assert instead.count("No port of this machine reaches the browser") == 1
    assert f"ssh -L {viewer.server.port}:127.0.0.1:{viewer.server.port}" in instead
    assert "image/png" in data


def test_colab_shows_the_page_with_its_own_helper(kernel, env, monkeypatch):
    """With a stand-in for Colab's module; nobody has tried it in Colab."""
    calls = []
    output = SimpleNamespace(serve_kernel_port_as_iframe=lambda *given, **named: calls.append((given, named)))
    colab = ModuleType("google.colab")
    colab.output = output
    monkeypatch.setitem(sys.modules, "google", ModuleType("google"))
    monkeypatch.setitem(sys.modules, "google.colab", colab)
    monkeypatch.delenv("DISPLAY", raising=False)
    (data,) = shown(env, "qtcoin")
    server = env.GetViewer().server
    assert calls == [((server.port,), {"path": f"/{server.token}/", "height": "480"})]
    assert "text/html" not in data
    with socket.create_connection(("127.0.0.1", server.port)) as sock:
        sock.sendall(f"GET /{server.token}/ HTTP/1.1\r\nHost: abc-{server.port}-colab.example\r\n\r\n".encode())
        assert sock.recv(100).startswith(b"HTTP/1.1 200"), "browsers come by another name"


def test_without_a_picture_the_page_is_shown_all_the_same(kernel, env, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)

    def cannot(*_: object) -> None:
        raise ravemj.RenderingError("nothing can draw here")

    monkeypatch.setattr(WebViewer, "render", cannot)
    (data,) = shown(env, "web")
    assert "image/png" not in data
    assert "<object data=" in data["text/html"]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("a.webp", "img"),
        ("a.mp4", "video"),
        pytest.param("a.gif", "img", marks=pytest.mark.stress),
        pytest.param("a.avi", None, marks=pytest.mark.stress),
    ],
)
def test_the_path_of_a_video_shows_the_video(env, tmp_path, name, kind):
    path = ravemj.record(env, tmp_path / name, [(0, [0, 0]), (0.1, [1, 0])], width=64, height=48, fps=10)
    assert path == tmp_path / name
    assert repr(path) == repr(tmp_path / name)
    text = HTMLFormatter()(path)
    assert (text is None) == (kind is None)
    if kind is not None:
        tag, data = re.match(r'<(\w+) src="data:[a-z]+/[a-z0-9]+;base64,([^"]+)"', text).groups()
        assert tag == kind
        assert base64.b64decode(data) == path.read_bytes()
        path.unlink()
        assert HTMLFormatter()(path) is None
