"""Waiting for controllers."""

import logging
import time
from collections.abc import Callable

from ravemj.core.locks import StateLock
from ravemj.errors import ErrorCode, RavemjError

_LOG = logging.getLogger("ravemj")

_POLL = 1e-3
"""The interval [s] at which the controller is asked: short against a time step of 10 ms, and no load for a core."""


def wait_until(is_done: Callable[[], bool], timeout: float, lock: StateLock, is_running: Callable[[], bool]) -> bool:
    """Wait until a controller has finished its command; see ``Robot.WaitForController``.

    Args:
        is_done: Returns whether the controller has finished.
        timeout: The longest wait in real time [s]; 0 for no limit.
        lock: The lock of the environment.
        is_running: Returns whether the thread of simulation time runs.

    Returns:
        Whether the controller has finished.

    Raises:
        RavemjError: the wait would never end, because this thread holds the lock.
    """
    if is_done():
        return True
    if lock.is_held:
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
