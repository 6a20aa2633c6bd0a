"""Names of openravepy that ravemj has under other names."""

import platform
import re
from collections.abc import Callable
from enum import Enum
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import ravemj
from ravemj.core.api_object import published
from ravemj.errors import ArgumentError
from ravemj.rave import IkParameterizationType, RaveDestroy

_RENAMED = """
IkFilterReturn=IkReturnAction InterfaceBase=Interface planning_error=PlanningError
RaveCreateProblemInstance=RaveCreateModule TransformInversePoints=transformInversePoints TransformPoints=transformPoints
raveGetDebugLevel=RaveGetDebugLevel raveLog=RaveLog raveLogDebug=RaveLogDebug raveLogError=RaveLogError
raveLogFatal=RaveLogFatal raveLogInfo=RaveLogInfo raveLogVerbose=RaveLogVerbose raveLogWarn=RaveLogWarn
raveSetDebugLevel=RaveSetDebugLevel
"""
"""Older OpenRAVE names, each with ``=`` and its name in ravemj."""


class VoidPointer:
    """OpenRAVE's opaque handle, which has no function."""


def RaveGlobalState() -> VoidPointer:
    """Return an opaque handle for the library's state."""
    return VoidPointer()


def RaveGetIkTypeFromUniqueId(uniqueid: int) -> IkParameterizationType:
    """Return the IK type that a unique id identifies.

    Args:
        uniqueid: The id, of which only the bits that identify types are used.
    """
    kinds = {int(kind) & 0xFF: kind for kind in IkParameterizationType}
    if uniqueid & 0xFF not in kinds:
        raise ArgumentError(f"RaveGetIkTypeFromUniqueId: there is no type of goals with the number {uniqueid}")
    return kinds[uniqueid & 0xFF]


def enum_to_dict(enum: type[Enum]) -> dict[str, Any]:
    """Return the members of an enumeration by name.

    Args:
        enum: The enumeration.
    """
    return {name: member for name, member in enum.__members__.items()}


def openravepyCompilerVersion() -> str:
    """Return the compiler of Python, since ravemj is not compiled."""
    return platform.python_compiler()


def loadlatest() -> None:
    """Do nothing: there is only one version of the API."""


def loadstable(ver: str) -> None:
    """Do nothing: there is only one version of the API.

    Args:
        ver: The version requested by a script.
    """


_Parameters = ParamSpec("_Parameters")
_Result = TypeVar("_Result")


def with_destroy(fn: Callable[_Parameters, _Result]) -> Callable[_Parameters, _Result]:
    """Decorator that destroys all environments at the end of a function, as for ``main`` of OpenRAVE's examples.

    Args:
        fn: The function.

    Example:
        >>> @with_destroy
        ... def main():
        ...     env = Environment()
    """

    @wraps(fn)
    def run(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
        try:
            return fn(*args, **kwargs)
        finally:
            RaveDestroy()

    return run


NAMES: dict[str, object] = {
    **{old: getattr(ravemj, new) for old, new in re.findall(r"(\S+)=(\S+)", _RENAMED)},
    **{
        name: published(own, __name__)
        for name, own in globals().items()
        if name[0] != "_" and getattr(own, "__module__", "") == __name__
    },
}
"""Names that this module provides for ``openravepy``."""
globals().update(NAMES, __all__=list(NAMES))
