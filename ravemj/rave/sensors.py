"""Sensors of an environment, and their constant properties."""

import logging
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.arguments import also_named, checked_kind
from ravemj.core.arrays import checked_number, checked_transform
from ravemj.core.transforms import Floats, Ints, Pose, pose_of
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.model import scene
from ravemj.model.shape_bodies import FROM_SCRIPT
from ravemj.rave.enums import InterfaceType, SensorCommand, SensorType
from ravemj.rave.env.viewing import GraphHandle
from ravemj.rave.infos.sensor import CameraIntrinsics, SensorGeometry, device_of, geometry_of, sensor_type
from ravemj.rave.instruments import (
    DATA,
    ActuatorSensorData,
    CameraSensorData,
    Force6DSensorData,
    IMUSensorData,
    Instrument,
    JointEncoderSensorData,
    LaserSensorData,
    OdometrySensorData,
    Place,
    SensorData,
    TactileSensorData,
    copied,
)
from ravemj.rave.interface import Interface, asked_for

if TYPE_CHECKING:
    from ravemj.rave.environment import Environment
    from ravemj.rave.robot.equipment import AttachedSensor


class DescribedSensor(Interface):
    """Sensor with its description in the scene, on a robot or without one.

    Attributes:
        attached: The mount of the sensor on a robot, or None.
    """

    _often_called = ("SetTransform",)

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
        """Handle a new pose of a sensor without a robot."""

    def _take_over(self) -> None:
        """Restart after a change of the sensor's constant properties."""

    def take_state(self, other: "DescribedSensor") -> None:
        """Copy the state of another sensor of the same kind."""

    def _problem(self) -> str | None:
        """Return the reason why the sensor cannot measure, or None."""
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
        """Return OpenRAVE's name of the sensor type, for instance ``BaseCamera``."""
        return self.description.type or ""

    def GetTransform(self) -> Floats:
        """Return the pose in the world, shape (4, 4)."""
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
        """Return the constant properties of the sensor; None if ``type`` is given and is not the sensor's type."""
        device = self.description.device
        geometry = None if device is None else geometry_of(device)
        is_meant = geometry is not None and type in {None, SensorType.Invalid, geometry.GetType()}
        return geometry if is_meant else None

    def CreateSensorData(self, type: SensorType | None = None) -> SensorData:  # OpenRAVE's name
        """Return an empty measurement of ``type``, by default of the sensor's own type.

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


_LOG = logging.getLogger("ravemj")

KIND_NAMES = tuple(kind.name for kind in scene.SENSOR_KINDS.values())
"""The names that ``RaveCreateSensor`` knows."""

_SWITCHES: tuple[SensorCommand, ...] = (
    SensorCommand.PowerOn,
    SensorCommand.RenderDataOn,
    SensorCommand.RenderGeometryOn,
)
_DRAWN: Mapping[SensorCommand, tuple[type, ...]] = MappingProxyType(
    {
        SensorCommand.RenderDataOn: (scene.Laser, scene.FlashLidar),
        SensorCommand.RenderGeometryOn: (scene.Laser, scene.FlashLidar, scene.Intrinsics),
    }
)
"""Device classes that viewers can draw, by the command that starts drawing their measurements or their geometry."""

_OFF = 1
"""Offset from the number of an "on" command to that of its "off" command."""

_SWITCH_BITS = 0x30  # the bits of a command's number that select what it switches

_SLACK = 1e-9
"""Time by which a measurement may be early [s], for rounding errors in sums of many time steps."""


class Sensor(DescribedSensor):
    """A sensor. ``attached.GetSensor()`` returns a robot's sensor; ``RaveCreateSensor`` makes one without a robot.

    A sensor is off at first. While it is on, it measures in each step of simulation time; a laser measures once in
    its ``time_scan``. ``GetSensorData`` returns the last measurement. If no simulation time has passed since, it
    measures again, so it also works without a simulation. Cameras take their picture when they are asked for it.

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

    _internal = ("advance", "hide", "take_state")

    def __init__(
        self, env: "Environment", description: scene.AttachedSensor, attached: "AttachedSensor | None" = None
    ) -> None:
        super().__init__(env, description, attached)
        self._instrument = Instrument(env)
        self._switched = dict.fromkeys(_SWITCHES, False)
        self._shape: GraphHandle | None = None
        self._trace: GraphHandle | None = None
        self._restart()
        if description.is_on and self._problem() is None:
            self._switched[SensorCommand.PowerOn] = True

    def _restart(self) -> None:
        """Discard all measurements."""
        self._instrument.restart()
        self._data: SensorData | None = None
        self._until_next = 0.0
        self._trace = None

    def _moved(self) -> None:
        self._show_shape()

    def _take_over(self) -> None:
        self._restart()
        self._show_shape(anew=True)

    def Configure(self, command: int, blocking: bool = False) -> int:
        """Switch the sensor or its drawing on or off, or ask whether it is on.

        Viewers and pictures draw the measurements of lasers after ``RenderDataOn``, and the frustums and rays of
        cameras and lasers after ``RenderGeometryOn``. At first neither is drawn; OpenRAVE draws geometries from the
        start.

        Args:
            command: A ``Sensor.ConfigureCommand``.
            blocking: Not used.

        Returns:
            1 if the sensor was switched, or if the answer is yes; 0 if the answer is no, or if viewers do not draw this
            kind of sensor.

        Raises:
            openrave_exception: the command is unknown; or the sensor cannot measure, since it is on no link or its
                geometry has impossible numbers, and stays off.
        """
        del blocking
        if command not in {known_command.value for known_command in SensorCommand}:
            known = ", ".join(known_command.name for known_command in SensorCommand)
            raise ArgumentError(f"Configure: there is no command {command!r}; there are {known}")
        switch = SensorCommand(int(command) & _SWITCH_BITS)
        with self._env.simulation.lock:
            if command == switch:
                self._switch_on(switch)
            elif command == switch + _OFF:
                self._switch_off(switch)
                return 1
        return int(self._switched[switch])

    def _switch_on(self, switch: SensorCommand) -> None:
        if switch == SensorCommand.PowerOn:
            problem = self._problem()
            if problem is not None:
                where = self.description.source
                raise RavemjError(f"Configure: sensor '{self.GetName()}' ({where}) cannot be switched on: {problem}")
            self._restart()
            self._env.clock.wake()  # scripts wait for the stamp of the data to change
        elif not isinstance(self.device, _DRAWN[switch]):
            return
        self._switched[switch] = True
        self._show_shape()

    def _switch_off(self, switch: SensorCommand) -> None:
        self._switched[switch] = False
        if switch == SensorCommand.RenderGeometryOn:
            self._shape = None
        elif switch == SensorCommand.RenderDataOn:
            self._trace = None
        else:
            self._restart()

    def SimulationStep(self, timeelapsed: float) -> None:
        """Advance this sensor alone by ``timeelapsed`` [s]; ``env.StepSimulation`` advances all sensors."""
        checked = checked_number(timeelapsed, "SimulationStep: timeelapsed", 0)
        with self._env.simulation.lock:
            self.advance(checked, self._env.clock.now)

    def advance(self, timestep: float, stamp: int) -> None:
        """Advance by ``timestep`` [s], which ends at ``stamp`` [microseconds], and measure if a measurement is due."""
        if self._switched[SensorCommand.PowerOn]:
            device = self.device
            self._instrument.advance(device, self._place(), timestep)
            self._until_next -= timestep
            if self._until_next <= _SLACK and not isinstance(device, scene.Intrinsics):
                self._until_next = getattr(device, "scan_time", 0.0)
                try:
                    self._data = self._measured(stamp)
                except RavemjError:  # GetSensorData measures again, and its caller gets the error
                    self._data = None
        self._show_shape()

    def GetSensorData(self, type: SensorType | None = None) -> Any:  # noqa: ANN401 - of the sensor's class of data
        """Return the last measurement. If no time has passed since, measure again. A camera takes a new picture.

        Args:
            type: The kind of data; by default the sensor's own.

        Returns:
            ``CameraSensorData``, ``LaserSensorData`` and so on, a copy.

        Raises:
            openrave_exception: the sensor is off, or does not measure this kind of data; or it measures forces, and
                the environment has no physics engine that simulates them.
        """
        self._checked_type(type, "GetSensorData")
        with self._env.simulation.lock:
            self._check_on("GetSensorData")
            now = self._env.clock.now
            if self._data is not None and self._data.stamp < now:
                return copied(self._data)
            return self._measured(now)

    def _check_on(self, caller: str) -> None:
        if not self._switched[SensorCommand.PowerOn]:
            command = "Configure(Sensor.ConfigureCommand.PowerOn)"
            raise RavemjError(f"{caller}: sensor '{self.GetName()}' is off; {command} switches it on")

    def depth_image(self) -> NDArray[np.float32]:
        """Return the depths that a camera sees now.

        Returns:
            Depths along the viewing direction [m], shape (height, width), top row first; infinite in the background.

        Raises:
            openrave_exception: the sensor is off, or is not a camera.
        """
        with self._env.simulation.lock:
            return self._instrument.depth_image(self._checked_camera("depth_image"), self._place())

    def segmentation_image(self) -> Ints:
        """Return the link that each pixel of a camera shows now.

        Returns:
            Shape (height, width, 2), top row first: ``body.GetEnvironmentBodyIndex()``, and the index of the link; 0
            and -1 in the background.

        Raises:
            openrave_exception: the sensor is off, or is not a camera.
        """
        with self._env.simulation.lock:
            return self._instrument.segmentation_image(self._checked_camera("segmentation_image"), self._place())

    def _checked_camera(self, caller: str) -> scene.Intrinsics:
        self._check_on(caller)
        device = self.device
        if not isinstance(device, scene.Intrinsics):
            raise ArgumentError(f"{caller}: '{self.GetName()}' is not a camera but {self.GetXMLId()}")
        return device

    def set_noise(self, deviation: float, seed: int | None = None) -> None:
        """Add Gaussian noise to all further measurements. At first there is none.

        Args:
            deviation: The standard deviation in the unit of the measured numbers: distances of lasers, colours of
                cameras from 0 to 255, forces and torques, angular velocities and accelerations, joint values,
                positions. 0 switches the noise off.
            seed: The seed of the random numbers; by default a random one.

        Raises:
            openrave_exception: the deviation is negative or not finite.
        """
        self._instrument.set_noise(checked_number(deviation, "set_noise: deviation", 0), seed)

    def take_state(self, other: DescribedSensor) -> None:
        """Copy the state of another sensor of the same kind: its noise, whether it is on, and whether it is drawn."""
        assert isinstance(other, Sensor)
        self._restart()
        self._instrument.take_over(other._instrument)
        self._switched, self._until_next = dict(other._switched), other._until_next
        self._switched[SensorCommand.PowerOn] &= self._problem() is None
        self._show_shape(anew=True)

    def hide(self) -> None:
        """Switch the sensor and its drawings off, since it is removed."""
        for switch in _SWITCHES:
            self._switch_off(switch)

    def _place(self) -> Place:
        link = self.description.link
        carrier = None if self.attached is None or link is None else (self.attached.state, link)
        return Place(self.GetTransform(), carrier)

    def _measured(self, stamp: int) -> SensorData:
        """Return a new measurement; draw it if drawing measurements is switched on."""
        device = self.device
        data = self._instrument.measured(device, self._place(), stamp)
        scanned = self._instrument.scanned
        if self._switched[SensorCommand.RenderDataOn] and scanned is not None:
            from ravemj.engine.sensing import scan_figure  # noqa: PLC0415 - slow to import

            assert isinstance(device, scene.Laser | scene.FlashLidar)
            figure = scan_figure(device, scanned[0], self.description.color)
            self._trace = GraphHandle(self._env.simulation.drawings, figure)
        return data

    def _show_shape(self, *, anew: bool = False) -> None:
        """Draw the sensor geometry if this drawing is on; ``anew`` redraws it after a possible change."""
        if not self._switched[SensorCommand.RenderGeometryOn]:
            return
        device = self.device
        if self._shape is None or anew:
            from ravemj.engine.sensing import shape_figure  # noqa: PLC0415 - slow to import

            self._shape = GraphHandle(self._env.simulation.drawings, shape_figure(device, self.description.color))
        self._shape.SetTransform(self._instrument.rays_pose(device, self._place()))

    def _colliding_bodies(self, arguments: str) -> str:
        """Return the environment index of the body that each ray has hit; 0 for rays without a hit."""
        del arguments
        if self._instrument.scanned is None:
            raise RavemjError(f"collidingbodies: '{self.GetName()}' has not scanned yet")
        measured, world = self._instrument.scanned
        return " ".join(map(str, world.labels(measured.geoms)[:, 0].tolist()))

    _commands = MappingProxyType({"collidingbodies": _colliding_bodies})

    def __repr__(self) -> str:
        if self.attached is not None:
            return f"{self.attached!r}.GetSensor()"
        return f"RaveCreateSensor({self._env!r}, {self.GetXMLId()!r})"


def RaveCreateSensor(env: "Environment", name: str) -> Sensor | None:
    """Make a sensor without a robot. ``SetTransform`` places it; after ``env.Add`` simulation steps advance it.

    Args:
        env: The environment.
        name: ``BaseCamera``, ``BaseLaser2D``, ``BaseSpinningLaser2D`` or ``BaseFlashLidar3D``; or a kind that only
            measures on a robot. Letter case does not matter.

    Returns:
        The sensor with OpenRAVE's defaults; None with a logged warning for an unknown name.

    Example:
        >>> laser = RaveCreateSensor(env, "BaseLaser2D")
        >>> laser.SetName("door")
        >>> laser.SetTransform([1, 0, 0, 0, 0.5, 0, 0.3])
        >>> env.Add(laser)
    """
    word = asked_for(env, name, "RaveCreateSensor")[0]
    kind = scene.SENSOR_KINDS.get(word.lower())
    if kind is None:
        _LOG.warning("there is no sensor '%s'; there are %s", name, ", ".join(KIND_NAMES))
        return None
    description = scene.AttachedSensor(
        name="", link=None, T_link_sensor=Pose(), type=word, device=kind.device, source=FROM_SCRIPT
    )
    return Sensor(env, description)
