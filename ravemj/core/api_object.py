"""The base class of API objects: how they appear in an interactive prompt."""

from collections.abc import Iterable
from typing import ClassVar


class _ApiType(type):
    """Gives classes the same ``dir`` as their objects: IPython completes an object by the union of both."""

    def __dir__(cls) -> list[str]:
        return _listed(cls, super().__dir__())


class ApiObject(metaclass=_ApiType):
    """An object with a ``repr`` without an address, and a ``dir`` of the names that users call.

    ``dir`` and tab completion leave out names with an underscore, and those in ``_internal``, which other modules of
    this package call. They have no underscore, since other modules may not call private names.
    """

    _internal: ClassVar[tuple[str, ...]] = ()

    def __dir__(self) -> list[str]:
        return _listed(type(self), super().__dir__())

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"


def _listed(kind: type, names: Iterable[str]) -> list[str]:
    internal = {name for base in kind.__mro__ for name in vars(base).get("_internal", ())}
    return [name for name in names if name.startswith("__") or not (name[0] == "_" or name in internal)]
