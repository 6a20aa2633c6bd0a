"""Enumerations like OpenRAVE's: ``str`` gives the name, and dictionaries list the members."""

from enum import Enum, EnumMeta, IntEnum, IntFlag
from typing import Any


class _Listed(EnumMeta):
    """Metaclass with the dictionaries of Boost.Python's enumerations, which old scripts use."""

    @property
    def names(cls) -> dict[str, Any]:
        """The members by name."""
        return dict(cls.__members__)

    def __dir__(cls) -> list[str]:
        """Return all names, including combinations of flags and aliases, which Python omits."""
        return sorted({*super().__dir__(), *cls.__members__})

    @property
    def values(cls) -> dict[int, Any]:
        """The members by number."""
        return {int(member): member for member in cls.names.values()}


class NamedInt(IntEnum, metaclass=_Listed):
    """Enumeration of numbers; ``str`` gives class and name, ``format`` the number."""

    __str__ = Enum.__str__


class NamedFlag(IntFlag, metaclass=_Listed):
    """Flags; ``str`` gives class and name, or the number for flags combined with ``|``, as in OpenRAVE."""

    def __str__(self) -> str:
        return Enum.__str__(self) if self.name in type(self).__members__ else str(int(self))
