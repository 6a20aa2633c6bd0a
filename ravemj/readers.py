"""Finds a file and reads it by its kind.

The readers are imported when they are asked for: that takes a while, and not every script reads a file.
"""

# ruff: noqa: PLC0415 - see above

import os
from typing import TYPE_CHECKING
from urllib.parse import unquote

from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.scene import Scene

if TYPE_CHECKING:
    from ravemj.openrave_xml import Reading


def read_file(path: str | os.PathLike[str]) -> "Reading":
    """Read a model file: beside the working folder, or in the folders of ``OPENRAVE_DATA``.

    Args:
        path: An OpenRAVE XML file, or a mesh file, which becomes a static body.

    Returns:
        What was read; its ``failure`` says what ended the reading.
    """
    from ravemj.openrave_xml import Reading, read
    from ravemj.openrave_xml.context import COLLADA_SUFFIXES
    from ravemj.openrave_xml.mesh_body import is_mesh

    found = find(_without_scheme(os.fspath(path)))
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


def read_data(data: str | bytes) -> "Reading":
    """Read the text of an OpenRAVE XML document, as ``read_file`` reads a file."""
    from ravemj.openrave_xml import Reading, read_text

    head = data[:1000] if isinstance(data, bytes) else data[:1000].encode()
    if b"<COLLADA" in head:
        failure = SourceError("this version of ravemj does not read COLLADA yet", Source("data"))
        return Reading(Scene(), Diagnostics(), failure)
    return read_text(data, "data")


def find(name: str) -> str | None:
    """Return the path of a file, or None where it is in no known place."""
    folders = ["", *filter(None, os.environ.get("OPENRAVE_DATA", "").split(os.pathsep))]
    candidates = (os.path.join(folder, name) for folder in folders)
    return next((path for path in candidates if os.path.exists(path)), None)


def _without_scheme(uri: str) -> str:
    """Return the path of a URI ``file:`` or ``openrave:``; anything else as it is."""
    scheme, separator, rest = uri.partition(":")
    if not separator or scheme.lower() not in {"file", "openrave"}:
        return uri
    path = rest.removeprefix("//") if scheme.lower() == "file" else rest.lstrip("/")
    return unquote(path)


def read_mesh_file(path: str) -> "Reading":
    """Read a mesh file as a static body with the file's name."""
    from ravemj.builder import BodyBuilder
    from ravemj.openrave_xml import Reading
    from ravemj.openrave_xml.context import Context
    from ravemj.openrave_xml.mesh_body import add_mesh

    context = Context()
    source = Source(path)
    body = BodyBuilder(is_robot=False, source=source)
    add_mesh(body, path, (1.0, 1.0, 1.0), source, context)
    scene = Scene((body.freeze(context.diagnostics),))
    return Reading(scene, context.diagnostics, None, tuple(context.files))
