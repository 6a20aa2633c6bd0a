"""What all infos have in common: they are what their fields say."""

# Users put anything into fields.
# pyright: reportUnknownArgumentType=false, reportUnknownVariableType=false

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, fields
from enum import Enum
from typing import Any, ClassVar, cast

import numpy as np

from ravemj.rave.trimesh import TriMesh


@dataclass(eq=False, repr=False)
class Info:
    """Compares by content, and prints as the expression that makes it: the fields that differ from a new one's."""

    _called: ClassVar[str]
    """How users get at the class."""

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(getattr(self, one.name), getattr(other, one.name)) for one in fields(self) if one.compare)

    __hash__ = None  # pyright: ignore[reportAssignmentType] - fields change

    def __repr__(self) -> str:
        shown = {one.name: getattr(self, one.name) for one in fields(self) if one.repr}
        new = {one.name: _default(one) for one in fields(self)}
        changed = [f"{name}={_written(value)}" for name, value in shown.items() if not _same(value, new[name])]
        return f"{self._called}({', '.join(changed)})"

    def __dir__(self) -> list[str]:
        shown = {one.name for one in fields(self) if one.repr}
        return [name for name in super().__dir__() if name.startswith("__") or name in shown]


def _default(one: Field[Any]) -> object:
    return one.default if one.default_factory is MISSING else one.default_factory()


def _same(first: Any, second: Any) -> bool:  # noqa: ANN401 - whatever users put into fields
    """Return whether two values are the same numbers, texts and infos."""
    if isinstance(first, TriMesh) and isinstance(second, TriMesh):
        return _same(first.toDict(), second.toDict())
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return first.keys() == second.keys() and all(_same(first[key], second[key]) for key in first)
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        return np.array_equal(cast("Any", first), cast("Any", second))
    if isinstance(first, list | tuple) and isinstance(second, list | tuple):
        return len(first) == len(second) and all(map(_same, first, second))
    return bool(first == second)


def _written(value: object) -> str:
    """Return the text of a value, without ``array`` and what else has to be imported."""
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, np.ndarray | np.generic):
        return repr(value.tolist())
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_written(one)}' for key, one in value.items())}}}"
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return f"[{', '.join(map(_written, value))}]"
    return repr(value)
