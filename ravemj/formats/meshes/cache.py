"""Disk cache of parsed meshes, keyed by the content of their files.

The name of an entry (``.mesh``) is a hash of the file, its suffix and the source code of the readers, so that a change
of any of them invalidates it. An entry lists the files that the mesh refers to with their hashes, and is valid only
while these are unchanged.

Errors of the cache are logged at debug level and never prevent a mesh from being read.

``RAVEMJ_CACHE`` is the folder, or ``off`` for no cache; the default is ``$XDG_CACHE_HOME/ravemj`` or
``~/.cache/ravemj``. Meshes are in its folder ``meshes``.
"""

import contextlib
import functools
import hashlib
import logging
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from ravemj.core.signals import signals_delayed
from ravemj.formats import file_access
from ravemj.formats.file_access import FileAccess
from ravemj.formats.meshes.entries import Parts, pack_entry, unpack_entry
from ravemj.formats.meshes.files import ReferencedFiles, digest_of, read_bytes
from ravemj.model.scene import mesh

_log = logging.getLogger(__name__)

MAX_BYTES = 1 << 30
"""Size to which the cache is pruned, by deleting the least recently used files first."""

_PRUNE_EVERY = 64  # files written by this process between two checks of the size
_RECENT = 24 * 3600  # s; a file that was used that recently is not marked again
_READ = os.O_RDONLY | getattr(os, "O_BINARY", 0)

_written = 0


def cached_file(
    path: str, kind: str, read: Callable[[bytes], tuple[Parts, ReferencedFiles]], access: FileAccess
) -> tuple[Parts, dict[str, str]]:
    """Return the parts of a mesh file parsed by ``read``, and the digests of the files to which it refers.

    Both come from the cache if possible.

    Args:
        path: The file.
        kind: Additional key of the cache, such as the suffix.
        read: Parser of the file's content; returns the parts, and the other files that it has read.
        access: The files that may be read; cache entries that refer to others are not used.

    Raises:
        SourceError: The file cannot be read.
    """
    folder = cache_folder()
    if folder is None:
        parts, references = read(read_bytes(path))
        return parts, references.digests
    home = os.path.dirname(os.path.abspath(path))
    parts, references = _by_content(
        folder, read_bytes(path), kind, home, read, functools.partial(access.permits_part, folder=home)
    )
    return parts, references.digests


def cached(content: bytes, kind: str, read: Callable[[], Parts]) -> Parts:
    """Return the parts that ``read`` parses from a content, from the cache if possible."""
    folder = cache_folder()
    if folder is None:
        return read()
    return _by_content(folder, content, kind, "", lambda _: (read(), ReferencedFiles()), lambda _: True)[0]


def cache_folder() -> Path | None:
    """Return the folder of the cache, or None if it is switched off."""
    chosen = os.environ.get("RAVEMJ_CACHE", "")
    if chosen.lower() == "off":
        return None
    if chosen:
        return Path(chosen, "meshes")
    base = os.environ.get("XDG_CACHE_HOME", "")
    if os.path.isabs(base):
        return Path(base, "ravemj", "meshes")
    try:
        return Path.home() / ".cache" / "ravemj" / "meshes"
    except RuntimeError:  # a user without a home
        return None


def _by_content(
    folder: Path,
    content: bytes,
    kind: str,
    home: str,
    read: Callable[[bytes], tuple[Parts, ReferencedFiles]],
    permits: Callable[[str], bool],
) -> tuple[Parts, ReferencedFiles]:
    """Return a mesh file's parts, and the other files to which it refers; from the cache, or read and cached now.

    If the mesh file refers to others, the entry is valid only for the folder ``home``, since their names are
    relative, and only while all of them are permitted and unchanged.
    """
    alone = f"{_name(readers_digest(), kind.encode(), content)}.mesh"
    at_home = f"{_name(readers_digest(), kind.encode(), content, os.fsencode(home))}.mesh"
    for entry in (alone, at_home):
        loaded = _loaded(folder, entry)
        if loaded:
            parts, digests = loaded
            if all(permits(path) and digest_of(path) == digest for path, digest in digests.items()):
                return parts, ReferencedFiles(digests)
    parts, references = read(content)
    if references.refused is None:
        entry = at_home if references.digests else alone
        _store(folder / entry, pack_entry(entry, parts, references.digests))
    return parts, references


def _name(readers: bytes, *parts: bytes) -> str:
    """Return the file name of a cache entry: a hash of the readers' version and all inputs."""
    key = hashlib.sha256(readers)
    for part in parts:
        key.update(b"%d\0" % len(part))
        key.update(part)
    return key.hexdigest()


@functools.cache
def readers_digest() -> bytes:
    """Return a hash of the source of the readers."""
    digest = hashlib.sha256()
    with contextlib.suppress(OSError):
        for path in reader_sources():
            with open(path, "rb") as file:
                digest.update(file.read())
    return digest.digest()


def reader_sources() -> list[str]:
    """Return the source files of the readers: the modules of this folder, ``Mesh``, and the file access policy."""
    folders = sorted(os.walk(os.path.dirname(__file__)))
    names = (os.path.join(folder, name) for folder, _, files in folders for name in sorted(files))
    return [*(name for name in names if name.endswith(".py")), mesh.__file__, file_access.__file__]


def _loaded(folder: Path, entry: str) -> tuple[Parts, dict[str, str]] | None:
    """Return parts and referenced files of an entry; None if it is missing, damaged, or a renamed copy of another."""
    file = f"{folder}/{entry}"
    try:
        descriptor = os.open(file, _READ)  # a model has many meshes, and ``open`` takes twice the time
        try:
            status = os.fstat(descriptor)
            unpacked = unpack_entry(entry, os.read(descriptor, status.st_size))
        finally:
            os.close(descriptor)
    except FileNotFoundError:
        return None
    except Exception as error:  # a damaged file never stops anything
        _log.debug("%s cannot be used: %s", file, error)
        return None
    if time.time() - status.st_mtime > _RECENT:
        with contextlib.suppress(OSError):  # a file of someone else
            os.utime(file)
    return unpacked


def _store(file: Path, content: bytes) -> None:
    """Write a cache file under a temporary name and rename it, so that no process reads an incomplete file."""
    global _written  # noqa: PLW0603 - a counter
    name = None
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with signals_delayed():  # which would leave the temporary file
            with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".tmp", delete=False) as opened:
                name = opened.name
                opened.write(content)
            os.replace(name, file)
        _written += 1
        if _written % _PRUNE_EVERY == 1:
            prune(file.parent)
    except OSError as error:
        _log.debug("cannot write to the cache: %s", error)
        if name is not None:
            with contextlib.suppress(OSError):
                os.unlink(name)


def prune(folder: Path, max_bytes: int = MAX_BYTES) -> None:
    """Delete the least recently used files until the rest fits.

    Args:
        folder: The folder of the cache.
        max_bytes: Maximum total size.
    """
    sizes: list[tuple[float, int, str]] = []
    with os.scandir(folder) as entries:
        for entry in entries:
            with contextlib.suppress(OSError):  # another process was faster
                if entry.name.endswith((".mesh", ".path", ".tmp")):  # .path files are from earlier versions
                    status = entry.stat()
                    sizes.append((status.st_mtime, status.st_size, entry.path))
    total = sum(size for _, size, _ in sizes)
    for _, size, path in sorted(sizes):
        if total <= max_bytes:
            return
        with contextlib.suppress(OSError):
            os.unlink(path)
        total -= size
