"""Checks of arguments that are not arrays."""

import operator
from collections.abc import Callable
from functools import wraps
from inspect import Parameter, cleandoc, signature
from typing import ParamSpec, TypeVar

from ravemj.errors import ArgumentError

Kind = TypeVar("Kind")
Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def also_named(**names: str) -> Callable[[Callable[Arguments, Result]], Callable[Arguments, Result]]:
    """Accept further keyword names of arguments, as in OpenRAVE's overloads: ``also_named(further="argument")``."""

    def decorate(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
        @wraps(function)
        def renamed(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
            for name in names.keys() & kwargs.keys():
                kwargs[names[name]] = kwargs.pop(name)
            return function(*args, **kwargs)

        original = signature(function)
        known = original.parameters
        further = [
            Parameter(name, Parameter.KEYWORD_ONLY, default=..., annotation=known[argument].annotation)
            for name, argument in names.items()
        ]
        parameters = [*known.values(), *further]
        parameters.sort(key=lambda parameter: parameter.kind)
        vars(renamed)["__signature__"] = original.replace(parameters=parameters)
        pairs = ", ".join(f"``{name}`` for ``{argument}``" for name, argument in names.items())
        renamed.__doc__ = f"{cleandoc(function.__doc__ or '')}\n\nNote:\n    Also taken by name: {pairs}."
        return renamed

    return decorate


def checked_kind(thing: object, kind: type[Kind] | tuple[type[Kind], ...], name: str, wanted: str = "") -> Kind:
    """Check the class of an argument and return it; errors call it ``name`` and the expected class ``wanted``.

    Raises:
        ArgumentError: it is not an instance of the class or classes.
    """
    if not isinstance(thing, kind):
        given = "None" if thing is None else f"of type {type(thing).__name__}"
        if isinstance(kind, type):
            wanted = wanted or kind.__name__
        raise ArgumentError(f"{name}: is {given}, and should be {wanted}")
    return thing


def checked_integer(number: int, name: str) -> int:
    """Return a whole number of Python or numpy as Python's; errors call it ``name``.

    Raises:
        ArgumentError: it is not a whole number.
    """
    try:
        return operator.index(number)
    except TypeError:
        return checked_kind(number, int, name, "a whole number")


def checked_index(index: int, count: int, name: str) -> int:
    """Check an index and return it; errors call it ``name``.

    Raises:
        ArgumentError: it is not a whole number from 0 to ``count - 1``.
    """
    if type(index) is not int:
        index = checked_integer(index, name)
    if not 0 <= index < count:
        raise ArgumentError(f"{name} is {index}, and should be from 0 to {count - 1}")
    return index


def checked_flag(text: str, command: str) -> bool:
    """Parse the argument of an on/off command.

    Raises:
        ArgumentError: it is neither 0 nor 1.
    """
    if text.strip() not in {"0", "1"}:
        raise ArgumentError(f"{command}: is followed by '{text}', and should be by 0 or 1")
    return text.strip() == "1"
