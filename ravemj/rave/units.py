"""Units of length, mass, angle and time, with OpenRAVE's numbers.

ravemj computes in metres, kilograms, radians and seconds. The units here convert the numbers of scripts.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.enumerations import NamedInt
from ravemj.errors import ArgumentError


class LengthUnit(NamedInt):
    """Units of length."""

    m = 0
    dm = -1
    cm = -2
    mm = -3
    dmm = -4
    """A tenth of a millimetre, written ``0.1mm``."""
    um = -6
    nm = -9
    vars()["in"] = 16  # OpenRAVE's name, which Python keeps for itself
    ft = 17


class MassUnit(NamedInt):
    """Units of mass."""

    g = 0
    kg = 3
    mg = -3
    lb = 16


class AngleUnit(NamedInt):
    """Units of angles."""

    rad = 0
    deg = 1
    cdeg = -2


class TimeDurationUnit(NamedInt):
    """Units of durations."""

    s = 0
    ms = -3
    us = -6
    ns = -9
    ps = -12


class TimeStampUnit(NamedInt):
    """Units of points in time."""

    s = 0
    ms = -3
    us = -6
    iso8601 = 16


Unit = TypeVar("Unit", LengthUnit, MassUnit, AngleUnit, TimeDurationUnit, TimeStampUnit)

_PER_STANDARD = {
    "in": 1 / 0.0254,
    "ft": 1 / 0.3048,
    "lb": 1 / 453.59237,
    "deg": 57.29577951308232,
    "cdeg": 5729.577951308232,
}
"""Number of units per metre, gram or radian, for inch, foot, pound (legal definitions) and angles.

Any other unit is 10 to the power of its enumeration number: ``mm`` is -3.
"""

_OTHER_WORDS: dict[type[NamedInt], dict[str, str]] = {
    LengthUnit: {
        "0.1mm": "dmm",
        "meter": "m",
        "millimeter": "mm",
        "micrometer": "um",
        "inch": "in",
        "foot": "ft",
        "feet": "ft",
    }
}


_WRITTEN: dict[NamedInt, str] = {LengthUnit.dmm: "0.1mm"}


def _written(unit: NamedInt) -> str:
    return _WRITTEN.get(unit, unit.name)


def _read(kind: type[Unit], text: str, default: Unit) -> Unit:
    """Return the unit named ``text``; the default for an empty text."""
    if not checked_kind(text, str, f"{kind.__name__}: the unit", "a text"):
        return default
    name = _OTHER_WORDS.get(kind, {}).get(text, text)
    if name not in kind.__members__ or text == "dmm":
        known = ", ".join(_written(unit) for unit in kind)
        raise ArgumentError(f"{kind.__name__}: there is no unit '{text}'; there are {known}")
    return kind[name]


def _per_standard(kind: type[Unit], unit: Unit | str) -> float:
    chosen = _read(kind, unit, next(iter(kind))) if isinstance(unit, str) else kind(unit)
    return _PER_STANDARD.get(chosen.name, 10.0**-chosen)


def GetLengthUnitString(unit: LengthUnit) -> str:
    """Return the name of the unit of length ``unit``."""
    return _written(LengthUnit(unit))


def GetMassUnitString(unit: MassUnit) -> str:
    """Return the name of the unit of mass ``unit``."""
    return _written(MassUnit(unit))


def GetAngleUnitString(unit: AngleUnit) -> str:
    """Return the name of the unit of angle ``unit``."""
    return _written(AngleUnit(unit))


def GetTimeDurationUnitString(unit: TimeDurationUnit) -> str:
    """Return the name of the unit of duration ``unit``."""
    return _written(TimeDurationUnit(unit))


def GetTimeStampUnitString(unit: TimeStampUnit) -> str:
    """Return the name of the unit of time stamps ``unit``."""
    return _written(TimeStampUnit(unit))


def GetLengthUnitFromString(text: str, default: LengthUnit) -> LengthUnit:
    """Return the unit of length called ``text``; ``default`` for an empty text."""
    return _read(LengthUnit, text, default)


def GetMassUnitFromString(text: str, default: MassUnit) -> MassUnit:
    """Return the unit of mass called ``text``; ``default`` for an empty text."""
    return _read(MassUnit, text, default)


def GetAngleUnitFromString(text: str, default: AngleUnit) -> AngleUnit:
    """Return the unit of angle called ``text``; ``default`` for an empty text."""
    return _read(AngleUnit, text, default)


def GetTimeDurationUnitFromString(text: str, default: TimeDurationUnit) -> TimeDurationUnit:
    """Return the unit of duration called ``text``; ``default`` for an empty text."""
    return _read(TimeDurationUnit, text, default)


def GetLengthUnitStandardValue(unit: LengthUnit | str) -> float:
    """Return the number of units ``unit`` per metre."""
    return _per_standard(LengthUnit, unit)


def GetMassUnitStandardValue(unit: MassUnit | str) -> float:
    """Return the number of units ``unit`` per gram."""
    return _per_standard(MassUnit, unit)


def GetAngleUnitStandardValue(unit: AngleUnit | str) -> float:
    """Return the number of units ``unit`` per radian."""
    return _per_standard(AngleUnit, unit)


def GetTimeDurationUnitStandardValue(unit: TimeDurationUnit | str) -> float:
    """Return the number of units ``unit`` per second."""
    return _per_standard(TimeDurationUnit, unit)


def GetLengthUnitConversionScale(source: LengthUnit | str, target: LengthUnit | str) -> float:
    """Return the factor that converts lengths from one unit to another.

    Args:
        source: The unit to convert from.
        target: The unit to convert to.

    Example:
        >>> GetLengthUnitConversionScale(LengthUnit.m, LengthUnit.mm)
        1000.0
    """
    return _per_standard(LengthUnit, target) / _per_standard(LengthUnit, source)


def GetMassUnitConversionScale(source: MassUnit | str, target: MassUnit | str) -> float:
    """Return the factor that converts masses from one unit to another.

    Args:
        source: The unit to convert from.
        target: The unit to convert to.
    """
    return _per_standard(MassUnit, target) / _per_standard(MassUnit, source)


def GetAngleUnitConversionScale(source: AngleUnit | str, target: AngleUnit | str) -> float:
    """Return the factor that converts angles from one unit to another.

    Args:
        source: The unit to convert from.
        target: The unit to convert to.
    """
    return _per_standard(AngleUnit, target) / _per_standard(AngleUnit, source)


def GetTimeDurationUnitConversionScale(source: TimeDurationUnit | str, target: TimeDurationUnit | str) -> float:
    """Return the factor that converts durations from one unit to another.

    Args:
        source: The unit to convert from.
        target: The unit to convert to.
    """
    return _per_standard(TimeDurationUnit, target) / _per_standard(TimeDurationUnit, source)


@dataclass
class UnitInfo(ApiObject):
    """The units of a file or an environment.

    Attributes:
        lengthUnit: Unit of lengths.
        massUnit: Unit of masses.
        timeDurationUnit: Unit of durations.
        angleUnit: Unit of angles.
        timeStampUnit: Unit of time stamps.
    """

    lengthUnit: LengthUnit = LengthUnit.m
    massUnit: MassUnit = MassUnit.kg
    timeDurationUnit: TimeDurationUnit = TimeDurationUnit.s
    angleUnit: AngleUnit = AngleUnit.rad
    timeStampUnit: TimeStampUnit = TimeStampUnit.us

    def __post_init__(self) -> None:
        if isinstance(self.lengthUnit, UnitInfo):  # the argument is one to copy, as in OpenRAVE
            vars(self).update(vars(self.lengthUnit))

    def SerializeJSON(self) -> dict[str, str]:
        """Return the units as OpenRAVE's JSON has them."""
        return {name: _written(getattr(self, name)) for name in _KINDS}

    def DeserializeJSON(self, obj: dict[str, Any]) -> None:
        """Set the units that ``obj`` names; the others stay.

        Args:
            obj: A result of ``SerializeJSON``, or a part of it.
        """
        checked_kind(obj, Mapping, "UnitInfo.DeserializeJSON: obj", "a dict")
        for name, kind in _KINDS.items():
            if name in obj:
                setattr(self, name, _read(kind, obj[name], getattr(self, name)))  # pyright: ignore[reportArgumentType]


_KINDS: dict[str, type[NamedInt]] = {name: type(unit) for name, unit in vars(UnitInfo()).items()}
"""Unit enumeration by field of ``UnitInfo``."""
