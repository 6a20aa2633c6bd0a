"""Simulation time, and an environment's description: infos, OpenRAVE's JSON, name and units."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_number, checked_numbers
from ravemj.engine.clock import Clock
from ravemj.engine.simulation import DEFAULT_GRAVITY
from ravemj.errors import ArgumentError, RavemjError, UnsupportedError
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import UpdateFromInfoMode, UpdateFromInfoResult
from ravemj.rave.env.contents import Contents
from ravemj.rave.infos import EnvironmentBaseInfo, GrabbedInfo, KinBodyInfo
from ravemj.rave.interface import Annotations, GetUserData, RemoveUserData, SetUserData
from ravemj.rave.kinbody import KinBody
from ravemj.rave.library import RaveGetHomeDirectory
from ravemj.rave.physics import PhysicsEngine, RaveCreatePhysicsEngine
from ravemj.rave.robot import Robot
from ravemj.rave.units import (
    GetLengthUnitConversionScale,
    GetLengthUnitFromString,
    GetLengthUnitStandardValue,
    GetLengthUnitString,
    LengthUnit,
    UnitInfo,
)

State = dict[str, Any]
"""Published state of a body; see ``GetPublishedBodies``."""


def _state(body: KinBody) -> State:
    state: State = {
        "body": body,
        "name": body.GetName(),
        "uri": body.GetURI(),
        "environmentid": body.GetEnvironmentBodyIndex(),
        "updatestamp": body.GetUpdateStamp(),
        "jointvalues": body.GetDOFValues(),
        "linktransforms": body.GetLinkTransformations(),
    }
    arm = body.GetActiveManipulator() if isinstance(body, Robot) else None
    if arm is not None and arm.GetEndEffector() is not None:
        state |= {"activeManipulatorName": arm.GetName(), "activeManipulatorTransform": arm.GetTransform()}
    return state


OTHER_UNITS = "environments in other units than kilograms, radians and seconds"


Json = Mapping[str, Any]


class Description(Contents):
    """Simulation time; name, user data, parameters and units of an environment; the environment as an info or JSON.

    Each step of time runs physics, then controllers and modules, then sensors. The simulation thread starts with the
    first command to a controller, or with the first call of ``GetSimulationTime`` or ``IsSimulationRunning``. It runs
    until ``StopSimulation``, and pauses while a script locks the environment (``with env:``).

    Published bodies are copies of poses and joint values, for readers without the lock. ``UpdatePublishedBodies`` and
    each step of the simulation thread update them.
    """

    _internal = (
        "annotations",
        "clock",
    )

    def __init__(self) -> None:
        super().__init__()
        self._clock = self._simulation.clock = Clock(self._simulation.lock, self._advance)
        self._engine = PhysicsEngine(self._environment, "GenericPhysicsEngine", DEFAULT_GRAVITY)
        self._engine.attach()
        self._published: list[State] = []
        self._name = ""
        self.annotations = Annotations()
        self._keywords: list[str] = []
        self._numbers: dict[str, int] = {}
        self._units = UnitInfo()

    def GetName(self) -> str:
        """Return the name given in ``Environment(name)``; empty without one."""
        return self._name

    def GetNameId(self) -> str:
        """Return the name and the id of the environment as a unique string."""
        return f"{self._name}({self._environment.GetId()})"

    def GetDescription(self) -> str:
        """Return the description that ``SetDescription`` set."""
        return self.annotations.description

    def SetDescription(self, sceneDescription: str) -> None:
        """Set ``sceneDescription``, free text."""
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
        """Return the folder for persistent files, that of ``RaveGetHomeDirectory``."""
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
            openrave_exception: the unit is unknown, or its length is wrong.
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
        """One metre in the environment's unit of length."""
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
        """Update the environment from a description: add, change and remove bodies.

        Args:
            info: The description.
            updateMode: Whether to remove bodies that the description does not name, an ``UpdateFromInfoMode``.

        Returns:
            The added, the changed and the removed bodies.

        Raises:
            openrave_exception: the description of a body is invalid.
        """
        checked_kind(info, EnvironmentBaseInfo, "UpdateFromInfo: info")
        added: list[KinBody] = []
        changed: list[KinBody] = []
        with self._simulation.lock:
            named = {body_info._name for body_info in info._vBodyInfos}
            exact = UpdateFromInfoMode(updateMode) == UpdateFromInfoMode.Exact
            if exact:
                self.SetUnitInfo(info._unitInfo)
            removed = [body for body in self.GetBodies() if exact and body.GetName() not in named]
            for body in removed:
                self.Remove(body)
            for body_info in info._vBodyInfos:
                self._take_info(body_info, added, changed)
            for body_info in info._vBodyInfos:
                body = self.GetKinBody(body_info._name)
                if body is not None:
                    body.ResetGrabbed(cast("Sequence[GrabbedInfo]", body_info._vGrabbedInfos))
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
        """Update the environment from a description in OpenRAVE's JSON; see ``UpdateFromInfo``.

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
        robots = [described for described in bodies if described.get("isRobot")]
        body = self.ReadKinBodyJSON({**envInfo, "bodies": robots}, atts, uri)
        if body is not None and not isinstance(body, Robot):
            raise ArgumentError("ReadRobotJSON: the body is not a robot")
        return body

    def StartSimulation(self, timestep: float, realtime: bool = True) -> None:
        """Run the simulation in a thread.

        Args:
            timestep: The duration of a step [s].
            realtime: Whether to run in real time; False runs as fast as possible.
        """
        self._check_alive()
        self._clock.start(checked_number(timestep, "StartSimulation: timestep", 1e-6, " s"), realtime=realtime)

    def StopSimulation(self, shutdownthread: int = 1) -> None:
        """Stop the simulation thread until ``StartSimulation``.

        ``StepSimulation`` still works. With ``shutdownthread``, wait for the end of a running step.
        """
        self._clock.stop(wait=bool(shutdownthread))

    def StepSimulation(self, timestep: float) -> None:
        """Run one simulation step: physics, controllers, sensors.

        Args:
            timestep: The duration of the step [s].

        Example:
            >>> env.StopSimulation()
            >>> robot.GetController().SetPath(trajectory)
            >>> while not robot.GetController().IsDone():
            ...     env.StepSimulation(0.01)
        """
        self._check_alive()
        self._clock.step(checked_number(timestep, "StepSimulation: timestep", 0, " s"))

    def IsSimulationRunning(self) -> bool:
        """Return whether the simulation thread runs."""
        self._clock.wake()
        return self._clock.is_allowed

    def GetSimulationTime(self) -> int:
        """Return the simulation time [microseconds]."""
        self._clock.wake()
        return self._clock.now

    def SetPhysicsEngine(self, physics: PhysicsEngine | str | None) -> bool:
        """Set the physics engine.

        Args:
            physics: An engine from ``RaveCreatePhysicsEngine``; None for no physics. A name makes a new engine with the
                environment's current gravity.

        Returns:
            True.

        Example:
            >>> env.SetPhysicsEngine("mujoco")
            True
        """
        self._check_alive()
        engine = self._new_engine(physics) if isinstance(physics, str | None) else physics
        checked_kind(engine, PhysicsEngine, "SetPhysicsEngine: physics")
        if engine.GetEnv() is not self._environment:
            raise ArgumentError("SetPhysicsEngine: physics was made for another environment")
        with self._simulation.lock:
            if engine is not self._engine:
                self._engine.detach()
                self._engine = engine
                engine.attach()
        return True

    def _new_engine(self, name: str | None) -> PhysicsEngine:
        engine = RaveCreatePhysicsEngine(self._environment, name or "GenericPhysicsEngine")
        if engine is None:
            known = "ode, bullet, mujoco and GenericPhysicsEngine"
            raise RavemjError(f"SetPhysicsEngine: there is no physics engine '{name}'; there are {known}")
        if name is not None:
            engine.SetGravity(self._engine.GetGravity())
        return engine

    def GetPhysicsEngine(self) -> PhysicsEngine:
        """Return the physics engine, which has gravity and advances bodies in time; never None."""
        return self._engine

    def UpdatePublishedBodies(self, timeout: float = 0.0) -> None:
        """Publish the state of the bodies for ``GetPublishedBodies``.

        Viewers show every change at once. While a script locks the environment, viewers show the state that this method
        or a step of simulation time published last.

        Args:
            timeout: Not used.
        """
        del timeout
        with self._simulation.lock:
            self._published = [_state(self.wrap(state)) for state in self._simulation.bodies]
            self._simulation.publish()

    def GetPublishedBodies(self, timeout: float = 0.0) -> list[State]:
        """Return the published state of all bodies.

        While simulation time runs in its thread, this is the current state; otherwise that of the last call of
        ``UpdatePublishedBodies``.

        Args:
            timeout: Not used.

        Returns:
            For each body a dict with ``body``, ``name``, ``uri``, ``environmentid``, ``updatestamp``, ``jointvalues``
            [rad or m], and ``linktransforms``, a list of ``T_world_link``; for a robot also with
            ``activeManipulatorName`` and ``activeManipulatorTransform``.
        """
        del timeout
        if self._clock.is_allowed:  # OpenRAVE's thread publishes at each of its steps
            self.UpdatePublishedBodies()
        return [dict(state) for state in self._published]

    def GetPublishedBody(self, name: str, timeout: float = 0.0) -> State | None:
        """Return the published state of one body, as in ``GetPublishedBodies``, or None.

        Args:
            name: The name of the body.
            timeout: Not used.
        """
        return next((state for state in self.GetPublishedBodies(timeout) if state["name"] == name), None)

    def GetPublishedBodyJointValues(self, name: str, timeout: float = 0.0) -> Any:  # noqa: ANN401 - an array or None
        """Return the published joint values of one body [rad or m], shape (dof,), or None.

        Args:
            name: The name of the body.
            timeout: Not used.
        """
        state = self.GetPublishedBody(name, timeout)
        return None if state is None else state["jointvalues"]

    def GetPublishedBodyTransformsMatchingPrefix(self, prefix: str, timeout: float = 0.0) -> dict[str, Any]:
        """Return the published ``T_world_body`` of all bodies whose names begin with a prefix, by name.

        Args:
            prefix: The beginning of the names.
            timeout: Not used.
        """
        states = (state for state in self.GetPublishedBodies(timeout) if state["name"].startswith(prefix))
        return {state["name"]: state["linktransforms"][0] for state in states if state["linktransforms"]}

    @property
    def clock(self) -> Clock:
        """Clock of simulation time, an object of ravemj that is not part of OpenRAVE's API."""
        return self._clock

    def _advance(self, timestep: float) -> None:
        """Run one simulation step of all objects. The clock calls it and holds the lock.

        Sensors come last, so that they measure the state at the end of the step.
        """
        self._engine.SimulateStep(timestep)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.step_controller(timestep)
        for module in tuple(self._modules):
            module.SimulationStep(timestep)
        stamp = self._clock.now + round(timestep * 1e6)
        for body in map(self.wrap, self._simulation.bodies):
            if isinstance(body, Robot):
                body.devices.step(timestep, stamp)
        for sensor in tuple(self._sensors):
            sensor.advance(timestep, stamp)
        self._simulation.publish()
