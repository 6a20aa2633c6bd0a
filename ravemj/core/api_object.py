"""The base class of API objects: their display at interactive prompts, and their argument errors."""

from collections.abc import Iterable
from enum import Enum
from types import FunctionType
from typing import ClassVar, TypeVar, cast

from ravemj.core.argument_errors import explain_methods, explained
from ravemj.core.signatures import show_as_written

Thing = TypeVar("Thing")


class _ApiType(type):
    """Metaclass that makes ``dir`` of a class equal to ``dir`` of its objects, since IPython completes with both."""

    def __dir__(cls) -> list[str]:
        return _listed(cls, super().__dir__())


class ApiObject(metaclass=_ApiType):
    """Base class with a ``repr`` without an address, and a ``dir`` of the names that users call.

    ``dir`` and tab completion omit names with an underscore, and those listed in ``_internal``: names that other
    modules of this package use, and that therefore have no underscore.
    """

    _internal: ClassVar[tuple[str, ...]] = ()

    _often_called: ClassVar[tuple[str, ...]] = ()
    """Performance-critical methods, and ``__init__`` of classes with many objects.

    They check their arguments themselves, since a wrapper would cost 0.1 µs per call.
    """

    def __init_subclass__(cls, **kwargs: object) -> None:
        """Wrap public methods and the constructor for argument errors, and set their displayed signatures.

        See ``argument_errors`` and ``signatures``.
        """
        super().__init_subclass__(**kwargs)
        explain_methods(cls, _all_of(cls, "_internal") | _all_of(cls, "_often_called"))
        show_as_written(cls)

    def __dir__(self) -> list[str]:
        return _listed(type(self), super().__dir__())

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"


def published(thing: Thing, module: str) -> Thing:
    """Prepare a public function or class: errors name wrong arguments, signatures are shown as in the source.

    ``module`` is the module of a function's public name, in which pickle looks it up.
    """
    if isinstance(thing, FunctionType):
        thing = cast("Thing", explained(thing))
        thing.__module__ = module  # where pickle finds it
    elif isinstance(thing, type):
        kind = cast("type[object]", thing)
        if not issubclass(kind, Enum | ApiObject):
            explain_methods(kind)
    show_as_written(thing)
    return cast("Thing", thing)


def _listed(kind: type, names: Iterable[str]) -> list[str]:
    internal = _all_of(kind, "_internal")
    return [name for name in names if name.startswith("__") or not (name[0] == "_" or name in internal)]


def _all_of(kind: type, attribute: str) -> set[str]:
    """Return the union of an attribute's names over a class and its bases."""
    return {name for base in kind.__mro__ for name in vars(base).get(attribute, ())}
