"""How threads wait for one another. Ctrl-C can leave ``threading.Event`` and ``queue.Queue`` locked for ever."""

from contextlib import suppress
from queue import SimpleQueue
from threading import Lock
from typing import Generic, TypeVar

_T = TypeVar("_T")


class Flag:
    """A flag that one thread sets and others wait for, whatever interrupts them."""

    def __init__(self) -> None:
        self._is_set = False
        self._gate = Lock()  # open while the flag is set
        self._gate.acquire()

    def is_set(self) -> bool:
        """Return whether the flag is set."""
        return self._is_set

    def set(self) -> None:
        """Set the flag, which wakes all who wait. It never waits itself, so it is safe in destructors and forks."""
        self._is_set = True
        self._open()

    def clear(self) -> None:
        """Take the flag back."""
        self._is_set = False
        self._gate.acquire(blocking=False)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the flag is set, or a time [s] is over; return whether it is set."""
        try:
            if not self._is_set:
                self._gate.acquire(timeout=-1 if timeout is None else max(timeout, 0.0))
        finally:
            if self._is_set:
                self._open()
        return self._is_set

    def _open(self) -> None:
        with suppress(RuntimeError):  # it is open already
            self._gate.release()


class Handover(Generic[_T]):
    """A queue with room for so many items, whatever interrupts the threads at its ends."""

    def __init__(self, length: int) -> None:
        self._items, self._room = SimpleQueue[_T](), SimpleQueue[None]()
        for _ in range(length):
            self._room.put(None)

    def put(self, item: _T) -> None:
        """Append an item; wait while there is no room."""
        self._room.get()
        self._items.put(item)

    def get(self, timeout: float | None = None) -> _T:
        """Wait for the next item and return it.

        Raises:
            queue.Empty: none came in time [s].
        """
        item = self._items.get(timeout=timeout)
        self._room.put(None)
        return item

    def put_at_once(self, item: _T) -> None:
        """Append an item, as if there were room."""
        self._items.put(item)

    def give_room(self) -> None:
        """Let one more item in, from the end that takes no more."""
        self._room.put(None)
