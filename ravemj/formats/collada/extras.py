"""``<extra>`` elements: OpenRAVE's, and ravemj's for properties that neither COLLADA nor OpenRAVE's can represent."""

from collections.abc import Generator, Iterator
from contextlib import contextmanager

from ravemj.formats.meshes.collada.document import Element, children
from ravemj.formats.xml_text import XmlText

PROFILE = "ravemj"
"""Type and profile of ravemj's own extras, which other programs skip."""


def extras(element: Element | None, kind: str = PROFILE) -> Iterator[tuple[Element, Element]]:
    """Yield the ``<extra>`` elements of a type in an element, each with its ``<technique>``."""
    for extra in children(element, "extra"):
        if extra.get("type") == kind:
            for technique in children(extra, "technique"):
                if technique.get("profile") == _profile(kind):
                    yield extra, technique


def own_techniques(element: Element | None) -> Iterator[Element]:
    """Yield the ``<technique>`` elements of ravemj's extras in an element."""
    return (technique for _, technique in extras(element))


@contextmanager
def inside_extra(out: XmlText, kind: str = PROFILE, name: str | None = None) -> Generator[None]:
    """Write an ``<extra>`` of a type around the content written in the block."""
    with out.inside("extra", type=kind, name=name), out.inside("technique", profile=_profile(kind)):
        yield


def _profile(kind: str) -> str:
    return kind if kind == PROFILE else "OpenRAVE"
