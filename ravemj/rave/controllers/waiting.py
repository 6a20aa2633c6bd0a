"""Waiting for controllers."""

import logging
import time
from collections.abc import Callable
from threading import Condition, RLock

from ravemj.errors import ErrorCode, RavemjError

_LOG = logging.getLogger("ravemj")

_POLL = 1e-3
"""How often [s] it looks."""


def wait_until(is_done: Callable[[], bool], timeout: float, lock: RLock, is_running: Callable[[], bool]) -> bool:
    """Wait until a controller has done what it was told; see ``Robot.WaitForController``.

    Args:
        is_done: Says whether it has.
        timeout: How long to wait [s] of real time; 0: as long as it takes.
        lock: The lock of its environment.
        is_running: Says whether simulation time passes there by itself.

    Returns:
        Whether it is done.

    Raises:
        RavemjError: it would take forever, since this thread holds the lock.
    """
    if is_done():
        return True
    if _is_held(lock):
        message = "WaitForController: time stands still inside 'with env:'; wait outside of it"
        if timeout <= 0:
            raise RavemjError(message, ErrorCode.InvalidState)
        _LOG.warning("%s", message)
        return False
    if not is_running():
        _LOG.warning("WaitForController: time was stopped by StopSimulation; waiting for others to step it")
    deadline = time.monotonic() + timeout
    while not is_done():
        if timeout > 0 and deadline < time.monotonic():
            return False
        time.sleep(_POLL)
    return True


def _is_held(lock: RLock) -> bool:
    """Return whether this thread holds a lock: only its holder may notify others of something."""
    try:
        Condition(lock).notify(0)
    except RuntimeError:
        return False
    return True
