"""Locks of what threads compute in C, and how the end of Python waits for these threads.

Python does not stop daemon threads when it ends. One that comes back from MuJoCo or OpenGL after that crashes the
process. So the end of Python takes all ``StateLock`` s for good: threads that compute finish, others wait for ever.
A thread that keeps a lock is ended by ``SystemExit``.
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
"""How long [s] the end of Python waits for threads that compute, and then for those that it ends."""

_EACH = 0.05
"""How long [s] it waits at least for a thread that it has ended; another may have been waiting for the same lock."""

_locks: "WeakValueDictionary[int, StateLock]" = WeakValueDictionary()
_before_end: list[Callable[[], object]] = []
_taken: list["StateLock"] = []
_is_ending = False


class StateLock(_Lock):  # pyright: ignore[reportGeneralTypeIssues] - final for pyright alone
    """A reentrant lock for all calls that compute in C. Hold it by ``with``, which no interrupt can leave locked."""

    def __init__(self) -> None:
        while is_left_to_end():
            time.sleep(LAST_CALL)
        _locks[id(self)] = self

    @property
    def is_held(self) -> bool:
        """Whether this thread holds the lock."""
        return self._is_owned()  # pyright: ignore

    def release_if_held(self) -> None:
        """Release the lock after an error, which may have come before it was acquired."""
        if self.is_held:
            self.release()

    def hold(self, timeout: float = -1.0) -> bool:
        """Acquire the lock, or raise an error without it; return whether it was acquired in time [s]."""
        try:
            return self.acquire(timeout=timeout)
        except BaseException:
            self.release_if_held()
            raise

    def __reduce__(self) -> NoReturn:
        message = "an environment, and what is in it, cannot be pickled"
        way_out = (
            'load the model in the other process, from a file that env.Save("scene.dae") writes; arrays can be sent'
        )
        raise RavemjError(f"{message}: {way_out}", ErrorCode.InvalidState)

    if sys.version_info >= (3, 14):  # handles signals after an ``__enter__`` in C, before the block begins
        __enter__ = hold

    @block
    def attempt(self, timeout: float) -> Generator[bool]:
        """Try to acquire the lock for the block.

        Args:
            timeout: How long to wait [s]; 0: not at all.

        Yields:
            Whether this thread has the lock.
        """
        try:
            yield self.acquire(timeout=timeout)
        finally:
            self.release_if_held()


def is_left_to_end() -> bool:
    """Return whether Python ends and this is another thread, which must free nothing in C any more."""
    return _is_ending and current_thread() is not main_thread()


def before_end(function: Callable[[], object]) -> Callable[[], object]:
    """Have a function called at the end of Python while the locks are free, to end threads; usable as a decorator."""
    _before_end.append(function)
    return function


@atexit.register
def end() -> None:
    """End threads and take all locks, once; what frees that with which threads compute calls it first."""
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
    """Have ``SystemExit`` raised in the thread that holds a lock, once it is out of C."""
    found = re.search(r"owner=(\d+)", repr(lock))
    if found:
        holder = ctypes.c_ulong(int(found[1]))
        ctypes.pythonapi.PyThreadState_SetAsyncExc(holder, ctypes.py_object(SystemExit))


@in_child
def _disown_all() -> None:
    for lock in [*_locks.values()]:
        disown(lock)
    _locks.clear()
