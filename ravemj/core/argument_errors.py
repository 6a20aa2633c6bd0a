"""Errors that name the argument of a wrong type.

A wrong argument often fails deep inside a call, with an unrelated error of Python. In this case, the methods,
constructors and functions of the API compare their arguments with the annotations. Successful calls skip this.
"""

import os
import re
import reprlib
from collections.abc import Callable, Collection, Iterable, Mapping
from enum import Enum
from functools import cache, wraps
from inspect import CO_VARARGS, CO_VARKEYWORDS, Parameter, formatannotation, signature
from traceback import walk_tb
from types import EllipsisType, FunctionType, MappingProxyType, NoneType
from typing import Any, cast, get_args

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError, RavemjError

_PYTHONS_ERRORS = (TypeError, AttributeError, ValueError, LookupError, ArithmeticError, MemoryError)
_OURS = (*map(os.path.dirname, (os.path.dirname(__file__), os.__file__, np.__file__)), "<frozen", "<__array_function__")
"""Path prefixes of the code of ravemj, Python and numpy; errors from other code, such as a user's, are not changed.

File names of numpy's compiled code end in ``.pyx``.
"""

_MARK = "__names_arguments__"


def _are_numbers(value: object) -> bool:
    try:
        checked_numbers(cast("ArrayLike", value), "")
    except ArgumentError:
        return False
    return True


def _is_list(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str | bytes)


def _is_any(*classes: type) -> Callable[[object], bool]:
    return lambda value: isinstance(value, classes)


_KINDS: Mapping[str, tuple[str, Callable[[object], bool]]] = MappingProxyType(
    {
        "str": ("a text", _is_any(str)),
        "bytes": ("bytes", _is_any(bytes, bytearray)),
        "int": ("a whole number", _is_any(int, np.integer)),
        "float": ("a number", _is_any(int, float, np.integer, np.floating)),
        "None": ("None", _is_any(NoneType)),
        "EllipsisType": ("...", _is_any(EllipsisType)),
        "PathLike": ("a path", _is_any(os.PathLike)),
        "Callable": ("a function", callable),
        **dict.fromkeys(("Mapping", "dict"), ("a dictionary", _is_any(Mapping))),
        **dict.fromkeys(("Iterable", "Sequence", "MutableSequence", "list", "tuple"), ("a list", _is_list)),
        # numpy's ArrayLike is a Union, and annotations have no other
        **dict.fromkeys(
            ("ArrayLike", "Floats", "Ints", "ndarray", "_SupportsArray", "Union"), ("numbers", _are_numbers)
        ),
        **dict.fromkeys(("bool", "Any", "object", "_empty"), ("anything", _is_any(object))),
    }
)
"""Description for messages, and type check, of each type name in annotations."""


@cache  # so that a function with two names stays one
def explained(function: FunctionType) -> Callable[..., Any]:
    """Wrap a function so that an error of Python caused by a wrong argument type becomes a ``TypeError`` that names it.

    OpenRAVE raises a ``TypeError`` for wrong types, too (test plan-31). Like OpenRAVE, it accepts numpy's 0-dimensional
    arrays as numbers: if a call with such arrays fails, it is repeated with their numbers.
    """
    if hasattr(function, _MARK):
        return function

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:  # noqa: ANN401 - those of the function
        try:
            return function(*args, **kwargs)
        except (ArgumentError, *_PYTHONS_ERRORS) as error:
            if any(map(_is_scalar_array, (*args, *kwargs.values()))):
                return call(*map(_plain, args), **{name: _plain(value) for name, value in kwargs.items()})
            clearer = _clearer(error, function, args, kwargs)
            if clearer is None:
                raise
            raise clearer from error

    setattr(call, _MARK, True)
    return call


def _is_scalar_array(value: object) -> bool:
    return isinstance(value, np.ndarray) and value.ndim == 0


def _plain(value: object) -> object:
    """Return the number in a zero-dimensional array; return other values unchanged."""
    return cast("np.ndarray[Any, Any]", value).item() if _is_scalar_array(value) else value


def explain_methods(kind: type, skipped: Collection[str] = ()) -> None:
    """Wrap the constructor and public methods of a class with ``explained``, except those with names in ``skipped``."""
    for name, method in tuple(vars(kind).items()):
        if (name[0] == "_" and name != "__init__") or name in skipped:
            continue
        if isinstance(method, FunctionType) and _takes(method):
            setattr(kind, name, explained(method))
        inner: object = getattr(method, "__func__", None)
        is_static = isinstance(method, staticmethod)
        if isinstance(inner, FunctionType) and (is_static or isinstance(method, classmethod)):
            setattr(kind, name, (staticmethod if is_static else classmethod)(explained(inner)))


def _takes(method: FunctionType) -> bool:
    """Return whether a method has arguments besides ``self``."""
    code = method.__code__
    return code.co_argcount + code.co_kwonlyargcount > 1 or bool(code.co_flags & (CO_VARARGS | CO_VARKEYWORDS))


def _clearer(
    error: Exception, function: FunctionType, args: tuple[Any, ...], kwargs: dict[str, Any]
) -> Exception | None:
    """Return an error that names the wrong argument; None if none is wrong, or if ``error`` already names it."""
    if isinstance(error, ArgumentError):
        known = {_caller(function, args), *signature(function).parameters} - {"self", "cls"}
        wrong = None if _is_in(known, error) else _wrong_type(function, args, kwargs)
        return None if wrong is None else ArgumentError(f"{wrong[0]}: {error.message}", error.errortype)
    wrong = None if isinstance(error, RavemjError) else _wrong_type(function, args, kwargs)
    return _named(error, function, args, kwargs) if wrong is None else TypeError(": ".join(wrong))


def _wrong_type(function: FunctionType, args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[str, str] | None:
    """Return names of function and argument, and a description, for the first argument of a wrong type, else None."""
    try:
        given = signature(function).bind(*args, **kwargs)
    except TypeError:  # its message names the argument that is missing or unknown
        return None
    for name, value in given.arguments.items():
        parameter = given.signature.parameters[name]
        if name in {"self", "cls"} or parameter.kind in {Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD}:
            continue
        if value is None and (parameter.default is None or NoneType in get_args(parameter.annotation)):
            continue  # an alias of types may hold None
        kinds = _kinds(parameter.annotation)
        if not any(_is_of(value, kind) for kind in kinds):
            description = "None" if value is None else f"of type {type(value).__name__}"
            wanted = " or ".join(
                dict.fromkeys(_KINDS[kind][0] if kind in _KINDS else _with_article(kind) for kind in kinds)
            )
            return f"{_caller(function, args)}: {name}", f"is {description}, and should be {wanted}"
    return None


def _named(error: Exception, function: FunctionType, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Exception | None:
    """Return a copy of an error with the arguments' values; None if it already names one or is from user code."""
    files = [frame.f_code.co_filename for frame, _ in walk_tb(error.__traceback__)]
    if isinstance(error, RavemjError) or not all(file.startswith(_OURS) or file.endswith(".pyx") for file in files):
        return None
    try:
        given = signature(function).bind(*args, **kwargs).arguments
    except TypeError:
        return None
    given = {name: value for name, value in given.items() if name not in {"self", "cls"}}
    if not given or _is_in(given, error):
        return None
    values = ", ".join(f"{name}={reprlib.repr(value)}" for name, value in given.items())
    kind = next(base for base in type(error).__mro__ if base.__module__ == "builtins")  # numpy's take other arguments
    return kind(f"{_caller(function, args)}: {error}; given {values}")


def _is_in(names: Iterable[str], error: Exception) -> bool:
    """Return whether the message of an error has one of the names as a word."""
    return any(re.search(rf"\b{name}\b", str(error)) for name in names)


def _caller(function: FunctionType, args: tuple[Any, ...]) -> str:
    """Return the function's name for messages; for a constructor the class's."""
    return type(args[0]).__name__ if function.__name__ == "__init__" else function.__name__


def _with_article(kind: str) -> str:
    return f"{'an' if kind[0] in 'AEIO' else 'a'} {kind}"


def _kinds(annotation: object) -> list[str]:
    """Return the names of the types in an annotation, without type parameters."""
    text = annotation if isinstance(annotation, str) else formatannotation(annotation)
    while "[" in text:
        text = re.sub(r"\[[^\[\]]*\]", "", text)
    names = [name.strip().rpartition(".")[2] for name in text.split("|")]
    is_enumeration = isinstance(annotation, type) and issubclass(annotation, Enum)
    return [*names, "int"] if is_enumeration else names


def _is_of(value: object, kind: str) -> bool:
    if kind in _KINDS:
        return _KINDS[kind][1](value)
    return any(base.__name__ == kind for base in type(value).__mro__)
