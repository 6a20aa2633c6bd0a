"""Temporary messages of a viewer."""

import threading
import time


class Notices:
    """Lines of text that expire, shown by all views of a viewer.

    No method waits for a lock, so any thread can report while a script holds the simulation.

    Attributes:
        recording: Whether a video of a view is being recorded.
        text_size: Height of the letters [points]; None: the default of the window or page.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: dict[str, float] = {}
        self.recording = False
        self.text_size: float | None = None

    def say(self, line: str, seconds: float = 6.0) -> None:
        """Show a line for a time [s]."""
        with self._lock:
            self._lines[line] = time.monotonic() + seconds

    def withdraw(self, line: str) -> None:
        """Remove a line."""
        with self._lock:
            self._lines.pop(line, None)

    def advance(self, now: float) -> None:
        """Remove expired lines; ``now`` is from ``time.monotonic``."""
        with self._lock:
            self._lines = {line: end for line, end in self._lines.items() if end > now}

    @property
    def lines(self) -> tuple[str, ...]:
        """The current lines."""
        with self._lock:
            return tuple(self._lines)
