"""The viewer whose window is a page in a browser."""

import http
import logging
import secrets
import threading
import weakref
from pathlib import Path

from numpy.typing import ArrayLike
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.sync.server import Server, ServerConnection, serve

from ravemj.errors import RenderingError
from ravemj.simulation import Simulation
from ravemj.studio import Studio
from ravemj.viewers.viewer import Viewer
from ravemj.viewers.web.client import Client
from ravemj.viewers.web.messages import LONGEST

_LOG = logging.getLogger("ravemj")
_HOST = "127.0.0.1"
_PAGE = Path(__file__).with_name("page.html")
_MOST_CLIENTS = 16


class WebViewer(Viewer):
    """A viewer in a browser: ``viewer.url`` opens it. Each page has a camera of its own; all share what is selected.

    Pages of this machine only can connect, and only with the secret that is in the URL.

    Attributes:
        url: The page.
    """

    _internal = ("answer", "serve_page")

    def __init__(self, simulation: Simulation, studio: Studio, name: str) -> None:
        super().__init__(simulation, studio, name)
        self._token = secrets.token_urlsafe(16)
        self._clients: set[ServerConnection] = set()
        self._cameras_set = 0
        self._closed = threading.Event()
        reference = weakref.ref(self)

        def serve_page(connection: ServerConnection) -> None:
            viewer = reference()
            if viewer is not None:
                viewer.serve_page(connection)

        def answer(connection: ServerConnection, request: Request) -> Response | None:
            viewer = reference()
            return _response(http.HTTPStatus.GONE, "text/plain", b"") if viewer is None else viewer.answer(request)

        silent = logging.getLogger("ravemj.web")
        silent.setLevel(logging.CRITICAL)  # what strangers send is no news
        try:
            self._server: Server = serve(
                serve_page,
                _HOST,
                0,
                process_request=answer,
                max_size=LONGEST,
                compression=None,
                logger=silent,
            )
        except OSError as error:
            raise RenderingError(f"no page can be served: {error}") from None
        self._port = int(self._server.socket.getsockname()[1])
        self.url = f"http://{_HOST}:{self._port}/{self._token}/"
        self._thread = threading.Thread(target=self._server.serve_forever, name="ravemj web", daemon=True)
        self._thread.start()
        self._end = weakref.finalize(self, _end, self._closed, self._server, self._thread)

    @property
    def is_open(self) -> bool:
        """False once it is closed."""
        return not self._closed.is_set()

    def SetCamera(self, transform: ArrayLike, focalDistance: float = 0.0) -> None:
        """Set the camera of all pages; see ``Viewer.SetCamera``."""
        super().SetCamera(transform, focalDistance)
        self._cameras_set += 1

    def main(self, bShow: bool = True) -> int:
        """Wait until ``quitmainloop`` is called or the viewer is closed.

        Args:
            bShow: Without meaning.

        Returns:
            0.
        """
        del bShow
        while not self._closed.wait(0.1):  # in slices, so that Ctrl-C gets through
            pass
        return 0

    def quitmainloop(self) -> None:
        """End ``main``; pages are told that the viewer has closed."""
        self._closed.set()

    def close(self) -> None:
        """Close the viewer and its pages."""
        self._end()
        super().close()

    def answer(self, request: Request) -> Response | None:
        """Answer a request: with the page, with a refusal, or None where a page may open its connection."""
        hosts = {f"{_HOST}:{self._port}", f"localhost:{self._port}"}
        path = request.path.partition("?")[0]
        wanted = {f"/{self._token}/": _page, f"/{self._token}/socket": None}
        known = next((key for key in wanted if secrets.compare_digest(key.encode(), path.encode())), None)
        if known is None or request.headers.get("Host") not in hosts:
            return _response(http.HTTPStatus.NOT_FOUND, "text/plain", b"There is nothing here.\n")
        page = wanted[known]
        if page is not None:
            return page()
        if request.headers.get("Origin") not in {f"http://{host}" for host in hosts}:
            return _response(http.HTTPStatus.FORBIDDEN, "text/plain", b"Other sites may not connect.\n")
        if len(self._clients) >= _MOST_CLIENTS:
            return _response(http.HTTPStatus.SERVICE_UNAVAILABLE, "text/plain", b"There are too many pages.\n")
        return None

    def serve_page(self, connection: ServerConnection) -> None:
        """Exchange messages with a page until it leaves or the viewer is closed."""
        client = Client(self._simulation, self._studio, self.interaction.another_view())
        cameras_set = self._cameras_set
        self._clients.add(connection)
        try:
            while not self._closed.is_set():
                if cameras_set != self._cameras_set:
                    cameras_set = self._cameras_set
                    client.interaction.look_from(self.camera, self.GetCameraDistanceToFocus())
                self._exchange(client, connection)
        except ConnectionClosed:
            _LOG.debug("a page has left")
        finally:
            self._clients.discard(connection)
            self._studio.close()

    def _exchange(self, client: Client, connection: ServerConnection) -> None:
        """Take a page's messages in, and send what has changed; the viewer's camera is that of the page used last."""
        before = client.interaction.view
        try:
            client.take_in(connection)
        except TimeoutError:
            pass
        else:
            view = client.interaction.view
            if view.camera is not before.camera:
                self.interaction.look_from(view.camera, view.distance)
        client.show(connection, self._background)


def _end(closed: threading.Event, server: Server, thread: threading.Thread) -> None:
    """Close all pages and wait for the end of the thread that serves them."""
    closed.set()
    server.shutdown()
    if threading.current_thread() is not thread:
        thread.join()


def _page() -> Response:
    return _response(http.HTTPStatus.OK, "text/html; charset=utf-8", _PAGE.read_bytes())


def _response(status: http.HTTPStatus, kind: str, body: bytes) -> Response:
    headers = Headers()
    headers["Content-Type"] = kind
    headers["Content-Length"] = str(len(body))
    headers["Cache-Control"] = "no-store"
    headers["Referrer-Policy"] = "no-referrer"
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Connection"] = "close"
    return Response(status.value, status.phrase, headers, body)
