"""Folders of the environment variable ``OPENRAVE_DATA``, in which files are searched."""

import os

from ravemj.errors import Source, SourceError


def data_folders() -> list[str]:
    """Return the folders in search order."""
    return [folder for folder in os.environ.get("OPENRAVE_DATA", "").split(os.pathsep) if folder]


def find(name: str, *folders: str) -> str | None:
    """Search for a file in folders and in those of ``OPENRAVE_DATA``; return its path, or None.

    Args:
        name: The file, relative to a folder.
        folders: Folders to search first; ``""`` is the working folder.
    """
    candidates = (os.path.join(folder, name) for folder in (*folders, *data_folders()))
    return next((path for path in candidates if os.path.exists(path)), None)


def existing(name: str) -> str:
    """Return the path of a file in the working folder or one of ``OPENRAVE_DATA``.

    Raises:
        SourceError: It is in none of them.
    """
    path = find(name, "")
    if path is None:
        raise SourceError("there is no such file", Source(name), "check the path, or set OPENRAVE_DATA")
    return path


def name_in_data_folders(path: str) -> str:
    """Return the path of a file relative to the first data folder that contains it; empty if there is none."""
    absolute = os.path.abspath(path)
    inside = (
        folder for folder in map(os.path.abspath, data_folders()) if absolute.startswith(os.path.join(folder, ""))
    )
    return next((os.path.relpath(absolute, folder) for folder in inside), "")
