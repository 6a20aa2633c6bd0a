"""Simulation time, and the thread that advances it."""

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
"""Minimum time [s] without the lock between steps, so that other threads can acquire it."""

BEHIND = 0.1
"""Maximum delay in real time that the thread makes up [s]; the rest of a longer delay is dropped."""

LAST_STEP = 1.0
"""Time limit [s] for a running step at the exit of Python; a script's controller may block in it."""

POLL = 0.05
"""Interval [s] at which the thread checks whether to end while other threads have the lock."""


class Clock:
    """Clock of the simulation time, with a thread that runs its steps.

    Running is enabled from the start, as in OpenRAVE, but the thread starts with the first ``wake``. The thread has a
    weak reference to the clock, so it ends when the clock is deleted.
    """

    def __init__(self, lock: StateLock, step: Callable[[float], None]) -> None:
        """Make a clock at time 0; it calls ``step`` with the length of each time step [s], holding the lock."""
        self.now = 0  # simulation time since the start [microseconds]
        self.is_allowed = True  # whether the thread may run; ``stop`` ends that
        self._lock = lock
        self._step = step
        self._rhythm = _Rhythm(lock, Flag(), DEFAULT_STEP, 1.0)
        self._thread: Thread | None = None
        self._starting = Lock()

    def step(self, timestep: float) -> None:
        """Advance by one time step [s]."""
        with self._lock:
            self._step(timestep)
            self.now += round(timestep * 1e6)

    def wake(self) -> None:
        """Start the thread, unless the clock is stopped."""
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
        """Run time steps of length ``timestep`` [s] in the thread, in real time or as fast as possible."""
        self.stop()
        self._rhythm = replace(self._rhythm, timestep=timestep, pace=1.0 if realtime else math.inf)
        self.resume()

    def resume(self) -> None:
        """Continue after ``stop``, with the previous time step and pace."""
        self.is_allowed = True
        self.wake()

    @property
    def is_running(self) -> bool:
        """Whether the thread runs; does not start it."""
        return self._thread is not None

    @property
    def timestep(self) -> float:
        """Time step of the thread [s]."""
        return self._rhythm.timestep

    @property
    def pace(self) -> float:
        """Target simulation speed: 1 is real time, inf is as fast as possible."""
        return self._rhythm.pace

    @pace.setter
    def pace(self, pace: float) -> None:
        self._rhythm.pace = pace

    def stop(self, *, wait: bool = True) -> None:
        """Stop the thread; ``wait`` waits for its end."""
        with self._starting:
            self.is_allowed = False
            self._rhythm.ending.set()
            thread, self._thread = self._thread, None
        if wait and thread is not None and thread is not threading.current_thread():
            thread.join()

    def lose_thread(self) -> None:
        """If the clock's thread calls this, record that the thread ends; ``wake`` then starts another one."""
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
    """Stop the threads before Python exits; a thread that returns from MuJoCo later would crash the process."""
    for thread, ending in tuple(_threads.items()):
        ending.set()
        thread.join(LAST_STEP)


@dataclass
class _Rhythm:
    """Schedule of the simulation thread, readable without a reference to the clock."""

    lock: StateLock  # held during each step
    ending: Flag  # set to end the thread
    timestep: float  # [s]
    pace: float  # seconds of simulation in a second; inf: no step waits


def _run(clock: "weakref.ref[Clock]", rhythm: _Rhythm) -> None:
    """Step a clock until it is stopped or garbage-collected."""
    due = time.monotonic() + rhythm.timestep / rhythm.pace
    while not rhythm.ending.wait(max(due - time.monotonic(), PAUSE)):
        with rhythm.lock.attempt(POLL) as is_free:
            if is_free and not _step(clock, rhythm):
                return
        if is_free:
            due = max(due + rhythm.timestep / rhythm.pace, time.monotonic() - BEHIND)


def _step(clock: "weakref.ref[Clock]", rhythm: _Rhythm) -> bool:
    """Run one time step; return whether the thread should continue."""
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
