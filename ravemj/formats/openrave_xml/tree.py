"""XML syntax: a file is parsed to a tree of elements with lower-case names and line numbers.

OpenRAVE's parser does not support namespaces, stops at the end tag of the root, and has processed everything before a
syntax error when it reports the error. Expat allows all this, and gives the positions of tags.
"""

import codecs
import os
from dataclasses import dataclass, field
from typing import NamedTuple, NoReturn
from xml.parsers import expat

from ravemj.errors import Source, SourceError
from ravemj.formats.limits import ParsingBudget, check_bytes

DEEPEST = 200
"""Maximum nesting depth of elements."""


@dataclass(slots=True)
class Element:
    """An XML element as OpenRAVE interprets it.

    Attributes:
        tag: Name in lower case; OpenRAVE ignores the letter case of names.
        spelled: The name as written.
        attributes: Values by lower-case name.
        source: Start of its start tag.
        text: The text after the last child element; text before a child is discarded.
        children: Child elements in document order.
        complete: False if the file ends before its end tag.
        checked: Whether its attributes were checked.
    """

    tag: str
    spelled: str
    attributes: dict[str, str]
    source: Source
    text: str = ""
    children: list["Element"] = field(default_factory=lambda: [])
    complete: bool = False
    checked: bool = False


class Document(NamedTuple):
    """A parsed file.

    Attributes:
        root: The root element.
        error: The error that ended the parsing before the root's end tag, or None.
        unread: Position of content after the root's end tag, or None.
    """

    root: Element
    error: SourceError | None
    unread: Source | None


def parse_file(path: str, included_from: Source | None = None, budget: ParsingBudget | None = None) -> Document:
    """Parse a file.

    Args:
        path: The file.
        included_from: The element that includes it, for messages.
        budget: Counts what the model has read; None if this file is the whole model.

    Raises:
        SourceError: the file cannot be read, is too large, or has no root element.
    """
    return parse(content_of(path, included_from), path, included_from, budget)


def content_of(path: str, included_from: Source | None = None) -> bytes:
    """Return the bytes of a file; arguments and errors are those of ``parse_file``."""
    try:
        with open(path, "rb", buffering=0) as file:
            check_bytes(os.fstat(file.fileno()).st_size, "the file has", Source(path, 0, included_from))
            return file.read()
    except OSError as error:
        raise SourceError(f"cannot read the file: {os_reason(error)}", Source(path, 0, included_from)) from None


def parse(
    content: bytes, path: str, included_from: Source | None = None, budget: ParsingBudget | None = None
) -> Document:
    """Parse the content of a file.

    Args:
        content: The bytes.
        path: Its name in messages.
        included_from: The element that includes it, for messages.
        budget: Counts what the model has read; None if this is the whole model.

    Raises:
        SourceError: there is no root element, or the content is too large.
    """
    if not content.strip():
        raise SourceError("the file is empty", Source(path, 0, included_from))
    (budget or ParsingBudget()).add_document(content, Source(path, 0, included_from))
    parser = _TreeBuilder(path, included_from)
    error = parser.parse(content)
    if parser.root is None:
        raise error or SourceError("there is no element in it", Source(path, 0, included_from))
    if error is not None and parser.root.complete:
        return Document(parser.root, None, error.source)
    return Document(parser.root, error, None)


def os_reason(error: OSError) -> str:
    """Return the reason of an operating system's error as one lower-case phrase."""
    return (error.strerror or os.strerror(error.errno or 0)).lower()


_HINTS = {
    expat.errors.XML_ERROR_INVALID_TOKEN: "write & as &amp;, < as &lt;, attributes in quotes, and no -- in a comment",
    expat.errors.XML_ERROR_UNDEFINED_ENTITY: "write the text itself in its place",
    expat.errors.XML_ERROR_DUPLICATE_ATTRIBUTE: "write it once",
    expat.errors.XML_ERROR_INCORRECT_ENCODING: "leave the encoding out of its first line",
    expat.errors.XML_ERROR_MISPLACED_XML_PI: "let the file begin with <?xml",
}
"""Hints for expat's syntax errors. For other errors, naming the open element helps more."""


class _TreeBuilder:
    def __init__(self, path: str, included_from: Source | None) -> None:
        self.root: Element | None = None
        self._path = path
        self._included_from = included_from
        self._content = b""
        self._encoding = ""  # that the file declares
        self._entities: list[str] = []
        self._open: list[Element] = []
        self._text: list[str] = []  # since the last tag
        self._expat = expat.ParserCreate()
        self._expat.buffer_text = True
        self._expat.StartElementHandler = self._start
        self._expat.EndElementHandler = self._end
        self._expat.CharacterDataHandler = self._text.append
        self._expat.DefaultHandler = self._other
        self._expat.XmlDeclHandler = self._declaration
        self._expat.EntityDeclHandler = self._declared

    def parse(self, content: bytes) -> SourceError | None:
        self._content = content
        try:
            self._expat.Parse(content, True)
        except expat.ExpatError as error:
            return self._explained(error)
        except (LookupError, ValueError) as error:  # an encoding that Python does not know
            return SourceError(f"not readable as XML: {error}", self._here(), "save it as UTF-8")
        except SourceError as error:
            return error
        return None

    def _explained(self, error: expat.ExpatError) -> SourceError:
        """Return a syntax error with an explanation: another encoding, no XML at all, or a hint from `_HINTS`."""
        source = Source(self._path, error.lineno, self._included_from)
        if not self._content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):  # half of whose bytes are 0
            if b"\0" in self._content:
                return SourceError("this is a binary file, not XML", Source(self._path, 0, self._included_from))
            if not self._content.removeprefix(codecs.BOM_UTF8).lstrip().startswith(b"<"):
                return SourceError("this is not XML, which begins with '<'", source)
        if self._encoding.lower() in {"", "utf-8", "utf8"}:
            try:
                self._content.decode()
            except UnicodeDecodeError as wrong:
                byte, line = self._content[wrong.start], self._content.count(b"\n", 0, wrong.start) + 1
                if line == error.lineno:
                    hint = (
                        'save it as UTF-8, or name its encoding in the first line: <?xml version="1.0" encoding="…"?>'
                    )
                    return SourceError(f"the byte 0x{byte:02X} is not UTF-8, the encoding of the file", source, hint)
        reason = expat.ErrorString(error.code) or "syntax error"
        hint = _HINTS.get(reason, "")
        if self._open and not hint:
            hint = f"<{self._open[-1].spelled}> of line {self._open[-1].source.line} is open there"
        words = reason.removeprefix("not well-formed (").removesuffix(")")
        return SourceError(f"not well-formed XML in column {error.offset + 1}: {words}", source, hint)

    def _here(self) -> Source:
        return Source(self._path, self._expat.CurrentLineNumber, self._included_from)

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        del version, standalone
        self._encoding = encoding or ""

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if attributes:
            if self._entities:
                self._refuse_entities()
            attributes = {key.lower(): value for key, value in attributes.items()}
        source = Source(self._path, self._expat.CurrentLineNumber, self._included_from)
        element = Element(name.lower(), name, attributes, source, "", [])
        opened = self._open
        if not opened:
            self.root = element
        elif len(opened) < DEEPEST:
            opened[-1].children.append(element)
        else:
            self._refuse(f"more than {DEEPEST} elements inside one another")
        opened.append(element)
        self._text.clear()

    def _end(self, name: str) -> None:
        del name
        element = self._open.pop()
        element.text = "".join(self._text)
        element.complete = True
        self._text.clear()

    def _other(self, data: str) -> None:
        if self._open and data.startswith("&"):
            self._refuse_entity(data)

    def _declared(self, name: str, is_parameter: bool, *_: object) -> None:
        if not is_parameter:
            self._entities.append(f"&{name};")

    def _refuse_entities(self) -> None:
        """Refuse a start tag that contains entities defined in the file, which expat replaces silently."""
        start = self._expat.CurrentByteIndex
        end = self._content.find(b"<", start + 1)  # values may hold a ">", never a "<"
        tag = self._content[start:end].replace(b"\0", b"")  # UTF-16 has zeros
        for entity in self._entities:
            if entity.encode() in tag:
                self._refuse_entity(entity)

    def _refuse_entity(self, entity: str) -> NoReturn:
        self._refuse(f"the entity {entity} is not supported; write the text itself in its place")

    def _refuse(self, reason: str) -> NoReturn:
        raise SourceError(reason, self._here())
