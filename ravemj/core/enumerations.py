"""Enumerations as those of OpenRAVE: their text is their name, and dictionaries list their members."""

from enum import Enum, EnumMeta, IntEnum, IntFlag
from typing import Any


class _Listed(EnumMeta):
    """Gives enumerations the dictionaries that Boost.Python gives them, and old scripts read."""

    @property
    def names(cls) -> dict[str, Any]:
        """The members by name."""
        return dict(cls.__members__)

    @property
    def values(cls) -> dict[int, Any]:
        """The members by number."""
        return {int(member): member for member in cls.names.values()}


class NamedInt(IntEnum, metaclass=_Listed):
    """An enumeration of numbers; ``str`` gives class and name, ``format`` the number."""

    __str__ = Enum.__str__


class NamedFlag(IntFlag, metaclass=_Listed):
    """Flags; ``str`` gives class and name, or the number where flags are combined with ``|``, as in OpenRAVE."""

    def __str__(self) -> str:
        return Enum.__str__(self) if self.name in type(self).__members__ else str(int(self))
