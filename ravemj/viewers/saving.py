"""Pictures and videos that people save from a viewer, written by threads of their own into the working folder."""

import itertools
import logging
import math
import os
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from ravemj.errors import RavemjError
from ravemj.interaction import Interaction, Notices, Playback
from ravemj.studio import Format, Frame, Studio

_FPS = 30
_LONGEST_END = 5.0
"""How long the end of a viewer waits at most [s] for what is being written."""

_LOG = logging.getLogger("ravemj")

_Colour = tuple[float, float, float]


class Saving:
    """Saves what a viewer shows, and tells in its notices where.

    A video of a motion has every frame at its time, however long drawing takes: it goes from the start of the motion to
    its end, at the speed chosen. Without a motion it is what happens until it is stopped, in real time.

    This knows no simulation: it outlives forgotten viewers until what they began to save is written.
    """

    def __init__(self, notices: Notices) -> None:
        self._notices = notices
        self._stop = threading.Event()
        self._recorder: threading.Thread | None = None

    def save_picture(self, picture: Frame) -> None:
        """Write a picture, shape (height, width, 3)."""
        from ravemj.video import write_picture  # noqa: PLC0415 - slow to import

        path = free_path(".png")
        self._start(path, lambda: write_picture(path, picture))

    def record(self, interaction: Interaction, studio: Studio, background: _Colour) -> None:
        """Begin a video of a view, or end the one that is under way.

        Args:
            interaction: The view; its end is the video's.
            studio: What draws it.
            background: Colour where nothing is, in 0..1.
        """
        if self._recorder is not None and self._recorder.is_alive():
            self._stop.set()
            return
        self._stop.clear()
        playback, form = interaction.controls.playback, Format(*interaction.view.size)
        times = self._frames_of_clock() if playback.course is None else _frames_of_motion(playback)
        look = _Look(weakref.ref(interaction), weakref.ref(studio), form, background)
        path = free_path(".mp4")
        self._notices.recording = True
        self._recorder = self._start(path, lambda: self._write(path, self._frames(times, look)))

    def end(self) -> None:
        """End a video, and wait until it is written; not for long, since a script may hold what is drawn."""
        self._stop.set()
        if self._recorder is not None and self._recorder is not threading.current_thread():
            self._recorder.join(_LONGEST_END)

    def _start(self, path: Path, write: Callable[[], object]) -> threading.Thread:
        def run() -> None:
            try:
                write()
            except RavemjError as error:
                _LOG.error("%s", error.message)
                self._notices.say(error.message)
            else:
                _LOG.info("saved %s", os.path.abspath(path))
                self._notices.say(f"Saved {path} in {os.path.abspath(path.parent)}")

        thread = threading.Thread(target=run, name="ravemj saving", daemon=True)
        thread.start()
        return thread

    def _write(self, path: Path, frames: Iterator[Frame]) -> None:
        from ravemj.video import write_frames  # noqa: PLC0415 - slow to import

        try:
            write_frames(path, frames, _FPS)
        finally:
            self._notices.recording = False

    def _frames(self, times: Iterator[bool], look: "_Look") -> Iterator[Frame]:
        frame = None
        try:
            for is_new in times:
                frame = look.frame() if is_new or frame is None else frame
                if frame is None:
                    return
                yield frame
                if self._stop.is_set():
                    return
        finally:
            look.close()

    def _frames_of_clock(self) -> Iterator[bool]:
        """Yield for each frame that is due whether there is time to draw it; those that are late show the last one."""
        start = time.monotonic()
        for count in itertools.count():
            late = time.monotonic() - start - count / _FPS
            self._stop.wait(max(-late, 0.0))
            yield late < 1 / _FPS


class _Look(NamedTuple):
    """What draws the frames of a video; views do not live longer for it."""

    interaction: "weakref.ref[Interaction]"
    studio: "weakref.ref[Studio]"
    form: Format
    background: _Colour

    def frame(self) -> Frame | None:
        """Return what the view shows now; None once there is none."""
        interaction, studio = self.interaction(), self.studio()
        if interaction is None or studio is None:
            return None
        gizmos = interaction.overlay().shapes
        return studio.picture(interaction.view.camera, self.background, self.form, gizmos=gizmos)

    def close(self) -> None:
        """Free what the thread has drawn with."""
        studio = self.studio()
        if studio is not None:
            studio.close()


def _frames_of_motion(playback: Playback) -> Iterator[bool]:
    """Go through a motion frame by frame."""
    course, step = playback.course, playback.speed / _FPS
    playback.pause()
    for count in range(math.ceil(playback.duration / step - 1e-6) + 1):
        if playback.course is not course:
            return
        playback.seek(count * step)
        yield True


def free_path(suffix: str) -> Path:
    """Return a name in the working folder that no file has, made of the time."""
    stem = time.strftime("ravemj-%Y%m%d-%H%M%S")
    names = itertools.chain([stem], (f"{stem}-{number}" for number in itertools.count(2)))
    return next(path for name in names if not (path := Path(name + suffix)).exists())
