"""Reader of PLY, OFF, GLB and glTF by trimesh; these formats are rare with OpenRAVE."""

import importlib
import io
import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.errors import SourceError
from ravemj.formats.meshes.declared_counts import check_counts
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.obj import GRAY, transparency
from ravemj.formats.meshes.parts import BLACK, WHITE, MeshPart, rgb, welded
from ravemj.model.scene import Rgb

_COLOURS: dict[str, tuple[Rgb, Rgb]] = {
    "off": (GRAY, GRAY),
    "ply": (WHITE, WHITE),
    "glb": (WHITE, BLACK),
    "gltf": (WHITE, BLACK),
}
"""Diffuse and ambient colour by file type that OpenRAVE's importer gives to files without materials."""


def read_with_trimesh(file: FileContent) -> tuple[MeshPart, ...]:
    """Read a PLY, OFF, GLB or glTF file: one part for each colour, in the order of the file.

    Raises:
        SourceError: The file is malformed.
    """
    kind = file.path.lower().rpartition(".")[2]
    pieces: dict[tuple[Rgb, float], list[Floats]] = {}
    for corners, rgba in _geometries(file, kind):
        colour = (_COLOURS[kind][0], 0.0) if rgba is None else (rgb(rgba), transparency(float(rgba[3])))
        pieces.setdefault(colour, []).append(corners)
    return tuple(
        part
        for (diffuse, clear), some in pieces.items()
        for part in welded(np.concatenate(some), file.source, diffuse, _COLOURS[kind][1], clear)
    )


class _References(Mapping[str, bytes]):
    """Resolver that gives trimesh the data buffers of a glTF file, but no pictures, since they are not drawn."""

    def __init__(self, file: FileContent) -> None:
        self._file = file

    def __getitem__(self, name: str) -> bytes:
        buffer = self._file.refer(name, is_raw=True) if name in self._buffers else None
        if buffer is None:
            raise KeyError(name)
        return buffer.data

    @cached_property
    def _buffers(self) -> set[str]:
        data = self._file.data
        text = data[20 : 20 + int.from_bytes(data[12:16], "little")] if data.startswith(b"glTF") else data
        return {buffer["uri"] for buffer in json.loads(text)["buffers"] if "uri" in buffer}

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def _geometries(file: FileContent, kind: str) -> list[tuple[Floats, Floats | None]]:
    """Return triangle corners and RGBA colour of each geometry in a file; the colour is None without a material."""
    data = file.data
    if kind == "ply":  # trimesh takes headers for UTF-8, and comments of older programs are Latin-1
        header, end, rest = data.partition(b"end_header")
        data = header.decode("ascii", "replace").encode("ascii", "replace") + end + rest
    options = {"resolver": _References(file), "process": False, "skip_materials": kind == "ply"}  # those are pictures
    trimesh: Any = importlib.import_module("trimesh")  # slow to import, and without types
    try:
        check_counts(data, kind, file.source)
        scene: Any = trimesh.load_scene(io.BytesIO(data), file_type=kind, **options)
        order = {name: number for number, name in enumerate(scene.geometry)}
        nodes: list[Any] = sorted(map(scene.graph.get, scene.graph.nodes_geometry), key=lambda node: order[node[1]])
        placed = [(scene.geometry[name], matrix) for matrix, name in nodes]
        return [_placed(geometry, matrix) for geometry, matrix in placed if hasattr(geometry, "faces")]
    except SourceError:
        raise
    except Exception as error:  # trimesh raises all kinds at malformed files
        if file.references.refused is not None:
            raise file.references.refused from error
        raise SourceError(f"trimesh cannot read it: {type(error).__name__}: {error}", file.source) from error


def _placed(geometry: Any, matrix: Floats) -> tuple[Floats, Floats | None]:  # noqa: ANN401 - trimesh has no types
    placed = np.asarray(geometry.vertices, np.float64).reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    corners = placed[np.asarray(geometry.faces, np.int_).reshape(-1, 3)]
    factor = getattr(getattr(geometry.visual, "material", None), "baseColorFactor", None)
    return corners, None if factor is None else np.asarray(factor, np.float64).reshape(4) / 255
