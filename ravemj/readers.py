"""Finds a file and reads it by its kind."""

import os

from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.openrave_xml import Reading, read
from ravemj.scene import Scene

_COLLADA = (".dae", ".zae")


def read_file(path: str | os.PathLike[str]) -> Reading:
    """Read a model file: beside the working folder, or in the folders of ``OPENRAVE_DATA``.

    Args:
        path: An OpenRAVE XML file.

    Returns:
        What was read; its ``failure`` says what ended the reading.
    """
    found = find(os.fspath(path))
    if found is None:
        failure = SourceError("there is no such file", Source(os.fspath(path)), "check the path, or set OPENRAVE_DATA")
    elif os.path.isdir(found):
        failure = SourceError("this is a folder, not a model file", Source(found))
    elif found.lower().endswith(_COLLADA):
        failure = SourceError("this version of ravemj does not read COLLADA yet", Source(found))
    else:
        return read(found)
    return Reading(Scene(), Diagnostics(), failure)


def find(name: str) -> str | None:
    """Return the path of a file, or None where it is in no known place."""
    folders = ["", *filter(None, os.environ.get("OPENRAVE_DATA", "").split(os.pathsep))]
    candidates = (os.path.join(folder, name) for folder in folders)
    return next((path for path in candidates if os.path.exists(path)), None)
