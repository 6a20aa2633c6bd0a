"""Finds a file and reads it by its kind."""

import os

from ravemj.builder import BodyBuilder
from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.openrave_xml import Reading, read
from ravemj.openrave_xml.context import COLLADA_SUFFIXES, Context
from ravemj.openrave_xml.mesh_body import add_mesh, is_mesh
from ravemj.scene import Scene


def read_file(path: str | os.PathLike[str]) -> Reading:
    """Read a model file: beside the working folder, or in the folders of ``OPENRAVE_DATA``.

    Args:
        path: An OpenRAVE XML file, or a mesh file, which becomes a static body.

    Returns:
        What was read; its ``failure`` says what ended the reading.
    """
    found = find(os.fspath(path))
    if found is None:
        failure = SourceError("there is no such file", Source(os.fspath(path)), "check the path, or set OPENRAVE_DATA")
    elif not os.path.isfile(found):
        kind = "folder" if os.path.isdir(found) else "device or pipe"
        failure = SourceError(f"this is a {kind}, not a model file", Source(found))
    elif found.lower().endswith(COLLADA_SUFFIXES):
        failure = SourceError("this version of ravemj does not read COLLADA yet", Source(found))
    else:
        return read_mesh_file(found) if is_mesh(found) else read(found)
    return Reading(Scene(), Diagnostics(), failure)


def find(name: str) -> str | None:
    """Return the path of a file, or None where it is in no known place."""
    folders = ["", *filter(None, os.environ.get("OPENRAVE_DATA", "").split(os.pathsep))]
    candidates = (os.path.join(folder, name) for folder in folders)
    return next((path for path in candidates if os.path.exists(path)), None)


def read_mesh_file(path: str) -> Reading:
    """Read a mesh file as a static body with the file's name."""
    context = Context()
    source = Source(path)
    body = BodyBuilder(is_robot=False, source=source)
    add_mesh(body, path, (1.0, 1.0, 1.0), source, context)
    scene = Scene((body.freeze(context.diagnostics),))
    return Reading(scene, context.diagnostics, None, tuple(context.files))
