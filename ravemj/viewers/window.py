"""A viewer with a window, drawn by a thread of its own while the script goes on."""

import atexit
import threading
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from ravemj.errors import RenderingError
from ravemj.rendering import Camera, Quality, Stage
from ravemj.simulation import Simulation
from ravemj.studio import Studio
from ravemj.viewers.viewer import Viewer

_WIDTH, _HEIGHT = 960, 720
_PERIOD = 1 / 60


class WindowViewer(Viewer):
    """A viewer in a window; it shows every change at once and stays until it is closed."""

    def __init__(self, simulation: Simulation, studio: Studio, name: str) -> None:
        super().__init__(simulation, studio, name)
        self._closing = threading.Event()
        self._opened = threading.Event()
        self._failure = ""
        self._thread = threading.Thread(target=self._run, name="ravemj window", daemon=True)
        self._thread.start()
        self._opened.wait()
        if self._failure:
            self._thread.join()
            raise RenderingError(self._failure)
        atexit.register(self.close)

    @property
    def is_open(self) -> bool:
        """False once the window is closed, by the user or by ``close``."""
        return self._thread.is_alive()

    def wait(self) -> None:
        """Wait until the user closes the window."""
        while self.is_open:
            self._thread.join(0.1)  # in slices, so that Ctrl-C gets through

    def close(self) -> None:
        """Close the window."""
        self._closing.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        atexit.unregister(self.close)
        super().close()

    def _run(self) -> None:
        try:
            window = _Window("ravemj")
        except RenderingError as error:
            self._failure = error.message
            self._opened.set()
            return
        self._opened.set()
        try:
            while not (self._closing.is_set() or window.is_closed):
                window.show(self._simulation, self._camera, self._background)
        finally:
            window.close()


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

    @property
    def is_closed(self) -> bool:
        return bool(self._glfw.window_should_close(self._window))

    def show(self, simulation: Simulation, camera: Camera, background: tuple[float, float, float]) -> None:
        """Draw a frame if anything has changed, then wait for at most a frame's time."""
        width, height = self._glfw.get_framebuffer_size(self._window)
        if width and height:
            with simulation.lock:
                compiled = simulation.compile()
                now = (simulation.version, compiled.data.qpos.tobytes(), camera, background, width, height)
                changed = now != self._shown
                if changed:
                    stage = self._prepared_stage(compiled.model, simulation.version)
                    stage.fill(compiled.data, camera, width, height)
            if changed:
                self._draw(background, width, height)
                self._shown = now
        self._glfw.wait_events_timeout(_PERIOD)

    def _prepared_stage(self, model: mujoco.MjModel, version: int) -> Stage:
        if self._stage is None or self._stage_version != version:
            if self._stage is not None:
                self._stage.close()
            self._stage = Stage(model, Quality(1, 1))
            self._stage_version = version
        return self._stage

    def _draw(self, background: ArrayLike, width: int, height: int) -> None:
        if self._stage is None:
            return
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_WINDOW.value, self._stage.context)
        colour = np.rint(np.multiply(background, 255)).astype(np.uint8)
        self._stage.draw(mujoco.MjrRect(0, 0, width, height), colour)
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
