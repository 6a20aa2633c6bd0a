"""``import openravepy`` gives ravemj: in this process, or in the whole Python environment.

Importing ravemj alone changes nothing. ``install_finder`` acts for the running process (``ravemj run``,
``%load_ext ravemj``); ``install_package`` puts a package of a few lines where Python looks for packages
(``ravemj alias --install``), so that old scripts run by themselves.
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
    """Make ``import openravepy`` give ravemj, in this process."""
    names.install(NAME)


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
