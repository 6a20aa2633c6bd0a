"""Web server of the page and its connections, protected by a secret in the URL."""

import contextlib
import gzip
import http
import logging
import os
import re
import secrets
import socket
import threading
import time
import weakref
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

from websockets.datastructures import Headers
from websockets.http11 import Request, Response
from websockets.sync.server import ServerConnection, serve

from ravemj.core.flags import Flag
from ravemj.core.forks import in_child
from ravemj.core.locks import before_end
from ravemj.errors import ArgumentError, RenderingError
from ravemj.gui.viewers.web.document import document
from ravemj.gui.viewers.web.embedding import checked_origins, frame_ancestors, origins_of_environment
from ravemj.gui.viewers.web.limits import MOST_PAGES, MOST_STRANGERS, Guesses
from ravemj.gui.viewers.web.messages import LONGEST, Rejections

LOOPBACK = "127.0.0.1"
_LOCAL_NAMES = {LOOPBACK, "localhost", "::1"}
_EVERYWHERE = {"", "0.0.0.0", "::"}
_SOCKET = "socket"
_FOREVER = "private, max-age=31536000, immutable"
"""Cache-Control header of content that is named by its hash, so that it never changes."""

_TOKEN = re.compile(r"[A-Za-z0-9_-]{8,64}")
_MAY_REPEAT = {"forwarded", "via", "x-forwarded-for", "x-forwarded-port", "x-forwarded-proto"}
"""Headers that may be repeated, since each proxy may add one."""

_METHOD = re.compile(rb"([A-Za-z]{1,16})(?: |$)")
_HANDSHAKE = 5.0
"""Time limit for a request of an unauthenticated connection [s]."""

_FAREWELL = 1.0
"""Time limit for pages to disconnect when the viewer is closed [s]."""

_servers: "weakref.WeakSet[PageServer]" = weakref.WeakSet()


class PageServer:
    """HTTP and WebSocket server of a viewer's page.

    Attributes:
        port: Port number.
        token: Secret at the start of each path.
        complain: Logs invalid requests and messages.
        closed: Set when the server is closed.
    """

    def __init__(
        self,
        host: str,
        port: int,
        serve_page: Callable[[ServerConnection], None],
        find_scene: Callable[[str], bytes | None],
        first_scene: Callable[[], str],
        *,
        token: str | None = None,
        any_name: bool,
    ) -> None:
        """Start to listen.

        Args:
            host: Name or address of the interface.
            port: Port number; 0 selects a free one.
            serve_page: Called with the connection of each page, in a new thread.
            find_scene: Returns cacheable content by its name; None if it does not exist.
            first_scene: Returns the name of the content that a new page needs; empty if it is not known yet.
            token: Secret at the start of each path; None generates one.
            any_name: Whether any ``Host`` header is accepted, as needed behind a proxy.

        Raises:
            RenderingError: the port is not available.
            ArgumentError: the token is too short or has invalid characters, or ``RAVEMJ_EMBED`` is invalid.
        """
        self._origins = origins_of_environment()
        self._is_lasting = port != 0 and token is not None
        self.token = secrets.token_urlsafe(16) if token is None else checked_token(token)
        self.complain = Rejections()
        self.closed = Flag()
        self._may_stop = threading.Lock()  # computed by the first request
        self._any_name = any_name
        self._find_scene, self._first_scene = find_scene, first_scene
        self._listening = _listen(host, port)
        self.port = int(self._listening.getsockname()[1])
        self._threads: set[threading.Thread] = set()
        self._connections: set[socket.socket] = set()
        self._strangers: dict[threading.Thread, socket.socket] = {}  # unauthenticated connections, the oldest first
        self._pages: set[threading.Thread] = set()
        self._guesses = Guesses()
        silent = logging.getLogger("ravemj.web")
        silent.setLevel(logging.CRITICAL)  # requests of strangers are not logged
        self._server = serve(
            serve_page,
            sock=self._listening,
            process_request=self._answer,
            max_size=LONGEST,
            compression=None,
            open_timeout=_HANDSHAKE,
            close_timeout=_FAREWELL,
            logger=silent,
        )
        self._accepting = threading.Thread(target=self._accept, name="ravemj web", daemon=True)
        self._accepting.start()
        _servers.add(self)

    def url(self, host: str, scheme: str = "http") -> str:
        """Return the URL of the page, given a name of this machine."""
        name = socket.gethostname() if host in _EVERYWHERE else f"[{host}]" if ":" in host else host
        return f"{scheme}://{name}:{self.port}/{self.token}/"

    def allow_embedding(self, origins: str | Iterable[str]) -> None:
        """Permit additional origins to embed the page.

        Raises:
            ArgumentError: one of them is not an origin.
        """
        self._origins += checked_origins(origins)

    def close(self) -> None:
        """Stop listening, and wait briefly for the pages to disconnect. Blocked threads do not keep Python alive."""
        self.closed.set()
        if self._may_stop.acquire(blocking=False):
            self._stop_listening()
        end = time.monotonic() + _FAREWELL
        for thread in {self._accepting, *self._threads} - {threading.current_thread()}:
            thread.join(max(end - time.monotonic(), 0.0))

    def _stop_listening(self) -> None:
        with contextlib.suppress(OSError):  # not supported on every system
            self._listening.shutdown(socket.SHUT_RDWR)  # wakes the thread that accepts
        self._listening.close()
        self._server.serve_forever()  # ``shutdown`` waits for its end, which is immediate
        self._server.shutdown()

    def forget(self) -> None:
        """Close this process's copies of the sockets, without effect on other processes."""
        self.closed.set()
        for each in (self._listening, *self._connections):
            with contextlib.suppress(OSError):  # it is closed
                os.close(each.detach())

    def _accept(self) -> None:
        """Accept connections, a thread for each: ``Server.serve_forever`` would wait for its threads without limit."""
        while not self.closed.is_set():
            try:
                connection, address = self._listening.accept()
            except OSError:  # closed, or too many files are open
                self.closed.wait(0.1)
                continue
            if len(self._threads) >= MOST_PAGES + MOST_STRANGERS:
                self.complain("there are too many connections")
                if not self._drop_oldest_stranger():
                    connection.close()
                    continue
            thread = threading.Thread(target=self._serve, args=(connection, address), name="ravemj page", daemon=True)
            self._threads.add(thread)
            self._strangers[thread] = connection
            thread.start()

    def _drop_oldest_stranger(self) -> bool:
        """Close the oldest unauthenticated connection; return whether there was one."""
        for thread, connection in self._strangers.copy().items():
            if self._strangers.pop(thread, None) is not None:
                with contextlib.suppress(OSError):  # the peer has disconnected
                    connection.shutdown(socket.SHUT_RDWR)
                self._threads.discard(thread)
                return True
        return False

    def _serve(self, connection: socket.socket, address: object) -> None:
        thread = threading.current_thread()
        self._connections.add(connection)
        try:
            if not _is_refused(connection):
                self._server.handler(connection, address)
        finally:
            self._connections.discard(connection)
            self._threads.discard(thread)
            self._pages.discard(thread)
            self._strangers.pop(thread, None)

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request with content or a refusal; None accepts a WebSocket connection."""
        token, slash, name = request.path.partition("?")[0].removeprefix("/").partition("/")
        is_friend = secrets.compare_digest(token.encode(), self.token.encode())
        refusal = _repeated(request.headers) or self._refusal_of_guess(connection, token, is_right=is_friend)
        if refusal is not None:
            return refusal
        scene = self._find_scene(name) if is_friend else None
        is_known = is_friend and (name in {"", _SOCKET} or scene is not None)
        if is_known:
            self._strangers.pop(threading.current_thread(), None)
        if not (slash and is_known) or not self._is_our_name(request.headers.get("Host", "")):
            return _text(http.HTTPStatus.NOT_FOUND, "There is nothing here.\n")
        if scene is not None:
            return _response(http.HTTPStatus.OK, "application/octet-stream", scene, {"Cache-Control": _FOREVER})
        return self._open(request.headers) if name == _SOCKET else self._document(request.headers)

    def _document(self, headers: Headers) -> Response:
        if len(self._pages) >= MOST_PAGES:
            return self._full()
        page, policy = document(self._first_scene(), is_lasting=self._is_lasting)
        policy = f"{policy}; {frame_ancestors(self._origins)}"
        return _page(page, policy, may_compress="gzip" in headers.get("Accept-Encoding", ""))

    def _open(self, headers: Headers) -> Response | None:
        """Return a refusal of a WebSocket connection, or None to accept it."""
        origin, thread = headers.get("Origin", ""), threading.current_thread()
        if not self._is_our_page(origin, headers):
            self.complain("a page of another site is refused", origin)
            return _text(http.HTTPStatus.FORBIDDEN, "Other sites may not connect.\n")
        self._pages.add(thread)
        if len(self._pages) <= MOST_PAGES:
            return None
        self._pages.discard(thread)
        return self._full()

    def _full(self) -> Response:
        self.complain("there are too many pages")
        return _text(http.HTTPStatus.SERVICE_UNAVAILABLE, f"The viewer has {MOST_PAGES} open pages, and no more.\n")

    def _refusal_of_guess(self, connection: ServerConnection, token: str, *, is_right: bool) -> Response | None:
        peer = str(connection.remote_address[0])
        if not self._guesses.refuses(peer, token, is_right=is_right):
            return None
        self.complain("there are too many wrong addresses", peer)
        text = "Too many wrong addresses have come from this machine: try again in a minute.\n"
        return _text(http.HTTPStatus.TOO_MANY_REQUESTS, text, {"Retry-After": "60"})

    def _is_our_name(self, host: str) -> bool:
        return self._any_name or host in {f"{_bracketed(name)}:{self.port}" for name in _LOCAL_NAMES}

    def _is_our_page(self, origin: str, headers: Headers) -> bool:
        """Return whether the Origin header is this server's; other sites cannot forge it in a browser."""
        names, schemes = [headers.get("Host", "")], ["http"]
        if self._any_name:
            names.append(headers.get("X-Forwarded-Host", "").partition(",")[0].strip())
            schemes.append("https")
        scheme, _, name = origin.partition("://")
        return scheme in schemes and name != "" and name in names


@before_end
def _close_all() -> None:
    """Close the servers and wait for their pages' threads: Python must not exit while OpenGL draws."""
    for server in _servers.copy():
        server.close()


@in_child
def _forget_all() -> None:
    """Close the sockets in a forked child, so that the ports are free when the parent closes them."""
    for server in _servers.copy():
        server.forget()
    _servers.clear()


def checked_token(token: str) -> str:
    """Validate a token and return it.

    Raises:
        ArgumentError: it is too short, or has invalid characters.
    """
    if not _TOKEN.fullmatch(token):
        raise ArgumentError(f"token: is {token!r}, and should be 8 to 64 letters, digits, - and _")
    return token


def is_local(host: str) -> bool:
    """Return whether an interface accepts connections of this machine only."""
    return host in _LOCAL_NAMES


def _listen(host: str, port: int) -> socket.socket:
    try:
        family = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0][0]
        return socket.create_server((host, port), family=family)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        place = f"port {port} of {host or 'this machine'}" if port else host or "this machine"
        raise RenderingError(f"no page can be served at {place}: {reason}") from None


def _bracketed(name: str) -> str:
    return f"[{name}]" if ":" in name else name


def _is_refused(connection: socket.socket) -> bool:
    """Wait for the method of a request; if it is not GET, answer with a refusal, close, and return True.

    ``websockets`` would close the connection without an answer if the request has a body.
    """
    try:
        connection.settimeout(_HANDSHAKE)
        first = connection.recv(17, socket.MSG_PEEK)
        connection.settimeout(None)
        method = _METHOD.match(first)
        if method is None or b"GET ".startswith(method[0]):
            return False
        refusal = _text(http.HTTPStatus.METHOD_NOT_ALLOWED, "The only method here is GET.\n", {"Allow": "GET"})
        connection.settimeout(_FAREWELL)
        connection.sendall(refusal.serialize() if method[1] != b"HEAD" else refusal.serialize()[: -len(refusal.body)])
        connection.shutdown(socket.SHUT_WR)
        for _ in range(64):  # unread input would reset the connection before the client reads the answer
            if not connection.recv(65536):
                break
    except OSError:
        pass
    connection.close()
    return True


def _repeated(headers: Headers) -> Response | None:
    """Return a refusal if a header occurs more than once, which proxies may interpret differently; else None."""
    names = [name.lower() for name, _ in headers.raw_items()]
    again = next((name for name in names if names.count(name) > 1 and name not in _MAY_REPEAT), None)
    if again is None:
        return None
    return _text(http.HTTPStatus.BAD_REQUEST, f"The header {again} comes more than once.\n")


def _page(page: bytes, policy: str, *, may_compress: bool) -> Response:
    headers = {"Content-Security-Policy": policy}
    if may_compress:
        page, headers["Content-Encoding"] = gzip.compress(page), "gzip"
    return _response(http.HTTPStatus.OK, "text/html; charset=utf-8", page, headers)


def _text(status: http.HTTPStatus, text: str, more: Mapping[str, str] = MappingProxyType({})) -> Response:
    return _response(status, "text/plain", text.encode(), more)


def _response(
    status: http.HTTPStatus, kind: str, body: bytes, more: Mapping[str, str] = MappingProxyType({})
) -> Response:
    headers = {
        "Content-Type": kind,
        "Content-Length": str(len(body)),
        "Content-Security-Policy": "default-src 'none'",
        "Cache-Control": "no-store",
        "Referrer-Policy": "no-referrer",
        "X-Content-Type-Options": "nosniff",
        "Connection": "close",
    }
    return Response(status.value, status.phrase, Headers({**headers, **more}), body)
