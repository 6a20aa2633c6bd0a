"""Trajectories and layouts in OpenRAVE's text and binary formats."""

import struct
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, ErrorCode, SourceError
from ravemj.trajectories.groups import Group
from ravemj.trajectories.layout import count, flaw
from ravemj.trajectories.waypoints import Waypoints

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.tree import Element

AS_TEXT = 0x8000
"""Option of serialization that selects text."""

_MAGIC = b"\xff\x62"
_VERSION = 2
_READABLE_VERSIONS = range(1, 4)
_LARGEST = 2**31 - 1  # largest of OpenRAVE's integers


class Stored(NamedTuple):
    """Serialized content of a trajectory.

    Attributes:
        waypoints: Its configurations.
        description: Its description.
    """

    waypoints: Waypoints
    description: str


def to_text(stored: Stored, kind: str) -> str:
    """Return a trajectory of type ``kind`` as XML, with all digits of its numbers."""
    numbers = "".join(f"{_digits(number)} " for number in stored.waypoints.data.ravel().tolist())
    quoted = stored.description.replace("]]>", "]]]]><![CDATA[>")
    description = f"<description><![CDATA[{quoted}]]></description>\n" if quoted else ""
    return (
        f'<trajectory type="{kind}">\n{layout_text(stored.waypoints.groups)}'
        f'<data count="{len(stored.waypoints)}">\n{numbers}</data>\n{description}</trajectory>\n'
    )


def _digits(number: float) -> str:
    short = f"{number:.16g}"
    return short if float(short) == number else f"{number:.17g}"


def to_bytes(stored: Stored) -> bytes:
    """Return a trajectory in OpenRAVE's binary form.

    Raises:
        ArgumentError: a name or the description is too long.
    """
    groups = stored.waypoints.groups
    parts = [_MAGIC, struct.pack("<HH", _VERSION, len(groups))]
    for group in groups:
        parts += [_packed(group.name), struct.pack("<ii", group.offset, group.dof), _packed(group.interpolation)]
    data = np.ascontiguousarray(stored.waypoints.data, dtype="<f8")
    parts += [struct.pack("<I", data.size), data.tobytes(), _packed(stored.description), struct.pack("<H", 0)]
    return b"".join(parts)


def _packed(text: str) -> bytes:
    encoded = text.encode()
    if len(encoded) > 0xFFFF:
        raise ArgumentError(f"'{text[:20]}...' has {len(encoded)} bytes, and 65535 can be stored")
    return struct.pack("<H", len(encoded)) + encoded


def read(data: bytes | str) -> Stored:
    """Parse a trajectory in either format; a ``str`` may also contain the bytes of the binary format as characters.

    Raises:
        ArgumentError: the data is not a trajectory.
    """
    if not isinstance(data, str | bytes):  # pyright: ignore[reportUnnecessaryIsInstance] - users give it
        raise ArgumentError(f"data: is of type {type(data).__name__}, and should be bytes or a text")
    if isinstance(data, str):
        is_latin1 = data.startswith(_MAGIC.decode("latin-1"))
        data = data.encode("latin-1", "replace") if is_latin1 else data.encode(errors="surrogateescape")
    if data.startswith(_MAGIC):
        return _from_bytes(data)
    try:
        return _from_text(data.decode())
    except UnicodeDecodeError:
        raise ArgumentError("data: is not a trajectory; its bytes are neither of the binary form nor text") from None


def _from_text(text: str) -> Stored:
    children = {child.tag: child for child in read_element(text, "trajectory").children}
    groups = groups_of(children["configuration"]) if "configuration" in children else []
    numbers = _numbers(children["data"]) if "data" in children else np.empty(0)
    description = children["description"].text if "description" in children else ""
    return Stored(Waypoints(groups, _rows(numbers, groups)), description)


def _numbers(element: "Element") -> Floats:
    try:
        return np.array([float(word) for word in element.text.split()])
    except ValueError:
        raise ArgumentError(f"{element.source}: <data> should hold numbers") from None


def _from_bytes(data: bytes) -> Stored:
    reader = _ByteReader(data)
    version, number = reader.unpack("<2xHH")
    if version not in _READABLE_VERSIONS:
        raise ArgumentError(f"data: is a trajectory of version {version}, and 1 to 3 can be read")
    groups: list[Group] = []
    for _ in range(number):
        name = reader.text()
        offset, dof = reader.unpack("<ii")
        groups.append(Group(name, offset, dof, reader.text()))
    (size,) = reader.unpack("<I")
    numbers = np.frombuffer(reader.next_bytes(8 * size), dtype="<f8").astype(np.float64)
    return Stored(Waypoints(groups, _rows(numbers, groups)), reader.text())


class _ByteReader:
    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def next_bytes(self, size: int) -> bytes:
        taken = self._data[self._at : self._at + size]
        if len(taken) < size:
            raise ArgumentError(f"data: is not a whole trajectory; it breaks off after {len(self._data)} bytes")
        self._at += size
        return taken

    def unpack(self, form: str) -> tuple[int, ...]:
        return struct.unpack(form, self.next_bytes(struct.calcsize(form)))

    def text(self) -> str:
        (size,) = self.unpack("<H")
        return self.next_bytes(size).decode(errors="replace")


def _rows(numbers: Floats, groups: Sequence[Group]) -> Floats:
    wrong = flaw(groups)
    if wrong is not None:
        raise ArgumentError(f"data: is not a trajectory; {wrong}")
    width = count(groups)
    if numbers.size % width if width else numbers.size:
        raise ArgumentError(f"data: has {numbers.size} numbers, and should have a multiple of {width}")
    return numbers.reshape(-1, width) if width else np.empty((0, 0))


def layout_text(groups: Sequence[Group]) -> str:
    """Return the ``<configuration>`` element of a layout, with one line per group."""
    from xml.sax.saxutils import quoteattr  # noqa: PLC0415 - imports urllib, which is slow

    lines = [
        f"<group name={quoteattr(group.name)} offset={quoteattr(str(group.offset))} dof={quoteattr(str(group.dof))} "
        f"interpolation={quoteattr(group.interpolation)}/>"
        for group in sorted(groups, key=lambda group: group.offset)
    ]
    return "\n".join(["<configuration>", *lines, "</configuration>", ""])


def read_layout(text: str) -> list[Group]:
    """Parse the layout in a text.

    Raises:
        ArgumentError: the text is not a layout, or its groups overlap or have gaps.
    """
    root = read_element(text, "configuration")
    groups = groups_of(root)
    wrong = flaw(groups)
    if wrong is not None:
        raise ArgumentError(f"xmldata: {wrong}", ErrorCode.Assert)
    return groups


def read_element(text: str, tag: str) -> "Element":
    """Parse a text, and return its root element.

    Raises:
        ArgumentError: the text is not XML, or its root has another name.
    """
    from ravemj.formats.openrave_xml.tree import parse  # noqa: PLC0415 - slow to import

    try:
        document = parse(text.encode(), tag)
    except SourceError as error:
        raise ArgumentError(str(error)) from None
    if document.root.tag != tag or document.error is not None:
        raise ArgumentError(str(document.error) if document.error else f"the text should start with <{tag}>")
    return document.root


def groups_of(configuration: "Element") -> list[Group]:
    """Return the groups in a ``<configuration>`` element.

    Raises:
        ArgumentError: an offset or a number of values is not an integer.
    """
    groups: list[Group] = []
    for child in configuration.children:
        if child.tag == "group":
            given = child.attributes
            try:
                offset, dof = int(given.get("offset", "0")), int(given.get("dof", "0"))
            except ValueError:
                raise ArgumentError(f"{child.source}: offset and dof should be integers") from None
            if max(offset, dof) > _LARGEST:
                raise ArgumentError(f"{child.source}: offset and dof should be at most {_LARGEST}")
            groups.append(Group(given.get("name", ""), offset, dof, given.get("interpolation", "")))
    return groups
