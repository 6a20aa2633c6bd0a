"""What a viewer tells for some seconds."""

import threading
import time


class Notices:
    """Lines of text that go away by themselves; all views of a viewer show them.

    No method waits for anybody, so that threads can tell what they did while a script holds the simulation.

    Attributes:
        recording: Whether a video is being made of a view.
        text_size: Height of the letters of what is shown [points]; None: as who draws it likes.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: dict[str, float] = {}
        self.recording = False
        self.text_size: float | None = None

    def say(self, line: str, seconds: float = 6.0) -> None:
        """Show a line for some time."""
        with self._lock:
            self._lines[line] = time.monotonic() + seconds

    def take_back(self, line: str) -> None:
        """Show a line no more."""
        with self._lock:
            self._lines.pop(line, None)

    def pass_time(self, now: float) -> None:
        """Forget what has been shown for long enough; ``now`` as ``time.monotonic`` says."""
        with self._lock:
            self._lines = {line: end for line, end in self._lines.items() if end > now}

    @property
    def lines(self) -> tuple[str, ...]:
        """What is shown now."""
        with self._lock:
            return tuple(self._lines)
