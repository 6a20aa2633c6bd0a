"""Robots: bodies with manipulators and sensors."""

from ravemj.rave.kinbody import KinBody
from ravemj.rave.manipulator import Manipulator
from ravemj.rave.sensors import AttachedSensor
from ravemj.rave.specification import ConfigurationSpecification


class Robot(KinBody):
    """A body that the file calls ``<Robot>``. ``env.GetRobots()`` makes it."""

    Manipulator = Manipulator

    def GetManipulators(self) -> list[Manipulator]:
        """Return the manipulators; the first one is the active one."""
        return [Manipulator(self, self._state, index) for index in range(len(self._state.scene.manipulators))]

    def GetManipulator(self, name: str) -> Manipulator | None:
        """Return the manipulator of that name, or None."""
        return next((manipulator for manipulator in self.GetManipulators() if manipulator.GetName() == name), None)

    def GetActiveManipulator(self) -> Manipulator | None:
        """Return the manipulator that calls without one refer to: the first, or None where there is none."""
        return next(iter(self.GetManipulators()), None)

    def GetAttachedSensors(self) -> list[AttachedSensor]:
        """Return the sensors on the robot's links, in the order of the file."""
        return [AttachedSensor(self, self._state, index) for index in range(len(self._state.scene.sensors))]

    def GetAttachedSensor(self, name: str) -> AttachedSensor | None:
        """Return the attached sensor of that name, or None."""
        return next((sensor for sensor in self.GetAttachedSensors() if sensor.GetName() == name), None)

    def GetActiveConfigurationSpecification(self, interpolation: str = "") -> ConfigurationSpecification:
        """Return the specification of the active DOFs: all joint values.

        Args:
            interpolation: How they change between waypoints, for instance ``linear``.
        """
        return self.GetConfigurationSpecificationIndices(range(self.GetDOF()), interpolation)
