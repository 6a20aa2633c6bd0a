"""Lines of XML, each with its source in the user's file."""

import functools
import re

from ravemj.core.transforms import UNIT_WXYZ, ZERO, Pose
from ravemj.errors import Source

Attribute = str | float | bool | tuple[float, ...]

_INDENTS = ["  " * depth for depth in range(20)]
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
)
_ESCAPED = frozenset(map(chr, _ESCAPES))


class XmlLines:
    """XML text under construction, one element per line.

    Attributes:
        text: The lines.
        sources: For each line its source, or None.
    """

    def __init__(self, indent: int = 0) -> None:
        self.text: list[str] = []
        self.sources: list[Source | None] = []
        self._indent = indent

    def element(self, tag: str, source: Source | None = None, /, **attributes: Attribute | None) -> None:
        """Write an element without children; attributes that are None are left out."""
        self._line(f"<{tag}{_attributes(attributes)}/>", source)

    def text_element(self, name: str, data: str) -> None:
        """Write a ``<text>`` of ``<custom>`` in single quotes, since JSON contains many double quotes."""
        quoted = attribute_text(data.replace('"', "\0")).replace("\0", '"').replace("'", "&apos;")
        self._line(f"<text name=\"{attribute_text(name)}\" data='{quoted}'/>", None)

    def open(self, tag: str, source: Source | None = None, /, **attributes: Attribute | None) -> None:
        """Write a start tag."""
        self._line(f"<{tag}{_attributes(attributes)}>", source)
        self._indent += 1

    def close(self, tag: str) -> None:
        """Write an end tag."""
        self._indent -= 1
        self._line(f"</{tag}>", None)

    def comment(self, text: str, source: Source | None) -> None:
        """Write a comment."""
        self._line(f"<!-- {comment_text(text)} -->", source)

    def section(self, tag: str, content: "XmlLines") -> None:
        """Write a section with given content, unless it is empty."""
        if content.text:
            self.open(tag)
            self.text += content.text
            self.sources += content.sources
            self.close(tag)

    def _line(self, text: str, source: Source | None) -> None:
        self.text.append(f"{_INDENTS[self._indent] if self._indent < len(_INDENTS) else '  ' * self._indent}{text}")
        self.sources.append(source)


def comment_text(text: str) -> str:
    """Return a text made valid for a comment: on one line, without consecutive dashes."""
    if not text.isprintable():
        text = "".join(character if character.isprintable() else "?" for character in text)
    return re.sub("-(?=-)", "- ", text) if "--" in text else text


def pose_attributes(pose: Pose) -> dict[str, Attribute]:
    """Return ``pos`` and ``quat`` of a pose; an identity part is left out."""
    attributes: dict[str, Attribute] = {}
    position, wxyz = pose
    if position != ZERO:
        attributes["pos"] = position
    if wxyz != UNIT_WXYZ and any(wxyz[1:]):
        attributes["quat"] = wxyz
    return attributes


def attribute_text(value: Attribute) -> str:
    """Return an attribute's text; numbers keep all their digits."""
    if isinstance(value, tuple):
        return _numbers_text(value)
    if isinstance(value, str):
        return value if _ESCAPED.isdisjoint(value) else value.translate(_ESCAPES)
    if isinstance(value, bool):
        return "true" if value else "false"
    return _numbers_text((value,))


@functools.lru_cache(maxsize=10_000)  # models repeat sizes, colours and axes, and digits take time
def _numbers_text(values: tuple[float, ...]) -> str:
    """Return numbers separated by spaces; integers have no point, and zero has no minus sign."""
    return f"{' '.join(map(repr, values))} ".replace(".0 ", " ").replace("-0 ", "0 ")[:-1]


def _attributes(attributes: dict[str, Attribute | None]) -> str:
    return "".join([f' {name}="{attribute_text(value)}"' for name, value in attributes.items() if value is not None])
