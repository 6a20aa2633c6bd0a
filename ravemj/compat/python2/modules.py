"""Imports of Python 2, with the old names of modules.

Scripts use views of modules; other code uses the modules themselves.
"""

import __future__

import builtins
import functools
import importlib
import importlib.util
import pkgutil
import sys
from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

from ravemj.compat.python2 import library, numpy1

_NAMES = {**library.NAMES, "numpy": numpy1.NAMES, "ravemj.compat.openravepy": {}}  # the last one has numpy in it


class ModuleView(ModuleType):
    """View of a module with its Python 2 names; modules in it are views, too.

    Args:
        module: The module; attributes set on the view are set on it.
        names: The values of the Python 2 names; a string is the location of a value in Python 3.
    """

    def __init__(self, module: ModuleType, names: Mapping[str, object]) -> None:
        super().__init__(module.__name__)
        public: Sequence[str] = getattr(module, "__all__", [name for name in dir(module) if name[0] != "_"])
        places = {name: place for name, place in names.items() if isinstance(place, str)}
        values = {name: value for name, value in names.items() if name not in places}
        for name in ("__doc__", "__loader__", "__package__", "__spec__"):
            del vars(self)[name]
        vars(self).update({"__all__": [*public, *names], "_module_": module, "_places_": places, **values})

    def __getattr__(self, name: str) -> object:
        place = vars(self)["_places_"].get(name)
        value = pkgutil.resolve_name(place) if place else getattr(vars(self)["_module_"], name)
        return view(value) if isinstance(value, ModuleType) else value

    def __setattr__(self, name: str, value: object) -> None:
        setattr(vars(self)["_module_"], name, value)

    def __dir__(self) -> list[str]:
        return sorted({*dir(vars(self)["_module_"]), *vars(self)["__all__"]})


@functools.cache
def view(module: ModuleType) -> ModuleType:
    """Return a module, or a view if it lacks Python 2 names."""
    names = _NAMES.get(module.__name__)
    return module if names is None else ModuleView(module, names)


def import_(
    name: str,
    globals: Mapping[str, Any] | None = None,
    locals: Mapping[str, Any] | None = None,
    fromlist: Sequence[str] | None = None,
    level: int = -1,
) -> ModuleType:
    """Import a module for a script: first from its own package, then by its Python 2 name."""
    importer = globals or {}
    if level > 0 or _is_beside(name, importer):
        return view(builtins.__import__(name, globals, locals, fromlist or (), max(level, 1)))
    if name == "__builtin__":
        return importer["__builtins__"]
    if (name in library.RENAMED or name in _NAMES) and (name == "imp" or not _exists(name)):  # before 3.12, imp warns
        return _older(name, bool(fromlist))
    return view(builtins.__import__(name, globals, locals, fromlist or ()))


def _is_beside(name: str, importer: Mapping[str, Any]) -> bool:
    """Return whether Python 2 would find the module in the importer's package (implicit relative import)."""
    package = importer.get("__package__")
    if not package or importer.get("absolute_import") is __future__.absolute_import:
        return False
    return _exists(f"{package}.{name.partition('.')[0]}")


def _exists(name: str) -> bool:
    try:
        return name in sys.modules or importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:  # its package
        return False


def _older(name: str, is_last: bool) -> ModuleType:
    """Import a module by its Python 2 name; return it if ``is_last``, else the top-level package of the name."""
    module = importlib.import_module(library.RENAMED[name]) if name in library.RENAMED else _empty(name)
    first, _, rest = name.partition(".")
    return view(module if is_last or not rest else importlib.import_module(first))


@functools.cache
def _empty(name: str) -> ModuleType:
    return ModuleType(name)
