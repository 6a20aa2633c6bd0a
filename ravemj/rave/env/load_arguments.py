"""Arguments of the methods that load models."""

import os
from collections.abc import Mapping
from typing import cast

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError, Diagnostics, Source, send_warnings
from ravemj.rave.kinbody import KinBody

Attributes = Mapping[str, str]
"""Attributes for the bodies of a file, by name; see ``Load``."""

Text = str | bytes | os.PathLike[str]
Argument = KinBody | Text | Attributes | None


def warn_of_attributes(path: str, given: Attributes) -> None:
    """Warn of attributes for a JSON file, which has a name for everything already."""
    diagnostics = Diagnostics()
    for name in given:
        diagnostics.warn("unknown-attribute", f"nothing reads '{name}' for a JSON file", Source(path))
    send_warnings(diagnostics)


def read_arguments(
    caller: str, arguments: tuple[Argument, ...], named: dict[str, Argument]
) -> tuple[KinBody | None, str | bytes, Attributes]:
    """Return the body to fill, if one is given, the file or text, and the attributes."""
    given = [*arguments, *(named.pop(name) for name in ("filename", "data", "atts") if name in named)]
    if named:
        raise TypeError(f"{caller}: has no argument {', '.join(named)}")
    into = given[0] if given and isinstance(given[0], KinBody) else None
    text, atts, *rest = *(given if into is None else given[1:]), None, None
    if len(rest) > 2 or not isinstance(text, str | bytes | os.PathLike):
        raise ArgumentError(f"{caller}: takes a text, optionally after a body and before attributes, not {arguments!r}")
    return into, os.fspath(text), checked_attributes(atts, caller)


def checked_attributes(atts: object, caller: str) -> Attributes:
    """Return attributes that a user gave, with their names in lower case.

    Raises:
        ArgumentError: they are no texts by names.
    """
    if atts is None:
        return {}
    given = cast("Mapping[object, object]", checked_kind(atts, Mapping, f"{caller}: atts", "a dict of texts"))
    wanted = f"{caller}: atts: a name or value"
    return {
        checked_kind(name, str, wanted, "a text").lower(): checked_kind(value, str, wanted, "a text")
        for name, value in given.items()
    }
