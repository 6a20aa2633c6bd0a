"""What an environment is called, and the notes and units that belong to it."""

from collections.abc import Iterable
from dataclasses import replace

from ravemj.core.arguments import checked_kind
from ravemj.errors import UnsupportedError
from ravemj.rave.env.base import EnvironmentPart
from ravemj.rave.library import RaveGetHomeDirectory
from ravemj.rave.units import LengthUnit, UnitInfo

OTHER_UNITS = "environments in other units than metres, kilograms, radians and seconds"


class Description(EnvironmentPart):
    """Name, description, keywords and numbers of an environment, and its units, which are always the same."""

    def __init__(self) -> None:
        super().__init__()
        self._name = ""
        self._description = ""
        self._keywords: list[str] = []
        self._numbers: dict[str, int] = {}

    def GetName(self) -> str:
        """Return the name that ``Environment(name)`` gave; else empty."""
        return self._name

    def GetNameId(self) -> str:
        """Return name and number, which no other environment has."""
        return f"{self._name}({self._environment.GetId()})"

    def GetDescription(self) -> str:
        """Return the text of ``SetDescription``."""
        return self._description

    def SetDescription(self, sceneDescription: str) -> None:
        """Attach a text.

        Args:
            sceneDescription: The text.
        """
        self._description = str(sceneDescription)

    def GetKeywords(self) -> list[str]:
        """Return the words of ``SetKeywords``."""
        return list(self._keywords)

    def SetKeywords(self, sceneKeywords: Iterable[str]) -> None:
        """Attach words.

        Args:
            sceneKeywords: The words.
        """
        self._keywords = [str(word) for word in sceneKeywords]

    def GetRevision(self) -> int:
        """Return the revision of the environment in a database: 0."""
        return 0

    def GetUInt64Parameter(self, parameterName: str, defaultValue: int) -> int:
        """Return a number of ``SetUInt64Parameter``.

        Args:
            parameterName: Its name.
            defaultValue: What stands for one that was not set.
        """
        return self._numbers.get(parameterName, int(defaultValue))

    def SetUInt64Parameter(self, parameterName: str, value: int) -> None:
        """Attach a whole number under a name.

        Args:
            parameterName: The name.
            value: The number.
        """
        self._numbers[str(parameterName)] = int(value)

    def RemoveUInt64Parameter(self, parameterName: str) -> bool:
        """Forget a number; return whether it was there.

        Args:
            parameterName: Its name.
        """
        return self._numbers.pop(parameterName, None) is not None

    def GetHomeDirectory(self) -> str:
        """Return the folder for what is kept between runs, that of ``RaveGetHomeDirectory``."""
        return RaveGetHomeDirectory()

    def GetUnit(self) -> tuple[str, float]:
        """Return the unit of length and how many metres it is: always the metre."""
        return ("m", 1.0)

    def SetUnit(self, unitname: str, unitmult: float) -> None:
        """Accept the metre.

        Args:
            unitname: Name of the unit of length.
            unitmult: How many metres it is.

        Raises:
            UnsupportedError: it is another one.
        """
        if (unitname, unitmult) not in {("m", 1.0), ("meter", 1.0)}:
            raise UnsupportedError(f"SetUnit('{unitname}', {unitmult})", OTHER_UNITS)

    def GetUnitInfo(self) -> UnitInfo:
        """Return the units: metres, kilograms, radians and seconds."""
        return UnitInfo()

    def SetUnitInfo(self, unitInfo: UnitInfo) -> None:
        """Accept the units of ``GetUnitInfo``.

        Args:
            unitInfo: The units.

        Raises:
            UnsupportedError: they are others.
        """
        checked_kind(unitInfo, UnitInfo, "SetUnitInfo: unitInfo")
        if replace(unitInfo, timeStampUnit=UnitInfo().timeStampUnit) != UnitInfo():
            raise UnsupportedError(f"SetUnitInfo({LengthUnit(unitInfo.lengthUnit).name}, …)", OTHER_UNITS)
