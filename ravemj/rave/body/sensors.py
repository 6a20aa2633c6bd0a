"""The sensors of a robot."""

from typing import TYPE_CHECKING, cast

from ravemj.core.arguments import checked_kind
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.rave.attached_sensor import AttachedSensor
from ravemj.rave.body.base import BodyPart
from ravemj.rave.infos import AttachedSensorInfo
from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot


class Sensors(BodyPart):
    """The sensors that a robot carries."""

    _devices: dict[str, Sensor]
    """The sensors that were used, by the names of their attached sensors; others are not made."""
    _internal = ("device", "forget_sensors", "step_sensors", "take_sensors")

    def GetAttachedSensors(self) -> list[AttachedSensor]:
        """Return the sensors on the robot's links, in the order of the file."""
        robot = cast("Robot", self)
        return [AttachedSensor(robot, self._state, index) for index in range(len(self._state.scene.sensors))]

    def GetAttachedSensor(self, sensorname: str) -> AttachedSensor | None:
        """Return the attached sensor of a name, or None.

        Args:
            sensorname: The name.
        """
        return next((sensor for sensor in self.GetAttachedSensors() if sensor.GetName() == sensorname), None)

    GetSensors = GetAttachedSensors
    GetSensor = GetAttachedSensor

    def AddAttachedSensor(
        self, attachedsensorinfo: AttachedSensorInfo, removeduplicate: bool = False
    ) -> AttachedSensor:
        """Attach a sensor to a link.

        Args:
            attachedsensorinfo: The description of the sensor.
            removeduplicate: Whether it replaces an attached sensor of the same name.

        Returns:
            The new attached sensor.

        Raises:
            openrave_exception: the robot has a sensor of that name, or no such link, or the sensor cannot measure with
                these properties. The robot stays as it is.
        """
        body = self._state.scene
        info = checked_kind(attachedsensorinfo, AttachedSensorInfo, "AddAttachedSensor: attachedsensorinfo")
        made = info.sensor([link.name for link in body.links])
        if made.link is None:
            known = ", ".join(link.name for link in body.links)
            message = f"'{body.name}' has no link '{info._linkname}'; it has {known}"  # pyright: ignore[reportPrivateUsage] - OpenRAVE's field
            raise ArgumentError(f"AddAttachedSensor: {message}")
        sensors, names = list(body.sensors), [sensor.name for sensor in body.sensors]
        index = names.index(made.name) if made.name in names else len(names)
        if index < len(names) and not removeduplicate:
            raise ArgumentError(f"AddAttachedSensor: '{body.name}' has a sensor '{made.name}' already")
        kind = scene.sensor_kind(made.type or "")
        is_told = kind is not None and made.device is not None and made.device != kind.device
        problem = made.device.problem() if is_told and made.device is not None else None
        if problem is not None:
            raise ArgumentError(f"AddAttachedSensor: '{made.name}' cannot measure: {problem}")
        with self._simulation.lock:
            self.forget_sensors(made.name)
            self._state.edit(sensors=(*sensors[:index], made, *sensors[index + 1 :]))
        return self.GetAttachedSensors()[index]

    def RemoveAttachedSensor(self, attsensor: AttachedSensor) -> bool:
        """Remove a sensor from the robot.

        Args:
            attsensor: The attached sensor.

        Returns:
            Whether the robot had it.
        """
        if attsensor not in self.GetAttachedSensors():
            return False
        with self._simulation.lock:
            name = attsensor.GetName()
            self.forget_sensors(name)
            self._state.edit(sensors=tuple(one for one in self._state.scene.sensors if one.name != name))
        return True

    def device(self, attached: AttachedSensor) -> Sensor | None:
        """Return the sensor of an attached sensor, always the same object; None for a frame without a sensor."""
        name, description = attached.GetName(), attached.description
        if description.type is None:
            return None
        with self._simulation.lock:
            if name not in self._devices:
                self._devices[name] = Sensor(attached.GetRobot().GetEnv(), description, attached)
            return self._devices[name]

    def step_sensors(self, timestep: float, stamp: int) -> None:
        """Advance the sensors by a time step [s] that ends at a stamp [microseconds]. Unused sensors are not made."""
        for attached in self.GetAttachedSensors():
            if attached.GetName() in self._devices or attached.description.is_on:
                sensor = attached.GetSensor()
                if sensor is not None:
                    sensor.advance(timestep, stamp)

    def take_sensors(self, other: "Sensors") -> None:
        """Copy the state of the sensors of another robot of the same description; see ``Sensor.take_state``."""
        self.forget_sensors()
        for name, device in other._devices.items():
            attached = self.GetAttachedSensor(name)
            sensor = None if attached is None else attached.GetSensor()
            if sensor is not None:
                sensor.take_state(device)

    def forget_sensors(self, name: str | None = None) -> None:
        """Switch off and discard one sensor and its drawings; without a name, all of them."""
        for known in [*self._devices] if name is None else [name]:
            sensor = self._devices.pop(known, None)
            if sensor is not None:
                sensor.hide()
