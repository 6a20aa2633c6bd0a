"""Format of cache files: arrays in their memory layout, after a checksum and a JSON header.

NumPy's own format would take several times as long to load, and pickles can run code.

An entry contains the parts of a mesh, derived data that are slow to compute, and the entry's name, which reveals
renamed copies. It begins with ``_MAGIC`` and the CRC-32 of the rest.
"""

import json
import zlib

import numpy as np

from ravemj.formats.meshes.hulls import collision_form, store_form
from ravemj.formats.meshes.parts import MeshPart
from ravemj.model.scene import Mesh

Parts = tuple[MeshPart, ...]

_MAGIC = b"ravemj\x00\x01"
_START = len(_MAGIC) + 4
_ARRAYS = 8  # at multiples of this
_SINGLE, _DOUBLE, _TRIANGLE = np.dtype("<f4"), np.dtype("<f8"), np.dtype("<i4")


def pack_entry(name: str, parts: Parts, digests: dict[str, str]) -> bytes:
    """Return the content of an entry: its name, parts, and the digests of other files as in ``ReferencedFiles``."""
    about: list[object] = []
    arrays: list[bytes] = []
    for part in parts:
        mesh = part.mesh
        with np.errstate(over="ignore"):
            points = mesh.vertices.astype(_SINGLE)  # the readers round to it, and scaling leads away from it
        is_single = np.array_equal(points, mesh.vertices)
        counts = len(mesh.vertices), len(mesh.triangles), is_single
        about.append((counts, part.diffuse, part.ambient, part.transparency, collision_form(mesh), mesh.digest))
        arrays += [points.tobytes() if is_single else mesh.vertices.astype(_DOUBLE).tobytes()]
        arrays += [mesh.triangles.astype(_TRIANGLE).tobytes()]
    header = json.dumps((name, digests, about)).encode()
    header += b" " * (-(_START + 4 + len(header)) % _ARRAYS)
    return _sealed(b"".join([len(header).to_bytes(4, "little"), header, *arrays]))


def unpack_entry(name: str, content: bytes) -> tuple[Parts, dict[str, str]]:
    """Return the parts and digests in the content of an entry.

    Raises:
        ValueError: The content is damaged, or belongs to an entry with another name.
    """
    _check(content)
    position = _START + 4 + int.from_bytes(content[_START : _START + 4], "little")
    own_name, digests, about = json.loads(content[_START + 4 : position].decode())
    if own_name != name:
        raise ValueError(f"it is a copy of the entry {own_name}")
    parts: list[MeshPart] = []
    for (vertices, triangles, is_single), diffuse, ambient, transparency, form, digest in about:
        kind = _SINGLE if is_single else _DOUBLE
        middle = position + 3 * kind.itemsize * vertices
        points = np.ndarray((vertices, 3), kind, content, position).astype(np.float64)
        corners = np.ndarray((triangles, 3), _TRIANGLE, content, middle).astype(np.int_)
        position = middle + 3 * _TRIANGLE.itemsize * triangles
        for numbers in (points, corners):
            numbers.flags.writeable = False  # so that the mesh takes them as they are
        mesh = Mesh(points, corners, digest)
        store_form(mesh, form)
        parts.append(MeshPart(mesh, tuple(diffuse), tuple(ambient), transparency))
    return tuple(parts), digests


def _sealed(content: bytes) -> bytes:
    return _MAGIC + zlib.crc32(content).to_bytes(4, "little") + content


def _check(content: bytes) -> None:
    if content[:_START] != _MAGIC + zlib.crc32(memoryview(content)[_START:]).to_bytes(4, "little"):
        raise ValueError("the check sum is wrong")
