"""OpenRAVE's log functions, on Python's logger ``openravepy``."""

import logging
from collections.abc import Callable

from ravemj.rave.enums import DebugLevel

_VERBOSE = logging.DEBUG - 5  # Python has no level below DEBUG
_LEVELS = {
    DebugLevel.Fatal: logging.CRITICAL,
    DebugLevel.Error: logging.ERROR,
    DebugLevel.Warn: logging.WARNING,
    DebugLevel.Info: logging.INFO,
    DebugLevel.Debug: logging.DEBUG,
    DebugLevel.Verbose: _VERBOSE,
}
_LEVEL_BITS = 0xFFFF  # OpenRAVE's levels have flags above these bits

log = logging.getLogger("openravepy")
log.setLevel(logging.INFO)
_level = int(DebugLevel.Info)


def RaveSetDebugLevel(level: int) -> None:
    """Set the log level for ``RaveLogInfo`` and similar functions, and for ravemj's own messages.

    Args:
        level: A ``DebugLevel``, or its number. The flag ``VerifyPlans`` is stored and has no effect.

    Example:
        >>> RaveSetDebugLevel(DebugLevel.Warn)
    """
    global _level  # noqa: PLW0603 - OpenRAVE has one level for the whole process
    _level = int(level)
    for name in ("openravepy", "ravemj"):
        logging.getLogger(name).setLevel(_python_level(_level))


def RaveGetDebugLevel() -> int:
    """Return the level of ``RaveSetDebugLevel``; ``DebugLevel.Info`` by default."""
    return _level


def RaveLog(log: str, level: int = DebugLevel.Info) -> None:  # OpenRAVE's name of the argument
    """Log a line.

    Args:
        log: The message.
        level: A ``DebugLevel``, or its number.
    """
    logging.getLogger("openravepy").log(_python_level(int(level)), "%s", str(log).rstrip("\n"))


def _log_function(name: str, level: DebugLevel, summary: str) -> Callable[[str], None]:
    """Return a function that logs a message with a fixed level."""

    def function(log: str) -> None:
        RaveLog(log, level)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"{summary}\n\nArgs:\n    log: The text.\n"
    return function


RaveLogFatal = _log_function("RaveLogFatal", DebugLevel.Fatal, "Log a fatal error.")
RaveLogError = _log_function("RaveLogError", DebugLevel.Error, "Log an error.")
RaveLogWarn = _log_function("RaveLogWarn", DebugLevel.Warn, "Log a warning.")
RaveLogInfo = _log_function("RaveLogInfo", DebugLevel.Info, "Log an informative message.")
RaveLogDebug = _log_function("RaveLogDebug", DebugLevel.Debug, "Log a message for debugging.")
RaveLogVerbose = _log_function("RaveLogVerbose", DebugLevel.Verbose, "Log a detail for debugging.")


def _python_level(level: int) -> int:
    number = min(level & _LEVEL_BITS, int(DebugLevel.Verbose))
    return _LEVELS[DebugLevel(number)]
