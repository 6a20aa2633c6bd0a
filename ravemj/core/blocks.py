"""Context managers whose exit no signal can skip.

Python handles signals at the start of Python functions and after calls. A signal that raises an exception, like Ctrl-C,
at the start of a Python function ``__exit__`` would skip it. So the ``__exit__`` of these context managers is C code.
Their ``__enter__`` may be Python code, because no signal is handled between its ``return`` and the block.
"""

import io
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager
from functools import wraps
from operator import attrgetter
from types import TracebackType
from typing import Any, Generic, ParamSpec, TypeVar

_P = ParamSpec("_P")
_T = TypeVar("_T")


class _CodeInC(io.IOBase):
    """Base class that inherits ``__exit__`` from ``io.IOBase``: C code that calls ``close()`` for any arguments."""

    closed = True  # pyright: ignore - garbage collection should not call ``close``


class Block(_CodeInC, Generic[_T]):
    """Runs a generator up to its ``yield`` at the start of a ``with`` block, and the rest at its end.

    Unlike with ``contextlib.contextmanager``, the generator does not receive the error that ends the block.
    """

    def __init__(self, generator: Generator[_T]) -> None:
        self._generator = generator
        self.close = generator.close

    def __enter__(self) -> _T:  # pyright: ignore[reportIncompatibleMethodOverride]
        try:
            return next(self._generator)
        except BaseException:
            self.close()
            raise


def block(function: Callable[_P, Generator[_T]]) -> Callable[_P, AbstractContextManager[_T]]:
    """Convert a generator function to a context manager; see ``Block``."""

    @wraps(function)
    def begin(*args: _P.args, **kwargs: _P.kwargs) -> Any:  # noqa: ANN401 - typed above
        return Block(function(*args, **kwargs))

    return begin


class _Exit(Generic[_T]):
    """Descriptor for ``__exit__`` whose function is looked up when the block begins."""

    def __init__(self, find: Callable[[_T], Callable[..., object]]) -> None:
        self._find = find

    def __get__(self, owner: _T | None, kind: type) -> object:
        return self if owner is None else self._find(owner)

    def __call__(self, owner: _T, *error: object) -> None:
        """Leave the ``with`` block of an object, as ``contextlib.ExitStack`` does."""
        self._find(owner)(*error)


def exit_in_c(
    find: Callable[[_T], Callable[..., object]],
) -> Callable[[_T, type[BaseException] | None, BaseException | None, TracebackType | None], None]:
    """Create an ``__exit__`` from a method that returns a C function with the arguments of ``__exit__``.

    The method is called before the block begins.
    """
    exit_: Any = _Exit(find)
    return exit_


@block
def restoring(action: Callable[[], object]) -> Generator[None]:
    """Call a function at the end of the block; if an interrupt stops the call, repeat it."""
    try:
        yield
    finally:
        try:
            action()
        except BaseException:
            action()
            raise


def always(action: Callable[[], object]) -> Callable[..., object]:
    """Return an ``__exit__`` that calls a function."""
    waiting = restoring(action)
    waiting.__enter__()
    return waiting.__exit__


class Closing(_CodeInC):
    """Base class with an ``__exit__`` in C that closes the object's current ``innermost_block``."""

    close = property(attrgetter("_owner.innermost_block.close"))  # pyright: ignore[reportAssignmentType]

    def __init__(self, owner: object) -> None:
        self._owner = owner
