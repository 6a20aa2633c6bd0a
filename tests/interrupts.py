"""Raises ``KeyboardInterrupt`` at every place where Python handles signals, one place after the other."""

import ctypes
import math
import signal
import sys
import threading
from collections.abc import Callable, Iterator

_set_interrupt = ctypes.PYFUNCTYPE(None, *3 * [ctypes.py_object])(("PyErr_SetInterrupt", ctypes.pythonapi))
"""A trace function in C, so that Python handles the signal in the function that is traced, at its next such place."""


def _interrupt(action: Callable[[], object], number: int = 0) -> int:
    """Run an action and interrupt it at the place of a number, from 1; return how many places it came to."""
    count = 0

    def handle(signum, frame):
        nonlocal count
        if frame.f_code not in {begin.__code__, _interrupt.__code__}:
            count += 1
            if count == number:
                raise KeyboardInterrupt

    def begin(frame, event, argument):
        if frame.f_code is handle.__code__:
            return None
        frame.f_trace_lines, frame.f_trace_opcodes = False, True
        return _set_interrupt

    before = signal.signal(signal.SIGINT, handle)
    traced = sys.gettrace()
    try:
        sys.settrace(begin)
        action()
    except KeyboardInterrupt:
        assert count >= number > 0
    finally:
        number = 0  # whatever runs from here on, as callbacks of garbage collection do, is not interrupted
        sys.settrace(traced)
        signal.signal(signal.SIGINT, before)
    return count


def interrupts(action: Callable[[], object], most: int = 200) -> Iterator[int]:
    """Interrupt an action at each place, or at so many of them; yield the number of the place after each."""
    action()  # once, since first calls import and compile
    count = _interrupt(action)
    for number in range(1, count + 1, math.ceil(count / most)):
        _interrupt(action, number)
        yield number


def is_free(env) -> bool:
    """Return whether another thread gets the lock of an environment."""
    answers = []

    def ask() -> None:
        answers.append(env.TryLock())
        if answers[0]:
            env.Unlock()

    thread = threading.Thread(target=ask)
    thread.start()
    thread.join()
    return answers[0]
