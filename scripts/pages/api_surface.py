"""OpenRAVE's public names, read from ``tests/data/surface.txt``, and which of them are there.

Each line of the file is a name of openravepy 0.149.1: its module, a colon, its path, its kind, and the names of the
arguments of each overload, or the value of a member of an enumeration.
"""

import importlib
import inspect
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ravemj.compat import alias

_LIST = Path(__file__).resolve().parents[2] / "tests" / "data" / "surface.txt"
_MISSING = object()


class Name(NamedTuple):
    """A name of OpenRAVE's.

    Attributes:
        module: The module, for instance ``openravepy``.
        path: The name in it, with those of classes around it.
        kind: ``class``, ``method``, ``enum``, ...; ``=`` for a member of an enumeration.
        rest: Overloads, or the value.
    """

    module: str
    path: str
    kind: str
    rest: str

    @property
    def owner(self) -> str:
        """The class, or the module of what stands in none."""
        return f"{self.module}.{self.path}".rpartition(".")[0] if "." in self.path else self.module

    @property
    def overloads(self) -> list[list[str]]:
        """The names of the arguments of each overload."""
        return [one.strip()[1:-1].split() for one in self.rest.split("|")] if self.rest.startswith("(") else []


@cache
def names() -> list[Name]:
    """Return all names, in the order of the file."""
    found: list[Name] = []
    for line in _LIST.read_text(encoding="utf-8").splitlines():
        place, kind, *rest = line.split(" ", 2)
        module, _, path = place.partition(":")
        found.append(Name(module, path, kind, rest[0] if rest else ""))
    return found


def thing_of(name: Name) -> object:
    """Return what has a name here; a mark where nothing has."""
    alias.install_finder()
    try:
        thing: object = importlib.import_module(name.module)
    except ImportError:
        return _MISSING
    for word in name.path.split("."):
        thing = getattr(thing, word, _MISSING)
    return thing


def is_there(name: Name) -> bool:
    """Return whether a name exists; of a member of an enumeration, with OpenRAVE's number."""
    thing = thing_of(name)
    if name.kind == "=":
        return thing is not _MISSING and int(thing) == int(name.rest)  # type: ignore[call-overload]
    return thing is not _MISSING


def refused_arguments(name: Name) -> Iterator[str]:
    """Yield the overloads whose arguments a function does not take by their names."""
    thing = thing_of(name)
    if not callable(thing) or name.kind == "property":
        return
    bound = 1 if name.kind == "method" and inspect.isfunction(thing) else 0
    for overload in name.overloads:
        if not _accepts(thing, overload, bound):
            yield f"{name.module}.{name.path}({', '.join(overload)})"


def _accepts(function: object, overload: list[str], bound: int) -> bool:
    try:
        parameters = inspect.signature(function).parameters.values()  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return True
    if any(one.kind is one.VAR_KEYWORD for one in parameters):
        return True
    known = {one.name for one in parameters if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)}
    positional = sum(one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD) for one in parameters)
    anything = any(one.kind is one.VAR_POSITIONAL for one in parameters)
    wanted = {word for word in overload if not word.startswith(("arg", "*"))}
    return wanted <= known and (anything or len(overload) + bound <= positional)
