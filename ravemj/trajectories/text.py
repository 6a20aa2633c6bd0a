"""Layouts as OpenRAVE's XML."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ravemj.errors import ArgumentError, ErrorCode, SourceError
from ravemj.trajectories.groups import Group
from ravemj.trajectories.layout import flaw

if TYPE_CHECKING:
    from ravemj.formats.openrave_xml.tree import Element


def layout_text(groups: Sequence[Group]) -> str:
    """Return the ``<configuration>`` element of a layout, a group a line."""
    from xml.sax.saxutils import quoteattr  # noqa: PLC0415 - imports urllib, which is slow

    lines = [
        f"<group name={quoteattr(group.name)} offset={quoteattr(str(group.offset))} dof={quoteattr(str(group.dof))} "
        f"interpolation={quoteattr(group.interpolation)}/>"
        for group in sorted(groups, key=lambda group: group.offset)
    ]
    return "\n".join(["<configuration>", *lines, "</configuration>", ""])


def read_layout(text: str) -> list[Group]:
    """Return the layout in a text.

    Raises:
        ArgumentError: the text is no layout, or values are in two groups of it or in none.
    """
    root = read_element(text, "configuration")
    groups = groups_of(root)
    wrong = flaw(groups)
    if wrong is not None:
        raise ArgumentError(f"xmldata: {wrong}", ErrorCode.Assert)
    return groups


def read_element(text: str, tag: str) -> "Element":
    """Return the root element of a text.

    Raises:
        ArgumentError: the text is no XML, or its root has another name.
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
        ArgumentError: an offset or a number of values is no integer.
    """
    groups: list[Group] = []
    for child in configuration.children:
        if child.tag == "group":
            given = child.attributes
            try:
                offset, dof = int(given.get("offset", "0")), int(given.get("dof", "0"))
            except ValueError:
                raise ArgumentError(f"{child.source}: offset and dof should be integers") from None
            groups.append(Group(given.get("name", ""), offset, dof, given.get("interpolation", "")))
    return groups
