"""Sensors on the links of a robot."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ravemj.core.api_object import ApiObject
from ravemj.core.transforms import Floats
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, RavemjError, UnsupportedError
from ravemj.graphics.rendering import Camera, CameraIntrinsics, Pinhole
from ravemj.graphics.simulation_renderer import Format
from ravemj.model import scene
from ravemj.rave.enums import SensorCommand, SensorType
from ravemj.rave.infos import AttachedSensorInfo
from ravemj.rave.link import Link

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot

SENSING = "simulation of sensors"


@dataclass(eq=False)
class CameraGeomData:
    """Image size and intrinsics of a camera.

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


@dataclass(eq=False)
class CameraSensorData:
    """A camera's picture.

    Attributes:
        transform: ``T_world_camera`` when it was taken, shape (4, 4); z forward, y down.
        imagedata: Shape (height, width, 3), uint8, top row first.
        intrinsics: The camera matrix, wrapped.
        stamp: Simulation time when it was taken [microseconds].
        type: The kind of data.
    """

    transform: Floats
    imagedata: NDArray[np.uint8]
    intrinsics: CameraIntrinsics
    stamp: int
    type: SensorType = SensorType.Camera

    @property
    def KK(self) -> Floats:
        """The camera matrix [pixels], shape (3, 3)."""
        return self.intrinsics.K


class Sensor(ApiObject):
    """A device that measures; ``attached.GetSensor()`` makes it.

    Example:
        >>> camera = robot.GetAttachedSensor("camera").GetSensor()
        >>> camera.Configure(Sensor.ConfigureCommand.PowerOn)
        1
        >>> picture = camera.GetSensorData().imagedata
    """

    Type = SensorType
    ConfigureCommand = SensorCommand
    CameraSensorData = CameraSensorData

    def __init__(self, attached: "AttachedSensor", description: scene.AttachedSensor, kind: str) -> None:
        self._attached = attached
        self._scene = description
        self._kind = kind

    def GetName(self) -> str:
        """Return the names of the robot and of the attached sensor, with a colon between them."""
        return f"{self._attached.GetRobot().GetName()}:{self._attached.GetName()}"

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of sensor, for instance ``BaseCamera``."""
        return self._kind

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4): that of the attached sensor."""
        return self._attached.GetTransform()

    def Supports(self, type: SensorType) -> bool:  # OpenRAVE's name
        """Return whether the sensor gives this kind of data: cameras do.

        Args:
            type: A ``Sensor.Type``.
        """
        return type == SensorType.Camera and self._scene.camera is not None

    def Configure(self, command: int, blocking: bool = False) -> int:
        """Switch the sensor on or off, or ask whether it is on.

        Args:
            command: ``Sensor.ConfigureCommand.PowerOn``, ``PowerOff`` or ``PowerCheck``; what is said about drawing
                of data and shapes has no effect here.
            blocking: OpenRAVE's; ignored.

        Returns:
            1 if it was done, or if the answer is yes; else 0.
        """
        del blocking
        powered = self._attached.GetRobot().powered_sensors
        if command == SensorCommand.PowerCheck:
            return int(self._scene.name in powered)
        if command == SensorCommand.PowerOn:
            powered.add(self._scene.name)
        elif command == SensorCommand.PowerOff:
            powered.discard(self._scene.name)
        return int(command in {SensorCommand.PowerOn, SensorCommand.PowerOff})

    def SimulationStep(self, timestep: float) -> None:
        """Do nothing: data is taken when it is asked for.

        Args:
            timestep: How long [s].
        """

    def GetSensorData(self, type: SensorType | None = None) -> CameraSensorData:  # OpenRAVE's name
        """Return what the sensor sees now.

        Args:
            type: The kind of data; None: the sensor's own.

        Returns:
            A picture with the camera's own intrinsics.

        Raises:
            openrave_exception: the sensor is off, or gives no data of this kind.
            UnsupportedError: it is no camera.
        """
        camera, geometry = self._scene.camera, self.GetSensorGeometry()
        if camera is None or geometry is None:
            raise UnsupportedError(f"sensor '{self._kind}'", "simulation of sensors that are no cameras")
        if type not in {None, SensorType.Camera}:
            raise ArgumentError(f"GetSensorData: a camera has no data of type {SensorType(type).name}")
        if not self.Configure(SensorCommand.PowerCheck):
            raise RavemjError("GetSensorData: the camera is off; Configure(Sensor.ConfigureCommand.PowerOn)")
        env = self._attached.GetRobot().GetEnv()
        with env.simulation.lock:
            transform = self.GetTransform()
            pinhole = Pinhole(camera.fx, camera.fy, camera.cx, camera.cy)
            form = Format(camera.width, camera.height)
            picture = env.renderer.render(Camera(transform, calibration=pinhole), env.background, form, drawings=False)
            return CameraSensorData(transform, picture, geometry.intrinsics, env.clock.now)

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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sensor) and self._attached == other._attached

    def __hash__(self) -> int:
        return hash((Sensor, self._attached))

    def __repr__(self) -> str:
        return f"{self._attached!r}.GetSensor()"


class AttachedSensor(ApiObject):
    """A place on a link, with or without a device; ``robot.GetAttachedSensors()`` makes it."""

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._scene = state.scene.sensors[index]

    def GetName(self) -> str:
        """Return the attached sensor's name."""
        return self._scene.name

    def GetRobot(self) -> "Robot":
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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, AttachedSensor) and self._state is other._state and self.GetName() == other.GetName()

    def __hash__(self) -> int:
        return hash((id(self._state), "sensor", self.GetName()))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetAttachedSensor({self.GetName()!r})"
