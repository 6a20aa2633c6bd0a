"""Files with models: COLLADA, and OpenRAVE XML with its meshes; they appear whole or not at all."""

import io
import os
import zipfile
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Literal
from urllib.parse import quote
from xml.sax.saxutils import escape

from ravemj.core.output import AnyPath, added_files, new_file
from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.formats.collada import read_text
from ravemj.formats.collada import writer as collada
from ravemj.formats.collada.external import ExternalBody, find_external
from ravemj.formats.file_access import FileAccess
from ravemj.formats.openrave_xml import writer as openrave_xml
from ravemj.formats.openrave_xml.geom_writer import FOLDER, MeshFormat
from ravemj.model.comparison import compare
from ravemj.model.scene import UNLIMITED, KinBody, Scene, View

ModelFormat = Literal["collada", "openrave"]

_ARCHIVE_SUFFIX = ".zae"
_COMPRESSION = 2  # of 9: a fifth of the time of the default, and files that are a tenth larger
_NO_TIME = (1980, 1, 1, 0, 0, 0)  # the first that zip archives know, so that one scene always gives the same bytes


def save(
    path: AnyPath,
    scene: Scene,
    diagnostics: Diagnostics,
    kind: ModelFormat = "collada",
    meshes: MeshFormat = "stl",
    external: Mapping[str, ExternalBody] | None = None,
) -> None:
    """Write a scene to a file.

    Args:
        path: The file. COLLADA goes into a zip archive where it ends in ``.zae``.
        scene: What to write.
        diagnostics: Takes a warning for everything that the format cannot say.
        kind: The format.
        meshes: The kind of the files in the folder ``meshes`` beside an OpenRAVE XML file.
        external: Bodies that COLLADA refers to in other files; see ``external_bodies``.

    Raises:
        OutputError: It cannot be written, or a name in it cannot.
    """
    for body in scene.bodies:
        _warn_of_losses(body, diagnostics)
    if kind == "openrave":
        described = [body.name for body in scene.bodies if body.description]
        if described or scene.description:
            message = f"descriptions are left out, of {', '.join(described) or 'the environment'}"
            diagnostics.warn("not-written", message, Source(os.fspath(path)), "COLLADA keeps them")
        _save_openrave_xml(Path(path), openrave_xml.write(scene, diagnostics, meshes))
        return
    if scene.view not in (None, View()):
        message = "background and camera are left out: COLLADA has no place for them"
        diagnostics.warn("not-written", message, Source(os.fspath(path)), "OpenRAVE XML keeps them")
    content = collada.write(scene, diagnostics, external).encode()
    if os.fspath(path).lower().endswith(_ARCHIVE_SUFFIX):
        content = _archive(f"{Path(path).stem}.dae", content)
    with new_file(path) as file:
        file.write_bytes(content)


def _warn_of_losses(body: KinBody, diagnostics: Diagnostics) -> None:
    """Warn of what neither format can say of a body; only scripts and JSON give it."""
    for arm in body.manipulators:
        if arm.gripper_name:
            message = f"the name '{arm.gripper_name}' of the gripper of the manipulator '{arm.name}' is left out"
            diagnostics.warn("not-written", message, arm.source, "OpenRAVE's JSON keeps it")
    for joint in body.all_joints:
        if any(axis.circular and (axis.lower, axis.upper) != (-UNLIMITED, UNLIMITED) for axis in joint.axes):
            message = f"limits of the joint '{joint.name}' are left out: it is circular, and without end in a file"
            diagnostics.warn("not-written", message, joint.source)
    for link in body.links:
        if link.inertial.undefined:
            message = f"the mass of link '{link.name}' is undefined, and becomes {link.inertial.mass:g} kg"
            diagnostics.warn("not-written", message, link.source)
        if any(geometry.collision_mesh is not None for geometry in link.geometries):
            message = f"triangles that a script gave the shapes of link '{link.name}' are left out"
            diagnostics.warn("not-written", message, link.source, "OpenRAVE's JSON keeps them")


def external_bodies(
    path: AnyPath, scene: Scene, names: Collection[str], diagnostics: Diagnostics, scheme: str | None = None
) -> dict[str, ExternalBody]:
    """Return the bodies that a COLLADA file can refer to in the files that they were read from.

    Args:
        path: The file that is going to be written.
        scene: Its bodies; a reference has to give one as it is now.
        names: Names of those that are asked for.
        diagnostics: Takes a warning for each of them that cannot be had by a reference.
        scheme: What URIs of files in the folders of ``OPENRAVE_DATA`` start with; None for relative ones.
    """
    asked = [(number, body) for number, body in enumerate(scene.bodies) if body.name in names]
    found = {body.name: _external(path, body, number, diagnostics, scheme) for number, body in asked}
    return {name: external for name, external in found.items() if external is not None}


def _external(
    path: AnyPath, body: KinBody, number: int, diagnostics: Diagnostics, scheme: str | None
) -> ExternalBody | None:
    """Return a reference to a body in its file; None, with a warning, where reading it gives another body."""
    try:
        reference = find_external(body, number, os.fspath(path), scheme)
        for root in body.links[:1]:
            there = _referred(path, body, reference)
            T_world_file = root.T_world_link @ there.links[0].T_world_link.inverse()
            reference = reference._replace(T_world_file=T_world_file)
        differences = compare(Scene((body,)), Scene((_referred(path, body, reference),)))
        if not differences:
            return reference
        problem = f"{differences[0].part}: {differences[0].quantity} differs"
    except SourceError as error:
        problem = error.message
    message = f"no reference gives '{body.name}' as it is now: {problem}"
    diagnostics.warn("not-referred", message, body.source, "it stands in the new file itself")
    return None


def _referred(path: AnyPath, body: KinBody, reference: ExternalBody) -> KinBody:
    """Return what a reader makes of a reference to a body.

    Raises:
        SourceError: It makes nothing of it.
    """
    document = collada.write(Scene((body,)), Diagnostics(), {body.name: reference})
    found = read_text(document.encode(), os.fspath(path), FileAccess.opened(os.fspath(path))).bodies
    if not found:
        raise SourceError("the reference leads nowhere", body.source)
    return found[0].freeze(Diagnostics())


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
