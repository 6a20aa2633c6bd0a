"""Reader of STL, binary and text, and writer of binary STL."""

import re

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import SourceError
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.parts import WHITE, MeshPart, check_size, corners_of, rgb, welded
from ravemj.model.scene import Mesh

AMBIENT = rgb((0.05, 0.05, 0.05))
"""Ambient colour of STL files in OpenRAVE's importer."""

_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")


def read_stl(file: FileContent) -> tuple[MeshPart, ...]:
    """Read an STL file; solids are joined, as in OpenRAVE.

    The part has the colour ``COLOR=rgba`` in the header of a binary file, as some programs write it; else it is white.

    Raises:
        SourceError: It is neither binary nor text STL, or is truncated.
    """
    diffuse = WHITE
    count = int.from_bytes(file.data[80:_HEADER], "little")
    size = _HEADER + count * _FACET.itemsize
    text = file.data.lstrip()[:5].lower() == b"solid" and b"facet" in file.data
    if len(file.data) == size or (_HEADER <= size < len(file.data) and not text):
        corners = np.frombuffer(file.data, _FACET, count, _HEADER)["corners"].astype(np.float64)
        at = file.data.find(b"COLOR=", 0, 80)
        if 0 <= at <= 80 - 10:
            diffuse = rgb(np.frombuffer(file.data, np.uint8, 3, at + 6) / 255)
    elif b"facet" in file.data:
        corners = _text_corners(file)
    else:
        raise SourceError("neither text nor binary STL, or cut short", file.source)
    return welded(corners, file.source, diffuse, AMBIENT)


def _text_corners(file: FileContent) -> Floats:
    check_size(file.data.count(b"vertex") // 3, file.source)
    vertices = (vertex.groups() for vertex in _VERTEX.finditer(file.data))
    try:
        numbers = np.fromiter((float(word) for vertex in vertices for word in vertex), np.float64)
    except ValueError as error:
        raise SourceError(f"a coordinate that is not a number: {error}", file.source) from error
    if not len(numbers) or len(numbers) % 9:
        raise SourceError("a facet without three vertices", file.source)
    return numbers.reshape(-1, 3, 3)


def write_stl(mesh: Mesh) -> bytes:
    """Return a mesh as a binary STL file, with coordinates in single precision and without normals."""
    facets = np.zeros(len(mesh.triangles), _FACET)
    facets["corners"] = corners_of(mesh)
    return bytes(80) + len(facets).to_bytes(4, "little") + facets.tobytes()
