"""Enumerations whose text is their name, as in OpenRAVE; Python's own ``IntEnum`` and ``IntFlag`` print a number."""

from enum import Enum, IntEnum, IntFlag


class NamedInt(IntEnum):
    """An enumeration of numbers; ``str`` gives class and name, ``format`` the number."""

    __str__ = Enum.__str__


class NamedFlag(IntFlag):
    """Flags; ``str`` gives class and name, or the number where flags are combined with ``|``, as in OpenRAVE."""

    def __str__(self) -> str:
        return Enum.__str__(self) if self.name in type(self).__members__ else str(int(self))
