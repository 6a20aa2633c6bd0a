"""Saving pictures and videos of a viewer, in background threads, into the working folder."""

import itertools
import logging
import math
import os
import tempfile
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path

from ravemj.core.flags import Flag
from ravemj.errors import RavemjError
from ravemj.graphics.rendering import Look
from ravemj.graphics.simulation_renderer import Format, Frame, SimulationRenderer
from ravemj.gui.interaction import Interaction, Notices, Playback
from ravemj.gui.viewers.sharpness import bounded_size

_FPS = 30
_LONGEST_END = 5.0
"""Maximum time that closing a viewer waits for unfinished recordings [s]."""

_LOG = logging.getLogger("ravemj")


class FrameSource:
    """Renderer of the frames of a view, with a weak reference, so that a closed view can be freed."""

    def __init__(self, interaction: Interaction, renderer: SimulationRenderer, look: Look, ratio: float = 1.0) -> None:
        """Render a view with a look; ``ratio`` is the number of pixels per point."""
        self._interaction, self._renderer = weakref.ref(interaction), weakref.ref(renderer)
        self._look = look
        width, height = (round(ratio * length) for length in interaction.view.size)
        self._form = Format(*bounded_size(width, height))

    def frame(self, *, is_still: bool = False) -> Frame | None:
        """Return the current frame, always of one size; None if the view is gone. Stills have shadows."""
        interaction, renderer = self._interaction(), self._renderer()
        if interaction is None or renderer is None:
            return None
        over, camera = interaction.overlay(), interaction.drawn_view.camera
        form = self._form._replace(shadows=True) if is_still else self._form
        return renderer.render(camera, self._look, form, gizmos=over.primitives, style=over.style)

    def close(self) -> None:
        """Free the renderer of this thread."""
        renderer = self._renderer()
        if renderer is not None:
            renderer.close()


class Recorder:
    """Saves pictures and videos of a viewer, and reports the paths in its notices.

    If there is a motion, a video covers it from start to end at the playback speed with exact frame times, however long
    drawing takes. Otherwise it records in real time until it is stopped.

    It has no reference to the simulation, so that files can be completed after the viewer is deleted.
    """

    def __init__(self, notices: Notices, clock: Callable[[], float] = time.monotonic) -> None:
        self._notices, self._clock = notices, clock
        self._stop = Flag()
        self._recorder: threading.Thread | None = None
        self._threads: set[threading.Thread] = set()

    def save_picture(self, source: FrameSource) -> None:
        """Save a picture."""
        self._start(free_path(".png"), lambda path: _write_picture(path, source))

    def record(
        self, source: FrameSource, playback: Playback, deliver: Callable[[str, bytes], None] | None = None
    ) -> None:
        """Stop the current video or, if there is none, start one: of the motion if there is one, else in real time.

        Args:
            source: Renders the frames.
            playback: Playback of the motion.
            deliver: Called with name and content of the file; None writes it to the working folder.
        """
        if self._recorder is not None and self._recorder.is_alive():
            self._stop.set()
            return
        self._stop.clear()
        times = self._frames_of_clock() if playback.motion is None else _frames_of_motion(playback)
        self._notices.recording = True
        if deliver is None:
            self._recorder = self._start(free_path(".mp4"), lambda path: self._write_video(path, times, source))
        else:
            self._recorder = self._thread(lambda: self._deliver_video(times, source, deliver))

    def stop(self) -> None:
        """Stop the current video; it is completed in the background."""
        self._stop.set()

    def end(self) -> None:
        """Stop the current video and wait for unfinished files, with a time limit, since a script may hold the lock."""
        self._stop.set()
        end = time.monotonic() + _LONGEST_END
        for thread in self._threads - {threading.current_thread()}:
            thread.join(max(end - time.monotonic(), 0.0))

    def _start(self, path: Path, write: Callable[[Path], object]) -> threading.Thread:
        def save() -> None:
            write(path)
            folder = os.path.abspath(path.parent)
            _LOG.info("saved %s in %s", path, folder)
            self._notices.say(f"Saved {path} in {folder}")

        return self._thread(save)

    def _thread(self, work: Callable[[], None]) -> threading.Thread:
        def run() -> None:
            try:
                work()
            except RavemjError as error:
                _LOG.error("%s", error.message)
                self._notices.say(error.message)
            finally:
                self._threads.discard(threading.current_thread())

        thread = threading.Thread(target=run, name="ravemj saving", daemon=True)
        self._threads.add(thread)
        thread.start()
        return thread

    def _write_video(self, path: Path, times: Iterator[bool], source: FrameSource) -> None:
        from ravemj.graphics.video import write_frames  # noqa: PLC0415 - slow to import

        try:
            write_frames(path, self._frames(times, source), _FPS)
        finally:
            self._notices.recording = False
            source.close()

    def _deliver_video(self, times: Iterator[bool], source: FrameSource, deliver: Callable[[str, bytes], None]) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / free_path(".mp4").name
            self._write_video(path, times, source)
            deliver(path.name, path.read_bytes())

    def _frames(self, times: Iterator[bool], source: FrameSource) -> Iterator[Frame]:
        frame = None
        for is_new in times:
            frame = source.frame() if is_new or frame is None else frame
            if frame is None:
                return
            yield frame
            if self._stop.is_set():
                return

    def _frames_of_clock(self) -> Iterator[bool]:
        """Wait for each frame time and yield whether to render; False repeats the last frame, if rendering is late."""
        start = self._clock()
        for count in itertools.count():
            late = self._clock() - start - count / _FPS
            self._stop.wait(max(-late, 0.0))
            yield late < 1 / _FPS


def _write_picture(path: Path, source: FrameSource) -> None:
    from ravemj.graphics.video import write_picture  # noqa: PLC0415 - slow to import

    frame = source.frame(is_still=True)
    source.close()
    if frame is not None:
        write_picture(path, frame)


def _frames_of_motion(playback: Playback) -> Iterator[bool]:
    """Seek through a motion, and yield True at each frame; stop if another motion is loaded."""
    motion, step = playback.motion, playback.speed / _FPS
    playback.pause()
    for count in range(math.ceil(playback.duration / step - 1e-6) + 1):
        if playback.motion is not motion:
            return
        playback.seek(count * step)
        yield True


def free_path(suffix: str, clock: Callable[[], float] = time.time) -> Path:
    """Return an unused path in the working folder, with the date and time in its name."""
    stem = time.strftime("ravemj-%Y%m%d-%H%M%S", time.localtime(clock()))
    names = itertools.chain([stem], (f"{stem}-{number}" for number in itertools.count(2)))
    return next(path for name in names if not (path := Path(name + suffix)).exists())
