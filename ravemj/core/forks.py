"""What stays usable in the child after ``os.fork``.

A child has a copy of all objects, and of their threads only the one that forked. So locks that other threads held stay
locked for ever there, and windows, pages and OpenGL contexts have nobody who serves them. What depends on these belongs
to the process that made it; in the child, it raises an error.
"""

import os
from collections.abc import Callable
from functools import cache
from typing import Any, NoReturn

from ravemj.errors import ErrorCode, RavemjError

WAYS_OUT = (
    "make it in the child instead, or start processes with multiprocessing.get_context('spawn'); "
    "arrays, MuJoCo models and IK solvers work in both"
)


def in_child(function: Callable[[], None]) -> Callable[[], None]:
    """Have a function called in the child after each fork; a decorator."""
    if hasattr(os, "register_at_fork"):  # not on Windows
        os.register_at_fork(after_in_child=function)
    return function


def in_this_process(function: Callable[[], object]) -> Callable[[], None]:
    """Return a function that calls another one in this process, and does nothing in a fork of it."""
    process = os.getpid()

    def call() -> None:
        if os.getpid() == process:
            function()

    return call


def disown(thing: object) -> None:
    """Let each further use of an object raise an error, since it belongs to the process that was forked."""
    thing.__class__ = _inherited(type(thing))


@cache
def _inherited(kind: type) -> type:
    """Return a class of the same layout whose objects raise an error when they are used."""

    def refuse(thing: object, *arguments: object) -> NoReturn:
        del thing, arguments
        message = f"this {kind.__name__} belongs to the process that was forked: {WAYS_OUT}"
        raise RavemjError(message, ErrorCode.InvalidState)

    def attribute(thing: object, name: str) -> object:
        return object.__getattribute__(thing, name) if name.startswith("__") else refuse(thing)

    def describe(thing: object) -> str:
        return f"<{type(thing).__name__} of the process that was forked>"

    members: dict[str, Any] = {"__slots__": (), "__getattribute__": attribute, "__repr__": describe}
    members |= {"__enter__": refuse, "__exit__": refuse, "__del__": lambda _: None}  # pyright: ignore
    return type(kind)(kind.__name__, (kind,), members)
