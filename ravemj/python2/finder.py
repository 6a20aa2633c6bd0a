"""Modules written for Python 2, found where scripts import them and translated while they are read."""

import os
import sys
import sysconfig
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import Any

from ravemj.python2.division import HELPERS
from ravemj.python2.translation import compile_script


def install_finder(folder: str) -> None:
    """Translate from now on the modules in a folder, and those in folders that are added to ``sys.path``."""
    here = next(place for place, finder in enumerate(sys.meta_path) if finder is PathFinder)
    sys.meta_path.insert(here, _Finder(folder))  # pyright: ignore[reportArgumentType] - has what finders need


class _Finder:
    """Finds what Python's own finder does, and has it translated."""

    def __init__(self, folder: str) -> None:
        self._folder = os.path.realpath(folder)
        self._known = {os.path.realpath(path) for path in sys.path} - {self._folder}
        self._installed = [os.path.realpath(sysconfig.get_path(name)) for name in ("purelib", "platlib", "stdlib")]

    def find_spec(self, fullname: str, path: Any = None, target: ModuleType | None = None) -> ModuleSpec | None:  # noqa: ANN401 - as Python passes it
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader and self._is_neighbour(spec.loader.path):
            spec.loader = _Loader(fullname, spec.loader.path)
        return spec

    def _is_neighbour(self, path: str) -> bool:
        path = os.path.realpath(path)
        if any(_is_in(path, folder) for folder in self._installed):
            return False
        added = {os.path.realpath(folder) for folder in sys.path} - self._known
        return any(_is_in(path, folder) for folder in {self._folder, *added})


class _Loader(SourceFileLoader):
    """Translates a module; keeps no byte code, which Python 3 would take for its own."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = ModuleType(spec.name)
        module.__dict__.update(HELPERS)
        return module

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return compile_script(self.get_data(path), path)


def _is_in(path: str, folder: str) -> bool:
    return path.startswith(os.path.join(folder, ""))
