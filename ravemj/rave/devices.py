"""The sensors that a robot carries, as objects that measure."""

from typing import TYPE_CHECKING

from ravemj.rave.sensors import Sensor

if TYPE_CHECKING:
    from ravemj.rave.attached_sensor import AttachedSensor
    from ravemj.rave.robot import Robot


class Devices:
    """One sensor object for each attached sensor of a robot, made when it is first used."""

    def __init__(self, robot: "Robot") -> None:
        self._robot = robot
        self._by_name: dict[str, Sensor] = {}

    def of(self, attached: "AttachedSensor") -> Sensor | None:
        """Return the sensor of an attached sensor, always the same object; None for a frame without a sensor."""
        name, description = attached.GetName(), attached.description
        if description.type is None:
            return None
        env = self._robot.GetEnv()
        with env.simulation.lock:
            if name not in self._by_name:
                self._by_name[name] = Sensor(env, description, attached)
            return self._by_name[name]

    def step(self, timestep: float, stamp: int) -> None:
        """Advance the sensors by a time step [s] that ends at a stamp [microseconds]. Unused sensors are not made."""
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
