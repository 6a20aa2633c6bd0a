"""What strangers, broken pages and many pages may not do with the viewer's server: each refusal is one line."""

import base64
import contextlib
import json
import os
import socket

import pytest
from conftest import MODELS, one_in
from waiting import PATIENCE, await_that, time_limit
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

import ravemj
from ravemj.gui.interaction import Resize
from ravemj.gui.viewers.dropping import Upload
from ravemj.gui.viewers.recorder import FrameSource
from ravemj.gui.viewers.web import uploads
from ravemj.gui.viewers.web.limits import Guesses
from ravemj.gui.viewers.web.messages import UploadChunk, parse
from ravemj.gui.viewers.web.uploads import PageUploads, UploadQuota

TOKEN = "robots-2026"


@pytest.fixture
def env():
    env = ravemj.load(MODELS / "env.xml")
    yield env
    env.Destroy()


@pytest.fixture
def viewer(env):
    return env.serve_viewer(token=TOKEN)


def ask(viewer, path=f"/{TOKEN}/", *headers, method="GET", host="127.0.0.1", body=""):
    """Return the status, the headers and the text of an answer."""
    name = f"[{host}]" if ":" in host else host
    lines = [f"{method} {path} HTTP/1.1", f"Host: {name}:{viewer.server.port}", *headers]
    with socket.create_connection((host, viewer.server.port), timeout=PATIENCE) as connection:
        connection.sendall(("\r\n".join(lines) + "\r\n\r\n" + body).encode())
        answer = b"".join(iter(lambda: connection.recv(65536), b"")).decode(errors="replace")
    head, _, text = answer.partition("\r\n\r\n")
    status, *fields = head.split("\r\n")
    return int(status.split()[1]), dict(field.lower().split(": ", 1) for field in fields), text


def come(viewer, tab=""):
    address = viewer.url.replace("http", "ws", 1) + "socket" + (f"?tab={tab}" if tab else "")
    return connect(address, origin=viewer.url.rsplit("/", 2)[0], compression=None)


def is_one_line(text) -> bool:
    return text.count("\n") == 1 and text.endswith("\n")


class Clock:
    now = 1000.0

    def __call__(self):
        return self.now


class TestGuesses:
    @pytest.fixture
    def clock(self):
        return Clock()

    @pytest.fixture
    def guesses(self, clock):
        return Guesses(clock)

    def test_the_21st_wrong_secret_of_a_minute_is_refused(self, guesses, clock):
        for _ in range(20):
            assert not guesses.refuses("10.0.0.1", "wrong", is_right=False)
            clock.now += 2
        assert guesses.refuses("10.0.0.1", "wrong", is_right=False)
        assert not guesses.refuses("10.0.0.2", "wrong", is_right=False)
        clock.now += 20  # the first one is a minute ago
        assert not guesses.refuses("10.0.0.1", "wrong", is_right=False)
        assert guesses.refuses("10.0.0.1", "wrong", is_right=False)

    def test_an_old_page_that_comes_again_and_again_locks_nobody_out(self, guesses):
        for _ in range(1000):
            guesses.refuses("127.0.0.1", "that of yesterday", is_right=False)
            assert not guesses.refuses("127.0.0.1", "right", is_right=True)

    def test_who_searches_is_not_told_when_the_secret_is_found(self, guesses, clock):
        for number in range(20):
            assert not guesses.refuses("10.0.0.1", f"guess {number}", is_right=False)
        assert guesses.refuses("10.0.0.1", "right", is_right=True)
        assert not guesses.refuses("10.0.0.2", "right", is_right=True)
        clock.now += 59
        assert guesses.refuses("10.0.0.1", "right", is_right=True)
        clock.now += 1
        assert not guesses.refuses("10.0.0.1", "right", is_right=True)

    def test_a_search_behind_one_wrong_secret_is_noticed(self, guesses):
        for _ in range(20):
            guesses.refuses("10.0.0.1", "wrong", is_right=False)
        for number in range(20):
            assert guesses.refuses("10.0.0.1", f"guess {number}", is_right=False)
        assert guesses.refuses("10.0.0.1", "right", is_right=True)

    def test_all_addresses_of_a_machine_are_one_peer(self, guesses):
        for number in range(20):
            assert not guesses.refuses(f"2001:db8:1:2::{number}", "wrong", is_right=False)
        assert guesses.refuses("2001:db8:1:2:ffff::1%eth0", "wrong", is_right=False)
        assert not guesses.refuses("2001:db8:1:3::1", "wrong", is_right=False)
        for number in range(20):
            assert not guesses.refuses(f"::ffff:10.0.0.{number}", "wrong", is_right=False)

    def test_it_remembers_no_more_than_it_has_to(self, guesses, clock):
        for number in range(3000):
            guesses.refuses(f"10.0.{number // 256}.{number % 256}", "wrong", is_right=False)
            guesses.refuses(f"11.0.{number // 256}.{number % 256}", "right", is_right=True)
        assert len(guesses._records) <= 1024


def test_strangers_have_20_tries_a_minute(viewer, caplog):
    paths = [f"/guess-{number}/" for number in range(10)] + ["/", "/favicon.ico", "/guess/socket", f"/{TOKEN}x/"]
    assert [ask(viewer, path)[0] for path in (*paths, *paths[:6])] == [404] * 20
    status, headers, text = ask(viewer, "/guess/")
    assert (status, headers["retry-after"]) == (429, "60")
    assert is_one_line(text)
    assert ask(viewer)[0] == 200, "there were less than 20 different ones"
    for number in range(10):
        assert ask(viewer, f"/another-{number}/")[0] == 429
    assert ask(viewer)[0] == 429
    assert caplog.text.count("too many wrong addresses") == 1


def test_pages_that_are_open_stay_while_somebody_searches(viewer):
    with come(viewer) as page:
        for number in range(30):
            ask(viewer, f"/guess-{number}/")
        page.send('{"type": "ready"}')
        assert "lines" in json.loads(page.recv(PATIENCE))


@pytest.mark.parametrize(
    "method", ["POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT", "PRI", "get", "GETT"]
)
def test_the_only_method_is_get(viewer, method):
    for more, body in (
        ([], ""),
        (["Content-Length: 100000"], 100000 * "x"),
        (["Transfer-Encoding: chunked"], "0\r\n\r\n"),
    ):
        status, headers, text = ask(viewer, f"/{TOKEN}/", *more, method=method, body=body)
        assert (status, headers["allow"]) == (405, "get")
        assert is_one_line(text)


def test_an_answer_to_head_has_no_body(viewer):
    status, headers, text = ask(viewer, method="HEAD")
    assert (status, headers["allow"], text) == (405, "get", "")


@pytest.mark.parametrize(
    "header",
    [
        "Host: evil.example",
        "host: 127.0.0.1",
        "ORIGIN: http://evil.example",
        "Accept-Encoding: br",
        "X-Forwarded-Host: a",
    ],
)
def test_a_header_that_comes_twice_is_refused(viewer, header):
    name = header.partition(":")[0]
    first = [] if name.lower() == "host" else [f"{name.title()}: x"]
    status, _, text = ask(viewer, f"/{TOKEN}/", *first, header)
    assert (status, text) == (400, f"The header {name.lower()} comes more than once.\n")
    assert ask(viewer, f"/{TOKEN}/", "Via: 1.1 a", "via: 1.1 b", "X-Forwarded-For: a", "X-Forwarded-For: b")[0] == 200


def test_requests_that_are_none_end_and_harm_nobody(viewer):
    def say(*parts):
        with socket.create_connection(("127.0.0.1", viewer.server.port), timeout=PATIENCE) as connection:
            with contextlib.suppress(OSError):
                for part in parts:
                    connection.sendall(part)
                connection.shutdown(socket.SHUT_WR)
            with contextlib.suppress(OSError):
                return b"".join(iter(lambda: connection.recv(65536), b""))
            return b""

    start = f"GET /{TOKEN}/ HTTP/1.1\r\nHost: 127.0.0.1:{viewer.server.port}\r\n".encode()
    with time_limit():
        for parts in (
            [b""],
            [b"\r\n\r\n"],
            [b"\x16\x03\x01\x02\x00\x01\x00"],
            [os.urandom(5000)],
            [b"GET"],
            [start],
            [start, b"A: " + 20000 * b"x", b"\r\n\r\n"],
            [start, *(b"A%d: b\r\n" % number for number in range(5000)), b"\r\n"],
            [b"GET /" + 100000 * b"x" + b" HTTP/1.1\r\n\r\n"],
            [f"GET /{TOKEN}/ HTTP/3.0\r\n\r\n".encode()],
        ):
            assert b"200 OK" not in say(*parts)
    status, _, text = ask(viewer, f"/{TOKEN}/", "hOsT2: x", "ACCEPT-ENCODING: gzip")
    assert (status, text[:2]) == (200, "\x1f\ufffd")


def test_ipv6(env):
    try:
        viewer = env.serve_viewer("::1", token=TOKEN)
    except ravemj.errors.RenderingError:
        pytest.skip("there is no IPv6 here")
    assert ask(viewer, host="::1")[0] == 200
    assert [ask(viewer, f"/guess-{number}/", host="::1")[0] for number in range(21)] == [404] * 20 + [429]
    assert ask(viewer, host="::1")[0] == 429


def test_64_pages_are_open_at_most(viewer, caplog):
    with contextlib.ExitStack() as pages:
        first, *_ = [pages.enter_context(come(viewer)) for _ in range(64)]
        with pytest.raises(InvalidStatus, match="503") as caught:
            come(viewer)
        assert is_one_line(caught.value.response.body.decode())
        status, _, text = ask(viewer)
        assert status == 503
        assert is_one_line(text)
        for _ in range(80):  # strangers that say nothing keep nobody out
            pages.enter_context(socket.create_connection(("127.0.0.1", viewer.server.port)))
        first.close()
        await_that(lambda: ask(viewer)[0] == 200)
        pages.enter_context(come(viewer))
        assert caplog.text.count("too many pages") == 1


# --- pictures


@pytest.mark.parametrize(
    ("shape", "size"),
    [
        ({"width": 8192, "height": 1, "ratio": 10}, (4096, 16)),
        ({"width": 300, "height": 200, "ratio": 2}, (600, 400)),
        pytest.param({"width": 1, "height": 1, "ratio": 0.1}, (16, 16), marks=pytest.mark.stress),
        pytest.param({"width": 1, "height": 8192, "ratio": 1}, (16, 4096), marks=pytest.mark.stress),
        pytest.param({"width": 5000, "height": 100, "ratio": 1}, (4096, 81), marks=pytest.mark.stress),
    ],
)
def test_pictures_have_16_to_4096_pixels_a_side(viewer, shape, size, caplog):
    pictures = []
    handle = viewer.RegisterViewerImageCallback(pictures.append)
    with come(viewer) as page:
        page.send(json.dumps({"type": "shape", **shape}))
        page.send('{"type": "ready"}')
        await_that(lambda: pictures)
        await_that(lambda: (page.send('{"type": "ready"}'), pictures[-1].shape[1::-1] == size)[1], "another size")
        assert all(16 <= side <= 4096 for picture in pictures for side in picture.shape[:2])
    is_right = min(size) > 16 and max(size) < 4096
    assert caplog.text.count("pictures have 16 to 4096 pixels a side") == (not is_right)
    handle.Close()


@pytest.mark.stress
def test_files_have_these_sizes_too(env, viewer):
    for size, expected in (((8192, 1), (4096, 16)), ((5000, 2500), (4096, 2048)), ((333, 250), (333, 250))):
        viewer.interaction.handle(Resize(*size))
        source = FrameSource(viewer.interaction, env.renderer, (1, 1, 1))
        assert source.frame().shape[1::-1] == expected


# --- uploads


def piece(name, data=b"", last=False):
    return json.dumps({"type": "piece", "name": name, "data": base64.b64encode(data).decode(), "last": last})


def test_16_uploads_are_unfinished_at_most_and_one_that_is_left_counts_no_more(env, viewer, caplog):
    box = '<KinBody name="box"><Body><Geom type="box"><extents>1 1 1</extents></Geom></Body></KinBody>'
    with contextlib.ExitStack() as pages:
        others = [pages.enter_context(come(viewer)) for _ in range(16)]
        for page in others:
            page.send(piece("a.xml"))  # without a byte
        page = pages.enter_context(come(viewer))
        await_that(lambda: len(viewer._quota._unfinished) == 16)
        page.send(piece("box.xml", b"<KinBody"))
        await_that(lambda: "at most 16 uploads and 256 MiB at a time" in caplog.text)
        page.send(piece("box.xml", b"/>", last=True))  # the rest of what was refused is not taken for another upload
        others[0].close()
        await_that(lambda: len(viewer._quota._unfinished) == 15)
        page.send(piece("box.xml", box.encode(), last=True))
        await_that(lambda: env.GetKinBody("box") is not None, "it is not added")
        others[1].socket.close()  # the browser is gone
        await_that(lambda: len(viewer._quota._unfinished) == 14)
        assert len(env.GetBodies()) == 2


class TestPageUploads:
    @pytest.fixture(autouse=True)
    def _small(self, monkeypatch):
        monkeypatch.setattr(uploads, "_MOST_BYTES", 100)
        monkeypatch.setattr(Upload, "_LARGEST", 80)

    def test_all_pages_share_the_bytes(self):
        quota = UploadQuota()
        one, other = PageUploads(quota), PageUploads(quota)
        assert one.add(UploadChunk("a", 60 * b"x", False)) == ""
        assert other.add(UploadChunk("a", 40 * b"x", False)) == ""
        assert "256 MiB" in other.add(UploadChunk("a", b"x", False))
        assert other.add(UploadChunk("a", 40 * b"x", True)) == "", "it is said once"
        assert other.complete == []
        one.close()
        assert other.add(UploadChunk("b", 80 * b"x", True)) == ""
        assert "256 MiB" in one.add(UploadChunk("a", 60 * b"x", False)), (
            "complete ones count until their files are removed"
        )
        other.complete.clear()
        assert one.add(UploadChunk("c", b"", True)) == "", "this is the end of what was refused"
        assert one.add(UploadChunk("a", 60 * b"x", True)) == ""
        (path,) = one.complete[0].paths
        assert os.path.getsize(path) == 60

    def test_an_upload_that_is_too_large_leaves_no_half_of_it(self):
        page = PageUploads(UploadQuota())
        assert page.add(UploadChunk("a", 80 * b"x", False)) == ""
        assert "too large" in page.add(UploadChunk("a", b"x", False))
        for _ in range(3):
            assert page.add(UploadChunk("a", b"x", False)) == ""
        assert page.add(UploadChunk("a", b"x", True)) == ""
        assert page.complete == []
        assert page.add(UploadChunk("b", b"x", True)) == ""
        assert len(page.complete) == 1

    def test_500_drops_one_after_the_other(self):
        page = PageUploads(UploadQuota())
        for number in range(500):
            assert page.add(UploadChunk(f"{number}.xml", b"", True)) == ""
            page.complete.clear()

    def test_a_file_that_cannot_be_written_is_said(self, monkeypatch):
        def fail(self, name, data):
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(Upload, "append", fail)
        assert PageUploads(UploadQuota()).add(UploadChunk("a.xml", b"x", False)) == "a.xml: No space left on device"


@pytest.mark.parametrize(
    ("name", "cut"),
    [
        (96 * "機" + ".dae", 83 * "機" + ".dae"),
        (100 * "é", 100 * "é"),
        (100 * "機", 85 * "機"),
        ("a" + 93 * "𠀀" + ".xml", "a" + 62 * "𠀀" + ".xml"),
        ("a." + 98 * "機", "a." + 84 * "機"),
        ("mesh.stl", "mesh.stl"),
    ],
)
def test_names_have_255_bytes_at_most_and_keep_their_suffix(name, cut):
    assert len(parse(piece(name)).name.encode()) <= 255
    assert parse(piece(name)).name == cut


@pytest.mark.parametrize("data", [b"", b"x"])
def test_files_with_long_names_are_added(env, viewer, data):
    model = '<KinBody name="box"><Body><Geom type="box"><extents>1 1 1</extents></Geom></Body></KinBody>'
    with come(viewer) as page:
        page.send(piece(95 * "機" + "2.xml", data=data))
        page.send(piece(96 * "機" + ".xml", model.encode() if not data else b"", last=True))
        if not data:
            await_that(lambda: env.GetKinBody("box") is not None)
        page.send('{"type": "ready"}')
        assert page.recv(PATIENCE)


@pytest.mark.parametrize(
    "message",
    one_in(
        4,
        [
            '{"type": "shape", "width": -5, "height": 5, "ratio": 1}',
            '{"type": "shape", "width": 0, "height": 5, "ratio": 1}',
            '{"type": "shape", "width": NaN, "height": 5, "ratio": 1}',
            '{"type": "shape", "width": 1e999, "height": 5, "ratio": 1}',
            '{"type": "piece", "name": "a", "data": -1, "last": false}',
            '{"type": "shape", "width": "5", "height": 5, "ratio": 1}',
            '{"type": "piece", "name": "..", "data": "", "last": false}',
            '{"type": "piece", "name": "a", "data": "", "last": 1}',
            "not JSON",
            "\x00",
            "1e999",
            '"' + 700 * "é" + '"',
        ],
    ),
)
def test_messages_without_sense_are_left_out(viewer, message):
    with come(viewer) as page:
        page.send(message)
        page.send('{"type": "ready"}')
        assert "lines" in json.loads(page.recv(PATIENCE))


def test_a_huge_message_ends_its_page_alone(viewer):
    with come(viewer) as page, come(viewer) as other:
        with contextlib.suppress(ConnectionClosed):
            page.send(10_000_000 * "x")
        with pytest.raises(ConnectionClosed):
            page.recv(PATIENCE)
        other.send('{"type": "ready"}')
        assert other.recv(PATIENCE)
