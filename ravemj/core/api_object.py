"""How objects of the API show themselves in a prompt."""

from collections.abc import Iterable
from typing import ClassVar


class _ApiType(type):
    """Completes names of classes like those of their objects; IPython lists both behind an object."""

    def __dir__(cls) -> list[str]:
        return _listed(cls, super().__dir__())


class ApiObject(metaclass=_ApiType):
    """Shows no address, and completes to what users call.

    ``dir`` and tab completion leave out names with an underscore, and those in ``_internal``: what other rooms of this
    package call.
    """

    _internal: ClassVar[tuple[str, ...]] = ()

    def __dir__(self) -> list[str]:
        return _listed(type(self), super().__dir__())

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"


def _listed(kind: type, names: Iterable[str]) -> list[str]:
    internal = {name for base in kind.__mro__ for name in vars(base).get("_internal", ())}
    return [name for name in names if name.startswith("__") or not (name[0] == "_" or name in internal)]
