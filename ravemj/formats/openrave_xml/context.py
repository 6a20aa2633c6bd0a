"""The context of a reading: diagnostics, the search for files, and the traversal of an element's children."""

import functools
import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from ravemj.core.transforms import UNSCALED, Vec3
from ravemj.errors import LimitError, Source, SourceError
from ravemj.formats.collada import SUFFIXES as COLLADA_SUFFIXES
from ravemj.formats.collada.documents import Documents
from ravemj.formats.data_folders import data_folders
from ravemj.formats.file_access import FileAccess
from ravemj.formats.limits import MOST_FILES, MOST_MODEL_TRIANGLES, check_count
from ravemj.formats.meshes import MeshPart
from ravemj.formats.openrave_xml.tags import Tag, Target_contra
from ravemj.formats.openrave_xml.tree import Document, Element, parse_file
from ravemj.formats.openrave_xml.values import ChildTransform, is_false, is_true
from ravemj.formats.parameters import with_parameter
from ravemj.model.scene import Parameters

_MOST_ABOVE = 4
"""Number of parent folders that are searched for a referenced file; repositories are not nested deeper."""
FLAGS = {"enable", "circular", "render", "modifiable", "selfcollision", "skipgeometry"}
"""Attributes of any element that are true or false."""
PARAMETER_ATTRIBUTES = {"name": "what scripts ask for", "type": "floats, integers or text"}
_LONGEST_NAME = 80
"""Maximum length of an unknown name for which a similar known name is suggested."""


def uncomputable(element: Element) -> SourceError:
    """Return the error for an element whose numbers overflow."""
    return SourceError(
        f"a number in this <{element.spelled}> is too large or too small to compute with", element.source
    )


class Context:
    """State while reading a file and the files that it includes.

    Attributes:
        access: Controls which files may be read, and records those read.
        diagnostics: Receives diagnostics.
        documents: COLLADA documents of the model, and the size limit of all its XML documents.
    """

    def __init__(self, access: FileAccess) -> None:
        self.access = access
        self.diagnostics = access.diagnostics
        self.documents = Documents()
        self._inclusions = 0
        self._triangles = 0
        self._found: dict[tuple[str, str, tuple[str, ...]], str] = {}
        self._meshes: dict[tuple[str, Vec3, bool], tuple[MeshPart, ...]] = {}

    def walk(
        self,
        element: Element,
        tags: Mapping[str, Tag[Target_contra]],
        ignored: Mapping[str, str],
        target: Target_contra,
    ) -> None:
        """Read each child element that is in a table, in document order; report the others.

        Args:
            element: The parent of the children.
            tags: Readers of children by tag.
            ignored: Known tags without effect, and the reason.
            target: The object that receives the content of the children.
        """
        before: dict[object, Element] = {}
        for child in element.children:
            tag = tags.get(child.tag)
            if tag is not None:
                if not child.complete:
                    continue
                read, _, left_out, once = tag
                if once and (first := before.setdefault(read if once is True else once, child)) is not child:
                    place = f"<{first.spelled}> in line {first.source.line}"
                    message = f"<{child.spelled}> overrides {place}; the last one counts"
                    self.diagnostics.warn("repeated-tag", message, child.source, "write one")
                try:
                    read(target, child)
                except ArithmeticError as error:
                    raise uncomputable(child) from error
                if child.attributes and not left_out and not child.checked:
                    self.check_attributes(child, {}, {})
            elif child.tag in ignored:
                self.leave_out(child, ignored[child.tag])
            else:
                self.diagnostics.warn(
                    "unknown-tag",
                    f"OpenRAVE knows no <{child.spelled}> in <{element.spelled}> and skips it with all that it holds",
                    child.source,
                    _belongs(child) or did_you_mean(child.tag, tags),
                )

    def leave_out(self, element: Element, reason: str) -> None:
        """Report an element that has no effect here."""
        self.diagnostics.warn("ignored-tag", f"<{element.spelled}> is left out: {reason}", element.source)

    def check_attributes(self, element: Element, known: Mapping[str, str], ignored: Mapping[str, str]) -> None:
        """Report unknown and ignored attributes of an element; ``known`` gives meanings, ``ignored`` gives reasons."""
        element.checked = True
        for name, text in element.attributes.items():
            if name in FLAGS and not is_true(text) and not is_false(text):
                counted = "false" if name == "skipgeometry" else "true"
                message = f'{name}="{text}" counts as {counted} in OpenRAVE'
                self.diagnostics.warn("bad-flag", message, element.source, "write true or false")
            if name in known:
                continue
            if name in ignored:
                message = f"the attribute '{name}' of <{element.spelled}> is left out: {ignored[name]}"
                self.diagnostics.warn("ignored-attribute", message, element.source)
            elif not name.startswith("xmlns"):
                message = f"OpenRAVE knows no attribute '{name}' of <{element.spelled}> and skips it"
                self.diagnostics.warn("unknown-attribute", message, element.source, did_you_mean(name, known))

    def include(self, element: Element) -> Element | None:
        """Return the root of the file named by an element's ``file`` attribute.

        A missing file is skipped with a warning, as in OpenRAVE; for a malformed one, an error is reported, and the
        part before the error is read.

        Raises:
            SourceError: the file includes itself, or very many files are included.
        """
        name = element.attributes.get("file")
        if name is None:
            return None
        path = self.find(name, element.source)
        if path is None:
            return None
        if path.lower().endswith(COLLADA_SUFFIXES):
            message = f"{name} is left out: COLLADA files stand for a Robot or a KinBody only"
            self.diagnostics.error("unsupported-file", message, element.source)
            return None
        chain: Source | None = element.source
        while chain is not None:
            if _is_same_file(chain.file, path):
                raise SourceError(f"the file includes itself through {name}", element.source)
            chain = chain.included_from
        return self._included(path, element.source)

    def _included(self, path: str, source: Source) -> Element | None:
        self._inclusions += 1
        check_count(self._inclusions, MOST_FILES, "files in the model", source)
        self.access.files.setdefault(path, source)
        try:
            document = parse_file(path, source, self.documents.budget)
        except LimitError:
            raise
        except SourceError as error:
            self.diagnostics.error("broken-file", error.message, error.source)
            return None
        if document.error is not None:
            self.diagnostics.error("broken-file", document.error.message, document.error.source)
        self.check_end(document)
        return document.root

    def check_end(self, document: Document) -> None:
        """Warn of content after the end of the root element."""
        if document.unread is not None:
            message = f"what stands behind the end of <{document.root.spelled}> is not read, as in OpenRAVE"
            self.diagnostics.warn("unread", message, document.unread, "put it all into one <Environment>")

    def find(self, name: str, source: Source, *folders: str) -> str | None:
        """Search for a file in ``folders``, beside the file that names it, then in those of ``OPENRAVE_DATA``.

        If it is in none of them, as in a cloned repository, the folders above the file that names it are searched.

        Args:
            name: The file.
            source: The position of its name.
            folders: Folders to search first.

        Returns:
            Its path, or None, with a diagnostic, if it is in none of them or must not be read.
        """
        question = (name, source.file, folders)
        path = self._found.get(question)
        if path is not None:
            return path
        places = self.access.candidates(name, *folders, os.path.dirname(source.file))
        if not places and self.access.is_dropped:
            self.access.refuse(name, source)
            return None
        path = next(filter(os.path.isfile, places), None)
        if path is None:
            path = _found_above(name, os.path.dirname(source.file), self.access)
            if path is None:
                self._report_missing(name, source, places)
                return None
            message = f"{name} is in none of the places where OpenRAVE looks, so {path} is taken"
            self.diagnostics.warn("found-above", message, source, "OpenRAVE needs its folder in OPENRAVE_DATA")
        self._found[question] = path
        return path

    def _report_missing(self, name: str, source: Source, places: list[str]) -> None:
        if self.access.is_dropped:
            self.access.report_missing(name, source)
            return
        hint = "" if data_folders() else "put it there, or set OPENRAVE_DATA to the folder that it is in"
        message = f"there is no file '{name}'; looked at {', '.join(dict.fromkeys(places))}"
        self.diagnostics.warn("missing-file", message, source, hint)

    def with_parameter(self, before: Parameters, element: Element) -> Parameters:
        """Return ``before`` with the value of a ``<parameter>`` added; a malformed one is skipped, with a warning."""
        self.check_attributes(element, PARAMETER_ATTRIBUTES, {})
        try:
            return with_parameter(
                before, element.attributes.get("name", ""), element.attributes.get("type", ""), element.text
            )
        except ValueError as error:
            self.diagnostics.warn("bad-parameter", f"a parameter is left out: {error}", element.source)
            return before

    def mesh(
        self, name: str, source: Source, *folders: str, scale: Vec3 = UNSCALED, ros: bool = False
    ) -> tuple[MeshPart, ...]:
        """Return the triangles of a mesh file; none, with a warning, if it is missing or malformed.

        The parts are the same objects for every use with the same scale. ``ros`` is as for ``read_mesh``.
        """
        path = self.find(name, source, *folders)
        if path is None:
            return ()
        parts = self._meshes.get((path, scale, ros))
        if parts is None:
            parts = self._meshes[path, scale, ros] = self._read_mesh(path, source, scale, ros=ros)
            self._triangles += sum(len(part.mesh.triangles) for part in parts)
            check_count(self._triangles, MOST_MODEL_TRIANGLES, "triangles in the meshes of the model", source)
        return parts

    def _read_mesh(self, path: str, source: Source, scale: Vec3, *, ros: bool) -> tuple[MeshPart, ...]:
        self.access.files.setdefault(path, source if source.line else None)
        findings = len(self.diagnostics)
        from ravemj.formats.meshes.reading import read_mesh  # noqa: PLC0415 - most models have no meshes

        try:
            parts = read_mesh(path, scale, self.access, ros=ros)
            problem = "" if parts else f"{path}: there are no triangles in it"
        except SourceError as error:
            parts, problem = (), f"{error.source}: {error.message}"
        if problem and len(self.diagnostics) == findings:  # otherwise a refused file says why
            report = self.diagnostics.error if self.access.is_dropped else self.diagnostics.warn
            report("broken-mesh", problem, source)
        return parts


@dataclass
class Placed:
    """An element that is being read and has a transform of its own."""

    context: Context
    placement: ChildTransform = field(default_factory=ChildTransform)

    def translate(self, element: Element) -> None:
        """Read a ``<Translation>``."""
        self.placement.translate(element, self.context.diagnostics)

    def rotate(self, element: Element) -> None:
        """Read an element that specifies a rotation, such as ``<RotationAxis>``."""
        self.placement.rotate(element, self.context.diagnostics)


PLACEMENT_TAGS: dict[str, Tag[Placed]] = {
    "translation": Tag(Placed.translate, "x y z [m]; several add up, and rotations do not turn them"),
    "rotationaxis": Tag(Placed.rotate, "axis x y z of any length, angle [deg]"),
    "rotationmat": Tag(Placed.rotate, "nine numbers, row by row"),
    "quat": Tag(Placed.rotate, "w x y z"),
}


def _found_above(name: str, folder: str, access: FileAccess) -> str | None:
    """Return the path of a file in a folder above ``folder``; None if no folder or several folders contain it.

    The search ends at the root of a repository, or after ``_MOST_ABOVE`` folders.
    """
    if os.path.isabs(name):
        return None
    paths: set[str] = set()
    for _ in range(_MOST_ABOVE):
        if os.path.exists(os.path.join(folder, ".git")):
            break
        folder = os.path.normpath(os.path.join(folder, os.pardir))
        path = os.path.join(folder, name)
        paths.update([path] if access.permits(path) and os.path.isfile(path) else [])
    return paths.pop() if len(paths) == 1 else None


def _is_same_file(first: str, second: str) -> bool:
    try:
        return os.path.samefile(first, second)
    except OSError:  # one is gone, or was never a file
        return first == second


_HOMES = {
    **dict.fromkeys(("body", "joint", "adjacent"), "KinBody"),
    **dict.fromkeys(("geom", "mass", "offsetfrom"), "Body"),
    **dict.fromkeys(("extents", "radius", "height", "diffusecolor", "ambientcolor", "transparency"), "Geom"),
    **dict.fromkeys(("axis", "anchor", "limits", "limitsdeg", "maxvel", "weight"), "Joint"),
    **dict.fromkeys(("manipulator", "attachedsensor", "controller"), "Robot"),
    **dict.fromkeys(("base", "effector"), "Manipulator"),
    **dict.fromkeys(("density", "total", "com", "inertia"), "Mass"),
    **dict.fromkeys(("robot", "kinbody", "bkgndcolor", "camtrans", "camrotationaxis", "physicsengine"), "Environment"),
}


def _belongs(element: Element) -> str:
    """Return a hint for a misplaced element, or an empty text."""
    home = _HOMES.get(element.tag)
    return "" if home is None else f"<{element.spelled}> belongs in <{home}>"


def did_you_mean(name: str, known: Collection[str]) -> str:
    """Return a hint with the most similar known name, or an empty text."""
    return _closest(name, tuple(known)) if len(name) < _LONGEST_NAME else ""


@functools.lru_cache(maxsize=1000)  # slow, and who spells a tag wrongly does so many times
def _closest(name: str, known: tuple[str, ...]) -> str:
    import difflib  # noqa: PLC0415 - slow to import

    similar = difflib.get_close_matches(name, known, n=1)
    return f"did you mean '{similar[0]}'?" if similar else ""
