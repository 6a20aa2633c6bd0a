"""Handling of ``os.fork``: which objects the child process can use.

A child has copies of all objects, but only the thread that forked. So locks held by other threads stay locked forever,
and windows, pages and OpenGL contexts have no thread that serves them. Objects that depend on these belong to the
process that created them; in the child they raise an error.
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
"""Maximum time [s] that a fork waits until other threads finish their imports."""

NEW_PROCESS = 'start processes with multiprocessing.get_context("spawn")'


def in_child(function: Callable[[], None]) -> Callable[[], None]:
    """Register a function to be called in the child after each fork; a decorator."""
    if hasattr(os, "register_at_fork"):  # not on Windows
        os.register_at_fork(after_in_child=function)
    return function


def _await_imports() -> None:
    """Wait until no other thread imports a module: a forked child could never finish that import."""
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
    """Wrap a function so that it does nothing in forks of this process."""
    process = os.getpid()

    def call() -> None:
        if os.getpid() == process:
            function()

    return call


def disown(thing: object, but: tuple[str, ...] = ()) -> None:
    """Make each further use of an object raise an error, since it belongs to the parent process.

    Args:
        thing: The object.
        but: Methods without arguments that do nothing instead.
    """
    thing.__class__ = _inherited(type(thing), but)


@cache
def _inherited(kind: type, silent: tuple[str, ...]) -> type:
    """Return a subclass of ``kind`` for objects inherited from the parent process, whose use raises an error.

    It has the same memory layout. The methods named in ``silent`` do nothing.
    """

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
