"""XML documents under construction, shared by the writers of OpenRAVE XML and COLLADA."""

import math
import re
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from xml.sax.saxutils import escape

from ravemj.errors import OutputError

Content = str | float | bool | Iterable[float]
"""Content of an element or attribute: a text, a truth value, or numbers."""

_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML documents cannot contain, not even as references."""

_QUOTED = {'"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}


_HEAD = '<?xml version="1.0" encoding="utf-8"?>'


class XmlText:
    """Lines of XML, one element per line, indented by two spaces per level."""

    def __init__(self, level: int = 0) -> None:
        self._lines: list[str] = []
        self._indent = "  " * level

    def document(self) -> str:
        """Return the lines as a document."""
        return "\n".join([_HEAD, *self._lines, ""])

    def append(self, other: "XmlText") -> None:
        """Append the lines of another text."""
        self._lines += other._lines

    @contextmanager
    def inside(self, tag: str, /, **attributes: Content | None) -> Generator[None]:
        """Write an element around the content written in the block; attributes that are None are omitted."""
        self._lines.append(f"{self._indent}<{tag}{_attributes(attributes)}>")
        self._indent += "  "
        yield
        self._indent = self._indent[:-2]
        self._lines.append(f"{self._indent}</{tag}>")

    def element(self, tag: str, content: Content | None = None, /, **attributes: Content | None) -> None:
        """Write an element with or without text."""
        start = f"{self._indent}<{tag}{_attributes(attributes)}"
        text = "" if content is None else text_of(content, tag)
        self._lines.append(f"{start}>{escape(text, {chr(13): '&#13;'})}</{tag}>" if text else f"{start}/>")

    def element_inside(self, tag: str, inner: str, content: Content, /, **attributes: Content | None) -> None:
        """Write an element with attributes around another one with text."""
        with self.inside(tag, **attributes):
            self.element(inner, content)


def text_of(content: Content, tag: str) -> str:
    """Return a content as text: numbers with all their digits, integers without a point.

    Args:
        content: The content.
        tag: Name of its element or attribute, for messages.

    Raises:
        OutputError: XML cannot contain one of its characters, or a number is not finite, which OpenRAVE reads as 0.
    """
    if isinstance(content, str):
        forbidden = _FORBIDDEN.search(content)
        if forbidden is not None:
            raise OutputError(
                f"no XML file can hold the character {forbidden[0]!r} of {content!r}; choose another name"
            )
        return content
    if isinstance(content, bool):
        return "true" if content else "false"
    numbers = (content,) if isinstance(content, float | int) else tuple(content)
    if not all(map(math.isfinite, numbers)):
        forbidden = " ".join(map(str, numbers))
        raise OutputError(f"no file of OpenRAVE's can hold the number in '{tag}': {forbidden}; choose a finite one")
    return " ".join([repr(float(number) + 0.0).removesuffix(".0") for number in numbers])  # + 0.0: -0 becomes 0


def _attributes(attributes: dict[str, Content | None]) -> str:
    given = ((name.rstrip("_"), content) for name, content in attributes.items() if content is not None)
    return "".join([f' {name}="{escape(text_of(content, name), _QUOTED)}"' for name, content in given])
