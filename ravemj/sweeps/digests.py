"""Digests of values that are equal in all processes, unlike digests of pickles."""

import hashlib
import inspect
from collections.abc import Callable, Mapping, Set
from dataclasses import fields, is_dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ravemj.errors import Source


def digest(value: object) -> str:
    """Return a digest (64 hexadecimal digits) of a tree of records, tuples, mappings, sets, arrays and plain values.

    Source positions (file and line) are ignored.
    """
    return _digest(value).hex()


def _digest(value: object) -> bytes:
    return hashlib.sha256(b"".join(_parts(value))).digest()


def _parts(value: Any) -> list[bytes]:  # noqa: ANN401 - any value
    kind = type(value).__name__.encode()
    match value:
        case Source():
            parts: list[bytes] = []
        case np.ndarray():
            array = cast("NDArray[Any]", value)
            parts = [str((array.dtype.str, array.shape)).encode(), np.ascontiguousarray(array).tobytes()]
        case Mapping():
            entries = cast("Mapping[object, object]", value).items()
            parts = sorted(_digest(key) + _digest(entry) for key, entry in entries)
        case Set():
            parts = sorted(map(_digest, cast("Set[object]", value)))
        case tuple() | list():
            parts = list(map(_digest, cast("list[object]", value)))
        case _ if is_dataclass(value):
            parts = [_digest(getattr(value, entry.name)) for entry in fields(value)]
        case _:
            parts = [repr(value).encode()]
    return [kind, *parts]


def source_digest(function: Callable[..., object]) -> str | None:
    """Return a digest of the source of a function; None if it is not available."""
    try:
        return digest(inspect.getsource(function))
    except (OSError, TypeError):
        return None
