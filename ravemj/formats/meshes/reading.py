"""Selection of the mesh reader by the file's suffix, as in OpenRAVE."""

import importlib
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ravemj.core.transforms import UNSCALED, Vec3
from ravemj.errors import Source, SourceError, send_warnings
from ravemj.formats.file_access import FileAccess
from ravemj.formats.meshes import cache
from ravemj.formats.meshes.files import FileContent, ReferencedFiles, unpacked
from ravemj.formats.meshes.parts import MESH_SUFFIXES, READERS, MeshPart
from ravemj.model.scene import Mesh

_Reader = Callable[[FileContent], tuple[MeshPart, ...]]


def reader_of(suffix: str) -> _Reader:
    """Return the reader of a suffix, imported on demand: most meshes come from the cache."""
    module, name = READERS[suffix]
    return getattr(importlib.import_module(f"ravemj.formats.meshes.{module}"), name)


def read_mesh(
    path: str, scale: Vec3 = UNSCALED, access: FileAccess | None = None, *, ros: bool = False
) -> tuple[MeshPart, ...]:
    """Read a mesh file as OpenRAVE reads the ``<data>`` of a trimesh.

    Vertices are in metres, in the frame of the file; a COLLADA file is scaled by its unit and rotated to y up.
    Inventor and VRML give one part for the whole file, the other formats one for each material.

    Args:
        path: The file; its suffix selects the format, in upper or lower case.
        scale: Factors along x, y and z.
        access: The files that may be read; receives diagnostics. By default, the files are those of a mesh that its
            user opens, and diagnostics are issued as warnings.
        ros: Whether to read it as ROS does for URDF: the up axis of COLLADA is ignored, and the triangles of a mirrored
            mesh (a negative product of the factors) keep facing outwards.

    Returns:
        Its parts, without empty ones.

    Raises:
        SourceError: The file is missing, empty, malformed, too large, or of an unknown format.
    """
    suffix = next((suffix for suffix in MESH_SUFFIXES if path.lower().endswith(suffix)), None)
    if suffix is None:
        known = " ".join(MESH_SUFFIXES)
        raise SourceError("no mesh format that ravemj knows", Source(path), hint=f"it reads {known}")
    if access is None:
        access = FileAccess.opened(path)
        parts = read_mesh(path, scale, access, ros=ros)
        send_warnings(access.diagnostics)
        return parts
    kind = " ".join([suffix, *([] if scale == UNSCALED else [str(scale)]), *(["ros"] if ros else [])])
    mirrored = ros and scale[0] * scale[1] * scale[2] < 0

    def read(raw: bytes) -> tuple[tuple[MeshPart, ...], ReferencedFiles]:
        parts, references = read_content(
            FileContent(path, unpacked(raw, path), access=access, ros=ros), reader_of(suffix)
        )
        if scale != UNSCALED:
            parts = tuple(_scaled(part, scale, mirrored=mirrored) for part in parts)
        return parts, references

    parts, digests = cache.cached_file(path, kind, read, access)
    for name in (name for name, digest in digests.items() if digest):
        access.files.setdefault(name, Source(path, 0, access.files.get(path)))
    return parts


def read_content(file: FileContent, reader: _Reader) -> tuple[tuple[MeshPart, ...], ReferencedFiles]:
    """Return the parts, and the other files from which they were read."""
    try:
        with np.errstate(all="ignore"):  # what is not finite in the end is refused
            return reader(file), file.references
    except (RecursionError, MemoryError, OverflowError) as error:
        raise SourceError(
            f"the file is too large or nested too deep ({error or type(error).__name__})", file.source
        ) from error


def _scaled(part: MeshPart, scale: Vec3, *, mirrored: bool) -> MeshPart:
    triangles = part.mesh.triangles[:, ::-1] if mirrored else part.mesh.triangles
    return replace(part, mesh=Mesh(part.mesh.vertices * scale, triangles))
