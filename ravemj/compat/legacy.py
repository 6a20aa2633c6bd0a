"""Names of openravepy that ravemj itself leaves out, since it has the same under other names."""

import platform
from collections.abc import Callable
from enum import Enum
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from ravemj.errors import ArgumentError
from ravemj.geometry_functions import transformInversePoints, transformPoints
from ravemj.rave import (
    IkParameterizationType,
    IkReturnAction,
    Interface,
    PlanningError,
    RaveCreateModule,
    RaveDestroy,
    RaveGetDebugLevel,
    RaveLog,
    RaveLogDebug,
    RaveLogError,
    RaveLogFatal,
    RaveLogInfo,
    RaveLogVerbose,
    RaveLogWarn,
    RaveSetDebugLevel,
)

__all__ = [
    "IkFilterReturn",
    "InterfaceBase",
    "RaveCreateProblemInstance",
    "RaveGetIkTypeFromUniqueId",
    "RaveGlobalState",
    "TransformInversePoints",
    "TransformPoints",
    "VoidPointer",
    "enum_to_dict",
    "loadlatest",
    "loadstable",
    "openravepyCompilerVersion",
    "planning_error",
    "raveGetDebugLevel",
    "raveLog",
    "raveLogDebug",
    "raveLogError",
    "raveLogFatal",
    "raveLogInfo",
    "raveLogVerbose",
    "raveLogWarn",
    "raveSetDebugLevel",
    "with_destroy",
]

raveLog = RaveLog
raveLogFatal = RaveLogFatal
raveLogError = RaveLogError
raveLogWarn = RaveLogWarn
raveLogInfo = RaveLogInfo
raveLogDebug = RaveLogDebug
raveLogVerbose = RaveLogVerbose
raveGetDebugLevel = RaveGetDebugLevel
raveSetDebugLevel = RaveSetDebugLevel
RaveCreateProblemInstance = RaveCreateModule
planning_error = PlanningError
InterfaceBase = Interface
IkFilterReturn = IkReturnAction
TransformPoints = transformPoints
TransformInversePoints = transformInversePoints


class VoidPointer:
    """What OpenRAVE hands out of its insides, without anything to do with it."""


def RaveGlobalState() -> VoidPointer:
    """Return something that stands for the library's state."""
    return VoidPointer()


def RaveGetIkTypeFromUniqueId(uniqueid: int) -> IkParameterizationType:
    """Return the type of goals of inverse kinematics with a number.

    Args:
        uniqueid: The number; only the bits that tell types apart count.
    """
    kinds = {int(kind) & 0xFF: kind for kind in IkParameterizationType}
    if uniqueid & 0xFF not in kinds:
        raise ArgumentError(f"RaveGetIkTypeFromUniqueId: there is no type of goals with the number {uniqueid}")
    return kinds[uniqueid & 0xFF]


def enum_to_dict(enum: type[Enum]) -> dict[str, Any]:
    """Return the members of an enumeration by their names.

    Args:
        enum: The enumeration.
    """
    return {name: member for name, member in enum.__members__.items()}


def openravepyCompilerVersion() -> str:
    """Return the compiler of Python, since ravemj has none of its own."""
    return platform.python_compiler()


def loadlatest() -> None:
    """Do nothing: there is one version of the API."""


def loadstable(ver: str) -> None:
    """Do nothing: there is one version of the API.

    Args:
        ver: The version that a script wants.
    """


Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def with_destroy(fn: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return a function that destroys all environments when it ends; OpenRAVE's examples put it above ``main``.

    Args:
        fn: The function that does the work.

    Example:
        >>> @with_destroy
        ... def main():
        ...     env = Environment()
    """

    @wraps(fn)
    def run(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Result:
        try:
            return fn(*args, **kwargs)
        finally:
            RaveDestroy()

    return run
