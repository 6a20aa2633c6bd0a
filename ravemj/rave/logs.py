"""OpenRAVE's log functions, on Python's logger ``openravepy``."""

import logging

from ravemj.rave.enums import DebugLevel

_VERBOSE = logging.DEBUG - 5
_LEVELS = {
    DebugLevel.Fatal: logging.CRITICAL,
    DebugLevel.Error: logging.ERROR,
    DebugLevel.Warn: logging.WARNING,
    DebugLevel.Info: logging.INFO,
    DebugLevel.Debug: logging.DEBUG,
    DebugLevel.Verbose: _VERBOSE,
}
_LEVEL_BITS = 0xFFFF

log = logging.getLogger("openravepy")
log.setLevel(logging.INFO)
_level = int(DebugLevel.Info)


def RaveSetDebugLevel(level: int) -> None:
    """Set what is logged, by ``RaveLogInfo`` and its like and by ravemj itself.

    Args:
        level: A ``DebugLevel``, or its number; its bit ``VerifyPlans`` is kept, and has no effect.

    Example:
        >>> RaveSetDebugLevel(DebugLevel.Warn)
    """
    global _level  # noqa: PLW0603 - OpenRAVE has one level for the whole process
    _level = int(level)
    for name in ("openravepy", "ravemj"):
        logging.getLogger(name).setLevel(_python_level(_level))


def RaveGetDebugLevel() -> int:
    """Return the number of ``RaveSetDebugLevel``, or that of ``DebugLevel.Info``."""
    return _level


def RaveLog(log: str, level: int = DebugLevel.Info) -> None:  # OpenRAVE's name of the argument
    """Log a line.

    Args:
        log: What to say.
        level: A ``DebugLevel``, or its number.
    """
    logging.getLogger("openravepy").log(_python_level(int(level)), "%s", str(log).rstrip("\n"))


def RaveLogFatal(log: str) -> None:
    """Log that nothing can go on.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Fatal)


def RaveLogError(log: str) -> None:
    """Log an error.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Error)


def RaveLogWarn(log: str) -> None:
    """Log a warning.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Warn)


def RaveLogInfo(log: str) -> None:
    """Log something of interest.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Info)


def RaveLogDebug(log: str) -> None:
    """Log something for those who look for a mistake.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Debug)


def RaveLogVerbose(log: str) -> None:
    """Log something for those who want all.

    Args:
        log: The text.
    """
    RaveLog(log, DebugLevel.Verbose)


def _python_level(level: int) -> int:
    number = min(level & _LEVEL_BITS, int(DebugLevel.Verbose))
    return _LEVELS[DebugLevel(number)]
