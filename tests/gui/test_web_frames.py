"""The viewer's page in frames of other pages: who may show it, what its frames share, and what the wheel does there."""

import contextlib
import html
import http.server
import json
import threading
import urllib.request

import numpy as np
import pytest
from browsers import NEEDS_A_BROWSER
from command_line import Served, ravemj_command
from conftest import MODELS, one_in
from waiting import PATIENCE, await_that
from websockets.sync.client import connect

import ravemj
from ravemj.errors import ArgumentError
from ravemj.graphics.rendering import Camera
from ravemj.rave.recording import animate

SIDE = np.array([[0.0, 0, -1, 1], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
FAR = np.array([[0.0, 0, -1, 3], [1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    yield env
    env.Destroy()


@pytest.fixture
def viewer(env):
    viewer = env.serve_viewer()
    viewer.SetCamera(SIDE)
    return viewer


def ancestors(viewer) -> set[str]:
    with urllib.request.urlopen(viewer.url, timeout=PATIENCE) as answer:
        policy = answer.headers["Content-Security-Policy"]
    return next(set(part.split()[1:]) for part in policy.split("; ") if part.startswith("frame-ancestors "))


USUAL = {
    "'self'",
    "http://localhost:*",
    "https://localhost:*",
    "http://127.0.0.1:*",
    "https://127.0.0.1:*",
    "vscode-webview:",
}


class TestWhoMayShowIt:
    def test_pages_of_this_machine_and_those_that_are_named(self, env, viewer, monkeypatch):
        assert ancestors(viewer) == USUAL
        viewer.server.allow_embedding("https://*.lab.example:*")  # as helpers for hosted notebooks do
        assert ancestors(viewer) == {*USUAL, "https://*.lab.example:*"}
        one = env.serve_viewer(embed="https://lab.example")
        assert ancestors(one) == {*USUAL, "https://lab.example"}
        monkeypatch.setenv("RAVEMJ_EMBED", "https://hub.example:8443, http://10.0.0.7 http://a-b.example")
        env.SetViewer("web")
        named = {"https://hub.example:8443", "http://10.0.0.7", "http://a-b.example"}
        assert ancestors(env.GetViewer()) == {*USUAL, *named}
        assert ancestors(env.serve_viewer(embed=["https://x.example", "https://y.example"])) == {
            *USUAL,
            *named,
            "https://x.example",
            "https://y.example",
        }

    @pytest.mark.parametrize(
        "origin",
        [
            "",
            "*",
            "null",
            "lab.example",
            "https://",
            "https://*",
            "https://lab.example/",
            "https://lab.example/a",
            "https://lab.example:0",
            "https://lab.example:65536",
            "https://lab.example; script-src *",
            "https://lab.example\r\nX: y",
            "https://lab..example",
            "https://a.*.example",
            "https://maria@lab.example",
            "ftp://lab.example",
            "javascript:alert(1)",
            "'unsafe-inline'",
            "https://[::1]:8888",
        ],
    )
    def test_what_is_no_origin_is_refused_and_nothing_has_changed(self, env, viewer, origin, monkeypatch):
        with pytest.raises(ArgumentError, match=r"embed: is .* should be an origin"):
            env.serve_viewer(embed=[origin])
        assert env.GetViewer() is viewer
        assert viewer.is_open
        if origin and origin.split() == [origin]:
            monkeypatch.setenv("RAVEMJ_EMBED", origin)
            with pytest.raises(ArgumentError, match=r"RAVEMJ_EMBED: is .* should be an origin"):
                env.serve_viewer()

    @pytest.mark.stress
    def test_the_command_line(self, folder):
        with Served(folder, "view", "--web", "--embed", "https://a.example", "--embed", "https://b", "env.xml") as page:
            assert ancestors(page) == {*USUAL, "https://a.example", "https://b"}
        wrong = ravemj_command(folder, "view", "--web", "--embed", "a.example", "env.xml")
        assert (wrong.returncode, wrong.stdout, wrong.stderr.count("\n")) == (1, "", 1)
        assert wrong.stderr.startswith("ravemj: error: embed: is 'a.example', and should be an origin")


# --- views


@contextlib.contextmanager
def come(viewer, tab):
    """Connect as a page that draws by itself; return the name of its view."""
    address = viewer.url.replace("http", "ws", 1) + f"socket?tab={tab}"
    with connect(address, origin=viewer.url.rsplit("/", 2)[0], compression=None) as page:
        page.send('{"type": "draws", "itself": true}')
        page.send('{"type": "ready"}')
        yield json.loads(page.recv(PATIENCE))["tab"], page


class TestViewsOfFrames:
    def test_all_frames_of_a_tab_have_their_own_which_a_script_sets(self, viewer):
        with come(viewer, "a") as (one, page), come(viewer, "a") as (two, _), come(viewer, "a") as (three, _):
            assert len({one, two, three}) == 3
            page.send('{"type": "wheel", "steps": 3}')
            await_that(lambda: viewer.GetCameraTransform()[0, 3] < 0.9)
            views = [viewer._views[name] for name in (one, two, three)]
            assert len({id(view.view.camera) for view in views}) == 2, "one has moved"
            viewer.SetCamera(FAR)
            for view in views:
                np.testing.assert_allclose(view.view.camera.T_world_camera, FAR)

    def test_each_comes_back_to_its_own_in_whatever_order(self, viewer):
        with come(viewer, "a") as (one, _), come(viewer, "a") as (two, _):
            views = {name: viewer._views[name] for name in (one, two)}
            views[two].look_from(Camera(FAR))
        await_that(lambda: not viewer._clients)
        with come(viewer, two) as (second, _), come(viewer, one) as (first, _):  # the connection was lost
            assert (first, second) == (one, two)
            assert all(viewer._views[name] is views[name] for name in (one, two))
        await_that(lambda: not viewer._clients)
        with come(viewer, "a") as (first, _), come(viewer, "a") as (second, _):  # the page around them was loaded again
            assert (first, second) == (one, two)
            assert all(viewer._views[name] is views[name] for name in (one, two))

    def test_a_duplicate_begins_with_the_same_view(self, viewer):
        with come(viewer, "a") as (one, _):
            viewer._views[one].look_from(Camera(FAR))
            with come(viewer, "a") as (two, _):
                assert two != one
                np.testing.assert_allclose(viewer._views[two].view.camera.T_world_camera, FAR)

    def test_views_that_are_shown_are_never_forgotten(self, viewer):
        with come(viewer, "a") as (one, _):
            for number in range(100):
                with come(viewer, f"b{number}"):
                    pass
            viewer.SetCamera(FAR)
            np.testing.assert_allclose(viewer._views[one].view.camera.T_world_camera, FAR)
            assert len(viewer._views) < 70


# --- in a browser


class Around(http.server.ThreadingHTTPServer):
    """Serves a page with frames in it, as notebooks do."""

    class RequestHandlerClass(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write(self.server.text.encode())

        def log_message(self, *_):
            pass

    def __init__(self, *frames, host="127.0.0.1"):
        super().__init__((host, 0), self.RequestHandlerClass)
        framed = "".join(
            f"<iframe {frame} style='width: 500px; height: 250px; border: 0'></iframe>" for frame in frames
        )
        self.text = f"<!doctype html><body style='margin: 0; height: 3000px'>{framed}<p>below"
        self.url = f"http://{host}:{self.server_address[1]}/"

    def __enter__(self):
        threading.Thread(target=self.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *reason):
        self.shutdown()
        self.server_close()


@pytest.fixture
def page(webgl_browser):
    page = webgl_browser.new_page(viewport={"width": 520, "height": 560})
    yield page
    page.close()


def frames(page):
    for frame in page.frames[1:]:
        frame.wait_for_selector("[data-crisp]")
    return page.frames[1:]


class TestInABrowser:
    pytestmark = NEEDS_A_BROWSER

    @pytest.mark.parametrize("host", one_in(2, ["127.0.0.1", "127.0.0.2"]))
    def test_pages_of_others_show_it_only_if_they_are_named(self, page, viewer, host):
        with Around(f'src="{viewer.url}"', host=host) as around:
            said = []
            page.on("console", lambda message: said.append(message.text))
            page.goto(around.url)
            if host == "127.0.0.2":
                await_that(lambda: "frame-ancestors" in "".join(said), "it is shown")
                viewer.server.allow_embedding(around.url.rstrip("/"))
                page.reload()
            frames(page)

    @pytest.mark.stress
    def test_a_script_moves_the_views_of_all_frames(self, page, viewer):
        with Around(*2 * [f'src="{viewer.url}"']) as around:
            page.goto(around.url)
            for _ in range(2):
                names = [frame.evaluate("tab") for frame in frames(page)]
                assert len(set(names)) == 2
                for camera in (FAR, SIDE):
                    viewer.SetCamera(camera)
                    for frame in page.frames[1:]:
                        await_that(lambda frame=frame, camera=camera: self.position(frame) == camera[0, 3], "elsewhere")
                page.frames[2].evaluate("location.reload()")  # one of them alone
                await_that(lambda: len(viewer._clients) == 2)
                page.reload()

    @pytest.mark.stress
    def test_a_script_moves_the_views_of_duplicated_tabs(self, page, viewer):
        page.goto(viewer.url)
        page.wait_for_selector("[data-crisp]")
        with page.expect_popup() as opened:
            page.evaluate("open(location.href)")  # it has a copy of what the tab stores, as duplicates have
        other = opened.value
        other.wait_for_selector("[data-crisp]")
        assert other.evaluate("sessionStorage.ravemj") == page.evaluate("sessionStorage.ravemj")
        viewer.SetCamera(FAR)
        for tab in (page, other):
            await_that(lambda tab=tab: self.position(tab) == 3, "elsewhere")
        other.close()

    def position(self, frame) -> float:
        return frame.evaluate("drawing && drawing.serverView ? drawing.serverView.position[0] : null")

    @pytest.mark.stress
    def test_the_wheel_scrolls_the_page_around_until_a_click(self, page, viewer, env):
        player = f'srcdoc="{html.escape(env.animation(ravemj.Motion.line([0, 0], [1, 0], duration=1)).html)}"'
        with Around(f'src="{viewer.url}"', player) as around:
            page.goto(around.url)
            page.frames[1].wait_for_selector("[data-crisp]")
            page.frames[2].wait_for_function("window.ravemj")
            for frame, y, distance, hint in (
                (page.frames[1], 125, "drawing.serverView.distance", "#toast"),
                (page.frames[2], 375, "ravemj.view.distance", "#hint"),
            ):
                self.check_wheel(page, frame, y, distance, hint)

    def check_wheel(self, page, frame, y, distance, hint):
        before = frame.evaluate(distance)
        page.mouse.move(250, y)
        page.mouse.wheel(0, 60)
        await_that(lambda: page.evaluate("scrollY") == 60, "it does not scroll")
        await_that(lambda: "hold Ctrl" in frame.inner_text(hint), "nothing is said")
        assert frame.evaluate(distance) == before
        await_that(lambda: not frame.is_visible(hint) or frame.inner_text(hint) == "", "it is said for ever")
        page.mouse.wheel(0, -60)
        await_that(lambda: page.evaluate("scrollY") == 0, "it does not scroll back")
        page.keyboard.down("Control")
        page.mouse.wheel(0, 100)
        await_that(lambda: frame.evaluate(distance) > before, "it does not zoom with Ctrl")
        page.keyboard.up("Control")
        zoomed = frame.evaluate(distance)
        page.mouse.click(250, y)
        page.mouse.wheel(0, 100)
        await_that(lambda: frame.evaluate(distance) > zoomed, "it does not zoom after a click")
        assert page.evaluate("scrollY") == 0
        page.mouse.click(250, 530)  # beside the frames
        page.mouse.move(250, y)
        zoomed = frame.evaluate(distance)
        page.mouse.wheel(0, 60)
        await_that(lambda: page.evaluate("scrollY") == 60, "it does not scroll any more")
        assert frame.evaluate(distance) == zoomed
        page.mouse.wheel(0, -60)
        await_that(lambda: page.evaluate("scrollY") == 0)

    def test_a_page_of_its_own_has_the_wheel(self, page, viewer, env, tmp_path):
        page.goto(viewer.url)
        page.wait_for_selector("[data-crisp]")
        page.mouse.move(250, 200)
        page.mouse.wheel(0, 100)
        await_that(lambda: page.evaluate("drawing.serverView.distance") > 1.1)
        env.save_html(tmp_path / "still.html")
        page.goto(f"file://{tmp_path}/still.html")
        page.wait_for_function("window.ravemj")
        before = page.evaluate("ravemj.view.distance")
        page.mouse.wheel(0, 100)
        await_that(lambda: page.evaluate("ravemj.view.distance") > before)

    @pytest.mark.stress
    def test_notes_do_not_cover_a_phone(self, page, env, tmp_path):
        animate(env, None, notes=["a line"]).save(tmp_path / "notes.html")
        for width, is_open in ((1280, True), (390, False)):
            page.set_viewport_size({"width": width, "height": 800})
            page.goto(f"file://{tmp_path}/notes.html")
            page.wait_for_function("window.ravemj")
            assert page.evaluate("notes.open") is is_open

    def test_files_keep_names_that_the_model_refers_to(self, page, viewer, env):
        page.goto(viewer.url)
        page.wait_for_selector("[data-crisp]")
        names = page.evaluate(
            "['機械 1.xml', 'ä'.repeat(300) + '.stl', '機'.repeat(300) + '.dae', '../a.xml',"
            "'.bashrc', 'a/b', ' x', '💡.xml', 'u\\u0308.stl']"
            ".map(fileName)"
        )
        assert names == [
            "機械 1.xml",
            96 * "ä" + ".stl",
            96 * "機" + ".dae",
            "_._a.xml",
            "_bashrc",
            "a_b",
            "_x",
            "_.xml",
            "ü.stl",
        ]
        box = '<KinBody name="box"><Body><Geom type="box"><extents>1 1 1</extents></Geom></Body></KinBody>'
        upload = "content => upload([[fileName('机器人'.repeat(80) + '.xml'), new File([content], 'box.xml')]])"
        page.evaluate(upload, box)
        await_that(lambda: env.GetKinBody("box") is not None, "it is not added")
