"""A mesh file to its parts: the reader is chosen by the file's name, as OpenRAVE does it."""

from collections.abc import Callable

import numpy as np

from ravemj.errors import Source, SourceError
from ravemj.meshes import cache
from ravemj.meshes.collada import read_collada
from ravemj.meshes.exchange import SUFFIXES, read_exchange
from ravemj.meshes.files import MeshFile, read_bytes, unpacked
from ravemj.meshes.inventor import read_inventor
from ravemj.meshes.obj import read_obj
from ravemj.meshes.parts import MESH_SUFFIXES, MeshPart
from ravemj.meshes.stl import read_stl

_Reader = Callable[[MeshFile], tuple[MeshPart, ...]]

_READERS: dict[str, _Reader] = {
    ".iv": read_inventor,
    ".wrl": read_inventor,
    ".vrml": read_inventor,
    ".stl": read_stl,
    ".obj": read_obj,
    ".dae": read_collada,
    **dict.fromkeys(SUFFIXES, read_exchange),
}


def read_mesh(path: str) -> tuple[MeshPart, ...]:
    """Read a mesh file as OpenRAVE does it for the ``<data>`` of a trimesh.

    Vertices are in metres, in the frame of the file; a COLLADA file is scaled by its unit and turned to y up.
    Inventor and VRML give one part for the whole file, the other formats one for each material.

    Args:
        path: The file; the end of its name decides how it is read, in upper or lower case.

    Returns:
        Its parts, none of them without triangles.

    Raises:
        SourceError: The file is missing, empty, malformed, too large, or of an unknown kind.
        RavemjError: The package for this kind of file is not installed.
    """
    suffix = next((suffix for suffix in MESH_SUFFIXES if path.lower().endswith(suffix)), None)
    if suffix is None:
        known = " ".join(MESH_SUFFIXES)
        raise SourceError("no mesh format that ravemj knows", Source(path), hint=f"it reads {known}")
    raw = read_bytes(path)
    return cache.remembered(raw, suffix, lambda: _read(MeshFile(path, unpacked(raw, path)), _READERS[suffix]))


def _read(file: MeshFile, reader: _Reader) -> tuple[tuple[MeshPart, ...], dict[str, str]]:
    """Return the parts, and the digests of the files that they come from besides ``file``."""
    try:
        with np.errstate(all="ignore"):  # what is not finite in the end is refused
            return reader(file), file.references.digests
    except (RecursionError, MemoryError, OverflowError) as error:
        raise SourceError(f"the file is too large or nested too deep ({type(error).__name__})", file.source) from error
