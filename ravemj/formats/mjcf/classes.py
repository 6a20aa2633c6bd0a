"""Default classes of joints and geoms, for repeated attributes."""

import re
from collections import Counter
from typing import NamedTuple

from ravemj.formats.mjcf.lines import XmlLines
from ravemj.formats.mjcf.sections import MjcfSections

_ELEMENT = re.compile(r"(\s*)<(joint|geom) (.*)/>$")
_ATTRIBUTE = re.compile(r'(\w+)="([^"]*)"')
_SHARED = {
    "joint": ("type", "range", "limited", "armature", "damping", "frictionloss", "actuatorfrcrange"),
    "geom": ("contype", "conaffinity", "rgba"),
}
_LEAST = 16  # characters that a class has to save in each element


class _Class(NamedTuple):
    """MJCF default class to create: tag of its elements, parent class, and the attributes that they share."""

    tag: str
    parent: str
    attributes: tuple[tuple[str, str], ...]


def add_classes(document: MjcfSections) -> None:
    """Move attributes that several joints or geoms of a document share into classes."""
    numbered: list[tuple[int, _Class]] = []
    first = document.lines.index("  <worldbody>")
    for number in range(first, document.lines.index("  </worldbody>")):
        element = _ELEMENT.match(document.lines[number])
        if element:
            given = _ATTRIBUTE.findall(element[3])
            shared = tuple(attribute for attribute in given if attribute[0] in _SHARED[element[2]])
            numbered.append((number, _Class(element[2], dict(given).get("class", ""), shared)))
    counts = Counter(shared_class for _, shared_class in numbered)
    names: dict[_Class, str] = {}
    for shared_class, count in counts.items():
        if count > 1 and sum(len(name) + len(value) + 4 for name, value in shared_class.attributes) >= _LEAST:
            base = shared_class.parent or shared_class.tag
            names[shared_class] = f"{base}{1 + sum((other.parent or other.tag) == base for other in names)}"
    for number, shared_class in numbered:
        if shared_class in names:
            document.lines[number] = _with_class(document.lines[number], shared_class, names[shared_class])
    for shared_class, name in reversed(names.items()):
        _declare(document, shared_class, name)


def _with_class(line: str, shared: _Class, name: str) -> str:
    """Return an element's line with a class in place of the shared attributes."""
    for attribute, value in shared.attributes:
        line = line.replace(f' {attribute}="{value}"', "", 1)
    if shared.parent:
        return line.replace(f' class="{shared.parent}"', f' class="{name}"', 1)
    head, tail = line.split(f"<{shared.tag}", 1)
    return f'{head}<{shared.tag} class="{name}"{tail}'


def _declare(document: MjcfSections, shared: _Class, name: str) -> None:
    """Insert the ``<default>`` of a class, nested in the elements' previous class if they have one."""
    start = document.lines.index("  <default>")
    indent = 2
    if shared.parent:
        start, indent = document.lines.index(f'    <default class="{shared.parent}">') + 1, 3
    content = XmlLines(indent)
    content.open("default", **{"class": name})
    content.element(shared.tag, **dict(shared.attributes))
    content.close("default")
    document.insert(start + 1, content)
