"""Module ``viewerrecorder``, which writes videos of an environment."""

import time
from collections.abc import Iterator
from queue import Empty
from threading import Thread, main_thread
from typing import TYPE_CHECKING, NamedTuple

from ravemj.core.flags import Handover
from ravemj.errors import ArgumentError, RavemjError
from ravemj.graphics.simulation_renderer import Format, Frame
from ravemj.rave.interface import Module

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment

_WAITING = 8
"""Maximum number of frames in the encoder's queue; drawing blocks when it is full."""
_PATIENCE = 0.2
"""Interval [s] at which the encoder thread checks whether the script has ended; if so, the thread ends, too."""

_TIMINGS = ("simtime", "realtime", "controller")


class _Order(NamedTuple):
    """Settings of a video, from the command ``Start``."""

    width: int
    height: int
    fps: float
    timing: str
    path: str


class ViewerRecorder(Module):
    """Writes videos of the viewer's view; without a viewer, of the view of ``env.render``.

    ``Start WIDTH HEIGHT FPS codec NUMBER timing WHICH filename FILE`` begins a video. It has a frame for each 1/FPS of
    simulation time (``simtime``, ``controller``) or of real time (``realtime``). The suffix of the file selects the
    format; the number of the codec has no effect. ``Stop`` completes the file. A script that ends without ``Stop``, for
    instance by an error, completes the file as well. ``GetCodecs`` lists the formats.

    Example:
        >>> recorder = ravemj.RaveCreateModule(env, "viewerrecorder")
        >>> env.AddModule(recorder, "")
        0
        >>> recorder.SendCommand("Start 640 480 30 codec 0 timing simtime filename swing.mp4")
        >>> env.StepSimulation(1.0)
        >>> recorder.SendCommand("Stop")
    """

    def __init__(self, env: "Environment", name: str) -> None:
        commands = {"Start": self._start, "Stop": self._stop, "GetCodecs": self._codecs}
        super().__init__(env, name, lambda arguments: None, commands)
        self._order: _Order | None = None
        self._frames = Handover["Frame | None"](_WAITING)
        self._thread: Thread | None = None
        self._error: RavemjError | None = None
        self._passed = 0.0
        self._drawn = 0
        self._began = 0.0

    def SimulationStep(self, timeelapsed: float) -> bool:
        """Draw the frames that are due after ``timeelapsed`` [s], and return whether there were any."""
        if self._order is None:
            return False
        self._passed += timeelapsed
        passed = time.monotonic() - self._began if self._order.timing == "realtime" else self._passed
        before = self._drawn
        frame = None
        while self._drawn <= passed * self._order.fps + 1e-9 and self._is_writing():
            frame = self._picture(self._order.width, self._order.height) if frame is None else frame
            self._frames.put(frame)
            self._drawn += 1
        return self._drawn > before

    def _picture(self, width: int, height: int) -> Frame:
        """Return a frame like those of viewers; it has shadows if OpenGL draws with a graphics card."""
        env = self._env
        return env.renderer.render(env.default_camera(width / height), env.look(), Format(width, height))

    def _is_writing(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def end(self) -> None:
        """Complete the current video."""
        if self._order is not None:
            self._stop("")

    def _start(self, arguments: str) -> str:
        """Begin a video: WIDTH HEIGHT FPS codec NUMBER timing WHICH filename FILE."""
        from ravemj.graphics.video import check_target, write_frames  # noqa: PLC0415 - slow to import

        if self._order is not None:
            raise RavemjError("Start: a video is being recorded; send Stop first")
        order = _order_of(arguments)
        check_target(order.path)

        def write() -> None:
            try:
                write_frames(order.path, self._taken(), order.fps)
            except RavemjError as error:
                self._error = error

        self._order, self._error = order, None
        self._passed, self._drawn, self._began = 0.0, 0, time.monotonic()
        self._thread = Thread(target=write, name="ravemj recorder")
        self._thread.start()
        self.SimulationStep(0.0)
        return ""

    def _taken(self) -> Iterator[Frame]:
        while True:
            try:
                frame = self._frames.get(timeout=_PATIENCE)
            except Empty:
                if main_thread().is_alive():
                    continue
                return
            if frame is None:
                return
            yield frame

    def _stop(self, arguments: str) -> str:
        """End the video."""
        del arguments
        if self._order is None or self._thread is None:
            raise RavemjError("Stop: no video is being recorded; send Start first")
        self._order = None
        if self._thread.is_alive():
            self._frames.put(None)
        self._thread.join()
        self._frames = Handover["Frame | None"](_WAITING)
        if self._error is not None:
            raise self._error
        return ""

    def _codecs(self, arguments: str) -> str:
        """List the video formats."""
        from ravemj.graphics.video import VIDEO_FORMATS  # noqa: PLC0415 - slow to import

        del arguments
        names = [suffix[1:] for suffix in VIDEO_FORMATS if suffix]
        return "\n".join(f"{number} {name}" for number, name in enumerate(names))


def _order_of(arguments: str) -> _Order:
    before, separator, after = arguments.partition("filename")
    words = before.split()
    try:
        width, height, fps = int(words[0]), int(words[1]), float(words[2])
        named = dict(zip(words[3::2], words[4::2], strict=True))
        timing = named.pop("timing", "simtime")
        named.pop("codec", None)
        path = after.strip().splitlines()[0].strip() if separator else ""
        if named or timing not in _TIMINGS or not path or min(width, height, fps) <= 0:
            raise ValueError
    except (ValueError, IndexError):
        wanted = f"WIDTH HEIGHT FPS codec NUMBER timing {'|'.join(_TIMINGS)} filename FILE"
        raise ArgumentError(f"Start: is followed by '{arguments}', and should be by {wanted}") from None
    return _Order(width, height, fps, timing, path)
