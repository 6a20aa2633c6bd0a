"""A COLLADA file as a tree of elements with look-up by kind and id."""

import functools
import hashlib
import math
import re
from collections.abc import Iterator

from lxml import etree

from ravemj.core.transforms import Floats
from ravemj.errors import Source, SourceError
from ravemj.formats.limits import ParsingBudget
from ravemj.formats.meshes.number_lists import parse_list
from ravemj.formats.meshes.parts import MeshPart

Element = etree._Element  # pyright: ignore[reportPrivateUsage] - lxml's name for the type


class ColladaDocument:
    """A parsed file; namespaces are ignored.

    Attributes:
        path: Its path.
        root: The outermost element.
        digest: Hash of the content.
        elements: Upper bound of the number of elements.
        meshes: Cache of triangles.
    """

    def __init__(self, data: bytes, path: str, budget: ParsingBudget | None = None) -> None:
        """Parse a file.

        Args:
            data: Its content.
            path: Its path.
            budget: Counts what the model has read; None if this file is the whole model.

        Raises:
            SourceError: It is not well-formed XML, its root is not COLLADA, or it is too large.
        """
        self.path = path
        self.digest = hashlib.sha256(data).hexdigest()
        self.elements = (budget or ParsingBudget()).add_document(data, Source(path))
        root = parse_tree(data, path)
        if root is None or local_name(root) != "COLLADA":
            raise SourceError("the root element is not COLLADA", Source(path, 1))
        self.root = root
        self._by_id: dict[tuple[str, str], Element] = {}
        for element in root.iter(etree.Element):
            name = element.get("id")
            if name is not None:
                self._by_id.setdefault((local_name(element), name), element)
        self._of_any_kind: dict[str, list[Element]] = {}
        self._places: dict[Element, int] = {}
        self.meshes: dict[str, tuple[MeshPart, ...]] = {}

    def source(self, element: Element) -> Source:
        """Return the source position of an element, for messages."""
        return Source(self.path, element.sourceline or 0)

    def place(self, geometry: Element) -> int:
        """Return the index of a ``<geometry>`` in the file."""
        if not self._places:
            self._places = {element: number for number, element in enumerate(self.root.iter("{*}geometry"))}
        return self._places[geometry]

    def find(self, kind: str, url: str | None) -> Element | None:
        """Return the element of a kind with the id in a URL such as ``#id``.

        Elements of several kinds may share an id: some writers give a geometry and an effect the same one.
        """
        return self._by_id.get((kind, (url or "").strip().removeprefix("#")))

    def identified(self, name: str) -> list[Element]:
        """Return the elements with an id, at most one of each kind."""
        if not self._of_any_kind:
            for (_, known), element in self._by_id.items():
                self._of_any_kind.setdefault(known, []).append(element)
        return self._of_any_kind.get(name, [])


_HEAD = 1 << 16  # bytes in which the XML declaration ends
_ENCODING = re.compile(rb"<\?xml\s[^>]*?encoding\s*=\s*[\"']([^\"']*)")
_COUNTABLE = re.compile(
    rb"utf-?(8|16|32)(le|be)?|ucs-?[24]|(us-?)?ascii|iso-?8859-?\d+|latin-?\d+|(windows-?|cp)125\d|gb\w+|big5"
    rb"|shift_?jis|euc-?\w+|koi8-?\w",
    re.IGNORECASE,
)
"""Encodings in which ``<`` has its ASCII code, so that elements can be counted before parsing."""


def parse_tree(data: bytes, path: str) -> Element | None:
    """Parse XML with lxml, without expanding entities.

    Raises:
        SourceError: It is not well-formed, or has an unusual encoding.
    """
    start, _, rest = data[:_HEAD].replace(b"\0", b"").partition(b"?>")  # UTF-16 has zeros
    declared = _ENCODING.search(start) if rest else None
    if b"<" not in start or (declared and not _COUNTABLE.fullmatch(declared[1])):
        raise SourceError("not well-formed XML in one of the usual encodings", Source(path, 1), "save it as UTF-8")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True)
    try:
        return etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        reason = error.msg.partition(", line ")[0]  # the source says it already
        raise SourceError(f"not well-formed XML: {reason}", Source(path, error.lineno or 0)) from error


def local_name(element: Element) -> str:
    """Return an element's tag without its namespace."""
    return element.tag.rpartition("}")[2]


def children(element: Element | None, *kinds: str) -> Iterator[Element]:
    """Yield the children of some kinds, by default of all; none if ``element`` is None."""
    if element is None:
        return iter(())
    return element.iterchildren(*_patterns(kinds)) if kinds else element.iterchildren(etree.Element)


@functools.cache
def _patterns(kinds: tuple[str, ...]) -> tuple[str, ...]:
    """Return lxml patterns that match elements of these names in any namespace."""
    return tuple(f"{{*}}{kind}" for kind in kinds)


def child(element: Element | None, *path: str) -> Element | None:
    """Return the first child, grandchild, … along a path of kinds, or None."""
    for kind in path:
        element = next(children(element, kind), None)
    return element


def words(element: Element | None) -> list[str]:
    """Return the words of an element's text."""
    return [] if element is None else (element.text or "").split()


_LEADING_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def numbers(element: Element | None) -> Floats:
    """Return the numbers in an element's text; invalid ones are 0, as in OpenRAVE's reader."""
    text = "" if element is None else element.text or ""
    try:
        return parse_list(text, float)
    except ValueError:
        return parse_list(text, _leading_number)


def _leading_number(word: str) -> float:
    match = _LEADING_NUMBER.match(word)
    return float(match[0]) if match else 0.0


def attribute_number(element: Element | None, name: str, default: float) -> float:
    """Return the number in an attribute, or ``default`` if it is missing."""
    try:
        value = float((None if element is None else element.get(name)) or default)
    except ValueError:
        return default
    return value if math.isfinite(value) else default
