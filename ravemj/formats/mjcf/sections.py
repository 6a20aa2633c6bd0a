"""An MJCF document as lines, to which elements can be added."""

import re
from collections.abc import Sequence

from ravemj.errors import Source
from ravemj.formats.mjcf.lines import XmlLines

_NAMED = re.compile(r'\s*<([\w]+) (?:.*? )?name="([^"]*)"')
_SECTION = re.compile(r"  <(\w+)>$")
_KINDS = {"freejoint": "joint"}
_OF_SECTION = {"equality", "tendon", "actuator", "sensor", "contact", "deformable", "keyframe", "custom"}
"""Sections in which all elements share one namespace, whatever their tags."""


class MjcfSections:
    """The lines of a document, one element each, and their sources.

    Attributes:
        lines: The lines.
        sources: For each line its source, or None.
    """

    def __init__(self, text: str, sources: Sequence[Source | None]) -> None:
        self.lines = text.removesuffix("\n").split("\n")  # names may have other separators
        self.sources = list(sources)

    @property
    def text(self) -> str:
        """The document."""
        return "\n".join(self.lines) + "\n"

    def add(self, section: str, content: XmlLines) -> None:
        """Add elements to a section, creating it if necessary."""
        if not content.text:
            return
        end = f"  </{section}>"
        if end in self.lines:
            self.insert(self.lines.index(end), content)
            return
        framed = XmlLines(1)
        framed.section(section, content)
        self.insert(self.lines.index("</mujoco>"), framed)

    def insert(self, index: int, content: XmlLines) -> None:
        """Insert lines before an index."""
        self.lines[index:index] = content.text
        self.sources[index:index] = content.sources

    def names(self) -> dict[tuple[str, str], Source | None]:
        """Return the source of each name, by namespace and name."""
        names: dict[tuple[str, str], Source | None] = {}
        section = ""
        for line, source in zip(self.lines, self.sources, strict=True):
            opened = _SECTION.match(line)
            section = opened[1] if opened else section
            named = _NAMED.match(line)
            if named:
                names[kind_of(named[1], section), named[2]] = source
        return names


def kind_of(tag: str, section: str) -> str:
    """Return the namespace of an element's name."""
    return section if section in _OF_SECTION else _KINDS.get(tag, tag)
