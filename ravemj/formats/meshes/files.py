"""Mesh files and the files that they refer to, read within size limits and recorded for the cache."""

import hashlib
import os
import re
import zlib
from dataclasses import dataclass, field, replace
from urllib.parse import unquote

from ravemj.errors import Source, SourceError
from ravemj.formats.file_access import FileAccess
from ravemj.formats.limits import check_bytes, check_unpacked, most_bytes, most_unpacked

_MAX_REFERENCES = 1000


@dataclass(slots=True)
class ReferencedFiles:
    """The files to which a mesh file and its references refer.

    Attributes:
        digests: SHA-256 of each file by path; empty for unreadable files.
        refused: The error if one of them must not be read, else None.
    """

    digests: dict[str, str] = field(default_factory=dict[str, str])
    refused: SourceError | None = None
    _contents: dict[str, bytes] = field(default_factory=dict[str, bytes])
    _bytes_left: int = field(default_factory=most_bytes)

    def read(self, path: str) -> bytes | None:
        """Return a file's decompressed content, or None if it is unreadable or all files together are too large."""
        if path not in self.digests and len(self.digests) < _MAX_REFERENCES:
            self.digests[path] = ""
            try:
                raw = read_bytes(path)
                self.digests[path] = hashlib.sha256(raw).hexdigest()
                data = unpacked(raw, path)
            except SourceError:
                return None
            self._bytes_left -= len(data)
            if self._bytes_left >= 0:
                self._contents[path] = data
        return self._contents.get(path)


@dataclass(frozen=True, slots=True)
class FileContent:
    """The content of a file.

    Attributes:
        path: Its path.
        data: Its bytes, decompressed.
        references: The files that it refers to; shared with these files.
        parents: Absolute paths of the chain of files that refer to it.
        access: The files that may be read; by default those in the folder of the mesh.
        ros: Whether it is read for a URDF; see ``read_mesh``.
    """

    path: str
    data: bytes
    references: ReferencedFiles = field(default_factory=ReferencedFiles)
    parents: tuple[str, ...] = ()
    access: FileAccess = field(default_factory=lambda: FileAccess((), is_dropped=False))
    ros: bool = False

    @property
    def source(self) -> Source:
        """The file as a whole, for messages."""
        return Source(self.path)

    def refer(self, name: str, *, is_raw: bool = False) -> "FileContent | None":
        """Read a file that this file refers to.

        Args:
            name: Path relative to this file's folder, or a relative URL.
            is_raw: Whether the file contains raw numbers; see ``FileAccess.permits_part``.

        Returns:
            The file, or None if it cannot be read, is remote, refers back to itself, or must not be read, which is
            reported.
        """
        here = os.path.abspath(self.path)
        plain = unquote(re.sub("^file:(//)?", "", name.partition("#")[0], flags=re.IGNORECASE))
        path = os.path.normpath(os.path.join(os.path.dirname(here), plain))
        parents = (*self.parents, here)
        if "://" in plain or path in parents:
            return None
        if not self.access.permits_part(path, os.path.dirname(parents[0]), is_raw=is_raw):
            self.references.refused = self.access.refuse(name, self._place(name), is_raw=is_raw)
            return None
        data = self.references.read(path)
        return None if data is None else replace(self, path=path, data=data, parents=parents)

    def _place(self, name: str) -> Source:
        """Return the source line where a name first occurs; line 0 if it does not, or if the file is binary."""
        at = -1 if b"\0" in self.data else self.data.find(name.encode(errors="replace"))
        line = self.data.count(b"\n", 0, at) + 1 if at >= 0 else 0
        return Source(self.path, line, self.access.files.get(self.path))


def digest_of(path: str) -> str:
    """Return the SHA-256 of a file on the disk, or an empty text if it cannot be read."""
    try:
        return hashlib.sha256(read_bytes(path)).hexdigest()
    except SourceError:
        return ""


def read_bytes(path: str) -> bytes:
    """Read a whole file.

    Raises:
        SourceError: It is missing, unreadable, no regular file, empty, or too large.
    """
    source = Source(path)
    try:
        if not os.path.isfile(path):
            raise SourceError("no such mesh file", source)
        size = os.path.getsize(path)
        check_bytes(size, "the file has", source)
        with open(path, "rb") as file:
            data = file.read(size)
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise SourceError(f"cannot read the file: {reason}", source) from error
    if not data:
        raise SourceError("the file is empty", source)
    return data


def unpacked(data: bytes, path: str) -> bytes:
    """Return data, decompressed if gzip compressed it, within size limits.

    Raises:
        SourceError: The data is damaged, or too large when decompressed.
    """
    if not data.startswith(b"\x1f\x8b"):
        return data
    stream = zlib.decompressobj(wbits=31)
    try:
        plain = stream.decompress(data, most_unpacked(len(data)))
    except zlib.error as error:
        raise SourceError(f"the compressed file is damaged: {error}", Source(path)) from error
    check_unpacked(len(plain), len(data), Source(path))
    if not stream.eof:
        raise SourceError("the compressed file is cut short", Source(path))
    return plain
