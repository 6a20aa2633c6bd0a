"""Environments as infos and as OpenRAVE's JSON; their names, notes and units."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError, UnsupportedError
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import UpdateFromInfoMode, UpdateFromInfoResult
from ravemj.rave.env.simulation import Simulating
from ravemj.rave.infos import EnvironmentBaseInfo, GrabbedInfo, KinBodyInfo
from ravemj.rave.kinbody import KinBody
from ravemj.rave.library import RaveGetHomeDirectory
from ravemj.rave.robot import Robot
from ravemj.rave.units import (
    GetLengthUnitConversionScale,
    GetLengthUnitFromString,
    GetLengthUnitStandardValue,
    GetLengthUnitString,
    LengthUnit,
    UnitInfo,
)
from ravemj.rave.user_data import Annotations, GetUserData, RemoveUserData, SetUserData

OTHER_UNITS = "environments in other units than kilograms, radians and seconds"


Json = Mapping[str, Any]


class Description(Simulating):
    """Name, description, data of users, units of an environment, and all of it as an info or as JSON."""

    _internal = ("annotations",)

    def __init__(self) -> None:
        super().__init__()
        self._name = ""
        self.annotations = Annotations()
        self._keywords: list[str] = []
        self._numbers: dict[str, int] = {}
        self._units = UnitInfo()

    def GetName(self) -> str:
        """Return the name that ``Environment(name)`` gave; else empty."""
        return self._name

    def GetNameId(self) -> str:
        """Return name and number, which no other environment has."""
        return f"{self._name}({self._environment.GetId()})"

    def GetDescription(self) -> str:
        """Return the text of ``SetDescription``."""
        return self.annotations.description

    def SetDescription(self, sceneDescription: str) -> None:
        """Attach a text.

        Args:
            sceneDescription: The text.
        """
        self.annotations.description = str(sceneDescription)

    SetUserData = SetUserData
    GetUserData = GetUserData
    RemoveUserData = RemoveUserData

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
        """Return the unit of length and how many metres it is."""
        return GetLengthUnitString(self._units.lengthUnit), 1 / self._metre

    def SetUnit(self, unitname: str, unitmult: float) -> None:
        """Say in which unit lengths are; see ``SetUnitInfo``.

        Args:
            unitname: Name of the unit of length.
            unitmult: How many metres it is.

        Raises:
            openrave_exception: there is no such unit, or it is not that long.
        """
        unit = GetLengthUnitFromString(unitname, LengthUnit.m)
        metres = GetLengthUnitConversionScale(unit, LengthUnit.m)
        if not np.isclose(checked_numbers(unitmult, "SetUnit: unitmult"), metres):
            raise ArgumentError(f"SetUnit: unitmult is {unitmult}, and '{unitname}' is {metres:g} m long")
        self._units.lengthUnit = unit

    def GetUnitInfo(self) -> UnitInfo:
        """Return the units, a copy."""
        return replace(self._units)

    def SetUnitInfo(self, unitInfo: UnitInfo) -> None:
        """Say in which unit lengths are.

        As in OpenRAVE, all that is there keeps its numbers. Lengths in COLLADA files and in JSON are converted when
        they are loaded from then on; gravity and the numbers of XML files stay as they are.

        Args:
            unitInfo: The units.

        Raises:
            UnsupportedError: another unit than kilograms, radians and seconds.
        """
        checked_kind(unitInfo, UnitInfo, "SetUnitInfo: unitInfo")
        if unitInfo.lengthUnit not in set(LengthUnit):
            raise ArgumentError(f"SetUnitInfo: {unitInfo.lengthUnit!r} is no LengthUnit")
        usual = UnitInfo()
        if replace(unitInfo, lengthUnit=usual.lengthUnit, timeStampUnit=usual.timeStampUnit) != usual:
            raise UnsupportedError(f"SetUnitInfo({unitInfo})", OTHER_UNITS)
        self._units = replace(unitInfo, lengthUnit=LengthUnit(unitInfo.lengthUnit))

    @property
    def _metre(self) -> float:
        """Length of a metre in the environment's unit."""
        return GetLengthUnitStandardValue(self._units.lengthUnit)

    def ExtractInfo(self) -> EnvironmentBaseInfo:
        """Return the description of the environment as it stands, a copy."""
        with self._simulation.lock:
            return EnvironmentBaseInfo(
                _vBodyInfos=[body.ExtractInfo() for body in self.GetBodies()],
                _gravity=self.GetPhysicsEngine().GetGravity(),
                _description=self.GetDescription(),
                _keywords=self.GetKeywords(),
                _uInt64Parameters=dict(self._numbers),
                _unitInfo=self.GetUnitInfo(),
            )

    def UpdateFromInfo(
        self, info: EnvironmentBaseInfo, updateMode: int = UpdateFromInfoMode.Exact
    ) -> tuple[list[KinBody], list[KinBody], list[KinBody]]:
        """Change the environment into what an info describes: add, change and remove bodies.

        Args:
            info: The description.
            updateMode: Whether bodies that it does not name go, an ``UpdateFromInfoMode``.

        Returns:
            The bodies that were added, those that were changed, and those that were removed.

        Raises:
            openrave_exception: a body is described by nothing that can be.
        """
        checked_kind(info, EnvironmentBaseInfo, "UpdateFromInfo: info")
        added: list[KinBody] = []
        changed: list[KinBody] = []
        with self._simulation.lock:
            named = {one._name for one in info._vBodyInfos}
            exact = UpdateFromInfoMode(updateMode) == UpdateFromInfoMode.Exact
            if exact:
                self.SetUnitInfo(info._unitInfo)
            removed = [body for body in self.GetBodies() if exact and body.GetName() not in named]
            for body in removed:
                self.Remove(body)
            for one in info._vBodyInfos:
                self._take_info(one, added, changed)
            for one in info._vBodyInfos:
                body = self.GetKinBody(one._name)
                if body is not None:
                    body.ResetGrabbed(cast("Sequence[GrabbedInfo]", one._vGrabbedInfos))
            self.GetPhysicsEngine().SetGravity(np.asarray(info._gravity))
            self.annotations.description, self._keywords = info._description, list(info._keywords)
            self._numbers = dict(info._uInt64Parameters)
        return added, changed, removed

    def _take_info(self, info: KinBodyInfo, added: list[KinBody], changed: list[KinBody]) -> None:
        body = self.GetKinBody(info._name)
        if body is not None and body.IsRobot() == info._isRobot:
            result = body.UpdateFromKinBodyInfo(info)
            if result == UpdateFromInfoResult.Success:
                changed.append(body)
            if result != UpdateFromInfoResult.RequireReinitialize:
                return
        if body is not None:
            self.Remove(body)
            changed.append(self._add_info(info))
        else:
            added.append(self._add_info(info))

    def _add_info(self, info: KinBodyInfo) -> KinBody:
        body = self._new_body(is_robot=info._isRobot)
        body.InitFromKinBodyInfo(info)
        self.AddKinBody(body)
        return body

    def _new_body(self, *, is_robot: bool) -> KinBody:
        nothing = scene.KinBody(name="", is_robot=is_robot, links=(), joints=(), passive_joints=(), source=FROM_SCRIPT)
        return self.wrap(self._simulation.create(nothing))

    def LoadJSON(
        self,
        envInfo: Json,
        updateMode: int = UpdateFromInfoMode.OnlySpecifiedBodiesExact,
        atts: Mapping[str, str] | None = None,
        uri: str = "",
    ) -> bool:
        """Take over an environment in OpenRAVE's JSON; see ``UpdateFromInfo``.

        Args:
            envInfo: The environment, as a dict.
            updateMode: As there.
            atts: Not used.
            uri: Not used.

        Returns:
            True.
        """
        del atts, uri
        info = (
            EnvironmentBaseInfo()
            if "gravity" in checked_kind(envInfo, Mapping, "LoadJSON: envInfo", "a dict")
            else EnvironmentBaseInfo(_gravity=self.GetPhysicsEngine().GetGravity())
        )
        self._read_json(info, envInfo)
        self.UpdateFromInfo(info, updateMode)
        return True

    def _read_json(self, info: EnvironmentBaseInfo, content: Json) -> None:
        """Fill an info with what JSON has, in the environment's unit of length."""
        info._unitInfo = self.GetUnitInfo()
        info.DeserializeJSON({"unitInfo": content.get("unitInfo", {})})
        scale = self._metre / GetLengthUnitStandardValue(info._unitInfo.lengthUnit)
        info.DeserializeJSON(dict(content), scale)
        info._unitInfo = self.GetUnitInfo()

    def ReadKinBodyJSON(self, envInfo: Json, atts: Mapping[str, str] | None = None, uri: str = "") -> KinBody | None:
        """Return the first body of an environment in OpenRAVE's JSON, without adding it; None where it has none.

        Args:
            envInfo: The environment, as a dict.
            atts: Not used.
            uri: What the body's ``GetURI`` returns.
        """
        del atts
        info = EnvironmentBaseInfo()
        self._read_json(info, envInfo)
        if not info._vBodyInfos:
            return None
        first = info._vBodyInfos[0]
        first._uri = uri
        body = self._new_body(is_robot=first._isRobot)
        body.InitFromKinBodyInfo(first)
        return body

    def ReadRobotJSON(self, envInfo: Json, atts: Mapping[str, str] | None = None, uri: str = "") -> Robot | None:
        """Return the first robot of an environment in OpenRAVE's JSON, without adding it; None where it has none.

        Args:
            envInfo: The environment, as a dict.
            atts: Not used.
            uri: What the robot's ``GetURI`` returns.
        """
        bodies = cast("Sequence[Json]", envInfo.get("bodies", ()))
        robots = [one for one in bodies if one.get("isRobot")]
        body = self.ReadKinBodyJSON({**envInfo, "bodies": robots}, atts, uri)
        if body is not None and not isinstance(body, Robot):
            raise ArgumentError("ReadRobotJSON: the body is no robot")
        return body
