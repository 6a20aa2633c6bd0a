"""Simulation time, and the thread that lets it pass."""

import logging
import math
import threading
import time
import weakref
from collections.abc import Callable
from dataclasses import dataclass, replace
from threading import Lock, Thread
from weakref import WeakKeyDictionary

from ravemj.core.flags import Flag
from ravemj.core.forks import in_child
from ravemj.core.locks import StateLock, before_end

_LOG = logging.getLogger("ravemj")

DEFAULT_STEP = 0.01
"""OpenRAVE's time step [s]."""

PAUSE = 1e-4
"""How long [s] the thread lets go between steps at least, so that others get the lock."""

BEHIND = 0.1
"""How much real time [s] the thread catches up with after it was held up; what is beyond is lost."""

LAST_STEP = 1.0
"""How long [s] the end of Python waits for a step that has begun; a script's controller may hang in it."""

POLL = 0.05
"""How often [s] the thread looks whether it should end while others have the lock."""


class Clock:
    """Counts simulation time, and calls what happens in it.

    Time may pass from the start, as in OpenRAVE, but the thread comes with the first ``wake``. It holds the clock by
    a weak reference, and so ends when whatever owns the clock is gone.
    """

    def __init__(self, lock: StateLock, step: Callable[[float], None]) -> None:
        """Make a clock that stands at 0; with the lock held, it calls ``step`` for each time step [s]."""
        self.now = 0  # simulation time since the start [microseconds]
        self.is_allowed = True  # whether time passes by itself; ``stop`` ends that
        self._lock = lock
        self._step = step
        self._rhythm = _Rhythm(lock, Flag(), DEFAULT_STEP, 1.0)
        self._thread: Thread | None = None
        self._starting = Lock()

    def step(self, timestep: float) -> None:
        """Let time pass by one step [s]."""
        with self._lock:
            self._step(timestep)
            self.now += round(timestep * 1e6)

    def wake(self) -> None:
        """Let time pass by itself from now on, unless it was stopped."""
        with self._starting:
            if self.is_allowed and self._thread is None:
                self._rhythm = replace(self._rhythm, ending=Flag())
                arguments = (weakref.ref(self), self._rhythm)
                thread = Thread(target=_run, args=arguments, name="simulation time", daemon=True)
                try:
                    thread.start()
                    _threads[thread] = self._rhythm.ending
                    self._thread = thread
                except BaseException:
                    self._rhythm.ending.set()
                    self._thread = None
                    raise

    def start(self, timestep: float, *, realtime: bool) -> None:
        """Let time pass by itself from now on, in steps of so many seconds, in real time or as fast as it can."""
        self.stop()
        self._rhythm = replace(self._rhythm, timestep=timestep, pace=1.0 if realtime else math.inf)
        self.resume()

    def resume(self) -> None:
        """Let time pass again after ``stop``, in the steps and at the pace from before."""
        self.is_allowed = True
        self.wake()

    @property
    def is_running(self) -> bool:
        """Whether time passes by itself now; asking does not wake it."""
        return self._thread is not None

    @property
    def timestep(self) -> float:
        """Length of the steps with which time passes by itself [s]."""
        return self._rhythm.timestep

    @property
    def pace(self) -> float:
        """Seconds of simulation that are wanted in a second: 1 is real time, inf as many as can be computed."""
        return self._rhythm.pace

    @pace.setter
    def pace(self, pace: float) -> None:
        self._rhythm.pace = pace

    def stop(self, *, wait: bool = True) -> None:
        """Let time stand still; with ``wait``, return only when the thread has ended."""
        with self._starting:
            self.is_allowed = False
            self._rhythm.ending.set()
            thread, self._thread = self._thread, None
        if wait and thread is not None and thread is not threading.current_thread():
            thread.join()

    def lose_thread(self) -> None:
        """Take note that the calling thread ends, if it is the clock's: ``wake`` then starts another."""
        with self._starting:
            if self._thread is threading.current_thread():
                self._thread = None

    def __del__(self) -> None:
        self._rhythm.ending.set()


_threads: WeakKeyDictionary[Thread, Flag] = WeakKeyDictionary()


@in_child
def _forget_threads() -> None:
    _threads.clear()


@before_end
def _end_threads() -> None:
    """End the threads while Python is still there: one that comes back from MuJoCo later crashes the process."""
    for thread, ending in tuple(_threads.items()):
        ending.set()
        thread.join(LAST_STEP)


@dataclass
class _Rhythm:
    """What the thread knows without the clock."""

    lock: StateLock  # held during each step
    ending: Flag  # set when the thread should end
    timestep: float  # [s]
    pace: float  # seconds of simulation in a second; inf: no step waits


def _run(clock: "weakref.ref[Clock]", rhythm: _Rhythm) -> None:
    """Step a clock until it is stopped or gone."""
    due = time.monotonic() + rhythm.timestep / rhythm.pace
    while not rhythm.ending.wait(max(due - time.monotonic(), PAUSE)):
        with rhythm.lock.attempt(POLL) as is_free:
            if is_free and not _step(clock, rhythm):
                return
        if is_free:
            due = max(due + rhythm.timestep / rhythm.pace, time.monotonic() - BEHIND)


def _step(clock: "weakref.ref[Clock]", rhythm: _Rhythm) -> bool:
    """Let time pass by a step; return whether it goes on."""
    present = clock()
    if present is None or rhythm.ending.is_set():
        return False
    try:
        present.step(rhythm.timestep)
    except Exception:
        _LOG.exception("a step of simulation time failed; time stands still until the next command")
        present.lose_thread()
        return False
    return True
