"""What a viewer tells for some seconds."""

import threading
import time


class Notices:
    """Lines of text that go away by themselves; all views of a viewer show them.

    No method waits for anybody, so that threads can tell what they did while a script holds the simulation.

    Attributes:
        changes: How often any of this has changed.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: dict[str, float] = {}
        self._recording = False
        self._text_size: float | None = None
        self.changes = 0

    @property
    def text_size(self) -> float | None:
        """Height of the letters of what is shown [points]; None: as who draws it likes."""
        return self._text_size

    @text_size.setter
    def text_size(self, text_size: float) -> None:
        with self._lock:
            self._text_size = text_size
            self.changes += 1

    @property
    def recording(self) -> bool:
        """Whether a video is being made of a view."""
        return self._recording

    @recording.setter
    def recording(self, recording: bool) -> None:
        with self._lock:
            self._recording = recording
            self.changes += 1

    def say(self, line: str, seconds: float = 6.0) -> None:
        """Show a line for some time."""
        with self._lock:
            self._lines[line] = time.monotonic() + seconds
            self.changes += 1

    def take_back(self, line: str) -> None:
        """Show a line no more."""
        with self._lock:
            self._lines.pop(line, None)
            self.changes += 1

    def pass_time(self, now: float) -> None:
        """Forget what has been shown for long enough.

        Args:
            now: What ``time.monotonic`` says.
        """
        with self._lock:
            over = [line for line, end in self._lines.items() if end <= now]
            for line in over:
                del self._lines[line]
            self.changes += bool(over)

    @property
    def lines(self) -> tuple[str, ...]:
        """What is shown now."""
        with self._lock:
            return tuple(self._lines)
