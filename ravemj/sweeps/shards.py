"""Shard files: arrays as ``.npz``, or pictures as tar files, written atomically."""

import io
import os
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ravemj.core.output import new_file
from ravemj.sweeps.tars import pack, unpack

Arrays = Mapping[str, NDArray[Any]]
"""Arrays by name, with a row for each item."""

SHARDS, FAILED = "shards", "failed"


PICTURES = "pictures"
"""Name of the job whose shards are tar files."""


def shard_path(folder: Path, what: object, start: int, stop: int) -> Path:
    """Return the path of the file of a shard of a job."""
    return folder / SHARDS / f"{span_name(start, stop)}.{'tar' if what == PICTURES else 'npz'}"


def span_name(start: int, stop: int) -> str:
    """Return the name of a range of items; names sort like the ranges."""
    return f"{start:012d}-{stop:012d}"


def write_shard(path: Path, arrays: Arrays, first: int) -> None:
    """Write the file of a shard; ``first`` is the index of its first item. Equal arrays give equal bytes.

    Raises:
        OutputError: it cannot be written.
    """
    content = io.BytesIO()
    if path.suffix == ".tar":
        pack(content, dict(arrays), first)
    else:
        np.savez(content, allow_pickle=False, **arrays)
    with new_file(path) as temporary, open(temporary, "wb") as file:
        file.write(content.getvalue())
        file.flush()
        os.fsync(file.fileno())


def read_shard(path: Path) -> dict[str, NDArray[Any]]:
    """Return the arrays of a shard by name."""
    if path.suffix == ".tar":
        return unpack(path)
    with np.load(path, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def is_sound(path: Path) -> bool:
    """Return whether the file of a shard is complete and undamaged, by its checksums."""
    start, stop = map(int, path.stem.split("-"))
    try:
        if path.suffix == ".npz":
            with zipfile.ZipFile(path) as archive:
                if archive.testzip() is not None:
                    return False
        arrays = read_shard(path)
    except (OSError, ValueError, SyntaxError, EOFError, KeyError, NotImplementedError, zipfile.BadZipFile):
        return False  # a damaged PNG is a SyntaxError
    return bool(arrays) and all(len(array) == stop - start for array in arrays.values())


def joined(parts: Sequence[Arrays]) -> dict[str, NDArray[Any]]:
    """Concatenate arrays by name; shorter rows are padded with NaN, 0 or False."""
    return {name: _joined([part[name] for part in parts]) for name in parts[0]} if parts else {}


def _joined(arrays: Sequence[NDArray[Any]]) -> NDArray[Any]:
    shapes = {array.shape[1:] for array in arrays}
    if len(shapes) == 1:
        return np.concatenate(arrays)
    most = np.max([array.shape for array in arrays], axis=0)[1:]
    kind = np.result_type(*arrays)
    result = np.full((sum(map(len, arrays)), *most), np.nan if kind.kind == "f" else 0, dtype=kind)
    start = 0
    for array in arrays:
        result[(slice(start, start + len(array)), *map(slice, array.shape[1:]))] = array
        start += len(array)
    return result
