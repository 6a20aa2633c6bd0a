"""Pickles of OpenRAVE's databases, read with a fixed list of permitted classes, so that files cannot run code."""

import pickle
from collections.abc import Callable
from io import BytesIO
from typing import Any

import numpy as np

_RECONSTRUCT = np.zeros(1).__reduce__()[0]
_SCALAR = np.float64(1).__reduce__()[0]
_ALLOWED: dict[str, dict[str, Any]] = {
    "numpy": {"ndarray": np.ndarray, "dtype": np.dtype},
    "numpy.core.multiarray": {"_reconstruct": _RECONSTRUCT, "scalar": _SCALAR},
    "builtins": {"range": range, "list": list, "dict": dict, "tuple": tuple, "set": set},
}
_SAME = {"numpy._core.multiarray": "numpy.core.multiarray", "__builtin__": "builtins"}
_RENAMED = {"xrange": "range"}


class _ArrayUnpickler(pickle.Unpickler):
    """Unpickler that permits only NumPy arrays and plain containers."""

    def find_class(self, module: str, name: str, /) -> Any:  # noqa: ANN401 - as the base class
        if (module, name) == ("_codecs", "encode"):
            return _encoder()
        known = _ALLOWED.get(_SAME.get(module, module), {})
        name = _RENAMED.get(name, name)
        if name not in known:
            raise pickle.UnpicklingError(f"it holds {module}.{name}, which a table of numbers does not need")
        return known[name]


def _encoder() -> Callable[[str, str], bytes]:
    """Return a new ``_codecs.encode`` that permits only Latin-1; a pickle could modify a shared one."""

    def encode(text: str, encoding: str = "latin1") -> bytes:
        if encoding != "latin1":
            raise pickle.UnpicklingError(f"it holds text in {encoding}")
        return text.encode("latin1")

    return encode


def read_pickle(content: bytes) -> Any:  # noqa: ANN401 - any plain value
    """Return the plain value of a pickle of Python 2 or 3.

    Raises:
        pickle.UnpicklingError: it is damaged, or contains anything but numbers, texts, arrays and containers.
    """
    try:
        return _ArrayUnpickler(BytesIO(content), encoding="latin1").load()
    except pickle.UnpicklingError:
        raise
    except Exception as error:  # damaged pickles raise nearly anything
        raise pickle.UnpicklingError(" ".join(f"{type(error).__name__}: {error}".split())) from error
