"""Checks of the counts that PLY, OFF and glTF files declare against the file size, before trimesh allocates memory."""

import json
import re
from typing import Any, cast

from ravemj.errors import Source, SourceError
from ravemj.formats.limits import MOST_TRIANGLES, check_bytes, check_count, check_json

_DEEPEST = 150  # nodes of glTF inside one another, as in COLLADA
_OFF_COUNTS = re.compile(rb"OFF\s+(?:#[^\n\r]*\s+)*(-?\d+)[ \t]+(-?\d+)")
_COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_TRANSFORMS = {"matrix": 16, "translation": 3, "rotation": 4, "scale": 3}
_GLB_HEAD = 20  # bytes before the JSON of a GLB file, of which the last eight are its length and kind

Entry = dict[str, Any]
"""An object in the JSON of glTF."""


def check_counts(data: bytes, kind: str, source: Source) -> None:
    """Check the counts that a file declares.

    Args:
        data: The content of the file.
        kind: ``ply``, ``off``, ``gltf`` or ``glb``.
        source: The file.

    Raises:
        SourceError: A count is larger than the file can contain, or exceeds a limit.
        ValueError, TypeError, LookupError, AttributeError: The file is malformed.
    """
    match kind:
        case "ply":
            _check_ply(data, source)
        case "off":
            _check_off(data, source)
        case "glb":
            size = int.from_bytes(data[12:16], "little")
            _Gltf(data[_GLB_HEAD : _GLB_HEAD + size], len(data), source).check()
        case _:
            _Gltf(data, len(data), source).check()


def _check_ply(data: bytes, source: Source) -> None:
    header, _, body = data.partition(b"end_header")
    for line in header.splitlines():
        words = line.split()
        if len(words) == 3 and words[0] == b"element":
            _check_held(int(words[2]), len(body), f"{words[1].decode('ascii', 'replace')} elements", source)
            check_count(int(words[2]), 3 * MOST_TRIANGLES, "vertices or faces in the mesh", source)


def _check_off(data: bytes, source: Source) -> None:
    match = _OFF_COUNTS.search(data)
    if match:
        vertices, faces = int(match[1]), int(match[2])
        rest = data[match.end() :].rstrip()
        lines = rest.count(b"\n") + rest.count(b"\r")
        _check_held(vertices, lines, "vertices", source)
        _check_held(faces, lines - vertices, "faces", source)
        check_count(vertices, 3 * MOST_TRIANGLES, "vertices in the mesh", source)


def _check_held(count: int, most: int, what: str, source: Source) -> None:
    if not 0 <= count <= most:
        raise SourceError(f"it declares {count:,} {what}, and can hold {most:,}", source, "is the file complete?")


class _Gltf:
    """JSON part of a glTF or GLB file."""

    def __init__(self, content: bytes, size: int, source: Source) -> None:
        check_json(content, source)
        self._header: Entry = json.loads(content.decode("utf-8-sig"))
        self._source = source
        self._views = self._entries("bufferViews")
        self._accessors = self._entries("accessors")
        self._held = size + sum(int(view.get("byteLength", 0)) for view in self._views)

    def check(self) -> None:
        """Raise if the file declares more data than it contains, or more bytes or triangles than ravemj reads.

        Triangles of a mesh count once for each instance.
        """
        check_bytes(self._held, "the buffers have", self._source)
        check_bytes(sum(map(self._size, self._accessors)), "the accessors have", self._source)
        triangles = [self._triangles(mesh) for mesh in self._entries("meshes")]
        check_count(sum(triangles), MOST_TRIANGLES, "triangles in the meshes", self._source)
        meshes: list[int | None] = [node.get("mesh") for node in self._shown()]
        total = sum(triangles[mesh] for mesh in meshes if mesh is not None)
        check_count(total, MOST_TRIANGLES, "triangles in the mesh", self._source)

    def _entries(self, name: str) -> list[Entry]:
        return cast("list[Entry]", self._header.get(name, []))

    def _size(self, accessor: Entry) -> int:
        """Return the number of bytes that trimesh allocates for an accessor; raise if its count exceeds its data."""
        count = accessor["count"]
        item = _COMPONENT_BYTES[accessor["componentType"]] * _COMPONENTS[accessor["type"]]
        what = "items in an accessor"
        if type(count) is not int:
            raise SourceError(f"it declares {count!r} {what}, which is no whole number", self._source)
        if "bufferView" not in accessor:  # they are zeros
            _check_held(count, self._held // item, what, self._source)
            return count * item
        number: int = accessor["bufferView"]
        view = self._views[number]
        length: int = view["byteLength"] - accessor.get("byteOffset", 0)
        stride: int = view.get("byteStride", item)
        _check_held(count, max((length - item) // max(stride, 1) + 1, 0), what, self._source)
        return count * item

    def _triangles(self, mesh: Entry) -> int:
        """Return an upper bound of the number of triangles in a mesh; its vertices are at most three times as many."""
        total = 0
        for primitive in cast("list[Entry]", mesh["primitives"]):
            used: list[int | None] = [primitive["attributes"].get("POSITION"), primitive.get("indices")]
            counts: list[int] = [self._accessors[index]["count"] for index in used if index is not None]
            total += max(counts, default=0) if primitive.get("mode") == 5 else max(counts, default=0) // 3
        return total

    def _shown(self) -> list[Entry]:
        """Return all nodes of the scene; raise if they do not form trees, or the trees are too deep."""
        nodes = self._entries("nodes")
        scenes, number = self._entries("scenes"), cast("int", self._header.get("scene", 0))
        level: list[int] = scenes[number].get("nodes", []) if scenes else []
        met: list[int] = []
        depth = 0
        while level:
            depth += 1
            check_count(depth, _DEEPEST, "nodes inside one another", self._source)
            met += level
            level = [child for index in level for child in nodes[index].get("children", [])]
            if len(met) + len(level) > len(nodes):
                raise SourceError("a node stands in several places, and glTF allows one", self._source)
        shown = [nodes[index] for index in met]
        for node in shown:
            for name, size in _TRANSFORMS.items():
                if len(node.get(name) or range(size)) != size:  # trimesh makes a matrix of whatever size
                    raise SourceError(f"the {name} of a node has not {size} numbers", self._source)
        return shown
