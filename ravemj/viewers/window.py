"""A viewer with a window, drawn by a thread of its own while the script goes on."""

import threading
import weakref
from collections.abc import Callable
from queue import SimpleQueue
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import RenderingError
from ravemj.rendering import Camera
from ravemj.rendering.stage import Quality, Stage
from ravemj.simulation import Simulation
from ravemj.studio import Studio
from ravemj.viewers.callbacks import Callbacks
from ravemj.viewers.viewer import Viewer

_WIDTH, _HEIGHT = 960, 720
_PERIOD = 1 / 60
_LONGEST_SYNC = 1.0

_Request = Callable[["_Window"], object]
"""What other threads ask of a window: its methods belong to one thread."""


class WindowViewer(Viewer):
    """A viewer in a window; it shows every change at once and stays until it is closed."""

    def __init__(self, simulation: Simulation, studio: Studio, name: str) -> None:
        super().__init__(simulation, studio, name)
        self._size = _WIDTH, _HEIGHT
        self._requests: SimpleQueue[_Request] = SimpleQueue()
        self._closing = threading.Event()
        self._opened = threading.Event()
        self._failure = ""
        self._thread = threading.Thread(target=_run, args=(weakref.ref(self),), name="ravemj window", daemon=True)
        self._thread.start()
        self._opened.wait()
        if self._failure:
            self._thread.join()
            raise RenderingError(self._failure)
        self._end = weakref.finalize(self, _end, self._closing, self._thread)

    @property
    def is_open(self) -> bool:
        """False once the window is closed, by the user or by ``close``."""
        return self._thread.is_alive()

    def wait(self) -> None:
        """Wait until the user closes the window."""
        while self.is_open:
            self._thread.join(0.1)  # in slices, so that Ctrl-C gets through

    def SetName(self, title: str) -> None:
        """Set the title of the window.

        Args:
            title: The title.
        """
        super().SetName(title)
        self._requests.put(lambda window: window.set_title(str(title)))

    def SetSize(self, w: int, h: int) -> None:
        """Set the size of the window.

        Args:
            w: Columns [pixels].
            h: Rows [pixels].

        Raises:
            ArgumentError: a size is not positive.
        """
        super().SetSize(w, h)
        self._requests.put(lambda window: window.resize(w, h))

    def Move(self, x: int, y: int) -> None:
        """Move the window.

        Args:
            x: Where its left edge goes on the screen [pixels].
            y: Where its upper edge goes on the screen [pixels].
        """
        self._requests.put(lambda window: window.move(x, y))

    def Show(self, showtype: int) -> None:
        """Hide the window, or show it.

        Args:
            showtype: 0 hides it.
        """
        self._requests.put(lambda window: window.show_or_hide(bool(showtype)))

    def main(self, bShow: bool = True) -> int:
        """Wait until the user closes the window or ``quitmainloop`` is called.

        Args:
            bShow: False hides the window.

        Returns:
            0.
        """
        self.Show(int(bShow))
        self.wait()
        return 0

    def quitmainloop(self) -> None:
        """Close the window, which ends ``main``."""
        self._closing.set()

    def EnvironmentSync(self) -> None:
        """Wait until the window shows the environment as it is now; at most a second, in which others may hold it."""
        drawn = threading.Event()
        self._requests.put(lambda _: self._requests.put(lambda _: drawn.set()))
        drawn.wait(_LONGEST_SYNC)

    def close(self) -> None:
        """Close the window."""
        self._end()
        super().close()

    def open_window(self) -> "_Window | None":
        """Open the window, in the thread that it belongs to; None where that fails."""
        try:
            return _Window("ravemj")
        except RenderingError as error:
            self._failure = error.message
            return None
        finally:
            self._opened.set()

    def turn(self, window: "_Window") -> bool:
        """Do what others asked of the window and draw it anew if need be; return False once it should close."""
        if self._closing.is_set() or window.is_closed:
            return False
        for _ in range(self._requests.qsize()):
            self._requests.get()(window)
        self._size = window.size
        self._thread_callbacks.call()
        window.show(self._simulation, self._camera, self._background, self._image_callbacks)
        return True


def _run(reference: "weakref.ref[WindowViewer]") -> None:
    """Open a viewer's window and draw it until it is closed or the viewer is gone, which waiting does not keep."""
    viewer = reference()
    window = viewer.open_window() if viewer is not None else None
    if window is None:
        return
    try:
        while viewer is not None and viewer.turn(window):
            viewer = None
            window.wait()
            viewer = reference()
    finally:
        window.close()


def _end(closing: threading.Event, thread: threading.Thread) -> None:
    """Close a window and wait for the end of its thread."""
    closing.set()
    if threading.current_thread() is not thread:
        thread.join()


class _Window:
    """A GLFW window; all of its methods belong to one thread."""

    def __init__(self, title: str) -> None:
        self._glfw = glfw = _import_glfw()
        if not glfw.init():
            raise RenderingError("no window can be opened: GLFW finds no display")
        glfw.window_hint(glfw.SAMPLES, 4)
        self._window: Any = glfw.create_window(_WIDTH, _HEIGHT, title, None, None)
        if not self._window:
            raise RenderingError("no window can be opened: the display offers no OpenGL")
        glfw.make_context_current(self._window)
        glfw.swap_interval(1)
        self._stage: Stage | None = None
        self._stage_version = 0
        self._shown: object = None
        glfw.set_window_refresh_callback(self._window, self._forget_picture)

    def _forget_picture(self, window: object) -> None:
        """Have the window drawn again: what was in it is lost."""
        del window
        self._shown = None

    @property
    def is_closed(self) -> bool:
        return bool(self._glfw.window_should_close(self._window))

    @property
    def size(self) -> tuple[int, int]:
        width, height = self._glfw.get_window_size(self._window)
        return max(width, 1), max(height, 1)

    def set_title(self, title: str) -> None:
        self._glfw.set_window_title(self._window, title)

    def resize(self, width: int, height: int) -> None:
        self._glfw.set_window_size(self._window, width, height)

    def move(self, x: int, y: int) -> None:
        self._glfw.set_window_pos(self._window, x, y)

    def show_or_hide(self, shown: bool) -> None:
        (self._glfw.show_window if shown else self._glfw.hide_window)(self._window)

    def show(
        self,
        simulation: Simulation,
        camera: Camera,
        background: tuple[float, float, float],
        on_picture: Callbacks,
    ) -> None:
        """Draw a frame if anything has changed."""
        width, height = self._glfw.get_framebuffer_size(self._window)
        if width and height:
            with simulation.lock:
                compiled = simulation.compile()
                shapes = simulation.drawings.shapes()
                poses = compiled.data.geom_xpos.tobytes(), compiled.data.geom_xmat.tobytes()
                now = (simulation.version, poses, camera, background, width, height, shapes)
                changed = now != self._shown
                if changed:
                    stage = self._prepared_stage(compiled.model, simulation.version)
                    stage.fill(compiled.data, camera, width, height, shapes)
            if changed:
                self._draw(background, width, height, on_picture)
                self._shown = now

    def wait(self) -> None:
        """Wait for the user, for at most a frame's time."""
        self._glfw.wait_events_timeout(_PERIOD)

    def _prepared_stage(self, model: mujoco.MjModel, version: int) -> Stage:
        if self._stage is None or self._stage_version != version:
            if self._stage is not None:
                self._stage.close()
            self._stage = Stage(model, Quality(1, 1))
            self._stage_version = version
        return self._stage

    def _draw(self, background: ArrayLike, width: int, height: int, on_picture: Callbacks) -> None:
        if self._stage is None:
            return
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_WINDOW.value, self._stage.context)
        colour = np.rint(np.multiply(background, 255)).astype(np.uint8)
        viewport = mujoco.MjrRect(0, 0, width, height)
        self._stage.draw(viewport, colour)
        if on_picture:
            pixels = np.empty((height, width, 3), dtype=np.uint8)
            mujoco.mjr_readPixels(pixels, None, viewport, self._stage.context)
            on_picture.call(pixels[::-1].copy())
        self._glfw.swap_buffers(self._window)

    def close(self) -> None:
        if self._stage is not None:
            self._stage.close()
        self._glfw.destroy_window(self._window)
        self._glfw.poll_events()


def _import_glfw() -> Any:  # noqa: ANN401 - glfw has no types
    import glfw  # noqa: PLC0415 - loads the libraries of the display

    glfw.ERROR_REPORTING = "ignore"
    return glfw
