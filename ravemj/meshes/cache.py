"""Parsed meshes kept on disk, by the content of their files.

An entry is a ``.npz`` of plain arrays, named after the hash of the file, the end of its name and the source of the
readers, so that no entry outlives a change of them. It lists the files that the mesh refers to with their hashes, and
counts only while they are the same. Whatever goes wrong here is logged at debug level and never stops a mesh from
being read.

``RAVEMJ_CACHE`` names the folder, or ``off`` for none; otherwise it is ``$XDG_CACHE_HOME/ravemj`` or
``~/.cache/ravemj``. Meshes are in ``meshes`` below it.
"""

import contextlib
import functools
import hashlib
import json
import logging
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ravemj.meshes.files import digest_of
from ravemj.meshes.parts import MeshPart
from ravemj.scene import Mesh

_log = logging.getLogger(__name__)

MAX_BYTES = 1 << 30
"""The cache is pruned to this size, those entries first that were used least recently."""

_PRUNE_EVERY = 64  # entries written by this process between two looks at the size

_written = 0

Arrays = dict[str, NDArray[Any]]
Parts = tuple[MeshPart, ...]


def remembered(content: bytes, kind: str, read: Callable[[], tuple[Parts, dict[str, str]]]) -> Parts:
    """Return what ``read`` gives for a file, from the cache if it is there.

    Args:
        content: The file.
        kind: What else the result depends on, such as the end of the file's name.
        read: Reads the file; returns the parts, and hashes of the other files that were read, by path.
    """
    folder = cache_folder()
    if folder is None:
        return read()[0]
    key = hashlib.sha256(content)
    key.update(f"\0{kind}\0{_readers()}".encode())
    entry = folder / f"{key.hexdigest()}.npz"
    parts = _load(entry)
    if parts is None:
        parts, references = read()
        _store(entry, _packed(parts, references))
    return parts


@functools.cache
def _readers() -> str:
    """Return a hash of the modules beside this one, which make what is kept."""
    digest = hashlib.sha256()
    with contextlib.suppress(OSError):
        for path in sorted(Path(__file__).parent.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def cache_folder() -> Path | None:
    """Return the folder of the meshes, or None if it is switched off."""
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


def _packed(parts: Parts, references: dict[str, str]) -> Arrays:
    about = {"references": references, "finish": [[*p.diffuse, *p.ambient, p.transparency] for p in parts]}
    arrays: Arrays = {"about": np.frombuffer(json.dumps(about).encode(), np.uint8)}
    for number, part in enumerate(parts):
        arrays[f"vertices{number}"] = part.mesh.vertices.astype(np.float32)  # what the readers round to
        arrays[f"triangles{number}"] = part.mesh.triangles.astype(np.int32)
    return arrays


def _unpacked(arrays: Arrays) -> Parts | None:
    """Return the parts of an entry, or None if a file that they come from has changed."""
    about = json.loads(arrays["about"].tobytes())
    if any(digest_of(path) != digest for path, digest in about["references"].items()):
        return None
    parts: list[MeshPart] = []
    for number, finish in enumerate(about["finish"]):
        mesh = Mesh(np.asarray(arrays[f"vertices{number}"]), np.asarray(arrays[f"triangles{number}"]))
        red, green, blue, ambient_red, ambient_green, ambient_blue, transparency = map(float, finish)
        ambient = (ambient_red, ambient_green, ambient_blue)
        parts.append(MeshPart(mesh, (red, green, blue), ambient, transparency))
    return tuple(parts)


def _load(entry: Path) -> Parts | None:
    try:
        with open(entry, "rb") as file, np.load(file, allow_pickle=False) as stored:
            parts = _unpacked({name: stored[name] for name in stored.files})
        os.utime(entry)  # used just now
    except FileNotFoundError:
        return None
    except Exception as error:  # a damaged file makes zipfile and numpy raise all kinds
        _log.debug("cache entry %s cannot be used: %s", entry, error)
        return None
    return parts


def _store(entry: Path, arrays: Arrays) -> None:
    """Write an entry under another name first, so that no reader ever sees half of it."""
    global _written  # noqa: PLW0603 - a counter
    name = None
    try:
        entry.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=entry.parent, suffix=".tmp", delete=False) as file:
            name = file.name
            np.savez(file, **arrays)  # pyright: ignore[reportArgumentType] - numpy's stub means allow_pickle
        os.replace(name, entry)
        _written += 1
        if _written % _PRUNE_EVERY == 1:
            prune(entry.parent)
    except OSError as error:
        _log.debug("cannot write to the cache: %s", error)
        if name is not None:
            with contextlib.suppress(OSError):
                os.unlink(name)


def prune(folder: Path, max_bytes: int = MAX_BYTES) -> None:
    """Delete entries that were not used for the longest time, until the rest fits.

    Args:
        folder: The folder of the cache.
        max_bytes: How much may stay.
    """
    sizes: list[tuple[float, int, str]] = []
    with os.scandir(folder) as entries:
        for entry in entries:
            with contextlib.suppress(OSError):  # another process was faster
                if entry.name.endswith((".npz", ".tmp")):
                    status = entry.stat()
                    sizes.append((status.st_mtime, status.st_size, entry.path))
    total = sum(size for _, size, _ in sizes)
    for _, size, path in sorted(sizes):
        if total <= max_bytes:
            return
        with contextlib.suppress(OSError):
            os.unlink(path)
        total -= size
