"""What stays usable in the child after ``os.fork``.

A child has a copy of all objects, and of their threads only the one that forked. So locks that other threads held stay
locked for ever there, and windows, pages and OpenGL contexts have nobody who serves them. What depends on these belongs
to the process that made it; in the child, it raises an error.
"""

import os
import sys
import threading
import time
from collections.abc import Callable
from functools import cache
from typing import Any, NoReturn

from ravemj.errors import ErrorCode, RavemjError

_LONGEST_IMPORT = 1.0
"""How long [s] a fork waits for threads that import modules."""

NEW_PROCESS = 'start processes with multiprocessing.get_context("spawn")'


def in_child(function: Callable[[], None]) -> Callable[[], None]:
    """Have a function called in the child after each fork; a decorator."""
    if hasattr(os, "register_at_fork"):  # not on Windows
        os.register_at_fork(after_in_child=function)
    return function


def _await_imports() -> None:
    """Wait until no other thread imports a module, which could not be imported in the child then."""
    locks: dict[str, Any] = vars(sys.modules["_frozen_importlib"]).get("_module_locks", {})
    harmless = {None, threading.get_ident()}
    deadline = time.monotonic() + _LONGEST_IMPORT
    while time.monotonic() < deadline and any(
        getattr(reference(), "owner", None) not in harmless for reference in tuple(locks.values())
    ):
        time.sleep(1e-3)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_await_imports)


def in_this_process(function: Callable[[], object]) -> Callable[[], None]:
    """Return a function that calls another one in this process, and does nothing in a fork of it."""
    process = os.getpid()

    def call() -> None:
        if os.getpid() == process:
            function()

    return call


def disown(thing: object, but: tuple[str, ...] = ()) -> None:
    """Let each further use of an object raise an error, since it belongs to the process that was forked.

    Args:
        thing: The object.
        but: Methods without arguments that do nothing from now on.
    """
    thing.__class__ = _inherited(type(thing), but)


@cache
def _inherited(kind: type, silent: tuple[str, ...]) -> type:
    """Return a class of the same layout whose objects raise an error when they are used."""

    def refuse(thing: object, *arguments: object) -> NoReturn:
        del thing, arguments
        message = (
            "the environment was made before os.fork and belongs to the parent: make one in the child, or "
            f"{NEW_PROCESS}; arrays, MuJoCo models and IK solvers work in any child"
        )
        raise RavemjError(message, ErrorCode.InvalidState)

    def attribute(thing: object, name: str) -> object:
        if name in silent:
            return lambda: None
        return object.__getattribute__(thing, name) if name.startswith("__") else refuse(thing)

    def describe(thing: object) -> str:
        return f"<{type(thing).__name__} of the parent process>"

    members: dict[str, Any] = {"__slots__": (), "__getattribute__": attribute, "__repr__": describe}
    members |= {"__enter__": refuse, "__exit__": refuse, "__del__": lambda _: None}  # pyright: ignore
    return type(kind)(kind.__name__, (kind,), members)
