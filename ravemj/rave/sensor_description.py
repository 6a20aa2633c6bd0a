"""The constant properties of sensors: name, pose, geometry."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, pose_of
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.model import scene
from ravemj.rave.enums import InterfaceType, SensorType
from ravemj.rave.infos.sensor import SensorGeometry
from ravemj.rave.infos.sensor_devices import device_of, geometry_of, sensor_type
from ravemj.rave.interface import Interface
from ravemj.rave.sensor_data import DATA, SensorData

if TYPE_CHECKING:
    from ravemj.rave.attached_sensor import AttachedSensor
    from ravemj.rave.environment import Environment


class DescribedSensor(Interface):
    """A sensor as the scene describes it, on a robot or by itself.

    Attributes:
        attached: The attached sensor of a robot that it belongs to, or None.
    """

    _interface_type = InterfaceType.sensor
    _internal = ("attached", "description", "device", "take_state")

    def __init__(
        self, env: "Environment", description: scene.AttachedSensor, attached: "AttachedSensor | None"
    ) -> None:
        super().__init__(env, description.type or "")
        self._own = description
        self.attached = attached

    @property
    def description(self) -> scene.AttachedSensor:
        """The description in the scene. The pose of a sensor without a robot is its pose in the world."""
        return self._own if self.attached is None else self.attached.description

    @property
    def device(self) -> scene.Device:
        """The constant properties of the sensor.

        Raises:
            UnsupportedError: ravemj does not simulate this kind of sensor.
        """
        device = self.description.device
        if device is None:
            raise UnsupportedError(f"sensor '{self.GetXMLId()}'", "simulation of sensors of this kind")
        return device

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.AttachedSensor
        if self.attached is None:
            self._own = replace(self._own, **changes)
        else:
            self.attached.edit(**changes)

    def _moved(self) -> None:
        """React to a new pose of a sensor without a robot."""

    def _take_over(self) -> None:
        """Restart with other constant properties."""

    def take_state(self, other: "DescribedSensor") -> None:
        """Copy the state of another sensor of the same kind."""

    def _problem(self) -> str | None:
        """Return why the sensor cannot measure, or None."""
        description, device = self.description, self.device
        if self.attached is not None and description.link is None:
            return "it is attached to no link"
        if self.attached is None and scene.needs_link(device):
            return "it measures what a link feels: attach it to a robot, with robot.AddAttachedSensor"
        return device.problem()

    def GetName(self) -> str:
        """Return ``robot:sensor`` for an attached sensor, else the sensor's own name."""
        if self.attached is None:
            return self._own.name
        return f"{self.attached.GetRobot().GetName()}:{self.attached.GetName()}"

    def SetName(self, name: str) -> None:
        """Set the ``name`` of a sensor without a robot.

        Raises:
            openrave_exception: a robot carries the sensor, or the environment has another one of that name.
        """
        self._check_loose("SetName", "its robot and its place on it name it")
        other = self._env.GetSensor(checked_kind(name, str, "SetName: name", "a text"))
        if other is not None and other is not self and self in self._env.GetSensors():
            raise RavemjError(f"SetName: there already is a sensor '{name}'", ErrorCode.SensorNameConflict)
        self._edit(name=name)

    def _check_loose(self, caller: str, reason: str) -> None:
        if self.attached is not None:
            raise RavemjError(f"{caller}: '{self.GetName()}' is on a robot: {reason}", ErrorCode.InvalidState)

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of sensor, for instance ``BaseCamera``."""
        return self.description.type or ""

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4): that of the attached sensor."""
        return self._own.T_link_sensor.matrix() if self.attached is None else self.attached.GetTransform()

    def GetTransformPose(self) -> Floats:
        """Return the pose in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Move a sensor without a robot to ``transform``, ``T_world_sensor``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz].

        Raises:
            openrave_exception: a robot carries the sensor; ``attached.SetRelativeTransform`` moves it on its link.
        """
        self._check_loose("SetTransform", "attached.SetRelativeTransform moves it on its link")
        self._edit(T_link_sensor=pose_of(checked_transform(transform, "SetTransform: transform")))
        self._moved()

    def SetSensorGeometry(self, geometry: SensorGeometry) -> bool:
        """Change the resolution, range or calibration of the sensor. Earlier measurements are discarded.

        Args:
            geometry: A description like those that ``GetSensorGeometry`` returns.

        Returns:
            Whether the description fits this kind of sensor.

        Raises:
            openrave_exception: a sensor with these properties cannot measure; the sensor stays as it is.
        """
        with self._env.simulation.lock:
            device = device_of(geometry, self.device)
            if device is None:
                return False
            problem = device.problem()
            if problem is not None:
                raise ArgumentError(f"SetSensorGeometry: '{self.GetName()}' cannot measure like this: {problem}")
            self._edit(device=device)
            self._take_over()
        return True

    @also_named(reference="ref")
    def Clone(self, ref: "DescribedSensor", cloningoptions: int = 0) -> None:
        """Copy another sensor of the same kind: its geometry, its noise, whether it is on, and its user data.

        A sensor without a robot also copies the name and the pose.

        Args:
            ref: The other sensor.
            cloningoptions: Not used.

        Raises:
            openrave_exception: the other sensor is of another kind.
        """
        other = checked_kind(ref, DescribedSensor, "Clone: ref", "a Sensor")
        if other.GetXMLId().lower() != self.GetXMLId().lower():
            raise ArgumentError(f"Clone: ref is a '{other.GetXMLId()}', and this is a '{self.GetXMLId()}'")
        super().Clone(other, cloningoptions)
        with self._env.simulation.lock:
            if self.attached is None:
                self._own = replace(other.description, link=None, T_link_sensor=pose_of(other.GetTransform()))
            else:
                self._edit(device=other.description.device)
            self.take_state(other)

    def GetSensorGeometry(self, type: SensorType | None = None) -> SensorGeometry | None:  # OpenRAVE's name
        """Return the constant properties of the sensor.

        None if it has none of the kind ``type``, which by default is its own.
        """
        device = self.description.device
        geometry = None if device is None else geometry_of(device)
        is_meant = geometry is not None and type in {None, SensorType.Invalid, geometry.GetType()}
        return geometry if is_meant else None

    def CreateSensorData(self, type: SensorType | None = None) -> SensorData:  # OpenRAVE's name
        """Return an empty measurement of ``type``, by default of the sensor's own.

        Raises:
            openrave_exception: the sensor does not measure this kind of data.
        """
        return DATA[self._checked_type(type, "CreateSensorData")]()

    def Supports(self, type: SensorType) -> bool:  # OpenRAVE's name
        """Return whether the sensor measures data of ``type``, a ``Sensor.Type``."""
        device = self.description.device
        return device is not None and type == sensor_type(device)

    def _checked_type(self, type: SensorType | None, caller: str) -> SensorType:  # as in OpenRAVE
        own = sensor_type(self.device)
        if type not in {None, SensorType.Invalid, own}:
            raise ArgumentError(f"{caller}: '{self.GetXMLId()}' has no data of type {SensorType(type).name}")
        return own
