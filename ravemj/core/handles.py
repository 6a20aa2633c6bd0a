"""Handles: objects that release something when they are closed or garbage-collected."""

import weakref
from collections.abc import Callable
from types import TracebackType
from typing import ParamSpec, Self

from ravemj.core.api_object import ApiObject

_Arguments = ParamSpec("_Arguments")


class Handle(ApiObject):
    """Keeps something for as long as the handle is in use."""

    def __init__(
        self, release: Callable[_Arguments, object], *args: _Arguments.args, **kwargs: _Arguments.kwargs
    ) -> None:
        """Make a handle that calls ``release`` with the other arguments once, at the end.

        It has to be safe in any thread at any time: garbage collection calls it.
        """
        self._release = weakref.finalize(self, release, *args, **kwargs)
        self._release.atexit = False

    def Close(self) -> None:  # noqa: N802 - OpenRAVE's name
        """Release it now; a second call does nothing."""
        self._release()

    close = Close

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Release it."""
        self._release()
