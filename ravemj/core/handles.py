"""Handles: objects that release something when they are closed or garbage-collected."""

import weakref
from collections.abc import Callable
from types import TracebackType
from typing import ParamSpec, Self, TypeVar

from ravemj.core.api_object import ApiObject
from ravemj.errors import ArgumentError

_Arguments = ParamSpec("_Arguments")
_Function = TypeVar("_Function")


class Handle(ApiObject):
    """Holds a resource or registration while the handle exists."""

    def __init__(
        self, release: Callable[_Arguments, object], *args: _Arguments.args, **kwargs: _Arguments.kwargs
    ) -> None:
        """Create a handle that calls ``release`` once with the other arguments, when it is closed or collected.

        ``release`` must be safe in any thread at any time, since garbage collection may call it.
        """
        if not callable(release):
            raise TypeError(f"{type(self).__name__}: release: is {release!r}, and should be a function")
        self._release = weakref.finalize(self, release, *args, **kwargs)
        self._release.atexit = False

    def Close(self) -> None:  # noqa: N802 - OpenRAVE's name
        """Release the resource now; a second call does nothing."""
        self._release()

    close = Close

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Release the resource."""
        self._release()


def registered(functions: list[_Function], function: _Function, name: str) -> Handle:
    """Append a user's function to a list, and return a handle that removes it.

    Raises:
        ArgumentError: ``function`` is not callable.
    """
    if not callable(function):
        raise ArgumentError(f"{name} is {function!r}, and should be a function")
    functions.append(function)
    return Handle(functions.remove, function)  # in one step, since garbage collection may call it
