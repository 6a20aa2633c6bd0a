"""A viewer with a window, drawn by a thread of its own while the script goes on."""

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
from ravemj.gui.viewers.window_renderer import Surface, WindowRenderer

_LOG = logging.getLogger("ravemj")
_WIDTH, _HEIGHT = 960, 720
_PERIOD = 1 / 60
_SLOW = 1.5 * _PERIOD
"""From this long on drawing takes the processor and not only the wait for the screen; then the script has its turn."""

_LONGEST_SYNC = 1.0
_FARTHEST = 32767
"""Largest coordinate on an X screen."""

_running: dict[threading.Thread, tuple[Flag, Flag]] = {}
"""The threads of windows; for each an event that closes it, and one that tells its end: Ctrl-C breaks ``join``."""


class WindowViewer(Viewer):
    """A viewer in a window; it shows every change at once and stays until it is closed or forgotten."""

    _internal = ("open_window", "period", "turn")

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
        self._end = weakref.finalize(self, _end, thread)  # before Ctrl-C can end this here
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
            x: Where its left edge goes on the screen [pixels].
            y: Where its upper edge goes on the screen [pixels].

        Raises:
            ArgumentError: these are no numbers that a screen could have.
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
        """Wait until the window shows the environment as it is now; at most a second, in which others may hold it."""
        drawn = Flag()
        self._awaited.put(drawn)
        drawn.wait(_LONGEST_SYNC if self.is_open else 0.0)

    def close(self) -> None:
        """Close the window."""
        self._end()
        super().close()

    def open_window(self) -> GlfwWindow | None:
        """Open the window, in the thread that it belongs to; None where that fails."""
        try:
            return GlfwWindow("ravemj", *self._size)
        except RenderingError as error:
            self._failure = error.message
            return None
        finally:
            self._opened.set()

    def turn(self, window: GlfwWindow, painter: WindowRenderer) -> bool:
        """Do what was asked for, and draw if anything has changed; return False once the window should close."""
        if self._closing.is_set() or window.is_broken or window.is_closed:
            self.interaction.let_go()
            return False
        for _ in range(self._requests.qsize()):
            window.call(*self._requests.get())
        waiting = [self._awaited.get() for _ in range(self._awaited.qsize())]
        self._size = window.size
        self._thread_callbacks.call()
        now = time.monotonic()
        with self._simulation.lock.attempt(_PERIOD) as is_free:  # who holds it may wait for this thread to end
            self._simulation.published.is_wanted = not is_free
            is_changed = is_free and self._take_in(window, painter)
        if is_free:
            self._free_at = now
        else:
            is_changed = self._take_in_view(window, painter, now)
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
        """After how long the next turn should come [s], if people do nothing before."""
        return period(time.monotonic() - self._changed_at)

    def _take_in_view(self, window: GlfwWindow, painter: WindowRenderer, now: float) -> bool:
        """Do what changes only the view, while others have the simulation; return whether to draw the window."""
        size = [Resize(*window.points)] if self.interaction.view.size != window.points else []
        window.events = self.interaction.steer([*size, *window.events])
        self.interaction.pass_time_without_bodies(now)
        line = LOCKED if now - self._free_at > PATIENCE else ""
        surface = self._surface(window)
        if surface is None:
            return window.is_lost
        return painter.look_again(self.interaction, surface, line, self._simulation.published) or window.is_lost

    def _surface(self, window: GlfwWindow) -> Surface | None:
        """Return what is drawn on; None while it is minimised."""
        width, height = window.pixels
        return (
            Surface(self.look, self._choices.shadows, (width, height), window.pixel_ratio) if width and height else None
        )

    def _take_in(self, window: GlfwWindow, painter: WindowRenderer) -> bool:
        """Do what people did, and return whether the window has to be drawn."""
        try:
            if self.interaction.view.size != window.points:
                self.interaction.handle(Resize(*window.points))
            self.interaction.pass_time(time.monotonic())
            events, window.events = window.events, []
            for event in events:
                self.interaction.handle(event)
            surface = self._surface(window)
            if surface is None:
                return False
            return painter.look(self._simulation, self.interaction, surface) or window.is_lost
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
        """Do what buttons asked for, and add files that were dropped."""
        for request in self.interaction.controls.take_requests():
            self._grant(request, window)
        if window.dropped:
            add_files(self.GetEnv(), window.dropped, self.interaction.controls.notices)
            window.dropped = []

    def _grant(self, request: Request | str, window: GlfwWindow) -> None:
        """Do what a button asked for that needs the window."""
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
    """Show a viewer's window, and tell that it has ended."""
    try:
        _show(reference)
    finally:
        _running[threading.current_thread()][1].set()
        del _running[threading.current_thread()]


def _show(reference: "weakref.ref[WindowViewer]") -> None:
    """Open a viewer's window and draw it until it is closed, or the viewer is gone, which waiting does not keep."""
    viewer = reference()
    window = None if viewer is None else viewer.open_window()
    if window is None:
        return
    painter = WindowRenderer()
    try:
        begin = time.monotonic()
        while viewer is not None and viewer.turn(window, painter):
            pause, viewer = viewer.period, None
            taken = time.monotonic() - begin
            window.wait(max(pause - taken, 0.0) if taken < _SLOW else pause)
            begin = time.monotonic()
            viewer = reference()
    except Exception as error:  # of OpenGL, say; the script goes on without the window
        _LOG.error("the window closes: %s", error, exc_info=_LOG.isEnabledFor(logging.DEBUG))
    if window.is_broken:
        _LOG.error("the window is gone, as the connection to the display broke")
    else:
        painter.close()
    window.close()


def _end(thread: threading.Thread) -> None:
    """Close a window and wait for the end of its thread."""
    closing, ended = _running.get(thread, (None, None))
    if closing is not None and ended is not None and thread.ident is not None:
        closing.set()
        if threading.current_thread() is not thread:
            ended.wait()


@before_end
def _end_all() -> None:
    """Wait for windows whose viewers went in their own threads: Python must not end while OpenGL draws."""
    for thread in list(_running):
        _end(thread)


@in_child
def _forget_all() -> None:
    _running.clear()
