"""``import openravepy`` gives ravemj: in this process, or in the whole Python environment.

Importing ravemj alone changes nothing. ``install_finder`` acts for the running process (``ravemj run``,
``%load_ext ravemj``); ``install_package`` puts a package of a few lines where Python looks for packages
(``ravemj alias --install``), so that old scripts run by themselves.
"""

import importlib
import importlib.util
import shutil
import sys
import sysconfig
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

from ravemj.errors import OutputError, RavemjError

NAME = "openravepy"
_MARK = "made by ravemj alias --install"
_PACKAGE = f'''"""Scripts that import openravepy get ravemj; {_MARK}, removed by ravemj alias --remove."""

import ravemj.compat.alias

ravemj.compat.alias.install_finder()
ravemj.compat.alias.take_over(__name__)
'''


class _Finder(MetaPathFinder, Loader):
    """Answers imports of ``openravepy`` and its sub-modules with the modules of ravemj."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return a spec for ``openravepy`` and for its sub-modules that ravemj has."""
        del path, target
        if fullname.partition(".")[0] != NAME or not _exists(_translated(fullname)):
            return None
        return ModuleSpec(fullname, self)

    def exec_module(self, module: ModuleType) -> None:
        """Put ravemj's module in place of the empty one."""
        take_over(module.__name__)


def install_finder() -> None:
    """Make ``import openravepy`` give ravemj, in this process."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


def take_over(name: str) -> None:
    """Register ravemj's module under a name of openravepy's."""
    sys.modules[name] = importlib.import_module(_translated(name))


def _translated(name: str) -> str:
    """Return ravemj's module for a name of openravepy's."""
    return "ravemj.compat.openravepy" if name == NAME else "ravemj" + name.removeprefix(NAME)


def _exists(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def package_folder() -> Path:
    """Return where ``install_package`` puts its package: among the packages of this Python environment."""
    return Path(sysconfig.get_path("purelib")) / NAME


def install_package() -> Path:
    """Put a package ``openravepy`` that forwards to ravemj into the current Python environment.

    Returns:
        Its folder.

    Raises:
        RavemjError: there is an openravepy that is not ours.
        OutputError: the environment cannot be written.
    """
    folder = package_folder()
    other = _foreign_package()
    if other is not None:
        raise RavemjError(f"there is another openravepy at {other}, which stays; remove it first if you want this one")
    try:
        folder.mkdir(exist_ok=True)
        (folder / "__init__.py").write_text(_PACKAGE, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {folder}: {(error.strerror or str(error)).lower()}") from None
    return folder


def remove_package() -> Path | None:
    """Take the package of ``install_package`` out again.

    Returns:
        The folder that is gone, or None where there was none.

    Raises:
        RavemjError: there is an openravepy that is not ours.
        OutputError: the environment cannot be written.
    """
    folder = package_folder()
    if not folder.exists():
        return None
    if not _is_ours(folder):
        raise RavemjError(f"the openravepy at {folder} is not made by ravemj, and stays")
    try:
        shutil.rmtree(folder)
    except OSError as error:
        raise OutputError(f"cannot remove {folder}: {(error.strerror or str(error)).lower()}") from None
    return folder


def _foreign_package() -> str | None:
    """Return where Python finds an openravepy that is not ours, or None."""
    finders = [finder for finder in sys.meta_path if not isinstance(finder, _Finder)]
    for finder in finders:
        spec = finder.find_spec(NAME, None)
        if spec is not None:
            places = [*(spec.submodule_search_locations or ()), *([spec.origin] if spec.origin else [])]
            return None if any(_is_ours(Path(place)) for place in places) else ", ".join(places[:1])
    return None


def _is_ours(folder: Path) -> bool:
    try:
        return _MARK in (folder / "__init__.py").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
