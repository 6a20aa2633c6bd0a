"""Places for sensors on the links of a robot."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import RavemjError
from ravemj.model import hashes, scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos import AttachedSensorInfo
from ravemj.rave.link import Link
from ravemj.rave.sensor_data import SensorData
from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot


class AttachedSensor(ApiObject):
    """A place on a link, with or without a device; ``robot.GetAttachedSensors()`` makes it."""

    _internal = ("description", "edit", "state")

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._name = state.scene.sensors[index].name

    @property
    def state(self) -> BodyState:
        """The body of the robot."""
        return self._state

    @property
    def description(self) -> scene.AttachedSensor:
        """What the robot says about the sensor.

        Raises:
            RavemjError: the robot has no such sensor any more.
        """
        found = next((one for one in self._state.scene.sensors if one.name == self._name), None)
        if found is None:
            raise RavemjError(f"'{self._robot.GetName()}' has no sensor '{self._name}' any more")
        return found

    def edit(self, **changes: Any) -> scene.AttachedSensor:  # noqa: ANN401 - the fields of a scene.AttachedSensor
        """Change the description, and return it."""
        with self._state.simulation.lock:
            changed = replace(self.description, **changes)
            sensors = (changed if one.name == changed.name else one for one in self._state.scene.sensors)
            self._state.edit(sensors=tuple(sensors))
        return changed

    def GetId(self) -> str:
        """Return the id of the sensor in OpenRAVE's JSON: empty."""
        return ""

    def GetStructureHash(self) -> str:
        """Return a text that is the same for sensors of the same kind at the same place of a link: 32 digits."""
        sensor = self.description
        return hashes.of_text(repr((sensor.link, sensor.T_link_sensor.numbers().round(8).tolist(), sensor.type)))

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
        """Return the pose in the link.

        Returns:
            ``T_link_sensor``, shape (4, 4).
        """
        return self.description.T_link_sensor.matrix()

    def SetRelativeTransform(self, transform: ArrayLike) -> None:
        """Move the sensor on its link.

        Args:
            transform: ``T_link_sensor``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].
        """
        self.edit(T_link_sensor=pose_of(checked_transform(transform, "SetRelativeTransform: transform")))

    def GetTransformPose(self) -> Floats:
        """Return the pose in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def GetData(self) -> SensorData:
        """Return what the device measures; see ``Sensor.GetSensorData``.

        Raises:
            openrave_exception: there is no device, or it is off.
        """
        sensor = self.GetSensor()
        if sensor is None:
            raise RavemjError(f"GetData: '{self.GetName()}' is a mere frame")
        return sensor.GetSensorData()

    def GetTransform(self) -> Floats:
        """Return the pose in the world as the links stand now.

        Returns:
            ``T_world_sensor``, shape (4, 4); a camera looks along z, with y down. Without a link, the relative pose.
        """
        link = self.GetAttachingLink()
        return self.GetRelativeTransform() if link is None else link.GetTransform() @ self.GetRelativeTransform()

    def GetSensor(self) -> Sensor | None:
        """Return the device, or None for a mere frame; always the same object."""
        return self._robot.devices.of(self)

    def GetInfo(self) -> AttachedSensorInfo:
        """Return the description of the attached sensor, a copy."""
        return AttachedSensorInfo.of(self._state.scene, self.description)

    def UpdateAndGetInfo(self, type: SensorType | None = None) -> AttachedSensorInfo:  # OpenRAVE's name
        """Return ``GetInfo()``; ``type`` has no effect."""
        del type
        return self.GetInfo()

    def UpdateInfo(self, type: SensorType | None = None) -> None:  # OpenRAVE's name
        """Do nothing, whatever ``type`` is: ``GetInfo`` always gives the present state."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, AttachedSensor) and self._state is other._state and self.GetName() == other.GetName()

    def __hash__(self) -> int:
        return hash((id(self._state), "sensor", self.GetName()))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetAttachedSensor({self.GetName()!r})"
