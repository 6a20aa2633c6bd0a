"""Termination of commands by Ctrl-C (SIGINT), SIGTERM and SIGHUP, with the exit code 128 + the signal's number.

The command ends immediately, during imports, loading or drawing, after the functions of ``on_signal``. An exception at
an arbitrary point, as Python raises it, is not safe: C code converts it to other errors, and threads may wait forever.
Only while a command waits for its user, ``signals_raised`` raises an exception.

``ravemj/__init__.py`` imports this module first, so that it is active from the first line on; therefore it has very few
imports. Programs that import ravemj keep their signal handlers.
"""

import os
import sys


def _is_command() -> bool:
    """Return whether this process is ``ravemj …`` or ``python -m ravemj …``; valid before the command's code runs."""
    program = sys.argv[0] if sys.argv else ""
    if program == "-m":  # until Python has found the module to run, for which it imports the package
        return sys.orig_argv[-len(sys.argv)] in ("ravemj", "-mravemj")
    return os.path.basename(program) in ("ravemj", "ravemj.exe")


_IS_COMMAND = _is_command()

try:
    import signal
    from collections.abc import Callable, Generator
    from contextlib import contextmanager
except KeyboardInterrupt:
    if _IS_COMMAND:
        os._exit(130)
    raise

_functions: list[Callable[[], object]] = []
_delays: list[object] = []
_delayed: list[int] = []
_raises = False


class Terminated(SystemExit):
    """SIGTERM or SIGHUP as an exception."""

    def __init__(self, number: int) -> None:
        """Create the exception from the number of the signal."""
        super().__init__(128 + number)
        self.number = number


@contextmanager
def on_signal(function: Callable[[], object]) -> Generator[None]:
    """Call a function if a signal ends the process during the block."""
    _functions.append(function)
    try:
        yield
    finally:
        if function in _functions:  # not in a fork, which leaves the files of its parent alone
            _functions.remove(function)


@contextmanager
def signals_delayed() -> Generator[None]:
    """Delay signals until the end of the block, in whichever thread it runs."""
    block = object()
    _delays.append(block)
    try:
        yield
    finally:
        if block in _delays:
            _delays.remove(block)
        if _delayed and not _delays:
            signal.raise_signal(_delayed.pop())


@contextmanager
def signals_raised() -> Generator[None]:
    """Raise ``KeyboardInterrupt`` or ``Terminated`` for a signal in the block; a second signal ends the process."""
    global _raises  # noqa: PLW0603 - signals are the process's
    _raises = True
    try:
        yield
    finally:
        _raises = False


def heed_signals() -> None:
    """Install the signal handlers if this process is a command, except for signals that it was started to ignore."""
    for number in _signals() if _IS_COMMAND else ():
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _end)


def leave_signals_to_python() -> None:
    """Restore Python's signal handlers, as scripts and interactive prompts expect."""
    for number in _signals():
        if signal.getsignal(number) is _end:
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)


def message(number: int) -> str:
    """Return the message of a command that a signal has ended."""
    return "ravemj: interrupted" if number == signal.SIGINT else f"ravemj: ended by {signal.Signals(number).name}"


def _signals() -> list[signal.Signals]:
    names = ("SIGINT", "SIGTERM", "SIGHUP")
    return [getattr(signal, name) for name in names if hasattr(signal, name)]  # Windows has no SIGHUP


def _end(number: int, frame: object) -> None:
    global _raises  # noqa: PLW0603
    del frame
    if _delays:
        _delayed.append(number)
        if _delays:  # still, for they may end in other threads
            return
    if _raises:
        _raises = False
        raise KeyboardInterrupt if number == signal.SIGINT else Terminated(number)
    try:
        for function in reversed(_functions):
            function()
        if sys.__stderr__ is not None:  # past its buffer, which this may have interrupted
            os.write(sys.__stderr__.fileno(), f"{message(number)}\n".encode())
    finally:
        os._exit(128 + number)


def _forget() -> None:
    """Forget the parent's temporary files and signal blocks in a forked child."""
    _functions.clear()
    _delays.clear()


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=_forget)

heed_signals()
