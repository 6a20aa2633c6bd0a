"""Functions of users that a viewer calls."""

import itertools
import logging
from collections.abc import Callable

from ravemj.errors import ArgumentError
from ravemj.handles import Handle

_LOG = logging.getLogger("ravemj")

Callback = Callable[..., object]


class Callbacks:
    """Functions for one occasion, each for as long as its handle lives."""

    def __init__(self) -> None:
        self._functions: dict[int, Callback] = {}
        self._keys = itertools.count()

    def add(self, function: Callback) -> Handle:
        """Take a function up.

        Raises:
            ArgumentError: it cannot be called.
        """
        if not callable(function):
            raise ArgumentError(f"callback: {function!r} cannot be called")
        key = next(self._keys)
        self._functions[key] = function
        return Handle(self._functions.pop, key, None)

    def call(self, *arguments: object) -> None:
        """Call all functions; what they raise is logged."""
        for function in self._functions.copy().values():
            try:
                function(*arguments)
            except Exception:
                _LOG.exception("a viewer's callback failed")

    def __bool__(self) -> bool:
        return bool(self._functions)
