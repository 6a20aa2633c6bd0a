"""Import, translation and execution of Python 2 scripts and modules."""

import functools
import importlib.util
import os
import site
import sys
import sysconfig
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from ravemj.compat.python2.builtin import NAMES
from ravemj.compat.python2.translation import translate

_ENVIRONMENT = [
    os.path.realpath(folder)
    for folder in (
        *(sysconfig.get_path(name) for name in ("purelib", "platlib", "stdlib")),
        *site.getsitepackages(),
        site.getusersitepackages(),
        os.path.dirname(os.path.dirname(__file__)),
    )
]
"""Folders whose modules are never translated: those of installed packages and of ravemj."""


def execute(source: bytes, path: str, names: dict[str, Any]) -> None:
    """Run a script or module.

    Args:
        source: The source in Python 2 or 3.
        path: Its path, for tracebacks.
        names: Its namespace.

    Raises:
        SyntaxError: it is neither; file and line are those of the original.
    """
    try:
        code = translate(importlib.util.decode_source(source), path)
        names.update(NAMES)
    except SyntaxError:
        unchanged = _compile(source, path)
        if unchanged is None:
            raise
        code = unchanged
    exec(code, names)


def is_python2(path: str) -> bool:
    """Return whether a file is Python 2 and not Python 3."""
    try:
        with open(path, "rb") as file:
            source = file.read()
        if _compile(source, path) is not None:
            return False
        translate(importlib.util.decode_source(source), path)
    except (OSError, SyntaxError, ValueError):
        return False
    return True


def _compile(source: bytes, path: str) -> CodeType | None:
    """Compile a file as Python 3; return None if that fails."""
    try:
        return compile(source, path, "exec", dont_inherit=True)
    except (SyntaxError, ValueError):
        return None


def load_source(name: str, path: str) -> ModuleType:
    """Import a file under a name, like ``imp.load_source``."""
    spec = importlib.util.spec_from_file_location(name, path, loader=_Loader(name, path))
    assert spec is not None
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    _Loader(name, path).exec_module(module)
    return module


def install_finder(folder: str) -> None:
    """Install an import hook that translates Python 2 modules in a folder and in folders added to ``sys.path``."""
    here = next(place for place, finder in enumerate(sys.meta_path) if finder is PathFinder)
    sys.meta_path.insert(here, _SourceFinder(folder))  # pyright: ignore[reportArgumentType] - has what finders need


class _SourceFinder:
    """Import finder that locates modules as Python does, and has Python 2 modules translated."""

    def __init__(self, folder: str) -> None:
        self._folder = os.path.realpath(folder)
        self._known = {os.path.realpath(path) for path in sys.path} - {self._folder}

    def find_spec(self, fullname: str, path: Any = None, target: ModuleType | None = None) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader and self._is_old(spec.loader.path):
            spec.loader = _Loader(fullname, spec.loader.path)
        return spec

    def _is_old(self, path: str) -> bool:
        """Return whether a module is treated as Python 2: the script's own modules, and those invalid in Python 3."""
        path = os.path.realpath(path)
        if any(_is_in(path, folder) for folder in _ENVIRONMENT):
            return False
        folders = [folder for folder in map(os.path.realpath, sys.path) if _is_in(path, folder)]
        if folders and max(folders, key=len) not in self._known:
            return True
        folder = Path(path).parent
        return not (_all_compile(folder) if (folder / "__init__.py").exists() else _compiles(Path(path)))


@functools.cache
def _all_compile(folder: Path) -> bool:
    return all(_compiles(path) for path in folder.glob("*.py"))


def _compiles(path: Path) -> bool:
    return _compile(path.read_bytes(), str(path)) is not None


class _Loader(SourceFileLoader):
    """Loader that translates a module; it writes no byte code, since Python 3 would load that."""

    def exec_module(self, module: ModuleType) -> None:
        execute(self.get_data(self.path), self.path, vars(module))


def _is_in(path: str, folder: str) -> bool:
    return path.startswith(os.path.join(folder, ""))
