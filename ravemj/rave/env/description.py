"""Environments as infos and as OpenRAVE's JSON; their names, descriptions and units."""

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
    """Name, description, user data, parameters and units of an environment, and the environment as an info or JSON."""

    _internal = ("annotations",)

    def __init__(self) -> None:
        super().__init__()
        self._name = ""
        self.annotations = Annotations()
        self._keywords: list[str] = []
        self._numbers: dict[str, int] = {}
        self._units = UnitInfo()

    def GetName(self) -> str:
        """Return the name given in ``Environment(name)``; empty without one."""
        return self._name

    def GetNameId(self) -> str:
        """Return the name and the id of the environment, which no other environment has."""
        return f"{self._name}({self._environment.GetId()})"

    def GetDescription(self) -> str:
        """Return the description that ``SetDescription`` set."""
        return self.annotations.description

    def SetDescription(self, sceneDescription: str) -> None:
        """Set ``sceneDescription``, a text for people."""
        self.annotations.description = str(sceneDescription)

    SetUserData = SetUserData
    GetUserData = GetUserData
    RemoveUserData = RemoveUserData

    def GetKeywords(self) -> list[str]:
        """Return the keywords that ``SetKeywords`` set."""
        return list(self._keywords)

    def SetKeywords(self, sceneKeywords: Iterable[str]) -> None:
        """Set the keywords ``sceneKeywords``."""
        self._keywords = [str(word) for word in sceneKeywords]

    def GetRevision(self) -> int:
        """Return 0. In OpenRAVE this is the revision of the environment in a database."""
        return 0

    def GetUInt64Parameter(self, parameterName: str, defaultValue: int) -> int:
        """Return an integer that ``SetUInt64Parameter`` set.

        Args:
            parameterName: The name.
            defaultValue: The result if there is no integer of that name.
        """
        return self._numbers.get(parameterName, int(defaultValue))

    def SetUInt64Parameter(self, parameterName: str, value: int) -> None:
        """Set an integer under a name.

        Args:
            parameterName: The name.
            value: The number.
        """
        self._numbers[str(parameterName)] = int(value)

    def RemoveUInt64Parameter(self, parameterName: str) -> bool:
        """Remove the integer of ``parameterName``, and return whether there was one."""
        return self._numbers.pop(parameterName, None) is not None

    def GetHomeDirectory(self) -> str:
        """Return the folder for files that are kept between runs, that of ``RaveGetHomeDirectory``."""
        return RaveGetHomeDirectory()

    def GetUnit(self) -> tuple[str, float]:
        """Return the unit of length, and its length in metres."""
        return GetLengthUnitString(self._units.lengthUnit), 1 / self._metre

    def SetUnit(self, unitname: str, unitmult: float) -> None:
        """Set the unit of length; see ``SetUnitInfo``.

        Args:
            unitname: The name of the unit.
            unitmult: The length of the unit [m].

        Raises:
            openrave_exception: there is no such unit, or it has another length.
        """
        unit = GetLengthUnitFromString(unitname, LengthUnit.m)
        metres = GetLengthUnitConversionScale(unit, LengthUnit.m)
        if not np.isclose(checked_numbers(unitmult, "SetUnit: unitmult"), metres):
            raise ArgumentError(f"SetUnit: unitmult is {unitmult}, and '{unitname}' is {metres:g} m long")
        self._units.lengthUnit = unit

    def GetUnitInfo(self) -> UnitInfo:
        """Return a copy of the units."""
        return replace(self._units)

    def SetUnitInfo(self, unitInfo: UnitInfo) -> None:
        """Set the unit of length.

        As in OpenRAVE, the numbers of existing bodies stay as they are. From now on, loading converts lengths in
        COLLADA and JSON files to this unit; it does not convert gravity and the numbers of XML files.

        Args:
            unitInfo: The units.

        Raises:
            UnsupportedError: the units of mass, angle and time are not kilograms, radians and seconds.
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
        """The length of a metre in the environment's unit."""
        return GetLengthUnitStandardValue(self._units.lengthUnit)

    def ExtractInfo(self) -> EnvironmentBaseInfo:
        """Return the description of the environment in its current state."""
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
        """Make the environment match a description: add, change and remove bodies.

        Args:
            info: The description.
            updateMode: Whether to remove bodies that the description does not name, an ``UpdateFromInfoMode``.

        Returns:
            The added, the changed and the removed bodies.

        Raises:
            openrave_exception: a description does not make a body.
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
        """Make the environment match a description in OpenRAVE's JSON; see ``UpdateFromInfo``.

        Args:
            envInfo: The description, as a dict.
            updateMode: As for ``UpdateFromInfo``.
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
        """Set the fields of an info from JSON, in the environment's unit of length."""
        info._unitInfo = self.GetUnitInfo()
        info.DeserializeJSON({"unitInfo": content.get("unitInfo", {})})
        scale = self._metre / GetLengthUnitStandardValue(info._unitInfo.lengthUnit)
        info.DeserializeJSON(dict(content), scale)
        info._unitInfo = self.GetUnitInfo()

    def ReadKinBodyJSON(self, envInfo: Json, atts: Mapping[str, str] | None = None, uri: str = "") -> KinBody | None:
        """Return the first body of a description in OpenRAVE's JSON, without adding it; None without bodies.

        Args:
            envInfo: The description, as a dict.
            atts: Not used.
            uri: The result of the body's ``GetURI``.
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
        """Return the first robot of a description in OpenRAVE's JSON, without adding it; None without robots.

        Args:
            envInfo: The description, as a dict.
            atts: Not used.
            uri: The result of the robot's ``GetURI``.
        """
        bodies = cast("Sequence[Json]", envInfo.get("bodies", ()))
        robots = [one for one in bodies if one.get("isRobot")]
        body = self.ReadKinBodyJSON({**envInfo, "bodies": robots}, atts, uri)
        if body is not None and not isinstance(body, Robot):
            raise ArgumentError("ReadRobotJSON: the body is not a robot")
        return body
