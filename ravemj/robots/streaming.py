"""Real-time streaming: joint values of a motion that a user's function sends to a robot."""

import logging
import math
import signal
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from types import FrameType
from typing import NamedTuple, Protocol

import numpy as np

from ravemj.core.arrays import checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import RavemjError

_LOG = logging.getLogger("ravemj")

HOLD = 0.5
"""Duration [s] of a hold, during which the latest values are sent with zero velocities."""

SLOW = 1.1
"""Ratio of the actual to the nominal period above which a warning is given."""

Send = Callable[[float, Floats, Floats], object]
"""Function that sends values to a robot: time of the motion [s], values [rad or m] and velocities [rad/s or m/s]."""

Feedback = Callable[[], tuple[float, Floats] | None]
"""Function that returns the measured state: its time (``time.monotonic()``) and values [rad or m], shape (n,)."""


class StreamClock(Protocol):
    """Interface of a clock."""

    def now(self) -> float:
        """Return the time [s]."""
        ...

    def wait(self, seconds: float, ended: threading.Event) -> None:
        """Wait for a time [s], or until the event ``ended`` is set."""
        ...


class RealTime:
    """The clock of the machine."""

    def now(self) -> float:
        """Return ``time.monotonic()``."""
        return time.monotonic()

    def wait(self, seconds: float, ended: threading.Event) -> None:
        """Wait for a time [s], or until the event ``ended`` is set."""
        ended.wait(max(0.0, seconds))


class MotionRows(NamedTuple):
    """A sampled motion.

    Attributes:
        times: Times [s], shape (N,).
        values: Joint values [rad or m], shape (N, n).
        velocities: Velocities, shape (N, n).
        names: Names of the n joints.
        turn: Full turn [rad] of continuous joints, 0 for others, shape (n,).
    """

    times: Floats
    values: Floats
    velocities: Floats
    names: list[str]
    turn: Floats


class Guard(NamedTuple):
    """Stop conditions: feedback function, maximum distance from the motion [rad or m], maximum age of a state [s]."""

    feedback: Feedback | None = None
    tolerance: float = math.inf
    stale: float = math.inf


UNGUARDED = Guard()
"""Guard without feedback: no stop conditions."""


@dataclass(eq=False)
class Stream:
    """Sends the rows of a motion one after the other, in its own thread.

    A late row delays the following ones: rows are neither skipped nor sent in a burst, so the robot is never commanded
    to move faster than the motion.

    Attributes:
        rows: The motion.
        send: The function that sends a row.
        period: Time between two rows [s]; the last one may be shorter.
        guard: Stop conditions.
        clock: The clock.
        failure: The reason for a stop, or None.
        time: Time of the current row [s].
    """

    rows: MotionRows
    send: Send
    period: float
    guard: Guard = UNGUARDED
    clock: StreamClock = field(default_factory=RealTime)
    failure: Exception | None = None
    time: float = 0.0

    def __post_init__(self) -> None:
        self._ended = threading.Event()
        self._reason: str | None = None
        self._sent: list[float] = []  # times
        self._measured: Floats | None = None
        self._last_sent: Floats | None = None
        self._thread = threading.Thread(target=self.run, name="ravemj-stream")

    def start(self) -> None:
        """Start the thread; Ctrl-C stops the motion with a hold."""
        _StopAll.install()
        self._thread.start()

    @property
    def is_running(self) -> bool:
        """Whether rows or holds remain to be sent."""
        return self._thread.is_alive()

    @property
    def latest(self) -> Floats | None:
        """The last measured values, else the last sent ones; None if there are none."""
        return self._last_sent if self._measured is None else self._measured

    def join(self) -> None:
        """Wait for the end of the thread."""
        self._thread.join()

    def stop(self, reason: str) -> None:
        """Stop the motion with a hold; ``reason`` becomes the ``failure``."""
        self._reason = self._reason or reason
        self._ended.set()

    def run(self) -> None:
        """Send all rows; after a stop or a failed check send holds."""
        _running.add(self)
        try:
            self._follow()
        except _SendError as error:
            self.failure = error.cause
            self._hold(1)
        except Exception as error:
            self.failure = error
            self._hold(max(1, round(HOLD / self.period)))
        finally:
            _running.discard(self)
        if self.failure is not None:
            _LOG.warning("the motion stopped at %.3g s with a hold: %s", self.time, self.failure)
        self._tell_rate()

    def _follow(self) -> None:
        rows, begin = self.rows, self.clock.now()
        delay = 0.0
        for time_of_row, values, velocities in zip(rows.times.tolist(), rows.values, rows.velocities, strict=True):
            due = begin + delay + time_of_row - rows.times[0]
            self.clock.wait(due - self.clock.now(), self._ended)
            self._check_stopped()
            late = self.clock.now() - due
            delay += late if late > self.period else 0.0
            self.time = time_of_row
            self._check_feedback(values, begin)
            self._transmit(values, velocities)

    def _check_stopped(self) -> None:
        if not threading.main_thread().is_alive():
            self.stop("the script has ended")
        if self._ended.is_set():
            raise RavemjError(f"stopped: {self._reason}")

    def _check_feedback(self, wanted: Floats, begin: float) -> None:
        """Raise if the measured joint values are too old or too far from the motion's values ``wanted``.

        Before the first measurement, the age is counted from the time ``begin`` [s].
        """
        guard, rows = self.guard, self.rows
        if guard.feedback is None:
            return
        measured = guard.feedback()
        age = self.clock.now() - (begin if measured is None else measured[0])
        if measured is not None:
            self._measured = here = checked_vector(measured[1], len(wanted), "feedback")
            away = here - wanted
            away = np.abs(away - rows.turn * np.rint(away / (2 * np.pi)))
            joint = int(away.argmax())
            if away[joint] > guard.tolerance:
                deviation = f"joint '{rows.names[joint]}' is at {here[joint]:.4g}, and should be at {wanted[joint]:.4g}"
                allowed = f"the tolerance is {guard.tolerance:g} rad or m"
                raise RavemjError(f"{deviation} at {self.time:.4g} s; {allowed}")
        if not age <= guard.stale:
            raise RavemjError(
                f"the last measurement is {age:.3g} s old at {self.time:.4g} s; {guard.stale:g} s are allowed"
            )

    def _transmit(self, values: Floats, velocities: Floats) -> None:
        try:
            self.send(self.time, values.copy(), velocities.copy())
        except Exception as error:
            raise _SendError(error) from error
        self._sent.append(self.clock.now())
        self._last_sent = values

    def _hold(self, count: int) -> None:
        """Send the latest values ``count`` times with zero velocity, once per period; stop if ``send`` fails."""
        if self.latest is None:
            return
        begin, still = self.clock.now(), self.latest
        for number in range(count):
            self.clock.wait(begin + number * self.period - self.clock.now(), threading.Event())
            try:
                self.send(self.time, still.copy(), np.zeros_like(still))
            except Exception:
                return

    def _tell_rate(self) -> None:
        """Warn if values were sent at a lower rate than requested."""
        sent = np.array(self._sent)
        if len(sent) > 2:
            mean = float(np.diff(sent[:-1]).mean())
            if mean > SLOW * self.period:
                kept = f"{1 / mean:.3g} Hz in place of {1 / self.period:.3g} Hz"
                _LOG.warning("the motion was sent at %s, and took longer: send, feedback or the machine is slow", kept)


class _SendError(Exception):
    """Wrapper of an exception in the user's ``send`` function."""

    def __init__(self, cause: Exception) -> None:
        super().__init__()
        self.cause = cause


_running: set[Stream] = set()


class _StopAll:
    """Handler of Ctrl-C: it stops all streams, and calls the previous handler."""

    def __init__(self, previous: object) -> None:
        self._previous = previous

    def __call__(self, number: int, frame: FrameType | None) -> None:
        for stream in _running.copy():
            stream.stop("Ctrl-C")
        if callable(self._previous):
            self._previous(number, frame)

    @classmethod
    def install(cls) -> None:
        """Install the handler; do nothing outside the main thread, where Python does not allow it."""
        previous = signal.getsignal(signal.SIGINT)
        if threading.current_thread() is threading.main_thread() and not isinstance(previous, cls):
            signal.signal(signal.SIGINT, cls(previous))
