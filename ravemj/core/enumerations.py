"""Enumerations like OpenRAVE's: ``str`` gives the name, and dictionaries list the members."""

from enum import Enum, EnumMeta, IntEnum
from functools import reduce
from typing import Any


class _Listed(EnumMeta):
    """Metaclass with the dictionaries ``names`` and ``values`` of Boost.Python enumerations, which old scripts use."""

    @property
    def names(cls) -> dict[str, Any]:
        return dict(cls.__members__)

    def __dir__(cls) -> list[str]:
        """Return all names, including combinations of flags and aliases, which Python omits."""
        return sorted({*super().__dir__(), *cls.__members__})

    @property
    def values(cls) -> dict[int, Any]:
        return {int(member): member for member in cls.names.values()}


class NamedInt(IntEnum, metaclass=_Listed):
    """An enumeration of numbers; ``str`` gives class and name."""

    __str__ = Enum.__str__

    @classmethod
    def _missing_(cls, value: object) -> Enum | None:
        """Raise Python's error for an invalid value, with the argument's name."""
        wanted = "the number of a member" if isinstance(value, int) else "a whole number"
        raise ValueError(f"{cls.__name__}: value: is {value!r}, and should be {wanted}")


class NamedFlag(NamedInt):
    """Flags: ``|``, ``&``, ``^`` and ``~`` give whole numbers, as in OpenRAVE, and any whole number makes a flag.

    ``str`` gives class and name of a member; for a flag that is not a member, its number.
    """

    @classmethod
    def _missing_(cls, value: object) -> Enum | None:
        """Return a flag for a value without a member, such as a combination of two; its name lists the members."""
        if not isinstance(value, int):
            return super()._missing_(value)
        parts = [member for member in cls if member and member & value == member]
        unnamed = reduce(lambda rest, part: rest & ~part, parts, value)
        flag = int.__new__(cls, value)
        flag._name_ = "|".join([*(part.name for part in parts), *([str(unnamed)] if unnamed else [])])
        flag._value_ = value
        return cls._value2member_map_.setdefault(value, flag)

    def __reduce_ex__(self, proto: object) -> tuple[Any, ...]:
        """Pickle by number: early releases of Python 3.11 pickle by name, which combinations do not have."""
        return type(self), (int(self),)

    def __str__(self) -> str:
        return super().__str__() if self.name in type(self).__members__ else str(int(self))
