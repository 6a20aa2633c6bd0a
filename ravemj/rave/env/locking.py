"""The environment's lock."""

from types import TracebackType
from typing import Self

from ravemj.errors import ErrorCode, RavemjError
from ravemj.rave.env.base import EnvironmentPart


class Locking(EnvironmentPart):
    """Keeps other threads out: ``with env:``."""

    def Lock(self, timeout: float | None = None) -> bool | None:
        """Take the lock; the same thread can take it several times, and has to give it back as often.

        Args:
            timeout: How long to wait [s]; left out: as long as it takes.

        Returns:
            With a timeout, whether the lock was taken; else None.
        """
        if timeout is None:
            self._simulation.lock.acquire()
            return None
        return self._simulation.lock.acquire(timeout=max(0.0, timeout))

    def TryLock(self) -> bool:
        """Take the lock if it is free, without waiting; return whether it was taken."""
        return self._simulation.lock.acquire(blocking=False)

    def Unlock(self) -> None:
        """Give the lock back.

        Raises:
            openrave_exception: this thread does not hold it (``EnvironmentNotLocked``).
        """
        try:
            self._simulation.lock.release()
        except RuntimeError:
            raise RavemjError("Unlock: this thread does not hold the lock", ErrorCode.EnvironmentNotLocked) from None

    def __enter__(self) -> Self:
        """Hold the environment's lock: no other thread reads or changes it meanwhile."""
        self._simulation.lock.acquire()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Let go of the lock."""
        self._simulation.lock.release()
