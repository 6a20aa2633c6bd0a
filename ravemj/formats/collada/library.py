"""COLLADA documents opened while reading a model, and the references between their elements."""

import os
import posixpath
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple
from urllib.parse import unquote

from lxml import etree

from ravemj.errors import LimitError, Source, SourceError
from ravemj.formats.collada.archive import Archive
from ravemj.formats.collada.documents import Documents
from ravemj.formats.file_access import FileAccess
from ravemj.formats.limits import MOST_FILES, check_count
from ravemj.formats.meshes.collada.document import (
    ColladaDocument,
    Element,
    attribute_number,
    child,
    children,
    local_name,
    numbers,
    words,
)
from ravemj.formats.meshes.files import read_bytes

ARCHIVE_SUFFIX = ".zae"
_LONGEST_CHAIN = 20

_MODELS = {
    "instance_articulated_system",
    "instance_kinematics_model",
    "instance_joint",
    "instance_physics_model",
    "instance_node",
    "instance_formula",
}


class ResolvedReference(NamedTuple):
    """The result of resolving a reference.

    Attributes:
        element: The element.
        through: The instance elements that the path to it passes through.
    """

    element: Element
    through: tuple[Element, ...] = ()


class Library:
    """COLLADA documents opened while reading a model.

    Attributes:
        diagnostics: Receives diagnostics.
    """

    def __init__(
        self,
        access: FileAccess,
        included_from: Source | None = None,
        scale: float = 1.0,
        documents: Documents | None = None,
    ) -> None:
        self.diagnostics = access.diagnostics
        self._access = access
        self._scale = scale
        self._included_from = included_from
        self._documents = documents or Documents()
        self._opened_here: dict[str, ColladaDocument] = {}
        self._of_root: dict[Element, ColladaDocument] = {}
        self._units: dict[Element, float] = {}
        self._reported: set[tuple[Element, str]] = set()
        self._scopes: dict[Element, dict[str, ResolvedReference]] = {}

    def open_file(self, path: str, named_by: Source | None = None) -> ColladaDocument:
        """Return the document of a ``.dae`` file, or the main document of a ``.zae`` archive.

        Raises:
            SourceError: It cannot be read, or is not COLLADA.
        """
        self._access.files.setdefault(path, named_by or self._included_from)
        if not path.lower().endswith(ARCHIVE_SUFFIX):
            return self._opened(path, None, path)
        archive = self._documents.archives.get(path)
        if archive is None:
            archive = self._documents.archives[path] = Archive(path)
        return self._member(archive, archive.root())

    def open_text(self, data: bytes, name: str) -> ColladaDocument:
        """Return the document of a text; files that it names are searched in the working folder."""
        return self._parsed(data, name, None, name)

    def document_of(self, element: Element) -> ColladaDocument:
        """Return the document that contains an element."""
        return self._of_root[element.getroottree().getroot()]

    def source(self, element: Element) -> Source:
        """Return the source position of an element, for messages."""
        return self.document_of(element).source(element)._replace(included_from=self._included_from)

    def warn(self, code: str, message: str, element: Element, hint: str = "") -> None:
        """Report a warning about an element, with its ``label`` in the message; repeated warnings are dropped."""
        if (element, message) not in self._reported:
            self._reported.add((element, message))
            self.diagnostics.warn(code, f"{label(element)}: {message}", self.source(element), hint)

    def error(self, message: str, element: Element, hint: str = "") -> SourceError:
        """Return an error about an element, with its ``label`` in the message."""
        return SourceError(f"{label(element)}: {message}", self.source(element), hint)

    def follow(self, element: Element, *kinds: str, attribute: str = "url") -> Element | None:
        """Return the element to which a URL in an attribute refers.

        Args:
            element: The element with the attribute.
            kinds: Permitted kinds; by default the kind of which the element is an instance.
            attribute: The attribute.

        Returns:
            The element; None, with a warning, if it does not exist.
        """
        kinds = kinds or (local_name(element).removeprefix("instance_"),)
        url = (element.get(attribute) or "").strip()
        target = self._find(element, url, kinds) if url else None
        if target is None:
            self.warn("broken-reference", f"there is no {' or '.join(kinds)} '{url}'", element)
        return target

    def _find(self, element: Element, url: str, kinds: tuple[str, ...]) -> Element | None:
        file, _, name = url.partition("#")
        document = self._document(self.document_of(element), file, element) if file else self.document_of(element)
        if document is None:
            return None
        items = (document.find(kind, name or None) for kind in kinds)
        return next((item for item in items if item is not None), None)

    def _document(self, here: ColladaDocument, uri: str, element: Element) -> ColladaDocument | None:
        """Return the document that a URI in ``here`` names; None, with a warning, if it is missing or malformed."""
        archive, name = self._documents.places[here.path]
        plain = unquote(uri.partition(":")[2].lstrip("/") if uri.startswith("openrave:") else uri.removeprefix("file:"))
        plain = plain.removeprefix("./")  # so that a file has one name
        try:
            if archive is not None and not uri.startswith(("openrave:", "file:")):
                member = archive.member(plain, posixpath.dirname(name))
                if member is not None:
                    return self._member(archive, member)
            folder = os.path.dirname(name if archive is None else archive.path)
            paths = self._access.candidates(plain, *([] if uri.startswith("openrave:") else [folder]))
            path = next(filter(os.path.exists, paths), None)
            if path is not None:
                return self.open_file(path, self.source(element))
            if self._access.is_dropped:
                report = self._access.report_missing if paths else self._access.refuse
                report(uri, self.source(element))
            else:
                self.warn("missing-file", f"there is no file {uri}", element, "put it there, or set OPENRAVE_DATA")
        except LimitError:
            raise
        except SourceError as error:
            self.warn("broken-file", f"{error.source}: {error.message}", element)
        return None

    def _member(self, archive: Archive, name: str) -> ColladaDocument:
        return self._opened(archive.place(name), archive, name)

    def _opened(self, path: str, archive: Archive | None, name: str) -> ColladaDocument:
        if path in self._opened_here:
            return self._opened_here[path]
        known = self._documents.parsed.get(path)
        if known is None:
            return self._parsed(read_bytes(path) if archive is None else archive.read(name), path, archive, name)
        self._documents.budget.add_elements(known.elements, Source(path))
        return self._registered(known)

    def _parsed(self, data: bytes, path: str, archive: Archive | None, name: str) -> ColladaDocument:
        document = ColladaDocument(data, path, self._documents.budget)
        check_count(len(self._documents.parsed), MOST_FILES, "files in the model", Source(path))
        self._documents.parsed[path] = document
        self._documents.places[path] = (archive, name)
        return self._registered(document)

    def _registered(self, document: ColladaDocument) -> ColladaDocument:
        self._opened_here[document.path] = document
        self._of_root[document.root] = document
        return document

    def metres(self, element: Element) -> float:
        """Return the length unit of an element [m], multiplied by the scale that the user has chosen."""
        return self._scale * self._unit(element)

    def _unit(self, element: Element) -> float:
        """Return the length of the unit in the nearest enclosing ``<asset>`` [m]."""
        metres = self._units.get(element)
        if metres is None:
            asset = child(element, "asset", "unit")
            unit = child(element, "extra", "asset", "unit") if asset is None else asset
            parent = element.getparent()
            outer = 1.0 if parent is None else self._unit(parent)
            metres = self._units[element] = outer if unit is None else attribute_number(unit, "meter", outer)
            if unit is not None and unit.get("meter") and attribute_number(unit, "meter", 0.0) <= 0.0:
                message = f"'{unit.get('meter')}' is no length, which is a number above 0; {metres:g} m counts"
                self.warn("bad-number", message, unit)
        return metres

    def resolve(self, path: str, scope: Element) -> ResolvedReference | None:
        """Resolve a path of names.

        The first name is an id, or a sid in the scope or an enclosing one; ``.`` is the scope itself. Each further name
        is a sid below the previous element or, if that is an instance, below its target.
        """
        first, *rest = path.strip().split("/")
        for start in self._starts(first, scope):
            place: ResolvedReference | None = start
            for name in rest:
                place = None if place is None else self._below(place, name)
            if place is not None:
                return place
        return None

    def _starts(self, name: str, scope: Element) -> Iterator[ResolvedReference]:
        if name == ".":
            yield ResolvedReference(scope)
            return
        for element in self.document_of(scope).identified(name):
            yield ResolvedReference(element)
        for around in (scope, *scope.iterancestors()):
            place = self._scope(around).get(name)
            if place is not None:
                yield place

    def _below(self, place: ResolvedReference, name: str) -> ResolvedReference | None:
        inner = self._scope(place.element).get(name)
        return None if inner is None else ResolvedReference(inner.element, (*place.through, *inner.through))

    def _scope(self, element: Element) -> dict[str, ResolvedReference]:
        """Return the descendants of an element by sid, also in instantiated models; of equal sids the nearest one."""
        names = self._scopes.get(element)
        if names is not None:
            return names
        names = self._scopes[element] = {}
        queue: deque[ResolvedReference] = deque([ResolvedReference(element)])
        entered = {element}
        while queue:
            around, through = queue.popleft()
            target = self._target(around)
            if target is not None and target not in entered:
                entered.add(target)
                queue.append(ResolvedReference(target, (*through, around)))
            for item in around.iterchildren(etree.Element):
                if item in entered:
                    continue
                entered.add(item)
                name = item.get("sid") or (item.get("symbol") if local_name(item) == "bind" else None)
                if name:
                    names.setdefault(name, ResolvedReference(item, through))
                if len(item) or item.get("url"):
                    queue.append(ResolvedReference(item, through))
        return names

    def _target(self, element: Element) -> Element | None:
        """Return the model to which an instance element refers; None for other elements."""
        if not element.get("url") or local_name(element) not in _MODELS:
            return None
        return self.follow(element)

    def parameter(self, name: str, *scopes: Element) -> ResolvedReference | None:
        """Resolve a parameter to an element that is not a parameter, or to a parameter with a literal value.

        Its name, which may be a path, is searched in the scopes in order.
        """
        place = next((item for scope in scopes if (item := self.resolve(name, scope)) is not None), None)
        for _ in range(_LONGEST_CHAIN):
            path = None if place is None else _reference(place.element)
            if place is None or path is None:
                return place
            inner = self.resolve(path, place.element)
            place = None if inner is None else ResolvedReference(inner.element, (*place.through, *inner.through))
        return None

    def value(self, element: Element | None, *scopes: Element) -> Element | None:
        """Return the element with a literal value: the given one or, if it names a parameter, that of the parameter."""
        if element is None:
            return None
        param = child(element, "param")
        if param is None:
            return element
        name = (param.get("ref") or "".join(words(param))).strip()
        place = self.parameter(name, element, *scopes) if name else None
        return None if place is None else place.element

    def number(self, element: Element | None, *scopes: Element) -> float | None:
        """Return a number in an element, in its ``<float>``, or in the parameter that it names."""
        value = self.value(element, *scopes)
        if value is None:
            return None
        plain = next(children(value, "float", "int"), value)
        values = numbers(plain)
        return float(values[0]) if len(values) else None

    def truth(self, element: Element | None, default: bool, *scopes: Element) -> bool:
        """Return a truth value in an element, in its ``<bool>``, or in the parameter that it names."""
        value = self.value(element, *scopes)
        text = words(child(value, "bool") if child(value, "bool") is not None else value)
        return default if not text else text[0].lower() not in {"false", "0"}


def _reference(element: Element) -> str | None:
    """Return the path to which a bind or parameter refers; None for other elements and for literal values."""
    if local_name(element) == "bind":
        param = child(element, "param")
        return None if param is None else param.get("ref") or "".join(words(param))
    if local_name(element) not in {"newparam", "setparam"}:
        return None
    text = words(child(element, "SIDREF"))
    return "".join(text) if text else None


def label(element: Element) -> str:
    """Return a name of an element for messages: its tag, and its own or the nearest ancestor's id, sid or name."""
    tag = f"<{local_name(element)}>"
    for around in (element, *element.iterancestors(etree.Element)):
        for attribute in ("id", "sid", "name"):
            name = around.get(attribute)
            if name:
                return f"{tag} '{name}'" if around is element else f"{tag} in <{local_name(around)}> '{name}'"
    return tag
