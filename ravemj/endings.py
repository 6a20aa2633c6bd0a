"""How a command ends on Ctrl-C (SIGINT), SIGTERM and SIGHUP: with the exit code 128 + the signal's number.

It ends at once, whatever it imports, loads or computes. Only where something is ``Unfinished`` does the signal become
an exception that gets to the end of it: ``KeyboardInterrupt``, or ``Terminated``. A second signal ends that at once.

``ravemj/__init__.py`` imports this before all else, so that it holds from the first line on; therefore this imports
next to nothing. Programs that import ravemj keep the handlers that they have.
"""

import os
import sys


def _is_command() -> bool:
    """Return whether this process is ``ravemj …`` or ``python -m ravemj …``, before anything of that has run."""
    program = sys.argv[0] if sys.argv else ""
    if program == "-m":  # until Python has found the module to run, for which it imports the package
        return sys.orig_argv[-len(sys.argv)] in ("ravemj", "-mravemj")
    return os.path.basename(program) in ("ravemj", "ravemj.exe")


_IS_COMMAND = _is_command()

try:
    import signal
except KeyboardInterrupt:
    if _IS_COMMAND:
        os._exit(130)
    raise

_SHOW_CURSOR = "\x1b[?25h"  # a bar of progress hides it

_unfinished: "set[Unfinished]" = set()
_is_ending = False


class Terminated(SystemExit):
    """SIGTERM or SIGHUP has come while something was unfinished."""

    def __init__(self, number: int) -> None:
        """Make one of the number of the signal."""
        super().__init__(128 + number)
        self.number = number


class Unfinished:
    """A context at whose end something is put in order, also when a signal comes.

    Args:
        temporary: A file or folder that is removed if a second signal leaves no time for that.
    """

    def __init__(self, temporary: "os.PathLike[str] | None" = None) -> None:
        self._temporary = temporary

    def __enter__(self) -> None:
        _unfinished.add(self)

    def __exit__(self, *reason: object) -> None:
        _unfinished.discard(self)

    def give_up(self) -> None:
        """Remove the file or folder, though a thread may be writing into it."""
        import shutil  # noqa: PLC0415 - slow to import

        if self._temporary is None:
            return
        doomed = f"{os.fspath(self._temporary)}-"
        try:
            os.replace(self._temporary, doomed)  # so that nothing new gets into a folder
            os.unlink(doomed)
        except OSError:
            shutil.rmtree(doomed, ignore_errors=True)


def heed_signals() -> None:
    """Let signals end this process if it is a command, except those that it was started to ignore."""
    for number in _signals() if _IS_COMMAND else ():
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _end)


def leave_interrupts_to_python() -> None:
    """Let Ctrl-C be an exception, however often it comes; for scripts and prompts of users."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def message(number: int) -> str:
    """Return what is said when a signal has ended a command."""
    return "ravemj: interrupted" if number == signal.SIGINT else f"ravemj: ended by {signal.Signals(number).name}"


def _signals() -> "list[signal.Signals]":
    names = ("SIGINT", "SIGTERM", "SIGHUP")
    return [getattr(signal, name) for name in names if hasattr(signal, name)]  # Windows has no SIGHUP


def _end(number: int, frame: object) -> None:
    global _is_ending  # noqa: PLW0603 - a process ends once
    del frame
    if _unfinished and not _is_ending:
        _is_ending = True
        raise KeyboardInterrupt if number == signal.SIGINT else Terminated(number)
    try:
        for each in tuple(_unfinished):
            each.give_up()
        if sys.__stderr__ is not None:
            start = _SHOW_CURSOR if sys.__stderr__.isatty() else ""
            # Past Python's buffer, which this may have interrupted.
            os.write(sys.__stderr__.fileno(), f"{start}{message(number)}\n".encode())
    finally:
        os._exit(128 + number)


def _forget() -> None:
    """Leave a forked process, which scripts may start, as Python would."""
    _unfinished.clear()
    for number in _signals():
        if signal.getsignal(number) is _end:
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
heed_signals()
