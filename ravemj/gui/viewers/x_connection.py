"""The connection to an X server: waiting for what it sends, and living on when it breaks."""

import ctypes
import select

_OnError = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_OnExit = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)

_PIXEL, _GRAVITY = 1 << 1, 1 << 4
"""Which of the attributes are to be changed."""

_NORTH_WEST = 1


class _WindowAttributes(ctypes.Structure):
    """The beginning of Xlib's ``XSetWindowAttributes``; it reads no others than those that are to be changed."""

    _fields_ = (
        ("background_pixmap", ctypes.c_ulong),
        ("background_pixel", ctypes.c_ulong),
        ("border_pixmap", ctypes.c_ulong),
        ("border_pixel", ctypes.c_ulong),
        ("bit_gravity", ctypes.c_int),
    )


class XConnection:
    """A connection that does not take the process with it.

    Xlib ends the process when the server is gone, be it that somebody has logged out or that ssh has lost its network.
    From version 1.7 on it can be told to leave that; its calls have no effect then.

    Attributes:
        is_broken: Whether the server is gone; nothing should be asked of it any more.
    """

    def __init__(self, display: int) -> None:
        """Guard a connection that is open, by the address of Xlib's ``Display``."""
        self.is_broken = False
        self._xlib, self._display = xlib, address = ctypes.CDLL("libX11.so.6"), ctypes.c_void_p(display)
        self._number: int = xlib.XConnectionNumber(address)
        self._callbacks = _OnError(_ignore), _OnExit(self._on_exit)  # Xlib has nothing but their addresses
        if hasattr(xlib, "XSetIOErrorExitHandler"):
            xlib.XSetIOErrorHandler(self._callbacks[0])
            xlib.XSetIOErrorExitHandler(address, self._callbacks[1], None)

    def _on_exit(self, _display: object, _data: object) -> None:
        self.is_broken = True

    def wait(self, seconds: float) -> None:
        """Wait until the server sends something or is gone, but not longer than some time."""
        poll = select.poll()  # each thread needs its own
        poll.register(self._number, select.POLLIN)
        for _, events in poll.poll(1e3 * seconds):
            self.is_broken |= bool(events & (select.POLLHUP | select.POLLERR | select.POLLNVAL))

    def keep_picture(self, window: int, rgb: tuple[int, int, int]) -> None:
        """Have the server keep what is in a window that people resize, and fill what is new with a colour (0..255)."""
        red, green, blue = rgb
        pixel = 0xFF << 24 | red << 16 | green << 8 | blue
        attributes = _WindowAttributes(background_pixel=pixel, bit_gravity=_NORTH_WEST)
        self._xlib.XChangeWindowAttributes(
            self._display, ctypes.c_ulong(window), ctypes.c_ulong(_PIXEL | _GRAVITY), ctypes.byref(attributes)
        )

    def abandon(self) -> None:
        """Give back what this thread has locked in the display when it broke, or the process would wait for that."""
        for _ in range(3):
            self._xlib.XUnlockDisplay(self._display)


def _ignore(_display: object) -> int:
    """Print nothing when a connection breaks."""
    return 0
