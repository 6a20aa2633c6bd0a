"""Archives of COLLADA files (``.zae``): a zip file, and in it a manifest that names the document to start with."""

import io
import posixpath
import zipfile
import zlib
from urllib.parse import unquote

from lxml import etree

from ravemj.errors import Source, SourceError
from ravemj.formats.meshes.collada.document import words
from ravemj.formats.meshes.files import MAX_BYTES, read_bytes

_MOST_MEMBERS = 10_000


class Archive:
    """An opened archive; nothing of it is ever unpacked to the disk.

    Attributes:
        path: Where it lies.
    """

    def __init__(self, path: str) -> None:
        """Open an archive.

        Raises:
            SourceError: It is missing, too large, or no zip file.
        """
        self.path = path
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(read_bytes(path)))
        except (zipfile.BadZipFile, NotImplementedError, ValueError) as error:
            raise SourceError(f"this is not a zip archive: {error}", Source(path)) from error
        if len(self._zip.infolist()) > _MOST_MEMBERS:
            raise SourceError(f"the archive has more than {_MOST_MEMBERS} files", Source(path))
        self._bytes_left = MAX_BYTES

    def root(self) -> str:
        """Return the name of the document to start with.

        Raises:
            SourceError: The manifest is broken or names a file outside of the archive, or there is no document.
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
        """Return the full name of a file in the archive, given relative to a folder in it; None if it is not there."""
        full = posixpath.normpath(posixpath.join(folder, name))
        return next((known for known in self._zip.namelist() if posixpath.normpath(known) == full), None)

    def read(self, name: str) -> bytes:
        """Return the content of a file.

        Raises:
            SourceError: It is damaged or encrypted, or the archive unpacks to more than ``MAX_BYTES`` in all.
        """
        source = Source(self.place(name))
        try:
            with self._zip.open(name) as file:
                data = file.read(self._bytes_left + 1)
        except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError) as error:
            raise SourceError(f"the archive is damaged or encrypted: {error}", source) from error
        self._bytes_left -= len(data)
        if self._bytes_left < 0:
            raise SourceError(f"the archive unpacks to more than {MAX_BYTES >> 20} MiB", source)
        return data

    def place(self, name: str) -> str:
        """Return what a file of the archive is called in messages."""
        return f"{self.path}/{name}"

    def _named_by_manifest(self, manifest: Source) -> str | None:
        if self.member("manifest.xml") is None:
            return None
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
        try:
            root = etree.fromstring(self.read("manifest.xml"), parser)
        except etree.XMLSyntaxError as error:
            raise SourceError(f"not well-formed XML: {error.msg}", manifest) from error
        elements = [] if root is None else [*root.iter("{*}dae_root")]
        name = unquote("".join(words(elements[0])).partition("#")[0]) if elements else ""
        if name.startswith("/") or ":" in name or ".." in name.split("/"):
            raise SourceError(f"the manifest names '{name}', which lies outside of the archive", manifest)
        return name or None
