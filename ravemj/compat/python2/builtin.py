"""Built-in names of Python 2 that Python 3 lacks or has changed."""

# Values of old scripts have no types.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownParameterType=false

import builtins
import functools
import importlib
import importlib.util
import inspect
import itertools
import sys
from collections.abc import Callable, Iterable, Mapping
from decimal import ROUND_HALF_UP, Context, Decimal
from types import ModuleType
from typing import Any, Literal

from ravemj.compat.python2 import methods
from ravemj.compat.python2.division import DIVIDE, DIVISOR, Divisor, divide
from ravemj.compat.python2.files import File
from ravemj.compat.python2.modules import ModuleView, import_
from ravemj.compat.python2.numpy1 import item
from ravemj.compat.python2.statements import CODE, ITEM, MESSAGE, METHOD
from ravemj.compat.python2.translation import translate


def _apply(function: Callable[..., Any], args: Iterable[Any] = (), options: Mapping[str, Any] | None = None) -> Any:
    return function(*args, **(options or {}))


def _cmp(x: Any, y: Any) -> int:
    return int(x > y) - int(x < y)


def _filter(function: Callable[[Any], Any] | None, sequence: Any) -> Any:
    kept = list(builtins.filter(function, sequence))
    if isinstance(sequence, str):
        return "".join(kept)
    return tuple(kept) if isinstance(sequence, tuple) else kept


def _map(function: Callable[..., Any] | None, *sequences: Iterable[Any]) -> list[Any]:
    """Return a list like Python 2's ``map``, which pads shorter sequences with None."""
    rows = list(sequences[0]) if len(sequences) == 1 else list(itertools.zip_longest(*sequences))
    if function is None:
        return rows
    return [function(row) for row in rows] if len(sequences) == 1 else [function(*row) for row in rows]


def _range(*limits: int) -> list[int]:
    return list(builtins.range(*limits))


def _zip(*sequences: Iterable[Any]) -> list[tuple[Any, ...]]:
    return list(builtins.zip(*sequences, strict=False))


def _round(number: Any, ndigits: int = 0) -> float:
    """Round halves away from zero, as Python 2 does."""
    exact = Decimal(float(item(number)))
    if not exact.is_finite():
        return float(exact)
    return float(exact.quantize(Decimal((0, (1,), -ndigits)), ROUND_HALF_UP, Context(prec=2000)))


def _message(error: Any) -> Any:
    """Return the attribute ``message``; for exceptions without it, the value in Python 2."""
    if hasattr(error, "message") or not isinstance(error, BaseException):
        return error.message
    return error.args[0] if len(error.args) == 1 else ""


def _open(name: str, mode: str = "r", buffering: int = -1, **options: Any) -> Any:
    return builtins.open(name, mode, buffering, **options) if options else File(name, mode, buffering)


def _reload(module: ModuleType) -> ModuleType:
    return module if isinstance(module, ModuleView) else importlib.reload(module)


# Code


def _code(source: Any, mode: Literal["exec", "eval"], path: str = "<string>") -> Any:
    """Compile the argument of ``exec`` or ``eval``: text, bytes or an open file; return a code object unchanged."""
    source = source.read() if isinstance(source, File) else source
    source = importlib.util.decode_source(source) if isinstance(source, bytes) else source
    if not isinstance(source, str):
        return source
    if mode == "eval":
        source = source.strip()
        if "/" not in source:
            try:
                return builtins.compile(source, path, mode, dont_inherit=True)  # much faster, and mostly sufficient
            except SyntaxError:
                pass
    return translate(source, path, mode)


def _compile(source: Any, filename: str, mode: Any, *args: Any, **options: Any) -> Any:
    if mode == "single" or args or options:
        return builtins.compile(source, filename, mode, *args, **options)
    return _code(source, mode, filename)


def _input(prompt: object = "") -> Any:
    """Evaluate a line of user input in the caller's scope, as Python 2's ``input`` does."""
    frame = inspect.currentframe()
    assert frame is not None
    caller = frame.f_back
    assert caller is not None
    return eval(_code(builtins.input(prompt), "eval"), caller.f_globals, caller.f_locals)


_FOR_TRANSLATIONS = {
    CODE: _code,
    DIVIDE: divide,
    DIVISOR: Divisor,
    ITEM: item,
    MESSAGE: _message,
    METHOD: methods.call,
}
_OLD = {
    "apply": _apply,
    "basestring": str,
    "cmp": _cmp,
    "compile": _compile,
    "file": File,
    "filter": _filter,
    "input": _input,
    "intern": sys.intern,
    "long": int,
    "map": _map,
    "open": _open,
    "range": _range,
    "raw_input": input,
    "reduce": functools.reduce,
    "reload": _reload,
    "round": _round,
    "sorted": methods.sort,
    "StandardError": Exception,
    "unichr": chr,
    "unicode": str,
    "xrange": range,
    "zip": _zip,
    "__import__": import_,
    "__openravepy_build_doc__": False,
}
OLD_NAMES = frozenset(_OLD) - frozenset(vars(builtins))
"""Built-in names that Python 3 does not have."""

BUILTIN = ModuleType("__builtin__")
"""Module ``__builtin__`` of scripts."""
vars(BUILTIN).update({**vars(builtins), **_OLD, **_FOR_TRANSLATIONS})
NAMES: dict[str, object] = {"__builtins__": BUILTIN}
"""Initial namespace of a translated script."""
