"""Parser of binary Inventor.

Data are big-endian and aligned to four bytes: a string is its length and its bytes, a node its class, flags and fields,
then its children if it is a group. A field is its name, value and flags. Since values have no length prefix, a table of
the standard's field types is needed.
"""

import re
import struct
from collections.abc import Callable
from typing import NoReturn

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.formats.limits import MOST_NODES
from ravemj.formats.meshes.inventor.nodes import MAX_DEPTH, InventorDocument, InventorNode, Value

_IS_GROUP = 2  # in the flags of a node
_GROUPS_OF_2_0 = frozenset(
    {"Separator", "Group", "Annotation", "Selection", "TransformSeparator", "Switch", "LOD", "LevelOfDetail", "Array"}
    | {"MultipleCopy", "PathSwitch", "Blinker"}
)


def parse(document: InventorDocument, data: bytes) -> list[InventorNode]:
    """Read all nodes of a binary file.

    Raises:
        SourceError: It is malformed, too deep, too large, or has a field that is not in Inventor's standard.
    """
    header, _, body = data.partition(b"\n")
    version = re.match(rb"#Inventor V(\d+\.\d+) binary", header)
    if version is None:
        document.fail("neither text nor binary Inventor", 0)
    return _BinaryReader(document, body, flagged=float(version[1]) > 2.0).nodes()


class _BinaryReader:
    """Sequential reader; ``_at`` is the end of the data read."""

    def __init__(self, document: InventorDocument, body: bytes, flagged: bool) -> None:
        self._document = document
        self._body = body
        self._flagged = flagged
        self._at = 0
        self._depth = 0
        self._nodes_left = MOST_NODES
        self._named: dict[str, InventorNode] = {}

    def nodes(self) -> list[InventorNode]:
        nodes: list[InventorNode] = []
        while self._body[self._at :].strip(b"\0"):
            node = self.node()
            if node is not None:
                nodes.append(node)
        return nodes

    def node(self) -> InventorNode | None:
        kind = self.word()
        if kind == "NULL":
            return None
        if kind == "USE":
            name = self.word()
            return self._named.get(name) or self._fail(f"USE of {name[:40]!r}, which no DEF before it names")
        if kind != "DEF":
            return self._body_of(kind)
        name, kind = self.word(), self.word()
        node = self._named[name] = self._body_of(kind)
        return node

    def _body_of(self, kind: str) -> InventorNode:
        node = InventorNode(kind, self._document, 0)
        self._depth += 1
        self._nodes_left -= 1
        if self._depth > MAX_DEPTH or self._nodes_left < 0:
            self._fail("the nodes are nested too deep, or there are too many")
        is_group = bool(self._integer() & _IS_GROUP) if self._flagged else kind in _GROUPS_OF_2_0
        for _ in range(self._integer() & 0xFF):
            name = self.word()
            read = _FIELDS.get(f"{kind}.{name}") or _FIELDS.get(name)
            if read is None:
                self._fail(f"the field {name[:40]!r} of {kind[:40]!r} is not in Inventor's standard")
            node.fields[name] = read(self)
            self._integer()  # flags: ignored, connected
        if is_group:
            children = [self.node() for _ in range(self._count(4))]
            node.children = [child for child in children if child is not None]
        self._depth -= 1
        return node

    def _take(self, size: int) -> bytes:
        if size < 0 or self._at + size > len(self._body):
            self._fail("the file ends too early")
        start = self._at
        self._at += (size + 3) // 4 * 4
        return self._body[start : start + size]

    def _integer(self) -> int:
        return int(struct.unpack(">i", self._take(4))[0])

    def _count(self, bytes_each: int) -> int:
        """Read a number of items; raise if items of ``bytes_each`` bytes would exceed the file."""
        count = self._integer()
        if count < 0 or count * bytes_each > len(self._body) - self._at:
            self._fail("the file ends too early")
        return count

    def word(self) -> str:
        return self._take(self._count(1)).decode("latin-1")

    def floats(self, width: int) -> Floats:
        return np.frombuffer(self._take(4 * width), ">f4").astype(np.float64)

    def many_floats(self, width: int) -> Floats:
        return self.floats(width * self._count(4 * width))

    def integer(self) -> Floats:
        return np.array([float(self._integer())])

    def many_integers(self) -> Floats:
        return np.frombuffer(self._take(4 * self._count(4)), ">i4").astype(np.float64)

    def many_words(self) -> Value:
        return [self.word() for _ in range(self._count(4))]

    def bitmask(self) -> Value:
        words: list[Value] = []
        while word := self.word():
            words.append(word)
        return words

    def image(self) -> None:
        """Skip an image."""
        width, height, components = (self._integer() for _ in range(3))
        self._take(max(width, 0) * max(height, 0) * max(components, 0))

    def _fail(self, message: str) -> NoReturn:
        self._document.fail(f"{message} (at byte {self._at} after the header)", 0)


def _single(width: int) -> Callable[[_BinaryReader], Value]:
    return lambda reader: reader.floats(width)


def _multiple(width: int) -> Callable[[_BinaryReader], Value]:
    return lambda reader: reader.many_floats(width)


_TYPES: dict[Callable[[_BinaryReader], Value], str] = {
    _single(1): "angle width height depth radius bottomRadius textureQuality size spacing creaseAngle intensity "
    "nearDistance farDistance aspectRatio focalDistance heightAngle lineWidth pointSize dropOffRate cutOffAngle "
    "fogVisibility ambientIntensity Complexity.value Texture2Transform.rotation",
    _single(2): "Texture2Transform.translation Texture2Transform.scaleFactor Texture2Transform.center",
    _single(3): "translation scaleFactor center direction location position color fogColor blendColor attenuation "
    "Environment.ambientColor bboxCenter bboxSize separation1 separation2 separation3",
    _single(4): "rotation scaleOrientation orientation plane",
    _single(16): "Transform.matrix MatrixTransform.matrix",
    _multiple(1): "shininess transparency range screenArea",
    _multiple(2): "texCoord TextureCoordinate2.point ProfileCoordinate2.point",
    _multiple(3): "point vector diffuseColor ambientColor specularColor emissiveColor rgb vertex normal",
    _multiple(4): "Coordinate4.point",
    _multiple(16): "MultipleCopy.matrix",
    _BinaryReader.integer: "startIndex numPoints whichChild verticesPerColumn verticesPerRow linePattern on isVisible "
    "numElements1 numElements2 numElements3",
    _BinaryReader.many_integers: "coordIndex normalIndex materialIndex textureCoordIndex numVertices orderedRGBA",
    _BinaryReader.word: "vertexOrdering shapeType faceType value type units axis name filename wrapS wrapT model "
    "materialBinding normalBinding style renderCaching boundingBoxCaching renderCulling pickCulling justification "
    "viewportMapping family description map fogType string label origin policy",
    _BinaryReader.many_words: "Text2.string Text3.string AsciiText.string",
    _BinaryReader.bitmask: "parts hints FontStyle.style",
    _BinaryReader.node: "vertexProperty",
    _BinaryReader.image: "image",
}

_FIELDS = {name: read for read, names in _TYPES.items() for name in names.split()}
