"""Attached sensors and connected bodies of a robot."""

# The fields of infos have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Iterable
from copy import deepcopy
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.model import hashes, scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos import AttachedSensorInfo, ConnectedBodyInfo, GripperInfo, RobotBaseInfo
from ravemj.rave.infos.body import only_parts_of, with_connected
from ravemj.rave.instruments import SensorData
from ravemj.rave.link import Link
from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    from ravemj.rave.joint import Joint
    from ravemj.rave.manipulator import Manipulator
    from ravemj.rave.robot import Robot


class AttachedSensor(ApiObject):
    """Sensor mount on a link, with or without a device; ``robot.GetAttachedSensors()`` returns the mounts."""

    _internal = ("description", "edit", "state")

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._name = state.scene.sensors[index].name

    @property
    def state(self) -> BodyState:
        """The robot in the simulation."""
        return self._state

    @property
    def description(self) -> scene.AttachedSensor:
        """The attached sensor in the scene; an error if the robot no longer has it."""
        description = next((sensor for sensor in self._state.scene.sensors if sensor.name == self._name), None)
        if description is None:
            raise RavemjError(f"'{self._robot.GetName()}' has no sensor '{self._name}' any more")
        return description

    def edit(self, **changes: Any) -> scene.AttachedSensor:  # noqa: ANN401 - the fields of a scene.AttachedSensor
        """Change fields of the description in the scene, and return the new description."""
        with self._state.simulation.lock:
            changed = replace(self.description, **changes)
            sensors = (changed if sensor.name == changed.name else sensor for sensor in self._state.scene.sensors)
            self._state.edit(sensors=tuple(sensors))
        return changed

    def GetId(self) -> str:
        """Return the id of the sensor in OpenRAVE's JSON: empty."""
        return ""

    def GetStructureHash(self) -> str:
        """Return a hash of the sensor type and its pose on the link: 32 hexadecimal digits."""
        sensor = self.description
        return hashes.of_text(
            repr((sensor.link, sensor.T_link_sensor.numbers().round(hashes.DIGITS).tolist(), sensor.type))
        )

    def GetName(self) -> str:
        """Return the attached sensor's name."""
        return self._name

    def GetRobot(self) -> "Robot":
        """Return the robot that carries the sensor."""
        return self._robot

    def GetAttachingLink(self) -> Link | None:
        """Return the link that carries the sensor, or None."""
        return None if self.description.link is None else Link(self._robot, self._state, self.description.link)

    def GetRelativeTransform(self) -> Floats:
        """Return the sensor's pose in the link frame, ``T_link_sensor``, shape (4, 4)."""
        return self.description.T_link_sensor.matrix()

    def SetRelativeTransform(self, transform: ArrayLike) -> None:
        """Set the pose on the link to ``transform``, ``T_link_sensor``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]."""
        self.edit(T_link_sensor=pose_of(checked_transform(transform, "SetRelativeTransform: transform")))

    def GetTransformPose(self) -> Floats:
        """Return the pose in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetData(self) -> SensorData:
        """Return the measurement of the device; see ``Sensor.GetSensorData``.

        Raises:
            openrave_exception: there is no device, or it is off.
        """
        sensor = self.GetSensor()
        if sensor is None:
            raise RavemjError(f"GetData: '{self.GetName()}' is a mere frame")
        return sensor.GetSensorData()

    def GetTransform(self) -> Floats:
        """Return ``T_world_sensor``, shape (4, 4); without a link, the relative pose.

        A camera looks along z, with y down.
        """
        link = self.GetAttachingLink()
        return self.GetRelativeTransform() if link is None else link.GetTransform() @ self.GetRelativeTransform()

    def GetSensor(self) -> Sensor | None:
        """Return the device, always the same object; None for a frame without a device."""
        return self._robot.devices.of(self)

    def GetInfo(self) -> AttachedSensorInfo:
        """Return a copy of the description of the attached sensor."""
        return AttachedSensorInfo.of(self._state.scene, self.description)

    def UpdateAndGetInfo(self, type: SensorType | None = None) -> AttachedSensorInfo:  # OpenRAVE's name
        """Return ``GetInfo()``. ``type`` is not used."""
        del type
        return self.GetInfo()

    def UpdateInfo(self, type: SensorType | None = None) -> None:  # OpenRAVE's name
        """Do nothing, since ``GetInfo`` always returns the current state. ``type`` is not used."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, AttachedSensor) and self._state is other._state and self.GetName() == other.GetName()

    def __hash__(self) -> int:
        return hash((id(self._state), "sensor", self.GetName()))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetAttachedSensor({self.GetName()!r})"


class Devices:
    """Sensor objects of a robot's attached sensors, created on first use."""

    def __init__(self, robot: "Robot") -> None:
        self._robot = robot
        self._by_name: dict[str, Sensor] = {}

    def of(self, attached: AttachedSensor) -> Sensor | None:
        """Return the sensor object of an attached sensor, always the same; None for a frame without a sensor."""
        name, description = attached.GetName(), attached.description
        if description.type is None:
            return None
        env = self._robot.GetEnv()
        with env.simulation.lock:
            if name not in self._by_name:
                self._by_name[name] = Sensor(env, description, attached)
            return self._by_name[name]

    def step(self, timestep: float, stamp: int) -> None:
        """Advance the sensors by a time step [s] that ends at a stamp [microseconds]; skip unused sensors."""
        for attached in self._robot.GetAttachedSensors():
            if attached.GetName() in self._by_name or attached.description.is_on:
                sensor = self.of(attached)
                if sensor is not None:
                    sensor.advance(timestep, stamp)

    def take_over(self, other: "Devices") -> None:
        """Copy the state of the sensors of another robot of the same description; see ``Sensor.take_state``."""
        self.forget()
        for name, device in other._by_name.items():
            attached = self._robot.GetAttachedSensor(name)
            sensor = None if attached is None else self.of(attached)
            if sensor is not None:
                sensor.take_state(device)

    def forget(self, name: str | None = None) -> None:
        """Switch off and discard one sensor and its drawings; without a name, all of them."""
        for known in [*self._by_name] if name is None else [name]:
            sensor = self._by_name.pop(known, None)
            if sensor is not None:
                sensor.hide()


class ConnectedBody(ApiObject):
    """Body that can be connected to a link of a robot; ``robot.AddConnectedBody`` makes it.

    While it is active and the robot is in an environment, its links, joints, manipulators, sensors and grippers belong
    to the robot. Their names start with the name of the body and an underscore.

    Args:
        robot: The robot.
        info: Its description.
    """

    def __init__(self, robot: "Robot", info: ConnectedBodyInfo) -> None:
        self._robot = robot
        self._info = deepcopy(info)

    def GetName(self) -> str:
        """Return the name of the body."""
        return self._info._name or ""

    def GetId(self) -> str:
        """Return the id of the description; empty without one."""
        return self._info._id or ""

    def GetInfo(self) -> ConnectedBodyInfo:
        """Return a copy of the description."""
        return deepcopy(self._info)

    def GetInfoHash(self) -> str:
        """Return a hash of the description: 32 hexadecimal digits."""
        return hashes.of_text(repr(self._info.SerializeJSON()))

    def IsActive(self) -> int:
        """Return whether the body is connected when the robot is added: 1 yes, 0 no, -1 undecided."""
        return self._info._bIsActive

    def SetActive(self, active: int) -> bool:
        """Set whether the body is connected when the robot is added.

        Args:
            active: 1 or True, 0 or False, or -1 for undecided, which means no.

        Returns:
            Whether the state changes.

        Raises:
            openrave_exception: the state changes while the robot is in an environment (``InvalidState``).
        """
        if int(active) == self.IsActive():
            return False
        _check_removed(self._robot, "SetActive")
        self._info._bIsActive = int(active)
        return True

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4).

        Raises:
            openrave_exception: the robot does not have the link named in the description.
        """
        link = self._robot.GetLink(self._info._linkname or "")
        if link is None:
            raise RavemjError(f"'{self._robot.GetName()}' has no link '{self._info._linkname}'", ErrorCode.InvalidState)
        return link.GetTransform() @ self.GetRelativeTransform()

    def GetTransformPose(self) -> Floats:
        """Return the pose in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetRelativeTransform(self) -> Floats:
        """Return the body's pose in the frame of the robot's link, ``T_link_body``, shape (4, 4)."""
        return np.array(checked_transform(self._info._trelative, "ConnectedBodyInfo._trelative"))

    def GetRelativeTransformPose(self) -> Floats:
        """Return ``T_link_body`` as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetRelativeTransform()).numbers()

    def GetResolvedLinks(self) -> list[Link | None]:
        """Return the body's links on the robot; None for each while it is not connected."""
        return [self._robot.GetLink(self._resolved(info._name)) for info in self._info._linkInfos]

    def GetResolvedJoints(self) -> "list[Joint | None]":
        """Return the body's joints on the robot; None for each while it is not connected."""
        return [self._robot.GetJoint(self._resolved(info._name)) for info in self._info._jointInfos]

    def GetResolvedManipulators(self) -> "list[Manipulator | None]":
        """Return the body's manipulators on the robot; None for each while it is not connected."""
        return [self._robot.GetManipulator(self._resolved(info._name)) for info in self._info._manipulatorInfos]

    def GetResolvedAttachedSensors(self) -> list[AttachedSensor | None]:
        """Return the body's sensors on the robot; None for each while it is not connected."""
        return [self._robot.GetAttachedSensor(self._resolved(info._name)) for info in self._info._attachedSensorInfos]

    def GetResolvedGripperInfos(self) -> list[GripperInfo | None]:
        """Return the body's gripper descriptions on the robot; None for each while it is not connected."""
        return [self._robot.GetGripperInfo(self._resolved(info._name)) for info in self._info._gripperInfos]

    def CanProvideManipulator(self, resolvedManipulatorName: str) -> bool:
        """Return whether the connected body gives the robot a manipulator called ``resolvedManipulatorName``."""
        return resolvedManipulatorName in {self._resolved(info._name) for info in self._info._manipulatorInfos}

    def SetLinkEnable(self, enable: bool) -> None:
        """Enable collisions of the body's links if ``enable``, else disable them; no effect unless it is connected."""
        for link in filter(None, self.GetResolvedLinks()):
            link.Enable(enable)

    def SetLinkVisible(self, visible: bool) -> None:
        """Show the body's links if ``visible``, else hide them; no effect unless it is connected."""
        for link in filter(None, self.GetResolvedLinks()):
            link.SetVisible(visible)

    def _resolved(self, name: str | None) -> str:
        return f"{self.GetName()}_{name}"

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetConnectedBody({self.GetName()!r})"


class ConnectedBodies:
    """Connected bodies of a robot, and whether the active ones are merged into it at present.

    Args:
        robot: The robot.
        infos: The descriptions of the bodies.
    """

    def __init__(self, robot: "Robot", infos: Iterable[ConnectedBodyInfo] = ()) -> None:
        self._robot = robot
        self._own_parts: RobotBaseInfo | None = None  # the robot without them, while some are parts of it
        self.bodies = tuple(ConnectedBody(robot, info) for info in infos)

    def copy_for(self, robot: "Robot") -> "ConnectedBodies":
        """Return a copy of the connected bodies for a copy of the robot."""
        copied = ConnectedBodies(robot, [body.GetInfo() for body in self.bodies])
        copied._own_parts = self._own_parts
        return copied

    def add(self, info: ConnectedBodyInfo, replaces: bool) -> ConnectedBody:
        """Add a body; see ``Robot.AddConnectedBody``."""
        name = info._name
        _check_removed(self._robot, "AddConnectedBody")
        if not name or (not replaces and any(body.GetName() == name for body in self.bodies)):
            problem = f"has a connected body '{name}' already" if name else "needs a name for the body"
            raise ArgumentError(f"AddConnectedBody: '{self._robot.GetName()}' {problem}; set another _name")
        if self._robot.GetLink(info._linkname or "") is None:
            raise ArgumentError(f"AddConnectedBody: '{self._robot.GetName()}' has no link '{info._linkname}'")
        added = ConnectedBody(self._robot, info)
        self.bodies = (*(body for body in self.bodies if body.GetName() != name), added)
        return added

    def remove(self, gone: ConnectedBody) -> bool:
        """Remove a body; return whether it existed."""
        _check_removed(self._robot, "RemoveConnectedBody")
        before = len(self.bodies)
        self.bodies = tuple(body for body in self.bodies if body is not gone)
        return len(self.bodies) < before

    def connect(self) -> None:
        """Merge the active bodies into the robot, which must not be in an environment."""
        active = [body.GetInfo() for body in self.bodies if body.IsActive() == 1]
        if active and self._own_parts is None:
            own = self._robot.ExtractInfo()
            self._robot.remake(with_connected(own, active))
            self._own_parts = own

    def disconnect(self) -> None:
        """Remove the parts of the connected bodies from the robot, which must not be in an environment."""
        if self._own_parts is not None:
            own = self._robot.ExtractInfo()
            self._own_parts = None
            self._robot.remake(own)

    def without_their_parts(self, info: RobotBaseInfo) -> RobotBaseInfo:
        """Return a description of the robot without the parts of connected bodies."""
        return info if self._own_parts is None else only_parts_of(info, self._own_parts)


def _check_removed(robot: "Robot", caller: str) -> None:
    if robot.simulation_state.index:
        message = f"{caller}: '{robot.GetName()}' is in an environment; remove it first"
        raise RavemjError(message, ErrorCode.InvalidState)
