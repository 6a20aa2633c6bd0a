"""Sensors on the links of a robot."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from ravemj.core.api_object import ApiObject
from ravemj.core.arrays import checked_transform
from ravemj.core.transforms import Floats, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, RavemjError, UnsupportedError
from ravemj.graphics.rendering import Camera, Pinhole
from ravemj.graphics.simulation_renderer import Format
from ravemj.model import hashes, scene
from ravemj.rave.enums import InterfaceType, SensorCommand, SensorType
from ravemj.rave.infos import AttachedSensorInfo
from ravemj.rave.infos.sensor import CameraGeomData, CameraIntrinsics, SensorGeometry
from ravemj.rave.interface import Interface
from ravemj.rave.link import Link
from ravemj.rave.sensor_data import (
    DATA,
    ActuatorSensorData,
    CameraSensorData,
    Force6DSensorData,
    IMUSensorData,
    JointEncoderSensorData,
    LaserSensorData,
    OdometrySensorData,
    SensorData,
    TactileSensorData,
)
from ravemj.rave.user_data import Annotations

if TYPE_CHECKING:
    from ravemj.rave.robot import Robot

SENSING = "simulation of sensors"
LOOSE = "sensors without a robot"


class Sensor(Interface):
    """A device that measures; ``attached.GetSensor()`` makes it.

    Example:
        >>> camera = robot.GetAttachedSensor("camera").GetSensor()
        >>> camera.Configure(Sensor.ConfigureCommand.PowerOn)
        1
        >>> picture = camera.GetSensorData().imagedata
    """

    Type = SensorType
    Invalid = SensorType.Invalid
    Laser = SensorType.Laser
    Camera = SensorType.Camera
    JointEncoder = SensorType.JointEncoder
    Force6D = SensorType.Force6D
    IMU = SensorType.IMU
    Odometry = SensorType.Odometry
    Tactile = SensorType.Tactile
    Actuator = SensorType.Actuator

    ConfigureCommand = SensorCommand
    PowerOn = SensorCommand.PowerOn
    PowerOff = SensorCommand.PowerOff
    PowerCheck = SensorCommand.PowerCheck
    RenderDataOn = SensorCommand.RenderDataOn
    RenderDataOff = SensorCommand.RenderDataOff
    RenderDataCheck = SensorCommand.RenderDataCheck
    RenderGeometryOn = SensorCommand.RenderGeometryOn
    RenderGeometryOff = SensorCommand.RenderGeometryOff
    RenderGeometryCheck = SensorCommand.RenderGeometryCheck

    CameraIntrinsics = CameraIntrinsics
    SensorData = SensorData
    ActuatorSensorData = ActuatorSensorData
    CameraSensorData = CameraSensorData
    Force6DSensorData = Force6DSensorData
    IMUSensorData = IMUSensorData
    JointEncoderSensorData = JointEncoderSensorData
    LaserSensorData = LaserSensorData
    OdometrySensorData = OdometrySensorData
    TactileSensorData = TactileSensorData

    _interface_type = InterfaceType.sensor

    def __init__(self, attached: "AttachedSensor", description: scene.AttachedSensor, kind: str) -> None:
        self._attached = attached
        self._scene = description
        self._kind = kind
        self._env = attached.GetRobot().GetEnv()
        self._annotations = Annotations()

    def GetName(self) -> str:
        """Return the names of the robot and of the attached sensor, with a colon between them."""
        return f"{self._attached.GetRobot().GetName()}:{self._attached.GetName()}"

    def GetXMLId(self) -> str:
        """Return OpenRAVE's name of the kind of sensor, for instance ``BaseCamera``."""
        return self._kind

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4): that of the attached sensor."""
        return self._attached.GetTransform()

    def GetTransformPose(self) -> Floats:
        """Return the pose in the world as [w, x, y, z, tx, ty, tz], shape (7,)."""
        return pose_of(self.GetTransform()).numbers()

    def SetTransform(self, transform: ArrayLike) -> None:
        """Refuse another pose than that of the attached sensor.

        Args:
            transform: ``T_world_sensor``.

        Raises:
            UnsupportedError: always; ``attached.SetRelativeTransform`` moves the sensor on its link.
        """
        raise UnsupportedError("Sensor.SetTransform", LOOSE)

    def SetName(self, name: str) -> None:
        """Refuse another name than that of the attached sensor.

        Args:
            name: The name.

        Raises:
            UnsupportedError: always.
        """
        raise UnsupportedError("Sensor.SetName", LOOSE)

    def SetSensorGeometry(self, geometry: SensorGeometry) -> bool:
        """Give a camera another image size or other intrinsics.

        Args:
            geometry: A ``CameraGeomData``.

        Returns:
            Whether the sensor is a camera, and took it over.
        """
        if self._scene.camera is None or not isinstance(geometry, CameraGeomData):
            return False
        self._scene = self._attached.edit(camera=geometry.camera())
        return True

    def CreateSensorData(self, type: SensorType | None = None) -> SensorData:  # OpenRAVE's name
        """Return an empty measurement.

        Args:
            type: The kind of data; None: the sensor's own.

        Raises:
            openrave_exception: the sensor gives no data of this kind.
        """
        kind = SensorType.Camera if type is None else SensorType(type)
        if not self.Supports(kind):
            raise ArgumentError(f"CreateSensorData: '{self._kind}' has no data of type {kind.name}")
        return DATA[kind]()

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

    def SimulationStep(self, timeelapsed: float) -> None:
        """Do nothing: data is taken when it is asked for.

        Args:
            timeelapsed: How long [s].
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
            return CameraSensorData(env.clock.now, transform, picture, geometry.intrinsics)

    def GetSensorGeometry(self, type: SensorType | None = None) -> CameraGeomData | None:  # OpenRAVE's name
        """Return what is fixed about the sensor; None unless it is a camera.

        Args:
            type: The kind of geometry that is asked for; None: the sensor's own.
        """
        camera = self._scene.camera
        if camera is None or type not in {None, SensorType.Camera}:
            return None
        return CameraGeomData.of(camera)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sensor) and self._attached == other._attached

    def __hash__(self) -> int:
        return hash((Sensor, self._attached))

    def __repr__(self) -> str:
        return f"{self._attached!r}.GetSensor()"


class AttachedSensor(ApiObject):
    """A place on a link, with or without a device; ``robot.GetAttachedSensors()`` makes it."""

    _internal = ("edit",)

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._scene = state.scene.sensors[index]

    def edit(self, **changes: Any) -> scene.AttachedSensor:  # noqa: ANN401 - the fields of a scene.AttachedSensor
        """Change the description, and return it."""
        with self._state.simulation.lock:
            changed = replace(self._scene, **changes)
            sensors = (changed if one.name == changed.name else one for one in self._state.scene.sensors)
            self._state.edit(sensors=tuple(sensors))
        self._scene = changed
        return changed

    def GetId(self) -> str:
        """Return the id of the sensor in OpenRAVE's JSON: empty."""
        return ""

    def GetStructureHash(self) -> str:
        """Return a text that is the same for sensors of the same kind at the same place of a link: 32 digits."""
        sensor = self._scene
        return hashes.of_text(repr((sensor.link, sensor.T_link_sensor.numbers().round(8).tolist(), sensor.type)))

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
        """Return what the device sees now; see ``Sensor.GetSensorData``.

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
        """Return the device, or None for a mere frame."""
        return None if self._scene.type is None else Sensor(self, self._scene, self._scene.type)

    def GetInfo(self) -> AttachedSensorInfo:
        """Return the description of the attached sensor, a copy."""
        return AttachedSensorInfo.of(self._state.scene, self._scene)

    def UpdateAndGetInfo(self, type: SensorType | None = None) -> AttachedSensorInfo:  # OpenRAVE's name
        """Return ``GetInfo()``.

        Args:
            type: Not used.
        """
        del type
        return self.GetInfo()

    def UpdateInfo(self, type: SensorType | None = None) -> None:  # OpenRAVE's name
        """Do nothing: ``GetInfo`` always gives the present state.

        Args:
            type: Not used.
        """

    def __eq__(self, other: object) -> bool:
        return isinstance(other, AttachedSensor) and self._state is other._state and self.GetName() == other.GetName()

    def __hash__(self) -> int:
        return hash((id(self._state), "sensor", self.GetName()))

    def __repr__(self) -> str:
        return f"{self._robot!r}.GetAttachedSensor({self.GetName()!r})"
