"""Locks for computations in C, and waiting for their threads at the exit of Python.

Python does not stop daemon threads at exit. A thread that returns from MuJoCo or OpenGL afterwards crashes the process.
So the exit acquires all ``StateLock`` s permanently: computing threads finish, others wait forever. A thread that holds
a lock for too long is ended by ``SystemExit``.
"""

import atexit
import ctypes
import re
import sys
import time
from collections.abc import Callable, Generator
from threading import RLock, current_thread, main_thread
from typing import TYPE_CHECKING, NoReturn
from weakref import WeakValueDictionary

from ravemj.core.blocks import block
from ravemj.core.forks import disown, in_child
from ravemj.errors import ErrorCode, RavemjError

if TYPE_CHECKING:
    _Lock = RLock
else:
    _Lock = type(RLock())

LAST_CALL = 1.0
"""Maximum time that the exit waits for computing threads, and once more for threads that it ends [s]."""

_EACH = 0.05
"""Minimum time [s] to wait for a lock at exit after ending its holder: another thread may acquire it first."""

_locks: "WeakValueDictionary[int, StateLock]" = WeakValueDictionary()
_before_end: list[Callable[[], object]] = []
_taken: list["StateLock"] = []
_is_ending = False


class StateLock(_Lock):  # pyright: ignore[reportGeneralTypeIssues] - final for pyright alone
    """A reentrant lock for computations in C. A ``with`` statement releases it despite any interrupt."""

    def __init__(self) -> None:
        while is_left_to_end():
            time.sleep(LAST_CALL)
        _locks[id(self)] = self

    @property
    def is_held(self) -> bool:
        """Whether this thread holds the lock."""
        return self._is_owned()  # pyright: ignore

    def release_if_held(self) -> None:
        """Release the lock after an error that may have occurred before it was acquired."""
        if self.is_held:
            self.release()

    def hold(self, timeout: float = -1.0) -> bool:
        """Acquire the lock within ``timeout`` [s], and return whether it is acquired; after an error it is not."""
        try:
            return self.acquire(timeout=timeout)
        except BaseException:
            self.release_if_held()
            raise

    def __reduce__(self) -> NoReturn:
        message = "links, joints and other parts of an environment cannot be pickled"
        way_out = "send the environment or one of its bodies, and look the part up by its name"
        raise RavemjError(f"{message}: {way_out}", ErrorCode.InvalidState)

    if sys.version_info >= (3, 14):  # handles signals after an ``__enter__`` in C, before the block begins
        __enter__ = hold

    @block
    def attempt(self, timeout: float) -> Generator[bool]:
        """Try to acquire the lock for the block.

        Args:
            timeout: Maximum waiting time [s]; 0 does not wait.

        Yields:
            Whether this thread has the lock.
        """
        try:
            yield self.acquire(timeout=timeout)
        finally:
            self.release_if_held()


def is_left_to_end() -> bool:
    """Return whether Python is exiting and this is not the main thread, so that it must not free C objects."""
    return _is_ending and current_thread() is not main_thread()


def before_end(function: Callable[[], object]) -> Callable[[], object]:
    """Register a function that ends threads, called at exit before the locks are taken; usable as a decorator."""
    _before_end.append(function)
    return function


@atexit.register
def end() -> None:
    """End threads and acquire all locks, once. Exit handlers that free shared C objects call it first."""
    global _is_ending  # noqa: PLW0603 - Python ends once
    if _is_ending:
        return
    for function in reversed(_before_end):
        function()
    _is_ending = True
    patience = time.monotonic() + LAST_CALL
    for reference in _locks.valuerefs():
        lock = reference()
        if lock is None:
            continue
        _taken.append(lock)
        while not lock.acquire(timeout=max(_EACH, patience - time.monotonic())):
            if time.monotonic() > patience + LAST_CALL:
                break
            _end_holder(lock)


def _end_holder(lock: StateLock) -> None:
    """Raise ``SystemExit`` in the thread that holds a lock, once it has left C code."""
    owner = re.search(r"owner=(\d+)", repr(lock))
    if owner:
        holder = ctypes.c_ulong(int(owner[1]))
        ctypes.pythonapi.PyThreadState_SetAsyncExc(holder, ctypes.py_object(SystemExit))


@in_child
def _disown_all() -> None:
    for lock in [*_locks.values()]:
        disown(lock)
    _locks.clear()
