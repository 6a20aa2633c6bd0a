"""Alias ``import openravepy`` for ravemj: in this process, or in the whole Python environment.

Importing ravemj alone changes nothing. ``install_finder`` acts for the running process (``ravemj run``,
``%load_ext ravemj``); ``install_package`` installs a package of a few lines (``ravemj alias --install``), so that old
scripts run without changes.
"""

import shutil
import sys
import sysconfig
from pathlib import Path

from ravemj.compat import names
from ravemj.errors import OutputError, RavemjError

NAME = names.OPENRAVEPY
_MARK = "made by ravemj alias --install"
_PACKAGE = f'''"""Scripts that import openravepy get ravemj; {_MARK}, removed by ravemj alias --remove."""

from ravemj.compat import names

names.install(__name__)
names.take_over(__name__)
'''


def install_finder() -> None:
    """Make ``import openravepy`` import ravemj in this process."""
    names.install(NAME)


def package_folder() -> Path:
    """Return the folder of the package ``openravepy`` that ``install_package`` creates."""
    return Path(sysconfig.get_path("purelib")) / NAME


def install_package() -> Path:
    """Install a package ``openravepy`` that forwards to ravemj into the current Python environment.

    Returns:
        Its folder.

    Raises:
        RavemjError: another openravepy is installed.
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
    """Remove the package of ``install_package``.

    Returns:
        The removed folder, or None if there was none.

    Raises:
        RavemjError: another openravepy is installed.
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
    """Return the path of another ``openravepy`` that would be imported, or None."""
    finders = [finder for finder in sys.meta_path if not isinstance(finder, names.Renamed)]
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
