"""Initialization of the library, its folders and plugins."""

import logging
import os
import time
from pathlib import Path

from ravemj.formats.data_folders import find, name_in_data_folders
from ravemj.rave import logs
from ravemj.rave.enums import DebugLevel

_LOG = logging.getLogger("ravemj")

_PLUGINS = """
    basecontrollers basesamplers basesensors bulletrave configurationcache fclrave grasper ikfastsolvers logging oderave
    or_urdf pqprave qtcoinrave qtosgrave rmanipulation rplanners
"""
"""OpenRAVE's and or_urdf's plugins whose features ravemj includes."""


def RaveInitialize(load_all_plugins: bool = True, level: int | None = None) -> int:
    """Create the folder of ``RaveGetHomeDirectory()`` and set the log level; importing has initialized everything else.

    If the folder cannot be created, a warning is logged.

    Args:
        load_all_plugins: Not used; there are no plugins.
        level: A ``DebugLevel``; by default ``Info``.

    Returns:
        0 for success.
    """
    del load_all_plugins
    logs.RaveSetDebugLevel(DebugLevel.Info if level is None else level)
    try:
        os.makedirs(RaveGetHomeDirectory(), exist_ok=True)
    except (OSError, RuntimeError) as error:  # Path.home raises RuntimeError if the user has no home folder
        _LOG.warning("RaveInitialize: the folder of OPENRAVE_HOME cannot be made: %s", error)
    return 0


def RaveLoadPlugin(filename: str) -> bool:
    """Return whether ravemj provides the features of an OpenRAVE plugin; native plugins cannot be loaded.

    Args:
        filename: Name of the plugin, or its file.

    Returns:
        True for or_urdf and for OpenRAVE's own plugins; ravemj contains those of their interfaces that it supports.
        False for all others, as in OpenRAVE when it cannot load a plugin; a warning is logged.
    """
    if Path(filename).name.split(".")[0].removeprefix("lib") in _PLUGINS.split():
        return True
    _LOG.warning("RaveLoadPlugin: native plugins cannot be loaded, and %s is not", filename)
    return False


def RaveReloadPlugins() -> None:
    """Do nothing; there are no plugins."""


def RaveGetPluginInfo() -> list[tuple[str, object]]:
    """Return an empty list, since there are no plugins."""
    return []


def RaveGetHomeDirectory() -> str:
    """Return the folder for persistent data: ``OPENRAVE_HOME``, or ``.openrave`` in the home folder."""
    return os.environ.get("OPENRAVE_HOME") or str(Path.home() / ".openrave")


def RaveFindDatabaseFile(filename: str, bRead: bool = True) -> str:
    """Return the path of a file in the folders of ``OPENRAVE_DATABASE``, or else in ``RaveGetHomeDirectory()``.

    Args:
        filename: Path relative to one of these folders.
        bRead: True finds an existing file. False returns a path for writing, in the first folder.

    Returns:
        The path, or an empty text.
    """
    folders = [*filter(None, os.environ.get("OPENRAVE_DATABASE", "").split(os.pathsep)), RaveGetHomeDirectory()]
    paths = [os.path.join(folder, filename) for folder in folders]
    return next((path for path in paths if not bRead or os.path.exists(path)), "")


_data_access = 0


def RaveSetDataAccess(accessoptions: int) -> None:
    """Set the folders that ``RaveFindLocalFile`` searches. Loading of files is not restricted.

    Args:
        accessoptions: 0 searches everywhere; 1 searches only the folders of ``OPENRAVE_DATA``.
    """
    global _data_access  # noqa: PLW0603 - OpenRAVE's function sets it for the process
    _data_access = int(accessoptions)


def RaveGetDataAccess() -> int:
    """Return the value of ``RaveSetDataAccess``; 0 by default."""
    return _data_access


def RaveInvertFileLookup(filename: str) -> str:
    """Return the path of ``filename`` relative to its folder of ``OPENRAVE_DATA``; empty if it is in none."""
    return name_in_data_folders(filename)


def RaveGetDefaultViewerType() -> str:
    """Return the viewer of ``env.SetDefaultViewer``: the value of ``OPENRAVE_DEFAULT_VIEWER``, else ``qtcoin``."""
    return os.environ.get("OPENRAVE_DEFAULT_VIEWER") or "qtcoin"


def GetNanoTime() -> int:
    """Return the time since 1970 [ns]."""
    return time.time_ns()


def GetMicroTime() -> int:
    """Return the time since 1970 [microseconds]."""
    return time.time_ns() // 1000


def GetMilliTime() -> int:
    """Return the time since 1970 [ms]."""
    return time.time_ns() // 1_000_000


def RaveFindLocalFile(filename: str, curdir: str = "") -> str:
    """Search a file in a folder, then in the working folder and those of ``OPENRAVE_DATA``; return its path.

    Args:
        filename: A path, relative to the folder or to one of ``OPENRAVE_DATA``.
        curdir: The folder to search first.

    Returns:
        The absolute path, or an empty text.
    """
    file = find(filename, curdir, "")
    if not file or (_data_access and not RaveInvertFileLookup(file)):
        return ""
    return os.path.abspath(file)
