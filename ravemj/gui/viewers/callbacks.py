"""Functions of users that a viewer calls."""

import itertools
import logging
from collections.abc import Callable

from ravemj.core.handles import Handle
from ravemj.errors import ArgumentError

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

    def call(self, *arguments: object) -> list[object]:
        """Call all functions and return what they return; what they raise is logged."""
        answers: list[object] = []
        for function in self._functions.copy().values():
            try:
                answers.append(function(*arguments))
            except Exception:
                _LOG.exception("a viewer's callback failed")
        return answers

    def __bool__(self) -> bool:
        return bool(self._functions)
