"""Placeholders for unsupported functions of OpenRAVE: they accept its arguments, and raise ``UnsupportedError``."""

import re
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import NoReturn, TypeVar

from ravemj.errors import UnsupportedError

Kind = TypeVar("Kind", bound=type[object])


def refusing(name: str, capability: str, arguments: str) -> Callable[..., NoReturn]:
    """Return a function that raises ``UnsupportedError`` with the missing capability.

    Args:
        name: The function's name in the error; for a constructor, its class and ``__init__``.
        capability: The capability that ravemj lacks.
        arguments: The names of its arguments, which completion shows; ``*`` and ``**`` mark variadic arguments.
    """

    def refuse(*given: object, **named: object) -> NoReturn:
        raise UnsupportedError(name.removesuffix(".__init__"), capability)

    kinds = {0: Parameter.POSITIONAL_OR_KEYWORD, 1: Parameter.VAR_POSITIONAL, 2: Parameter.VAR_KEYWORD}
    shown = [Parameter(word.lstrip("*"), kinds[word.count("*")]) for word in arguments.split()]
    vars(refuse).update(__signature__=Signature(shown), capability=capability)
    refuse.__name__, refuse.__qualname__ = name.rpartition(".")[2], name
    refuse.__doc__ = f"Raise ``UnsupportedError``: ravemj has no {capability} yet."
    return refuse


def lacking(capability: str, methods: str) -> Callable[[Kind], Kind]:
    """Return a class decorator that adds unsupported methods of OpenRAVE, which raise ``UnsupportedError``.

    Args:
        capability: The capability that ravemj lacks.
        methods: Names, each with its arguments in parentheses, as for ``refusing``; ``@`` marks static methods.
    """

    def complete(kind: Kind) -> Kind:
        for mark, name, arguments in re.findall(r"(@?)(\w+)\((.*?)\)", methods, re.DOTALL):
            refuse = refusing(f"{kind.__qualname__}.{name}", capability, arguments if mark else f"self {arguments}")
            setattr(kind, name, staticmethod(refuse) if mark else refuse)
        return kind

    return complete
