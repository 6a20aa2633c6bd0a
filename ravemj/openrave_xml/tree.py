"""Syntax: a file becomes a tree of elements with lower-case names and the line that each stands on."""

import os
from dataclasses import dataclass
from typing import TypeAlias, cast

from lxml import etree

from ravemj.errors import Source, SourceError

_Node: TypeAlias = "etree._Element"  # pyright: ignore[reportPrivateUsage]


@dataclass(slots=True)
class Element:
    """An XML element as OpenRAVE sees it.

    Attributes:
        tag: Name in lower case; OpenRAVE ignores the letter case of names.
        spelled: The name as the author wrote it.
        attributes: Values by lower-case name.
        text: The text behind the last child element; what stands before a child is discarded.
        children: Child elements in document order.
        source: Where it stands.
    """

    tag: str
    spelled: str
    attributes: dict[str, str]
    text: str
    children: list["Element"]
    source: Source


def parse_file(path: str, included_from: Source | None = None) -> Element:
    """Read a file and return its root element.

    Args:
        path: The file.
        included_from: The element that includes it, for messages.

    Raises:
        SourceError: the file cannot be read, or is not well-formed XML.
    """
    whole_file = Source(path, 0, included_from)
    try:
        with open(path, "rb") as file:
            content = file.read()
    except OSError as error:
        raise SourceError(f"cannot read the file: {os_reason(error)}", whole_file) from None
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, remove_pis=True)
    try:
        root = etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        line = error.lineno or 0
        reason = str(error.msg).rsplit(", line ", 1)[0]
        message = f"not well-formed XML: {reason}" if content.strip() else "the file is empty"
        raise SourceError(message, Source(path, line, included_from)) from None
    return _element(root, path, included_from)


def os_reason(error: OSError) -> str:
    """Return the reason of an operating system's error as one lower-case phrase."""
    return (error.strerror or os.strerror(error.errno or 0)).lower()


def _element(node: _Node, path: str, included_from: Source | None) -> Element:
    source = Source(path, node.sourceline or 0, included_from)
    children: list[Element] = []
    text = node.text or ""
    for child in node:
        tag = cast(object, child.tag)  # comments and entities have a function in place of a name
        if isinstance(tag, str):
            children.append(_element(child, path, included_from))
            text = child.tail or ""
        elif tag is etree.Entity:
            raise SourceError(f"the entity {child.text} is not supported", source, "write the text itself in its place")
        else:  # a comment is transparent
            text += child.tail or ""
    attributes = {str(name).lower(): str(value) for name, value in node.attrib.items()}
    return Element(node.tag.lower(), node.tag, attributes, text, children, source)
