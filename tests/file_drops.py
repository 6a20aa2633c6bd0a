"""Files that are dragged from another program and dropped on a window, by X's protocol for that (XDND)."""

import ctypes
import ctypes.util
from pathlib import Path

from screens import ClientMessage, Display
from waiting import await_that

_CLIENT_MESSAGE, _SELECTION_REQUEST, _SELECTION_NOTIFY = 33, 30, 31
_VERSION = 5
_NOW = 0


class _Request(ctypes.Structure):
    """A program asks for what is dragged."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("owner", ctypes.c_ulong),
        ("requestor", ctypes.c_ulong),
        ("selection", ctypes.c_ulong),
        ("target", ctypes.c_ulong),
        ("property", ctypes.c_ulong),
        ("time", ctypes.c_ulong),
    )


class _Answer(ctypes.Structure):
    _fields_ = (
        *_Request._fields_[:4],
        ("requestor", ctypes.c_ulong),
        ("selection", ctypes.c_ulong),
        ("target", ctypes.c_ulong),
        ("property", ctypes.c_ulong),
        ("time", ctypes.c_ulong),
    )


class _XEvent(ctypes.Union):
    _fields_ = (
        ("type", ctypes.c_int),
        ("message", ClientMessage),
        ("request", _Request),
        ("answer", _Answer),
        ("whole", ctypes.c_long * 24),
    )


def drop(display: Display, window: int, files: list[Path]) -> None:
    """Drop files on a window, and wait until it has taken them."""
    source = _Source(display.name, window, "".join(f"{path.as_uri()}\r\n" for path in files).encode())
    try:
        source.say("XdndEnter", _VERSION << 24, source.atom("text/uri-list"))
        source.say("XdndPosition", 0, 40 << 16 | 40, _NOW, source.atom("XdndActionCopy"))
        await_that(lambda: source.hears("XdndStatus"), "the window does not look at what is dragged over it")
        source.say("XdndDrop", 0, _NOW)
        await_that(lambda: source.hears("XdndFinished"), "the window does not take what was dropped")
    finally:
        source.close()


class _Source:
    """The program that files are dragged from."""

    def __init__(self, display_name: str, window: int, content: bytes) -> None:
        self._x = x = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        for name, result in (
            ("XOpenDisplay", ctypes.c_void_p),
            ("XDefaultRootWindow", ctypes.c_ulong),
            ("XCreateSimpleWindow", ctypes.c_ulong),
            ("XInternAtom", ctypes.c_ulong),
        ):
            getattr(x, name).restype = result
        self._display = ctypes.c_void_p(x.XOpenDisplay(display_name.encode()))
        root = ctypes.c_ulong(x.XDefaultRootWindow(self._display))
        self._own = ctypes.c_ulong(x.XCreateSimpleWindow(self._display, root, 0, 0, 1, 1, 0, _NOW, _NOW))
        self._window, self._content = ctypes.c_ulong(window), content
        x.XSetSelectionOwner(self._display, ctypes.c_ulong(self.atom("XdndSelection")), self._own, ctypes.c_ulong(_NOW))

    def atom(self, name: str) -> int:
        return self._x.XInternAtom(self._display, name.encode(), 0)

    def say(self, name: str, *numbers: int) -> None:
        data = (ctypes.c_long * 5)(self._own.value, *numbers)
        event = _XEvent(message=ClientMessage(_CLIENT_MESSAGE, 0, 1, None, self._window, self.atom(name), 32, data))
        self._send(self._window, event)

    def hears(self, name: str) -> bool:
        """Give the window what it asks for meanwhile."""
        event = _XEvent()
        while self._x.XPending(self._display):
            self._x.XNextEvent(self._display, ctypes.byref(event))
            if event.type == _SELECTION_REQUEST:
                self._give(event.request)
            elif event.type == _CLIENT_MESSAGE and event.message.message_type == self.atom(name):
                return True
        return False

    def _give(self, request: _Request) -> None:
        requestor, size = ctypes.c_ulong(request.requestor), len(self._content)
        place, kind = ctypes.c_ulong(request.property), ctypes.c_ulong(request.target)
        self._x.XChangeProperty(self._display, requestor, place, kind, 8, 0, self._content, size)
        names = (request.requestor, request.selection, request.target, request.property, request.time)
        self._send(requestor, _XEvent(answer=_Answer(_SELECTION_NOTIFY, 0, 1, None, *names)))

    def _send(self, window: ctypes.c_ulong, event: _XEvent) -> None:
        assert self._x.XSendEvent(self._display, window, 0, ctypes.c_long(0), ctypes.byref(event))
        self._x.XFlush(self._display)

    def close(self) -> None:
        self._x.XCloseDisplay(self._display)
