"""Resource limits of all readers: a small file must not exhaust memory or processor time.

The content of documents is counted before a parser builds a tree, that of archives during unpacking, and declared
counts are checked before memory is allocated.
"""

import os

from ravemj.errors import ArgumentError, LimitError, Source

VARIABLE = "RAVEMJ_MOST_BYTES"
"""Environment variable that overrides the limit ``most_bytes``."""

MOST_RATIO = 200
"""Maximum ratio of unpacked to packed size. Meshes and XML reach about 20."""

MOST_ELEMENTS = 1_000_000
"""Maximum number of XML elements in a model, where an included file counts each time, and of JSON objects and lists."""

MOST_ATTRIBUTES = 2 * MOST_ELEMENTS
"""Maximum number of XML attributes, and of names and texts in JSON."""

MOST_NUMBERS = 50_000_000
"""Maximum number of numbers in one list."""

MOST_TRIANGLES = 5_000_000
"""Maximum number of triangles in a mesh file; repeated instances in a small file could give billions."""

MOST_MODEL_TRIANGLES = 4 * MOST_TRIANGLES
"""Maximum number of triangles in all mesh files of a model; each scale of a file counts."""

MOST_NODES = 200_000
"""Maximum number of nodes in a mesh file, and of copies of nodes in a COLLADA scene."""

MOST_FILES = 10_000
"""Maximum number of files in an archive or in a model, which may include a file repeatedly."""

_DEFAULT = 256 << 20


def most_bytes() -> int:
    """Return the maximum size of a file, unpacked if it is compressed, and of all XML documents of a model together.

    Raises:
        ArgumentError: The environment variable ``RAVEMJ_MOST_BYTES`` is not a whole number above 0.
    """
    text = os.environ.get(VARIABLE) or str(_DEFAULT)
    if not (text.isascii() and text.isdecimal() and len(text) < 20 and int(text)):
        raise ArgumentError(f"{VARIABLE} is '{text}'; write a number of bytes, for instance {4 * _DEFAULT}")
    return int(text)


def check_bytes(count: int, what: str, source: Source) -> None:
    """Refuse content that is too large.

    Args:
        count: Its size, or a lower bound.
        what: Start of the message, for instance "the file has".
        source: The file.

    Raises:
        LimitError: It has more than ``most_bytes()`` bytes.
    """
    most = most_bytes()
    if count > most:
        message = f"{what} {count:,} bytes or more, and {most:,} are read"
        raise LimitError(message, source, f"{VARIABLE} in the environment raises the limit")


def check_unpacked(count: int, packed: int, source: Source) -> None:
    """Refuse unpacked content that is too large, given unpacked and packed size.

    Raises:
        LimitError: It has more than ``most_bytes()`` bytes, or the ratio is above ``MOST_RATIO``.
    """
    check_bytes(count, "it unpacks to", source)
    if count > MOST_RATIO * packed:
        message = f"it unpacks to {count:,} bytes or more, over {MOST_RATIO} times its own {packed:,}"
        raise LimitError(message, source, "unpack it yourself if you trust it")


def most_unpacked(packed: int) -> int:
    """Return the number of bytes to unpack to decide whether the content is too large."""
    return min(most_bytes(), MOST_RATIO * packed) + 1


def json_bytes(path: str) -> bytes:
    """Return the content of a JSON file.

    Raises:
        LimitError: It is too large or has too many values.
        OSError: It cannot be read.
    """
    with open(path, "rb") as file:
        check_bytes(os.fstat(file.fileno()).st_size, "the file has", Source(path))
        content = file.read()
    check_json(content, Source(path))
    return content


def check_json(content: bytes, source: Source) -> None:
    """Refuse a JSON text with too many values, before it is parsed.

    Raises:
        LimitError: There are too many.
    """
    for count, most, what in (
        (content.count(b"{") + content.count(b"["), MOST_ELEMENTS, "objects and lists"),
        (content.count(b'"') // 2, MOST_ATTRIBUTES, "names and texts"),
        (content.count(b","), MOST_NUMBERS, "values"),
    ):
        check_count(count, most, what, source)


def check_count(count: int, most: int, what: str, source: Source) -> None:
    """Refuse a count above a limit; ``what`` is the noun in the message.

    Raises:
        LimitError: The count is above the limit.
    """
    if count > most:
        raise LimitError(f"there are {count:,} {what}, and at most {most:,} are read", source)


class ParsingBudget:
    """Counts the XML documents of one model against the limits.

    The elements of a document count at each use, its bytes at each parsing.
    """

    def __init__(self) -> None:
        """Start with a count of zero.

        Raises:
            ArgumentError: The environment variable ``RAVEMJ_MOST_BYTES`` is invalid.
        """
        most_bytes()
        self._bytes = self._elements = self._attributes = 0

    def add_document(self, content: bytes, source: Source) -> int:
        """Count a document that is about to be parsed; return an upper bound of its number of elements.

        Raises:
            LimitError: The model becomes too large.
        """
        self._bytes += len(content)
        check_bytes(self._bytes, "the files of the model have", source)
        self._attributes += content.count(b"=")
        check_count(self._attributes, MOST_ATTRIBUTES, "attributes in the model", source)
        elements = content.count(b"<") - content.count(b"</")
        self.add_elements(elements, source)
        return elements

    def add_elements(self, count: int, source: Source) -> None:
        """Count elements.

        Raises:
            LimitError: The model has too many.
        """
        self._elements += count
        check_count(self._elements, MOST_ELEMENTS, "elements in the model", source)
