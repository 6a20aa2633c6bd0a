"""A GLFW window and its input events."""

import functools
import threading
from typing import Any

from ravemj.core.forks import NEW_PROCESS, in_child
from ravemj.errors import RenderingError
from ravemj.gui.interaction import Button, Event, Key, Leave, Move, Press, Release, Type, Wheel
from ravemj.gui.viewers.x_connection import XConnection

_is_used = False
_is_fork = False  # of a process that has opened windows

_dispatching = threading.Lock()
"""Lock held while GLFW dispatches events: all windows share one queue, and each has its own thread."""


_FRAME = 40
"""Height of a window's frame, in GLFW's screen coordinates."""


class GlfwWindow:
    """A window with an OpenGL context; all of its methods must be called in one thread.

    Attributes:
        events: Input events; the user of the window clears the list.
        dropped: Paths of files dropped on it; the user of the window clears the list.
        size: Width and height, in GLFW's screen coordinates.
        pixels: Width and height of the framebuffer [pixels]; 0 while the window is minimised.
        pixel_ratio: Pixels per point: 1, or more on high-density screens.
        is_lost: Whether its content is lost and must be redrawn.
    """

    def __init__(self, title: str, width: int, height: int) -> None:
        """Open a window of a size in GLFW's screen coordinates.

        Raises:
            RenderingError: there is no display, or it has no OpenGL.
        """
        self._glfw = glfw = _import_glfw()
        self.events: list[Event] = []
        self.dropped: list[str] = []
        self.is_lost = True
        self._pointer = 0.0, 0.0
        self._rgb: tuple[int, int, int] | None = None
        self._cursor = ""
        self._cursors: dict[str, Any] = {}
        if _is_fork:
            raise RenderingError(f"no window can be opened in a fork of a process that opened some: {NEW_PROCESS}")
        self._x = _x_connection(glfw)
        if self.is_broken:
            raise RenderingError("no window can be opened: the connection to the display broke; a new process may do")
        glfw.window_hint(glfw.SCALE_TO_MONITOR, True)  # more of its pixels where they are small
        with _dispatching:
            size = _fitting(glfw, width, height)
            self._window: Any = glfw.create_window(*size, title, None, None)
        if not self._window:
            raise RenderingError("no window can be opened: the display offers no OpenGL")
        glfw.make_context_current(self._window)
        glfw.swap_interval(1)
        self._listen()

    def _listen(self) -> None:
        glfw, window = self._glfw, self._window
        self.size: tuple[int, int] = glfw.get_window_size(window)  # asking the display each time would be slow
        self.pixels: tuple[int, int] = glfw.get_framebuffer_size(window)
        glfw.set_window_size_callback(window, self._on_size)
        glfw.set_framebuffer_size_callback(window, self._on_pixels)
        self._on_scale(window, *glfw.get_window_content_scale(window))
        glfw.set_window_content_scale_callback(window, self._on_scale)
        glfw.set_window_refresh_callback(window, self._on_refresh)
        glfw.set_cursor_pos_callback(window, self._on_pointer)
        glfw.set_cursor_enter_callback(window, self._on_enter)
        glfw.set_mouse_button_callback(window, self._on_button)
        glfw.set_scroll_callback(window, self._on_scroll)
        glfw.set_key_callback(window, self._on_key)
        glfw.set_char_callback(window, self._on_letter)
        glfw.set_window_focus_callback(window, self._on_focus)
        glfw.set_drop_callback(window, self._on_drop)
        self._buttons = {
            glfw.MOUSE_BUTTON_LEFT: Button.LEFT,
            glfw.MOUSE_BUTTON_MIDDLE: Button.MIDDLE,
            glfw.MOUSE_BUTTON_RIGHT: Button.RIGHT,
        }
        self._keys = {
            glfw.KEY_ESCAPE: "escape",
            glfw.KEY_SPACE: " ",
            glfw.KEY_LEFT: "arrowleft",
            glfw.KEY_RIGHT: "arrowright",
            glfw.KEY_HOME: "home",
            glfw.KEY_F1: "f1",
            glfw.KEY_ENTER: "enter",
            glfw.KEY_KP_ENTER: "enter",
            glfw.KEY_BACKSPACE: "backspace",
        }

    # --- input

    def _on_size(self, _window: object, width: int, height: int) -> None:
        self.size = max(width, 1), max(height, 1)

    def _on_pixels(self, _window: object, width: int, height: int) -> None:
        self.pixels = width, height

    def _on_scale(self, _window: object, x: float, _y: float) -> None:
        self.pixel_ratio = max(float(x), 0.5)

    def _on_refresh(self, _window: object) -> None:
        self.is_lost = True

    def _on_pointer(self, _window: object, x: float, y: float) -> None:
        self._pointer = self._in_points(x, y)
        self._move(*self._pointer)

    def _move(self, x: float, y: float) -> None:
        if self.events and isinstance(self.events[-1], Move):
            self.events.pop()  # only the latest pointer position counts
        self.events.append(Move(x, y))

    def _on_enter(self, window: object, entered: int) -> None:
        held = any(self._glfw.get_mouse_button(window, button) for button in self._buttons)
        if not entered and not held:
            self._move(-1.0, -1.0)

    def _on_button(self, _window: object, button: int, action: int, mods: int) -> None:
        glfw = self._glfw
        if button not in self._buttons:
            return
        x, y = self._pointer  # GLFW would tell where it is now, not where it was then
        if action == glfw.PRESS:
            ctrl, shift = bool(mods & (glfw.MOD_CONTROL | glfw.MOD_SUPER)), bool(mods & glfw.MOD_SHIFT)
            self.events.append(Press(x, y, self._buttons[button], ctrl, shift))
        else:
            self.events.append(Release(x, y, self._buttons[button]))

    def _on_scroll(self, _window: object, _aside: float, steps: float) -> None:
        self.events.append(Wheel(steps))

    def _on_key(self, _window: object, key: int, scancode: int, action: int, mods: int) -> None:
        glfw = self._glfw
        if mods & (glfw.MOD_CONTROL | glfw.MOD_ALT | glfw.MOD_SUPER) and action == glfw.PRESS:
            return
        name = self._keys.get(key) or glfw.get_key_name(key, scancode)
        if name and not name.isascii() and key < 128:  # Greek, say: what the key is on an English keyboard
            name = chr(key)
        if name and (action != glfw.REPEAT or name == "backspace"):
            self.events.append(Key(name, action in (glfw.PRESS, glfw.REPEAT)))

    def _on_letter(self, _window: object, letter: int) -> None:
        self.events.append(Type(chr(letter)))
        if chr(letter) == "?":  # it is with other keys on other keyboards
            self.events += [Key("?"), Key("?", False)]

    def _on_focus(self, _window: object, focused: int) -> None:
        if not focused:
            self.events.append(Leave())

    def _on_drop(self, _window: object, paths: list[str]) -> None:
        self.dropped += paths

    # --- state

    @property
    def is_broken(self) -> bool:
        """Whether the connection to the display is lost; no other method may be called then."""
        return self._x is not None and self._x.is_broken

    @property
    def is_closed(self) -> bool:
        """Whether the user has closed it."""
        return bool(self._glfw.window_should_close(self._window))

    @property
    def points(self) -> tuple[int, int]:
        """Width and height [points]."""
        width, height = self.pixels
        return max(round(width / self.pixel_ratio), 1), max(round(height / self.pixel_ratio), 1)

    def _in_points(self, x: float, y: float) -> tuple[float, float]:
        width, height = self.size
        columns, rows = self.points
        return x * columns / width, y * rows / height

    def call(self, function: str, *arguments: object) -> None:
        """Call a GLFW function such as ``set_window_title`` with this window; sizes are in screen coordinates."""
        getattr(self._glfw, function)(self._window, *arguments)

    def set_background(self, rgb: tuple[int, int, int]) -> None:
        """Set the colour (0..255) that newly exposed areas of an enlarged window have until they are drawn."""
        if rgb != self._rgb and self._x is not None:
            self._x.keep_picture(self._glfw.get_x11_window(self._window), rgb)
        self._rgb = rgb

    def set_cursor(self, name: str) -> None:
        """Set the pointer shape, a name of ``Overlay.cursor``."""
        if name == self._cursor:
            return
        self._cursor = name
        glfw = self._glfw
        shapes = {"pointer": glfw.HAND_CURSOR, "move": glfw.CROSSHAIR_CURSOR, "text": glfw.IBEAM_CURSOR}
        if name in shapes and name not in self._cursors:
            self._cursors[name] = glfw.create_standard_cursor(shapes[name])
        glfw.set_cursor(self._window, self._cursors.get(name))

    def copy_text(self, text: str) -> None:
        """Copy a text to the clipboard."""
        with _dispatching:  # while it lasts, others ask for it, too
            self._glfw.set_clipboard_string(self._window, text)

    def wait(self, seconds: float) -> None:
        """Wait for input, at most for a time [s]."""
        if self._x is None:
            self._glfw.wait_events_timeout(seconds)
            return
        self._x.wait(seconds)
        if not self.is_broken:
            with _dispatching:
                self._glfw.poll_events()

    def swap(self) -> None:
        """Swap the buffers: show the drawn frame."""
        self.is_lost = False
        self._glfw.swap_buffers(self._window)

    def close(self) -> None:
        """Close the window; if the display is lost, only drop the reference."""
        if self._x is not None and self._x.is_broken:
            self._x.abandon()
            return
        with _dispatching:
            self._glfw.destroy_window(self._window)
            self._glfw.poll_events()


@in_child
def _leave_windows() -> None:
    """Disown the windows in a forked child: they belong to the parent."""
    global _is_fork, _dispatching
    _is_fork, _dispatching = _is_fork or _is_used, threading.Lock()


@functools.cache
def _x_connection(glfw: Any) -> XConnection | None:  # noqa: ANN401 - glfw has no types
    """Return GLFW's connection to its X server, which all windows share; None on other systems.

    Raises:
        RenderingError: there is no display.
    """
    global _is_used  # noqa: PLW0603 - of the process
    _is_used = True
    if not glfw.init():
        raise RenderingError("no window can be opened: GLFW finds no display")
    if not hasattr(glfw, "get_platform") or glfw.get_platform() != glfw.PLATFORM_X11:
        return None
    return XConnection(glfw.get_x11_display())


def _fitting(glfw: Any, width: int, height: int) -> tuple[int, int]:  # noqa: ANN401 - glfw has no types
    """Clip a size so that the window with its frame fits on the screen."""
    monitor = glfw.get_primary_monitor()
    if not monitor:
        return width, height
    _, _, most_columns, most_rows = glfw.get_monitor_workarea(monitor)
    return max(min(width, most_columns), 1), max(min(height, most_rows - _FRAME), 1)


def _import_glfw() -> Any:  # noqa: ANN401 - glfw has no types
    import glfw  # noqa: PLC0415 - loads the libraries of the display

    glfw.ERROR_REPORTING = "ignore"
    return glfw
