"""Names of openravepy that ravemj itself leaves out, since it has the same under other names."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from ravemj.rave import (
    PlanningError,
    RaveDestroy,
    RaveLog,
    RaveLogDebug,
    RaveLogError,
    RaveLogFatal,
    RaveLogInfo,
    RaveLogVerbose,
    RaveLogWarn,
)

__all__ = [
    "planning_error",
    "raveLog",
    "raveLogDebug",
    "raveLogError",
    "raveLogFatal",
    "raveLogInfo",
    "raveLogVerbose",
    "raveLogWarn",
    "with_destroy",
]

raveLog = RaveLog
raveLogFatal = RaveLogFatal
raveLogError = RaveLogError
raveLogWarn = RaveLogWarn
raveLogInfo = RaveLogInfo
raveLogDebug = RaveLogDebug
raveLogVerbose = RaveLogVerbose
planning_error = PlanningError

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def with_destroy(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return a function that destroys all environments when it ends; OpenRAVE's examples put it above ``main``.

    Example:
        >>> @with_destroy
        ... def main():
        ...     env = Environment()
    """

    @wraps(function)
    def run(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Result:
        try:
            return function(*args, **kwargs)
        finally:
            RaveDestroy()

    return run
