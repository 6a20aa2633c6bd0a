"""Files named by URIs in a URDF: ``package://``, ``model://``, ``file://``, and paths relative to the URDF."""

import glob
import os
import re
import site
import sys
from collections.abc import Iterator, Mapping
from typing import NamedTuple
from urllib.parse import unquote

from ravemj.core.caching import cached_property
from ravemj.formats.data_folders import data_folders
from ravemj.formats.file_access import FileAccess

SCHEMES = ("package", "model")
"""Schemes of URIs that start with the name of a package."""

_MOST_ABOVE = 12
"""Number of folders above a URDF in which a package is searched."""

_LONGEST_MANIFEST = 1 << 20
_MANIFEST_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
_REMOTE = re.compile(r"[a-z][a-z0-9+.-]+://", re.IGNORECASE)


class ResolvedPath(NamedTuple):
    """Result of the search for a file.

    Attributes:
        path: The file, or None.
        searched: The searched folders or paths, for messages.
        is_remote: Whether the URI is a network address, which ravemj does not read.
    """

    path: str | None
    searched: tuple[str, ...] = ()
    is_remote: bool = False


class Packages:
    """The search for the files of one URDF.

    Attributes:
        given: Folders of packages by name, from the user.
    """

    def __init__(self, urdf: str, access: FileAccess, given: Mapping[str, str]) -> None:
        self.given = given
        self._folder = os.path.dirname(urdf)
        self._access = access
        self._roots: dict[str, tuple[str, ...]] = {}

    def find(self, uri: str) -> ResolvedPath:
        """Look up the file of a URI."""
        scheme, separator, rest = uri.partition("://")
        if separator and scheme.lower() in SCHEMES:
            package, _, name = unquote(rest.lstrip("/")).partition("/")
            roots = self.roots(package)
            return self._first([os.path.join(root, name) for root in roots], roots)
        if uri.lower().startswith("file:"):
            path = unquote(uri[5:].removeprefix("//").removeprefix("localhost"))
            path = os.path.join(self._folder, path)
            return self._first([path, os.path.join(self._folder, os.path.basename(path))])
        if _REMOTE.match(uri):
            return ResolvedPath(None, is_remote=True)
        return self._first([os.path.join(folder, uri) for folder in (self._folder, *data_folders())])

    def _first(self, paths: list[str], searched: tuple[str, ...] = ()) -> ResolvedPath:
        """Return the first path that is permitted and a file; if none is, the paths searched."""
        for path in paths:
            if self._access.permits(path) and os.path.isfile(path):
                return ResolvedPath(os.path.normpath(path))
        return ResolvedPath(None, searched or tuple(paths))

    def roots(self, package: str) -> tuple[str, ...]:
        """Return the possible folders of a package, in the order of search."""
        if package not in self._roots:
            folders = (os.path.normpath(folder) for folder in self._candidates(package))
            self._roots[package] = tuple(
                dict.fromkeys(folder for folder in folders if self._access.permits(folder) and os.path.isdir(folder))
            )
        return self._roots[package]

    def _candidates(self, package: str) -> Iterator[str]:
        if package in self.given:
            yield self.given[package]
        if package in {"", ".", ".."}:
            return
        for folder in self._above:
            if os.path.basename(folder) == package or self._manifests[folder] == package:
                yield folder
            yield os.path.join(folder, package)
        for variable in ("ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"):
            yield from (path for folder in self._variable(variable) for path in _below(folder, package))
        for variable in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"):
            yield from (os.path.join(prefix, "share", package) for prefix in self._variable(variable))
        prefixes = (sys.prefix, *(os.path.join(folder, "cmeel.prefix") for folder in site.getsitepackages()))
        yield from (os.path.join(prefix, "share", package) for prefix in prefixes)
        yield from (os.path.join(folder, package) for folder in data_folders())

    @cached_property
    def _above(self) -> list[str]:
        """The folder of the URDF and its permitted parent folders, the nearest first."""
        folders = [os.path.abspath(self._folder)]
        while len(folders) <= _MOST_ABOVE and os.path.dirname(folders[-1]) != folders[-1]:
            folders.append(os.path.dirname(folders[-1]))
        return [folder for folder in folders if self._access.permits(folder)]

    @cached_property
    def _manifests(self) -> dict[str, str]:
        """Package name in the ``package.xml`` of each folder in `_above`; empty if there is none."""
        return {folder: _manifest_name(os.path.join(folder, "package.xml")) for folder in self._above}

    def _variable(self, name: str) -> list[str]:
        return [folder for folder in os.environ.get(name, "").split(os.pathsep) if folder]


def given_packages(text: str) -> dict[str, str]:
    """Return the folders by package in a text ``NAME=FOLDER``, with ``os.pathsep`` between several ones.

    Raises:
        ValueError: a part of it has another form.
    """
    folders: dict[str, str] = {}
    for word in filter(None, text.split(os.pathsep)):
        name, _, folder = word.partition("=")
        if not name or not folder:
            raise ValueError(f"'{word}' should be NAME=FOLDER")
        folders[name] = folder
    return folders


def _below(entry: str, package: str) -> Iterator[str]:
    """Yield possible folders of a package below a search-path entry, which may itself be the package."""
    if os.path.basename(os.path.normpath(entry)) == package:
        yield entry
    yield os.path.join(entry, package)
    yield from sorted(glob.glob(os.path.join(glob.escape(entry), "*", glob.escape(package))))


def _manifest_name(path: str) -> str:
    try:
        with open(path, "rb") as file:
            match = _MANIFEST_NAME.search(file.read(_LONGEST_MANIFEST))
    except OSError:
        return ""
    return match[1].decode(errors="replace") if match else ""
