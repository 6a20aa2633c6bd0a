"""Shards of pictures: tar files in the format of the package webdataset.

A sample consists of the files ``KEY.NAME.png`` of its pictures, with 8 or 16 bits, and ``KEY.json`` with its other
arrays; KEY is the index of the item. Equal arrays give equal bytes.
"""

import io
import json
import tarfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

_DIGITS = 12
_CHECK = "crc32"
_QUICK = 1  # the level of compression
_PICTURES = {(3, "uint8"): "RGB", (2, "uint16"): "I;16", (2, "uint8"): "L"}


def pack(file: IO[bytes], arrays: dict[str, NDArray[Any]], first: int) -> None:
    """Write arrays with a row for each item; ``first`` is the index of the first item."""
    count = len(next(iter(arrays.values())))
    with tarfile.open(fileobj=file, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for row in range(count):
            key, record = f"{first + row:0{_DIGITS}d}", dict[str, object]()
            for name in sorted(arrays):
                array = arrays[name][row]
                if (array.ndim, array.dtype.name) in _PICTURES:
                    _add(archive, f"{key}.{name}.png", _png(array))
                else:
                    record[name] = array.tolist()
            record[_CHECK] = zlib.crc32(json.dumps(record).encode())
            _add(archive, f"{key}.json", json.dumps(record).encode())


def _png(array: NDArray[Any]) -> bytes:
    content = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(array)).save(content, "PNG", compress_level=_QUICK)
    return content.getvalue()


def _add(archive: tarfile.TarFile, name: str, content: bytes) -> None:
    entry = tarfile.TarInfo(name)  # without time and owner
    entry.size = len(content)
    archive.addfile(entry, io.BytesIO(content))


def unpack(path: Path) -> dict[str, NDArray[Any]]:
    """Return the arrays of a file, with a row for each item.

    Raises:
        OSError: the file is damaged.
        ValueError: the file is damaged.
    """
    rows: dict[str, list[NDArray[Any]]] = {}
    samples = 0
    for name, content in _members(path):
        if name.endswith(".json"):
            samples += 1
            record = json.loads(content)
            if record.pop(_CHECK) != zlib.crc32(json.dumps(record).encode()):
                raise ValueError(f"{name} is damaged")
            entries = {key: np.array(value) for key, value in record.items()}
        else:
            with Image.open(io.BytesIO(content)) as picture:
                entries = {name.split(".")[1]: np.asarray(picture)}
        for key, array in entries.items():
            rows.setdefault(key, []).append(array)
    if any(len(arrays) != samples for arrays in rows.values()):
        raise ValueError(f"{path} is incomplete")
    return {key: np.stack(arrays) for key, arrays in rows.items()}


def _members(path: Path) -> Iterator[tuple[str, bytes]]:
    try:
        with tarfile.open(path) as archive:
            for entry in archive:
                content = archive.extractfile(entry)
                yield entry.name, b"" if content is None else content.read()
    except tarfile.TarError as error:
        raise ValueError(str(error)) from error
