"""Waiting for events: a test passes however long they take, and fails where they never come."""

import contextlib
import signal
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType

PATIENCE = 120.0
"""What takes longer hangs [s], also on a machine that has much else to do."""


def await_that(condition: Callable[[], object], otherwise: str = "it does not come") -> None:
    """Wait until a condition holds; fail with a message where it never does."""
    end, pause = time.monotonic() + PATIENCE, 0.002
    while not condition():
        assert time.monotonic() < end, otherwise
        time.sleep(pause)
        pause = min(2 * pause, 0.05)


class Hang(BaseException):
    """Something took too long; no ``except Exception`` swallows it."""


@contextlib.contextmanager
def time_limit(seconds: float = PATIENCE) -> Iterator[None]:
    """Raise ``Hang`` in this thread after some time; in other threads than the main one there is no limit."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def hang(number: int, frame: FrameType | None) -> None:
        raise Hang(f"longer than {seconds} s")

    before = signal.signal(signal.SIGALRM, hang)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
