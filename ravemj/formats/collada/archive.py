"""Archives of COLLADA files (``.zae``): zip files with a manifest that names the main document."""

import io
import os
import posixpath
import zipfile
import zlib
from urllib.parse import unquote

from ravemj.errors import Source, SourceError
from ravemj.formats.limits import MOST_FILES, ParsingBudget, check_count, check_unpacked, most_unpacked
from ravemj.formats.meshes.collada.document import parse_tree, words
from ravemj.formats.meshes.files import read_bytes

_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
"""ZIP compression methods that OpenRAVE supports. With others, Python does not limit the unpacked size."""
_ENTRY = b"PK\1\2"  # begins an entry of the directory
_DAMAGES = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError, ValueError)
"""Undocumented exceptions of ``zipfile`` for damaged or encrypted archives."""


class Archive:
    """An opened archive. Files in it are read without writing to the disk.

    Attributes:
        path: Its path.
    """

    def __init__(self, path: str) -> None:
        """Open an archive.

        Raises:
            SourceError: It is missing, too large, or not a zip file.
        """
        self.path = path
        data = read_bytes(path)
        check_count(data.count(_ENTRY), MOST_FILES, "files in the archive", Source(path))
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(data))
        except _DAMAGES as error:
            raise SourceError(f"this is not a zip archive: {error}", Source(path)) from error
        self._members = {posixpath.normpath(name): name for name in reversed(self._zip.namelist())}
        self._packed, self._unpacked = len(data), 0

    def root(self) -> str:
        """Return the name of the main document.

        Raises:
            SourceError: The manifest is malformed or names a file outside of the archive, or there is no document.
        """
        manifest = Source(self.place("manifest.xml"))
        named = self._named_by_manifest(manifest)
        if named is not None:
            name = self.member(named)
            if name is None:
                raise SourceError(f"the manifest names '{named}', which is not in the archive", manifest)
            return name
        documents = [name for name in self._zip.namelist() if name.lower().endswith(".dae")]
        if not documents:
            raise SourceError("there is no .dae file in the archive", Source(self.path))
        return documents[0]

    def member(self, name: str, folder: str = "") -> str | None:
        """Return the full name of a file, given relative to a folder in the archive; None if it does not exist."""
        return self._members.get(posixpath.normpath(posixpath.join(folder, name)))

    def read(self, name: str) -> bytes:
        """Return the content of a file.

        Raises:
            SourceError: It is damaged or encrypted, or the unpacked archive is too large.
        """
        source = Source(self.place(name))
        if self._zip.getinfo(name).compress_type not in _METHODS:
            raise SourceError("it is not compressed by deflate, as OpenRAVE expects", source, "pack the archive anew")
        try:
            with self._zip.open(name) as file:
                data = file.read(max(most_unpacked(self._packed) - self._unpacked, 0))
        except _DAMAGES as error:
            raise SourceError(f"the archive is damaged or encrypted: {error}", source) from error
        self._unpacked += len(data)
        check_unpacked(self._unpacked, self._packed, Source(self.path))
        return data

    def unpack(self, folder: str) -> None:
        """Write all files into a new folder.

        Raises:
            SourceError: A file is damaged or too large, or its name is outside of the folder.
        """
        for inside, name in self._members.items():
            if inside.startswith(("/", "..")) or ":" in inside or "\\" in inside:
                raise SourceError(f"it has a file '{name}' outside of itself", Source(self.path), "pack it anew")
            if name.endswith("/"):
                continue
            place = os.path.join(folder, *inside.split("/"))
            try:
                os.makedirs(os.path.dirname(place), exist_ok=True)
                with open(place, "xb") as file:
                    file.write(self.read(name))
            except OSError as error:
                raise SourceError(f"'{name}' cannot be unpacked: {error.strerror}", Source(self.path)) from error

    def place(self, name: str) -> str:
        """Return the name of a file of the archive for messages."""
        return f"{self.path}/{name}"

    def _named_by_manifest(self, manifest: Source) -> str | None:
        if self.member("manifest.xml") is None:
            return None
        content = self.read("manifest.xml")
        ParsingBudget().add_document(content, manifest)
        root = parse_tree(content, manifest.file)
        elements = [] if root is None else [*root.iter("{*}dae_root")]
        name = unquote("".join(words(elements[0])).partition("#")[0]) if elements else ""
        if name.startswith("/") or ":" in name or ".." in name.split("/"):
            raise SourceError(f"the manifest names '{name}', which lies outside of the archive", manifest)
        return name or None
