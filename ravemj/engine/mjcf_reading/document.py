"""MJCF text: the files of a model, and the positions of its elements.

MuJoCo accepts text that is not strict XML, and its errors do not name included files. So this module scans only tags,
for positions and referenced files; MuJoCo interprets them.
"""

import html
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from ravemj.errors import Source, SourceError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.limits import MOST_ELEMENTS, MOST_FILES, check_count
from ravemj.formats.openrave_xml.tree import content_of

_TAG = re.compile(
    r"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(/?)([A-Za-z_][\w:.-]*+)((?:[^<>"']++|"[^"]*+"|'[^']*+')*+)>""",
    re.DOTALL,
)
_ATTRIBUTE = re.compile(r"""([\w:.-]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_FOLDERS = {"mesh": ("meshdir", "assetdir"), "hfield": ("assetdir", "texturedir", "meshdir"), "model": ("assetdir",)}
_NUMBERS = ("hfield",)
"""XML elements that refer to files of raw numbers."""

_COPIES = {"replicate": "count", "composite": "count", "flexcomp": "count"}
_MOST_COPIES = 100_000
_MOST_LOOKED_AT = 100
"""Maximum number of files of a folder that are searched for the model that includes a partial model."""


class StartTag(NamedTuple):
    """Start tag of an element: name, attributes, and position."""

    name: str
    attributes: dict[str, str]
    source: Source


def tags_of(text: str, path: str, included_from: Source | None = None) -> Iterator[StartTag]:
    """Yield the start tags of a document, in order."""
    line, position = 1, 0
    for match in _TAG.finditer(text):
        if match[2] is None or match[1]:
            continue
        line += text.count("\n", position, match.start())
        position = match.start()
        attributes = {
            name: html.unescape(double_quoted or other) for name, double_quoted, other in _ATTRIBUTE.findall(match[3])
        }
        yield StartTag(match[2], attributes, Source(path, line, included_from))


@dataclass
class MjcfDocument:
    """Text of a model and of the files that it includes.

    Attributes:
        path: The file, or a name for the text in messages.
        text: Its text.
        access: The files that may be read, and those that were read.
        tags: All start tags; those of an included file replace its ``<include>``.
        named: The first tag of each kind of element and name.
        files: Tags that name files, by the last component of the path.
        paths: Paths of these files, as far as they were found.
    """

    path: str
    text: str
    access: FileAccess
    tags: list[StartTag] = field(default_factory=lambda: [])
    named: dict[tuple[str, str], StartTag] = field(default_factory=dict[tuple[str, str], StartTag])
    files: dict[str, StartTag] = field(default_factory=dict[str, StartTag])
    paths: dict[str, str] = field(default_factory=dict[str, str])

    @classmethod
    def parse(cls, path: str, content: bytes, access: FileAccess) -> "MjcfDocument":
        """Read the text of a model.

        Raises:
            SourceError: the model is only a part, has a plugin, is too large, or names a file that must not be read.
        """
        document = cls(path, content.decode("utf-8", "replace"), access)
        document._add(document.text, path, None, ())
        if not document.tags:
            raise SourceError("the first tag has no end", Source(path, 1))
        root = document.tags[0]
        if root.name != "mujoco":
            raise SourceError("this is a part of a model", root.source, document.includer_hint())
        document._check_counts()
        document._check_files()
        return document

    def source(self, name: str, *kinds: str) -> Source:
        """Return the position of an element, given its name and possible tags; else the position of the file."""
        for kind in kinds:
            if (kind, name) in self.named:
                return self.named[kind, name].source
        return self.tags[0].source

    def first(self, *kinds: str) -> Source | None:
        """Return the position of the first element of some tags, or None."""
        return next((tag.source for tag in self.tags if tag.name in kinds), None)

    def includer_hint(self) -> str:
        """Return a hint that names the file that includes this partial model; empty if there is none."""
        folder, name = os.path.split(self.path)
        try:
            others = sorted(os.listdir(folder or "."))[:_MOST_LOOKED_AT]
        except OSError:
            return ""
        for other in others:
            path = os.path.join(folder, other)
            if other == name or not other.endswith(".xml") or not self.access.permits(path):
                continue
            try:
                text = content_of(path).decode("utf-8", "replace")
            except SourceError:
                continue
            for tag in tags_of(text, path):
                if tag.name == "include" and os.path.normpath(tag.attributes.get("file", "")) == name:
                    return f"open {other}, which includes it"
        return "open the file that includes it"

    def _add(self, text: str, path: str, included_from: Source | None, chain: tuple[str, ...]) -> None:
        here = (*chain, os.path.realpath(path))
        for tag in tags_of(text, path, included_from):
            self.tags.append(tag)
            check_count(len(self.tags), MOST_ELEMENTS, "elements in the model", tag.source)
            self.named.setdefault((tag.name, tag.attributes.get("name", "")), tag)
            if tag.name == "plugin":
                message = "plugins are not loaded, and the model needs one"
                raise SourceError(message, tag.source, "leave it out")
            if tag.name == "include" and "file" in tag.attributes:
                self._include(tag, os.path.dirname(path), here)

    def _include(self, tag: StartTag, folder: str, chain: tuple[str, ...]) -> None:
        name = tag.attributes["file"]
        path = self._existing(name, os.path.dirname(self.path), folder)
        if path is None:
            raise SourceError(f"there is no file '{name}' to include", tag.source)
        if os.path.realpath(path) in chain:
            raise SourceError(f"the file includes itself through {name}", tag.source)
        self._read(path, name, tag)
        check_count(len(self.access.files), MOST_FILES, "files in the model", tag.source)
        self._add(content_of(path, tag.source).decode("utf-8", "replace"), path, tag.source, chain)

    def _existing(self, name: str, *folders: str) -> str | None:
        paths = (os.path.normpath(os.path.join(folder, name)) for folder in folders)
        return next((path for path in paths if os.path.isfile(path)), None)

    def _read(self, path: str, name: str, tag: StartTag) -> None:
        """Record that a file is read.

        Raises:
            SourceError: it must not be read.
        """
        is_raw = tag.name in _NUMBERS and not path.lower().endswith(".png")
        folder = os.path.abspath(os.path.dirname(self.path))
        permitted = self.access.permits(path)
        if is_raw and permitted:
            permitted = self.access.permits_part(os.path.abspath(path), folder, is_raw=True)
        if not permitted:
            raise self.access.refuse(name, tag.source, is_raw=is_raw)
        self.access.files.setdefault(path, tag.source)

    def _check_files(self) -> None:
        """Check that meshes, height fields and attached models may be read; MuJoCo opens them at the same paths."""
        folders = {key: tag.attributes[key] for tag in self.tags for key in _KEYS if key in tag.attributes}
        for tag in self.tags:
            name = tag.attributes.get("file")
            if tag.name not in _FOLDERS or name is None:
                continue
            self.files.setdefault(base_name(name), tag)
            beside = [os.path.dirname(self.path), os.path.dirname(tag.source.file)]
            places = [os.path.join(folder, folders.get(key, "")) for folder in beside for key in _FOLDERS[tag.name]]
            path = self._existing(name, *places, *beside)
            if path is None:
                if self.access.is_dropped:  # MuJoCo may find it elsewhere
                    raise SourceError(f"there is no file '{name}' with what was dropped", tag.source)
                continue
            self.paths.setdefault(base_name(name), path)
            is_new = path not in self.access.files
            self._read(path, name, tag)
            if tag.name == "model" and is_new:
                MjcfDocument.parse(path, content_of(path, tag.source), self.access)

    def _check_counts(self) -> None:
        """Reject excessive numbers of replicas before MuJoCo creates them."""
        for tag in self.tags:
            total = 1.0
            for word in tag.attributes.get(_COPIES.get(tag.name, ""), "").split():
                total *= float(word) if word.isdecimal() else 1.0
            check_count(int(min(total, 1e15)), _MOST_COPIES, "copies of an element", tag.source)


def base_name(file: str) -> str:
    """Return the last component of a path with any separators."""
    return file.replace("\\", "/").rpartition("/")[2]


_KEYS = ("meshdir", "assetdir", "texturedir")
