"""User-defined fragment of MJCF that is added to a translated model."""

from ravemj.core.output import AnyPath
from ravemj.errors import SourceError
from ravemj.formats.mjcf.lines import Attribute, XmlLines
from ravemj.formats.mjcf.sections import MjcfSections, kind_of
from ravemj.formats.openrave_xml.tree import Element, parse_file

_ROOTS = ("mujoco", "mujocoinclude")
_REFUSED = {
    "include": "write its content here",
    "plugin": "load plugins where the model is used",
    "extension": "load plugins where the model is used",
    "compiler": "the model has angles in radians and meshes in assets/",
}
_SINGLE = {"option", "size", "visual", "statistic"}
"""MJCF sections of settings, in which a later value overrides an earlier one."""


def append(document: MjcfSections, path: AnyPath) -> None:
    """Add the elements of a file to the sections of a document.

    Raises:
        SourceError: the file is not a fragment of MJCF, reuses a name of the document, includes files, or has
            plugins.
    """
    parsed = parse_file(str(path))
    if parsed.error is not None:
        raise parsed.error
    root = parsed.root
    if root.spelled not in _ROOTS:
        hint = "put its sections into <mujoco>…</mujoco>"
        raise SourceError(f"<{root.spelled}> is no fragment of MJCF", root.source, hint)
    for section in root.children:
        _check(section, section.spelled, document)
        content = XmlLines(1)
        if section.spelled in _SINGLE:
            _write(section, content)
            document.insert(document.lines.index("</mujoco>"), content)
            continue
        content = XmlLines(2)
        for element in section.children:
            _write(element, content)
        document.add(section.spelled, content)


def _check(element: Element, section: str, document: MjcfSections) -> None:
    """Raise if an element or one of its descendants cannot be added, by its tag or by a name in use."""
    taken = document.names()
    pending = [element]
    while pending:
        inner = pending.pop()
        if inner.spelled in _REFUSED:
            hint = _REFUSED[inner.spelled]
            raise SourceError(f"<{inner.spelled}> cannot be added to a translated model", inner.source, hint)
        key = kind_of(inner.spelled, section), inner.attributes.get("name", "")
        if key in taken:
            there = taken[key]
            where = "" if there is None else f", which is that of {there}"
            message = f"the {inner.spelled} '{key[1]}' has a name that the model has already{where}"
            raise SourceError(message, inner.source, "choose another name")
        if inner.attributes.get("name"):
            taken[key] = inner.source
        pending += inner.children


def _write(element: Element, out: XmlLines) -> None:
    attributes: dict[str, Attribute | None] = {**element.attributes}
    if not element.children:
        out.element(element.spelled, element.source, **attributes)
        return
    out.open(element.spelled, element.source, **attributes)
    for child in element.children:
        _write(child, out)
    out.close(element.spelled)
