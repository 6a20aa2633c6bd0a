"""Connection to an X server: waits for events, and survives the loss of the server."""

import ctypes
import select

_OnError = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_OnExit = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)

_PIXEL, _GRAVITY = 1 << 1, 1 << 4
"""Bits of Xlib's mask of changed window attributes."""

_NORTH_WEST = 1


class _WindowAttributes(ctypes.Structure):
    """First fields of Xlib's ``XSetWindowAttributes``; Xlib ignores the others, whose bits in the mask are not set."""

    _fields_ = (
        ("background_pixmap", ctypes.c_ulong),
        ("background_pixel", ctypes.c_ulong),
        ("border_pixmap", ctypes.c_ulong),
        ("border_pixel", ctypes.c_ulong),
        ("bit_gravity", ctypes.c_int),
    )


class XConnection:
    """An X connection whose loss does not end the process.

    Xlib exits the process when the server is lost, as on logout or when ssh loses its network. Since version 1.7 this
    can be disabled; Xlib's calls then have no effect.

    Attributes:
        is_broken: Whether the connection is lost; no other method may be called then.
    """

    def __init__(self, display: int) -> None:
        """Guard an open connection, given the address of Xlib's ``Display``."""
        self.is_broken = False
        self._xlib, self._display = xlib, address = ctypes.CDLL("libX11.so.6"), ctypes.c_void_p(display)
        self._number: int = xlib.XConnectionNumber(address)
        self._callbacks = _OnError(_ignore), _OnExit(self._on_exit)  # keeps them alive for Xlib
        if hasattr(xlib, "XSetIOErrorExitHandler"):
            xlib.XSetIOErrorHandler(self._callbacks[0])
            xlib.XSetIOErrorExitHandler(address, self._callbacks[1], None)

    def _on_exit(self, _display: object, _data: object) -> None:
        self.is_broken = True

    def wait(self, seconds: float) -> None:
        """Wait until the server sends an event or is lost, at most for a time [s]."""
        poll = select.poll()  # each thread needs its own
        poll.register(self._number, select.POLLIN)
        for _, events in poll.poll(1e3 * seconds):
            self.is_broken |= bool(events & (select.POLLHUP | select.POLLERR | select.POLLNVAL))

    def keep_picture(self, window: int, rgb: tuple[int, int, int]) -> None:
        """Have the server keep a window's content while it is resized, and fill new areas with a colour (0..255)."""
        red, green, blue = rgb
        pixel = 0xFF << 24 | red << 16 | green << 8 | blue
        attributes = _WindowAttributes(background_pixel=pixel, bit_gravity=_NORTH_WEST)
        self._xlib.XChangeWindowAttributes(
            self._display, ctypes.c_ulong(window), ctypes.c_ulong(_PIXEL | _GRAVITY), ctypes.byref(attributes)
        )

    def abandon(self) -> None:
        """Release the display lock that this thread has held since the connection broke, to avoid a deadlock."""
        for _ in range(3):
            self._xlib.XUnlockDisplay(self._display)


def _ignore(_display: object) -> int:
    """Suppress Xlib's error message."""
    return 0
