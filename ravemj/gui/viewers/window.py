"""The viewer in a window, with its own thread."""

import logging
import re
import threading
import time
import weakref
from queue import SimpleQueue

import numpy as np

from ravemj.core.arrays import checked_vector
from ravemj.core.flags import Flag
from ravemj.core.forks import in_child
from ravemj.core.locks import before_end
from ravemj.engine.simulation import Simulation
from ravemj.errors import ArgumentError, RavemjError, RenderingError
from ravemj.graphics.simulation_renderer import SimulationRenderer
from ravemj.gui.interaction import Request, Resize
from ravemj.gui.viewers.dropping import add_files
from ravemj.gui.viewers.glfw_window import GlfwWindow
from ravemj.gui.viewers.recorder import FrameSource
from ravemj.gui.viewers.sharpness import period
from ravemj.gui.viewers.viewer import LOCKED, PATIENCE, Viewer
from ravemj.gui.viewers.window_renderer import DrawTarget, WindowRenderer

_LOG = logging.getLogger("ravemj")
_WIDTH, _HEIGHT = 960, 720
_PERIOD = 1 / 60
_SLOW = 1.5 * _PERIOD
"""Drawing time [s] from which the thread waits a full period before the next frame, so that scripts get time."""

_LONGEST_SYNC = 1.0
_FARTHEST = 32767
"""Largest coordinate on an X screen."""

_running: dict[threading.Thread, tuple[Flag, Flag]] = {}
"""Two flags of each window thread: it must close, and it has ended.

The latter replaces ``Thread.join``, which Ctrl-C can break.
"""


class WindowViewer(Viewer):
    """A viewer in a window, which shows changes immediately until it is closed or collected."""

    _internal = ("open_window", "period", "run_once")

    def __init__(self, simulation: Simulation, renderer: SimulationRenderer, name: str) -> None:
        super().__init__(simulation, renderer, name)
        self._size = _WIDTH, _HEIGHT
        self._requests: SimpleQueue[tuple[str, *tuple[object, ...]]] = SimpleQueue()
        self._awaited: SimpleQueue[Flag] = SimpleQueue()
        self._complaint = ""
        self._free_at = self._changed_at = time.monotonic()
        self._closing = Flag()
        self._opened = Flag()
        self._failure = ""
        self._ended = Flag()
        thread = threading.Thread(target=_run, args=(weakref.ref(self),), name="ravemj window", daemon=True)
        _running[thread] = self._closing, self._ended
        self._end = weakref.finalize(self, _end, thread)  # before Ctrl-C can interrupt this
        thread.start()
        self._opened.wait()
        if self._failure:
            self._ended.wait()
            raise RenderingError(self._failure)

    def _ask_window(self, function: str, *arguments: object) -> None:
        self._requests.put((function, *arguments))

    def Move(self, x: int, y: int) -> None:
        """Move the window.

        Args:
            x: New column of its left edge on the screen [pixels].
            y: New row of its upper edge on the screen [pixels].

        Raises:
            ArgumentError: a coordinate is out of range.
        """
        place = checked_vector([x, y], 2, "Move")
        if np.abs(place).max() > _FARTHEST:
            raise ArgumentError(f"Move: is {x}, {y}, and should be from {-_FARTHEST} to {_FARTHEST}")
        left, top = place.astype(int).tolist()
        self._ask_window("set_window_pos", left, top)

    def quitmainloop(self) -> None:
        """Close the window, which ends ``main``."""
        self._closing.set()

    def EnvironmentSync(self) -> None:
        """Block until the window shows the present state of the environment, at most a second."""
        drawn = Flag()
        self._awaited.put(drawn)
        drawn.wait(_LONGEST_SYNC if self.is_open else 0.0)

    def close(self) -> None:
        """Close the window."""
        self._end()
        super().close()

    def open_window(self) -> GlfwWindow | None:
        """Open the window, in its own thread; return None if that fails."""
        try:
            return GlfwWindow("ravemj", *self._size)
        except RenderingError as error:
            self._failure = error.message
            return None
        finally:
            self._opened.set()

    def run_once(self, window: GlfwWindow, painter: WindowRenderer) -> bool:
        """Handle requests and events, and draw if anything changed; return False if the window should close."""
        if self._closing.is_set() or window.is_broken or window.is_closed:
            self.interaction.cancel_drag()
            return False
        for _ in range(self._requests.qsize()):
            window.call(*self._requests.get())
        waiting = [self._awaited.get() for _ in range(self._awaited.qsize())]
        self._size = window.size
        self._thread_callbacks.call()
        now = time.monotonic()
        with self._simulation.lock.attempt(_PERIOD) as is_free:  # not longer: its holder may wait for this thread
            self._simulation.published.is_wanted = not is_free
            is_changed = is_free and self._handle_events(window, painter)
        if is_free:
            self._free_at = now
        else:
            is_changed = self._handle_view_events(window, painter, now)
            for drawn in waiting:
                self._awaited.put(drawn)
            waiting = []
        if is_changed:
            self._changed_at = now
        if is_changed or painter.is_due(now):
            self._draw(window, painter, now)
        self._serve(window)
        for drawn in waiting:
            drawn.set()
        return True

    @property
    def period(self) -> float:
        """Time until the next iteration [s] if there is no input."""
        return period(time.monotonic() - self._changed_at)

    def _handle_view_events(self, window: GlfwWindow, painter: WindowRenderer, now: float) -> bool:
        """Handle only view events, while other threads hold the simulation's lock; return whether to draw."""
        size = [Resize(*window.points)] if self.interaction.view.size != window.points else []
        window.events = self.interaction.handle_view_events([*size, *window.events])
        self.interaction.advance_view(now)
        line = LOCKED if now - self._free_at > PATIENCE else ""
        surface = self._surface(window)
        if surface is None:
            return window.is_lost
        return painter.update_view(self.interaction, surface, line, self._simulation.published) or window.is_lost

    def _surface(self, window: GlfwWindow) -> DrawTarget | None:
        """Return the drawing target; None while the window is minimised."""
        width, height = window.pixels
        return (
            DrawTarget(self.look, self._choices.shadows, (width, height), window.pixel_ratio)
            if width and height
            else None
        )

    def _handle_events(self, window: GlfwWindow, painter: WindowRenderer) -> bool:
        """Handle all events under the simulation's lock; return whether to draw."""
        try:
            if self.interaction.view.size != window.points:
                self.interaction.handle(Resize(*window.points))
            self.interaction.advance(time.monotonic())
            events, window.events = window.events, []
            for event in events:
                self.interaction.handle(event)
            surface = self._surface(window)
            if surface is None:
                return False
            return painter.update(self._simulation, self.interaction, surface) or window.is_lost
        except RavemjError as error:
            if error.message != self._complaint:
                _LOG.error("the window cannot show the environment: %s", error)
                self._complaint = error.message
            return False

    def _draw(self, window: GlfwWindow, painter: WindowRenderer, now: float) -> None:
        surface = self._surface(window)
        if surface is None:
            return
        painter.draw(surface, now)
        if self._image_callbacks:
            self._image_callbacks.call(painter.read(surface.pixels))
        painter.draw_overlay(surface)
        window.set_cursor(painter.cursor)
        red, green, blue = (round(255 * shade) for shade in self.background)
        window.set_background((red, green, blue))
        window.swap()

    def _serve(self, window: GlfwWindow) -> None:
        """Perform requested actions, and add dropped files."""
        for request in self.interaction.controls.pop_requests():
            self._grant(request, window)
        if window.dropped:
            add_files(self.host(), window.dropped, self.interaction.controls.notices)
            window.dropped = []

    def _grant(self, request: Request | str, window: GlfwWindow) -> None:
        """Perform an action that needs the window, such as a picture, a video or copying text."""
        source = FrameSource(self.interaction, self._renderer, self.look, window.pixel_ratio)
        if request is Request.PICTURE:
            self._recorder.save_picture(source)
        elif request is Request.VIDEO:
            self._recorder.record(source, self.playback)
        else:
            window.copy_text(request)
            shortened = re.sub(r"\[.*\]", "[...]", request)
            self.interaction.controls.notices.say(f"Copied {shortened}")
            _LOG.info("%s", request)


def _run(reference: "weakref.ref[WindowViewer]") -> None:
    """Run a viewer's window, and set the flag of its end."""
    try:
        _show(reference)
    finally:
        _running[threading.current_thread()][1].set()
        del _running[threading.current_thread()]


def _show(reference: "weakref.ref[WindowViewer]") -> None:
    """Run a viewer's window until it is closed or the viewer is collected; waiting keeps no reference to the viewer."""
    viewer = reference()
    window = None if viewer is None else viewer.open_window()
    if window is None:
        return
    painter = WindowRenderer()
    try:
        begin = time.monotonic()
        while viewer is not None and viewer.run_once(window, painter):
            pause, viewer = viewer.period, None
            taken = time.monotonic() - begin
            window.wait(max(pause - taken, 0.0) if taken < _SLOW else pause)
            begin = time.monotonic()
            viewer = reference()
    except Exception as error:  # for instance of OpenGL; the script continues without the window
        _LOG.error("the window closes: %s", error, exc_info=_LOG.isEnabledFor(logging.DEBUG))
    if window.is_broken:
        _LOG.error("the window is gone, as the connection to the display broke")
    else:
        painter.close()
    window.close()


def _end(thread: threading.Thread) -> None:
    """Close a window and wait for its thread."""
    closing, ended = _running.get(thread, (None, None))
    if closing is not None and ended is not None and thread.ident is not None:
        closing.set()
        if threading.current_thread() is not thread:
            ended.wait()


@before_end
def _end_all() -> None:
    """Close all windows and wait for their threads: Python must not exit while OpenGL draws."""
    for thread in list(_running):
        _end(thread)


@in_child
def _forget_all() -> None:
    _running.clear()
