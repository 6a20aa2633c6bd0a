"""Sensors on the links of a robot."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ravemj import scene
from ravemj.errors import UnsupportedError
from ravemj.rave.enums import SensorCommand, SensorType
from ravemj.rave.infos import AttachedSensorInfo
from ravemj.rave.link import Link
from ravemj.rendering import CameraIntrinsics
from ravemj.simulation import BodyState
from ravemj.transforms import Floats

if TYPE_CHECKING:
    from ravemj.rave.kinbody import KinBody

SENSING = "simulation of sensors"


@dataclass(eq=False)
class CameraGeomData:
    """What is fixed about a camera.

    Attributes:
        intrinsics: The camera matrix, wrapped.
        width: Columns [pixels].
        height: Rows [pixels].
    """

    intrinsics: CameraIntrinsics
    width: int
    height: int

    @property
    def KK(self) -> Floats:
        """The camera matrix [pixels], shape (3, 3)."""
        return self.intrinsics.K


class Sensor:
    """A device that measures; ``attached.GetSensor()`` makes it."""

    Type = SensorType
    ConfigureCommand = SensorCommand

    def __init__(self, attached: "AttachedSensor", description: scene.AttachedSensor, kind: str) -> None:
        self._attached = attached
        self._scene = description
        self._kind = kind

    def GetName(self) -> str:
        """Return the sensor's name, unique in its environment: ``robot:sensor``."""
        return f"{self._attached.GetRobot().GetName()}:{self._scene.name}"

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4); a camera looks along z, with y down."""
        return self._attached.GetTransform()

    def Configure(self, command: SensorCommand, blocking: bool = False) -> int:
        """Switch the sensor on or off."""
        raise UnsupportedError("Sensor.Configure", SENSING)

    def GetSensorData(self, type: SensorType | None = None) -> object:  # OpenRAVE's name
        """Return what the sensor measured last."""
        raise UnsupportedError("Sensor.GetSensorData", SENSING)

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of sensor, for instance ``BaseCamera``."""
        return self._kind

    def GetSensorGeometry(self, type: SensorType | None = None) -> CameraGeomData | None:  # OpenRAVE's name
        """Return what is fixed about the sensor; None unless it is a camera.

        Args:
            type: The kind of geometry that is asked for; None: the sensor's own.
        """
        camera = self._scene.camera
        if camera is None or type not in {None, SensorType.Camera}:
            return None
        matrix = np.array([[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]])
        return CameraGeomData(CameraIntrinsics(matrix), camera.width, camera.height)


class AttachedSensor:
    """A place on a link, with or without a device; ``robot.GetAttachedSensors()`` makes it."""

    def __init__(self, robot: "KinBody", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._scene = state.scene.sensors[index]

    def GetName(self) -> str:
        """Return the attached sensor's name."""
        return self._scene.name

    def GetRobot(self) -> "KinBody":
        """Return the robot that carries the sensor."""
        return self._robot

    def GetAttachingLink(self) -> Link | None:
        """Return the link that carries the sensor, or None."""
        return None if self._scene.link is None else Link(self._robot, self._state, self._scene.link)

    def GetRelativeTransform(self) -> Floats:
        """Return the pose in the link.

        Returns:
            ``T_link_sensor``, shape (4, 4).
        """
        return self._scene.T_link_sensor.matrix()

    def GetTransform(self) -> Floats:
        """Return the pose in the world as the links stand now.

        Returns:
            ``T_world_sensor``, shape (4, 4); a camera looks along z, with y down. Without a link, the relative pose.
        """
        link = self.GetAttachingLink()
        return self.GetRelativeTransform() if link is None else link.GetTransform() @ self.GetRelativeTransform()

    def GetSensor(self) -> Sensor | None:
        """Return the device, or None for a mere frame."""
        return None if self._scene.type is None else Sensor(self, self._scene, self._scene.type)

    def GetInfo(self) -> AttachedSensorInfo:
        """Return the description of the attached sensor, a copy."""
        return AttachedSensorInfo.of(self._state.scene, self._scene)

    UpdateAndGetInfo = GetInfo

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetAttachedSensor('{self.GetName()}')"
