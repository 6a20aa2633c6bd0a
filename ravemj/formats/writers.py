"""Atomic writing of model files: COLLADA, OpenRAVE XML and URDF with their meshes."""

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
from ravemj.formats.urdf import writer as urdf
from ravemj.formats.urdf.shape_writer import FOLDER as MESHES
from ravemj.model.comparison import compare
from ravemj.model.scene import UNLIMITED, KinBody, Scene, View

ModelFormat = Literal["collada", "openrave", "urdf"]

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
        path: The file. COLLADA is written to a zip archive if the suffix is ``.zae``.
        scene: The scene.
        diagnostics: Receives a warning for everything that the format cannot represent.
        kind: The format.
        meshes: The format of the files in the folder ``meshes`` beside an OpenRAVE XML file.
        external: Bodies to which COLLADA refers in other files; see ``external_bodies``.

    Raises:
        OutputError: The file or a name in it cannot be written.
    """
    if kind == "urdf":
        _save_urdf(Path(path), scene, diagnostics)
        return
    for body in scene.bodies:
        _warn_of_losses(body, diagnostics)
    if kind == "openrave":
        _save_openrave_xml(Path(path), scene, diagnostics, meshes)
    else:
        _save_collada(Path(path), scene, diagnostics, external)


def _save_urdf(path: Path, scene: Scene, diagnostics: Diagnostics) -> None:
    """Write a robot's URDF, its SRDF beside that, and its meshes into a folder."""
    document = urdf.write(scene, diagnostics)
    with new_file(path) as file:
        file.write_text(document.urdf, encoding="utf-8", newline="\n")
        with new_file(path.with_suffix(".srdf")) as other:
            other.write_text(document.srdf, encoding="utf-8", newline="\n")
        if document.meshes:
            with added_files(path.parent / MESHES) as folder:
                for name, content in document.meshes.items():
                    (folder / name).write_bytes(content)


def _save_collada(
    path: Path, scene: Scene, diagnostics: Diagnostics, external: Mapping[str, ExternalBody] | None
) -> None:
    if scene.view not in (None, View()):
        message = "background and camera are left out: COLLADA has no place for them"
        diagnostics.warn("not-written", message, Source(str(path)), "OpenRAVE XML keeps them")
    content = collada.write(scene, diagnostics, external).encode()
    if path.suffix.lower() == _ARCHIVE_SUFFIX:
        content = _archive(f"{path.stem}.dae", content)
    with new_file(path) as file:
        file.write_bytes(content)


def _warn_of_losses(body: KinBody, diagnostics: Diagnostics) -> None:
    """Warn of properties of a body that only scripts and JSON can represent."""
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
        path: The file to write.
        scene: Its bodies; reading a reference must reproduce the present body.
        names: Names of the bodies to refer to.
        diagnostics: Receives a warning for each body that a reference does not reproduce.
        scheme: Scheme of URIs of files in the folders of ``OPENRAVE_DATA``; None for relative URIs.
    """
    asked = [(number, body) for number, body in enumerate(scene.bodies) if body.name in names]
    references = {body.name: _external(path, body, number, diagnostics, scheme) for number, body in asked}
    return {name: external for name, external in references.items() if external is not None}


def _external(
    path: AnyPath, body: KinBody, number: int, diagnostics: Diagnostics, scheme: str | None
) -> ExternalBody | None:
    """Return a reference to a body in the file ``path``; None, with a warning, if the body there differs."""
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
    """Return the body that a reader obtains from a reference; raise if the reference cannot be read."""
    document = collada.write(Scene((body,)), Diagnostics(), {body.name: reference})
    bodies = read_text(document.encode(), os.fspath(path), FileAccess.opened(os.fspath(path))).bodies
    if not bodies:
        raise SourceError("the reference leads nowhere", body.source)
    return bodies[0].freeze(Diagnostics())


def _save_openrave_xml(path: Path, scene: Scene, diagnostics: Diagnostics, meshes: MeshFormat) -> None:
    described = [body.name for body in scene.bodies if body.description]
    if described or scene.description:
        message = f"descriptions are left out, of {', '.join(described) or 'the environment'}"
        diagnostics.warn("not-written", message, Source(str(path)), "COLLADA keeps them")
    document = openrave_xml.write(scene, diagnostics, meshes)
    with new_file(path) as file:
        file.write_text(document.text, encoding="utf-8", newline="\n")
        if document.meshes:
            with added_files(path.parent / FOLDER) as folder:
                for name, content in document.meshes.items():
                    (folder / name).write_bytes(content)


def _archive(name: str, content: bytes) -> bytes:
    """Return a ``.zae`` archive of a document called ``name``, with a manifest."""
    manifest = f'<?xml version="1.0" encoding="utf-8"?>\n<dae_root>./{escape(quote(name))}</dae_root>\n'
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for member, data in ((name, content), ("manifest.xml", manifest.encode())):
            info = zipfile.ZipInfo(member, _NO_TIME)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data, compresslevel=_COMPRESSION)
    return stream.getvalue()
