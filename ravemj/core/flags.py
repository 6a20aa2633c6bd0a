"""Interrupt-safe waiting between threads. Ctrl-C can leave ``threading.Event`` and ``queue.Queue`` locked forever."""

from contextlib import suppress
from queue import SimpleQueue
from threading import Lock
from typing import Generic, TypeVar

_T = TypeVar("_T")


class Flag:
    """Flag that one thread sets and others wait for, safe against interrupts."""

    def __init__(self) -> None:
        self._is_set = False
        self._gate = Lock()  # unlocked while the flag is set
        self._gate.acquire()

    def is_set(self) -> bool:
        """Return whether the flag is set."""
        return self._is_set

    def set(self) -> None:
        """Set the flag and wake all waiting threads. It never blocks, so it is safe in destructors and forks."""
        self._is_set = True
        self._open()

    def clear(self) -> None:
        """Clear the flag."""
        self._is_set = False
        self._gate.acquire(blocking=False)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the flag is set, or for at most ``timeout`` [s]; return whether it is set."""
        try:
            if not self._is_set:
                self._gate.acquire(timeout=-1 if timeout is None else max(timeout, 0.0))
        finally:
            if self._is_set:
                self._open()
        return self._is_set

    def _open(self) -> None:
        with suppress(RuntimeError):  # it is unlocked already
            self._gate.release()


class Handover(Generic[_T]):
    """A queue of limited length, safe against interrupts."""

    def __init__(self, length: int) -> None:
        self._items, self._room = SimpleQueue[_T](), SimpleQueue[None]()
        for _ in range(length):
            self._room.put(None)

    def put(self, item: _T) -> None:
        """Append an item; block while the queue is full."""
        self._room.get()
        self._items.put(item)

    def get(self, timeout: float | None = None) -> _T:
        """Wait for the next item and return it.

        Raises:
            queue.Empty: no item arrived within the timeout [s].
        """
        item = self._items.get(timeout=timeout)
        self._room.put(None)
        return item

    def put_at_once(self, item: _T) -> None:
        """Append an item, even if the queue is full."""
        self._items.put(item)

    def give_room(self) -> None:
        """Raise the capacity by one item; for the consumer that stops reading."""
        self._room.put(None)
