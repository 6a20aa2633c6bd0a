"""Reader of Wavefront OBJ with its materials, and writer of OBJ for MuJoCo."""

import hashlib
import io
import os
import re
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import Source, SourceError
from ravemj.formats.meshes import triangulation
from ravemj.formats.meshes.files import FileContent
from ravemj.formats.meshes.parts import BLACK, MeshPart, check_finite, check_size, rgb, welded
from ravemj.model.scene import Mesh, Rgb

_LONGEST_LINE = 1_000_000  # of OBJ

GRAY = rgb((0.6, 0.6, 0.6))
"""Colour of OpenRAVE's importer if there is no material or the material has no colour."""

_TEXTS: WeakKeyDictionary[Mesh, str] = WeakKeyDictionary()
"""Cache of the OBJ texts of meshes in use: models share meshes, and formatting takes as long as compiling."""


_WRITTEN = re.compile(r"mesh-[0-9a-f]{16}\.obj")


@dataclass(slots=True)
class _MtlMaterial:
    diffuse: Rgb = GRAY
    ambient: Rgb = BLACK
    opacity: float = 1.0
    sizes: list[int] = field(default_factory=list[int])
    index: list[int] = field(default_factory=list[int])


class _ObjParser:
    def __init__(self, file: FileContent) -> None:
        self.file = file
        self._triangles = 0
        self.points: list[tuple[float, ...]] = []
        self.materials = {"": _MtlMaterial()}
        self.current = self.materials[""]

    def line(self, words: list[str]) -> None:
        match words:
            case ["v", *numbers] if len(numbers) >= 3:
                self.points.append(_point([float(word) for word in numbers]))
            case ["f", *corners] if len(corners) >= 3:
                self._face(corners)
            case ["usemtl", *rest]:
                self.current = self.materials.setdefault(" ".join(rest), _MtlMaterial())
            case ["mtllib", *names]:
                self._library(" ".join(names))
            case ["v", *_]:
                raise ValueError("a vertex needs three coordinates")
            case _:
                pass

    def _face(self, corners: list[str]) -> None:
        count = len(self.points)
        numbers = [int(corner.partition("/")[0]) for corner in corners]
        index = [number - 1 if number > 0 else count + number for number in numbers]
        if 0 in numbers or min(index) < 0 or max(index) >= count:
            raise ValueError("a face with a vertex that is not there")
        self.current.sizes.append(len(index))
        self.current.index.extend(index)
        self._triangles += len(index) - 2
        check_size(self._triangles, self.file.source)

    def _library(self, name: str) -> None:
        """Read a material library; its last material is used until the first ``usemtl``, as in OpenRAVE's importer."""
        file = self.file.refer(name)
        for line in [] if file is None else file.data.decode("latin-1").splitlines():
            words = line.split()
            if words[:1] == ["newmtl"]:
                self.current = self.materials.setdefault(" ".join(words[1:]), _MtlMaterial())
            else:
                _colour(self.current, words)


def read_obj(file: FileContent) -> tuple[MeshPart, ...]:
    """Read an OBJ file: one part for each used material, in the order of the material file.

    Objects and groups are joined, as in OpenRAVE. Lines and points are ignored.

    Raises:
        SourceError: A line is malformed, or a face has a vertex that does not exist.
    """
    reading = _ObjParser(file)
    lines = io.StringIO(file.data.decode("latin-1").replace("\\\n", " "), newline=None)
    for number, line in enumerate(lines, start=1):
        try:
            if len(line) > _LONGEST_LINE:
                raise ValueError(f"it has {len(line):,} characters, and at most {_LONGEST_LINE:,} are read")
            reading.line(line.split())
        except ValueError as error:
            raise SourceError(f"malformed line: {error}", Source(file.path, number)) from error
    points = np.array(reading.points, np.float64).reshape(-1, 3)
    return tuple(part for material in reading.materials.values() for part in _parts(material, points, file))


def write_obj(mesh: Mesh) -> str:
    """Return a mesh as OBJ text for MuJoCo.

    OBJ, unlike STL, shares vertices, has no limit of faces and is readable; nine digits preserve every single-precision
    coordinate, and MuJoCo stores no finer ones.
    """
    text = _TEXTS.get(mesh)
    if text is None:
        vertices = mesh.vertices
        if 0 < len(vertices) < 4:  # MuJoCo wants four vertices, used or not
            vertices = np.concatenate((vertices, vertices[-1:].repeat(4 - len(vertices), 0)))
        corners = mesh.triangles + 1
        text = "v %.9g %.9g %.9g\n" * len(vertices) % tuple(vertices.ravel().tolist())
        text += "f %d %d %d\n" * len(corners) % tuple(corners.ravel().tolist())
        _TEXTS[mesh] = text
    return text


def written_name(mesh: Mesh) -> str:
    """Return the name of a mesh in MJCF: a hash of its OBJ text, which stays the same after reading and writing."""
    return _name_of(write_obj(mesh))


def read_written(path: str) -> Mesh | None:
    """Read a file of ``write_obj`` exactly; None if its name is not the hash of its content."""
    if not _WRITTEN.fullmatch(os.path.basename(path)):
        return None
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    if _name_of(text) != os.path.basename(path).removesuffix(".obj"):
        return None
    return _parsed(text)


def as_written(mesh: Mesh) -> Mesh:
    """Return a mesh with coordinates rounded as in its OBJ file."""
    return _parsed(write_obj(mesh))


def _parsed(text: str) -> Mesh:
    rows = [line.split() for line in text.splitlines()]
    vertices = [row[1:] for row in rows if row[0] == "v"]
    triangles = [row[1:] for row in rows if row[0] == "f"]
    return Mesh(np.array(vertices, np.float64), np.array(triangles, np.int_) - 1)


def _name_of(text: str) -> str:
    return f"mesh-{hashlib.sha256(text.encode()).hexdigest()[:16]}"


def _point(numbers: list[float]) -> tuple[float, ...]:
    """Return x, y, z of a ``v`` line: four numbers are homogeneous, six or more end in a colour."""
    x, y, z = numbers[:3]
    weight = numbers[3] if len(numbers) == 4 and numbers[3] else 1.0
    return (x / weight, y / weight, z / weight)


def _colour(material: _MtlMaterial, words: list[str]) -> None:
    try:
        match words:
            case ["Kd", red, green, blue, *_]:
                material.diffuse = rgb([float(red), float(green), float(blue)])
            case ["Ka", red, green, blue, *_]:
                material.ambient = rgb([float(red), float(green), float(blue)])
            case ["d", opacity]:
                material.opacity = float(opacity)
            case ["Tr", transparency]:
                material.opacity = 1.0 - float(transparency)
            case _:
                pass
    except ValueError:
        pass  # a colour that is no number: as if it were not there


def _parts(material: _MtlMaterial, points: Floats, file: FileContent) -> tuple[MeshPart, ...]:
    sizes, index = np.array(material.sizes, np.int_), np.array(material.index, np.int_)
    check_size(int((sizes - 2).sum()), file.source)
    check_finite(points[index], file.source)
    corners = triangulation.triangles(points, sizes, index, concave=True)
    return welded(corners, file.source, material.diffuse, material.ambient, transparency(material.opacity))


def transparency(opacity: float) -> float:
    """Return the transparency of a material, given its opacity in a file.

    An opacity of 0 is read as 1: nobody models invisible shapes, but many exporters confuse opacity and transparency.
    """
    return float(np.float32(1.0 - opacity)) if 0.0 < opacity <= 1.0 else 0.0
