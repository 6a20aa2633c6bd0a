"""Methods of Python 2 and NumPy 1 that were removed or changed."""

# Values of old scripts have no types.
# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportUnknownLambdaType=false, reportGeneralTypeIssues=false

import functools
from collections.abc import Callable, ItemsView, Iterable, KeysView, ValuesView
from typing import Any

import numpy as np

from ravemj.compat.python2.files import as_bytes, as_text
from ravemj.rave import Trajectory
from ravemj.trajectories.serialization import AS_TEXT


def sort(iterable: Iterable[Any], cmp: Any = None, key: Any = None, reverse: bool = False) -> list[Any]:
    """Return a sorted list like Python 2's ``sorted``, which accepts a comparison function."""
    order = cmp and functools.cmp_to_key(cmp)
    both = (lambda item: order(key(item))) if order and key else order or key
    return sorted(iterable, key=both, reverse=reverse)


def _sort(values: list[Any], *args: Any, **options: Any) -> None:
    values[:] = sort(values, *args, **options)


_GONE: dict[str, Callable[..., Any]] = {
    "decode": lambda text, *args: as_bytes(text).decode(*args),
    "getchildren": list,
    "getiterator": lambda element, *args: element.iter(*args),
    "has_key": lambda values, key: key in values,
    "isAlive": lambda thread: thread.is_alive(),
    "itemset": lambda array, *args: array.__setitem__(args[0] if len(args) > 1 else ..., args[-1]),
    "iteritems": lambda values: iter(values.items()),
    "iterkeys": lambda values: iter(values.keys()),
    "itervalues": lambda values: iter(values.values()),
    "next": next,
    "ptp": np.ptp,
    "readfp": lambda parser, *args: parser.read_file(*args),
    "tostring": lambda array, *args: array.tobytes(*args),
    "viewitems": lambda values: values.items(),
    "viewkeys": lambda values: values.keys(),
    "viewvalues": lambda values: values.values(),
}
"""Functions that replace methods that Python 3 removed, by method name."""
_LISTED = {"items", "keys", "values"}
NAMES = {*_GONE, *_LISTED, "encode", "serialize", "sort"}
"""Names of methods that translated scripts call through ``call``."""


def call(owner: Any, name: str, *args: Any, **options: Any) -> Any:
    """Call a method, and return what it returns in Python 2."""
    if name == "sort" and isinstance(owner, list):
        return _sort(owner, *args, **options)
    if name == "encode" and isinstance(owner, str):
        return as_text(owner.encode(*args, **options))
    if name == "serialize" and isinstance(owner, Trajectory):  # XML that scripts insert into parameter texts
        return owner.serialize(AS_TEXT).decode()
    if name in _GONE and not hasattr(owner, name):
        return _GONE[name](*args) if isinstance(owner, type) else _GONE[name](owner, *args)
    result = getattr(owner, name)(*args, **options)
    return list(result) if name in _LISTED and isinstance(result, KeysView | ValuesView | ItemsView) else result
