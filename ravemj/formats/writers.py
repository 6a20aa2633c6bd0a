"""Files with models: COLLADA, and OpenRAVE XML with its meshes; they appear whole or not at all."""

import io
import os
import zipfile
from pathlib import Path
from typing import Literal
from urllib.parse import quote
from xml.sax.saxutils import escape

from ravemj.core.output import AnyPath, added_files, new_file
from ravemj.errors import Diagnostics, Source
from ravemj.formats.collada import writer as collada
from ravemj.formats.openrave_xml import writer as openrave_xml
from ravemj.formats.openrave_xml.geom_writer import FOLDER, MeshFormat
from ravemj.model.scene import Scene, View

ModelFormat = Literal["collada", "openrave"]

_ARCHIVE_SUFFIX = ".zae"
_COMPRESSION = 2  # of 9: a fifth of the time of the default, and files that are a tenth larger
_NO_TIME = (1980, 1, 1, 0, 0, 0)  # the first that zip archives know, so that one scene always gives the same bytes


def save(
    path: AnyPath, scene: Scene, diagnostics: Diagnostics, kind: ModelFormat = "collada", meshes: MeshFormat = "stl"
) -> None:
    """Write a scene to a file.

    Args:
        path: The file. COLLADA goes into a zip archive where it ends in ``.zae``.
        scene: What to write.
        diagnostics: Takes a warning for everything that the format cannot say.
        kind: The format.
        meshes: The kind of the files in the folder ``meshes`` beside an OpenRAVE XML file.

    Raises:
        OutputError: It cannot be written, or a name in it cannot.
    """
    if kind == "openrave":
        _save_openrave_xml(Path(path), openrave_xml.write(scene, diagnostics, meshes))
        return
    if scene.view not in (None, View()):
        message = "background and camera are left out: COLLADA has no place for them"
        diagnostics.warn("not-written", message, Source(os.fspath(path)), "OpenRAVE XML keeps them")
    content = collada.write(scene, diagnostics).encode()
    if os.fspath(path).lower().endswith(_ARCHIVE_SUFFIX):
        content = _archive(f"{Path(path).stem}.dae", content)
    with new_file(path) as file:
        file.write_bytes(content)


def _save_openrave_xml(path: Path, document: openrave_xml.Document) -> None:
    with new_file(path) as file:
        file.write_text(document.text, encoding="utf-8", newline="\n")
        if document.meshes:
            with added_files(path.parent / FOLDER) as folder:
                for name, content in document.meshes.items():
                    (folder / name).write_bytes(content)


def _archive(name: str, content: bytes) -> bytes:
    """Return a ``.zae`` archive: a document, and the manifest that names it."""
    manifest = f'<?xml version="1.0" encoding="utf-8"?>\n<dae_root>./{escape(quote(name))}</dae_root>\n'
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for member, data in ((name, content), ("manifest.xml", manifest.encode())):
            info = zipfile.ZipInfo(member, _NO_TIME)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data, compresslevel=_COMPRESSION)
    return stream.getvalue()
