"""The OpenRAVE API: familiar objects over a ``Simulation``.

``CamelCase`` methods are OpenRAVE's, with OpenRAVE's meaning, argument names and defaults; ``snake_case`` on the same
objects is ravemj's own.
"""

import importlib
import re
from pathlib import Path

from ravemj.core.api_object import published
from ravemj.core.handles import Handle as UserData
from ravemj.errors import RavemjError

_LINES = Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")
_MODULE_OF = {
    name: module
    for module, several, single in re.findall(r"^from (\S+) import (?:\(([^)]*)\)|(.+))$", _LINES, re.MULTILINE)
    for name in re.findall(r"(\w+) as \1\b", several or single)
}
"""Module of each public name, read from the stub that type checkers use."""

OpenRAVEException = openrave_exception = RavemjError

__all__ = ["OpenRAVEException", "UserData", "openrave_exception"]
__all__ += list(_MODULE_OF)  # pyright: ignore[reportUnsupportedDunderAll] - type checkers read the stub


def __getattr__(name: str) -> object:
    """Import the module of a name on first access."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'ravemj.rave' has no attribute '{name}'")
    value = published(getattr(importlib.import_module(_MODULE_OF[name]), name), __name__)
    return globals().setdefault(name, value)
