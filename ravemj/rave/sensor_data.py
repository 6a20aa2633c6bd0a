"""What sensors measure: a class for each kind of sensor."""

from dataclasses import dataclass, field, fields, replace
from enum import IntEnum
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats
from ravemj.errors import RavemjError
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.sensor import CameraIntrinsics


def _nothing() -> Floats:
    return np.zeros(0)


@dataclass(eq=False, slots=True)
class SensorData:
    """A measurement of any kind; each kind of sensor has its own class.

    Attributes:
        stamp: Simulation time of the measurement [microseconds].
    """

    type: ClassVar[SensorType] = SensorType.Invalid
    """The kind of data."""

    stamp: int = 0

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise RavemjError("SensorData stands for all kinds of data: make a CameraSensorData, for instance")


@dataclass(eq=False, slots=True)
class CameraSensorData(SensorData):
    """A camera's picture.

    Attributes:
        transform: ``T_world_camera`` when it was taken, shape (4, 4); z forward, y down.
        imagedata: Shape (height, width, 3), uint8, top row first.
        intrinsics: The camera matrix, wrapped.
    """

    type: ClassVar[SensorType] = SensorType.Camera

    transform: Floats = field(default_factory=_nothing)
    imagedata: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 0, 3), dtype=np.uint8))
    intrinsics: CameraIntrinsics = field(default_factory=CameraIntrinsics)

    @property
    def KK(self) -> Floats:
        """The camera matrix [pixels], shape (3, 3)."""
        return np.asarray(self.intrinsics.K, dtype=float)


@dataclass(eq=False, slots=True)
class LaserSensorData(SensorData):
    """A scan, in the world.

    Attributes:
        positions: Where the rays begin [m], shape (1, 3): one row for all.
        ranges: From there to what each ray meets [m], shape (n, 3), in the order of the angles, for a flash lidar
            column after column; of a ray that meets nothing its direction times the greatest range.
        intensity: 1 for each ray that meets something, else 0, shape (n,).
    """

    type: ClassVar[SensorType] = SensorType.Laser

    positions: Floats = field(default_factory=_nothing)
    ranges: Floats = field(default_factory=_nothing)
    intensity: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class JointEncoderSensorData(SensorData):
    """Values of a robot's joints.

    Attributes:
        encoderValues: Values of all DOFs [rad or m], rounded to the steps, shape (dof,).
        encoderVelocity: Velocities [rad/s or m/s], shape (dof,).
        resolution: Steps of the encoders [rad or m], shape (dof,); 0: exact.
    """

    type: ClassVar[SensorType] = SensorType.JointEncoder

    encoderValues: Floats = field(default_factory=_nothing)
    encoderVelocity: Floats = field(default_factory=_nothing)
    resolution: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class Force6DSensorData(SensorData):
    """The force and torque with which its parent holds the sensor's link and all that hangs on it, in sensor's axes.

    Attributes:
        force: Force on the link [N], shape (3,): against gravity at rest. With a polarity of -1 the load itself.
        torque: Torque about the sensor's origin [N m], shape (3,).
    """

    type: ClassVar[SensorType] = SensorType.Force6D

    force: Floats = field(default_factory=_nothing)
    torque: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class IMUSensorData(SensorData):
    """A measurement of motion, velocity and acceleration in the sensor's axes.

    Attributes:
        rotation: Orientation in the world as a quaternion [w, x, y, z], shape (4,).
        angular_velocity: Angular velocity [rad/s], shape (3,).
        linear_acceleration: What an accelerometer shows [m/s^2], shape (3,): the acceleration minus that of free
            fall, so at rest the opposite of gravity.
        rotation_covariance: Covariance of the orientation, shape (3, 3).
        angular_velocity_covariance: Covariance of the angular velocity, shape (3, 3).
        linear_acceleration_covariance: Covariance of the acceleration, shape (3, 3).
    """

    type: ClassVar[SensorType] = SensorType.IMU

    rotation: Floats = field(default_factory=_nothing)
    angular_velocity: Floats = field(default_factory=_nothing)
    linear_acceleration: Floats = field(default_factory=_nothing)
    rotation_covariance: Floats = field(default_factory=_nothing)
    angular_velocity_covariance: Floats = field(default_factory=_nothing)
    linear_acceleration_covariance: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class OdometrySensorData(SensorData):
    """A pose and a velocity, in the world.

    Attributes:
        pose: ``T_world_sensor``, or the pose of the body that is followed, shape (4, 4).
        linear_velocity: Velocity of its origin [m/s], shape (3,).
        angular_velocity: Angular velocity [rad/s], shape (3,).
        pose_covariance: Covariance of the pose, shape (6, 6).
        velocity_covariance: Covariance of the velocities, shape (6, 6).
        targetid: Name of the body that is followed; empty: the sensor itself.
    """

    type: ClassVar[SensorType] = SensorType.Odometry

    pose: Floats = field(default_factory=_nothing)
    linear_velocity: Floats = field(default_factory=_nothing)
    angular_velocity: Floats = field(default_factory=_nothing)
    pose_covariance: Floats = field(default_factory=_nothing)
    velocity_covariance: Floats = field(default_factory=_nothing)
    targetid: str = ""


@dataclass(eq=False, slots=True)
class TactileSensorData(SensorData):
    """Forces on a skin, in the sensor's frame.

    Attributes:
        positions: Where the link is touched [m], shape (n, 3).
        forces: Forces on it there [N], shape (n, 3).
        force_covariance: Covariance of a force, shape (3, 3).
        thickness: Thickness of the skin [m].
    """

    type: ClassVar[SensorType] = SensorType.Tactile

    positions: Floats = field(default_factory=_nothing)
    forces: Floats = field(default_factory=_nothing)
    force_covariance: Floats = field(default_factory=_nothing)
    thickness: float = 0.0


class _ActuatorState(IntEnum):
    """What an actuator does."""

    Undefined = 0
    Idle = 1
    Moving = 2
    Stalled = 3
    Braked = 4


@dataclass(eq=False, slots=True)
class ActuatorSensorData(SensorData):
    """The state of an actuator.

    Attributes:
        state: What it does.
        measuredcurrent: Current [A].
        measuredtemperature: Temperature [degrees Celsius].
        appliedcurrent: Current that is asked for [A].
        maxtorque: Torque limit [N m].
        maxcurrent: Current limit [A].
        nominalcurrent: Current for long [A].
        maxvelocity: Velocity limit [rad/s].
        maxacceleration: Acceleration limit [rad/s^2].
        maxjerk: Jerk limit [rad/s^3].
        staticfriction: Torque to start [N m].
        viscousfriction: Torque per velocity [N m s/rad].
    """

    type: ClassVar[SensorType] = SensorType.Actuator
    ActuatorState: ClassVar = _ActuatorState
    Undefined: ClassVar = _ActuatorState.Undefined
    Idle: ClassVar = _ActuatorState.Idle
    Moving: ClassVar = _ActuatorState.Moving
    Stalled: ClassVar = _ActuatorState.Stalled
    Braked: ClassVar = _ActuatorState.Braked

    state: _ActuatorState = _ActuatorState.Undefined
    measuredcurrent: float = 0.0
    measuredtemperature: float = 0.0
    appliedcurrent: float = 0.0
    maxtorque: float = 0.0
    maxcurrent: float = 0.0
    nominalcurrent: float = 0.0
    maxvelocity: float = 0.0
    maxacceleration: float = 0.0
    maxjerk: float = 0.0
    staticfriction: float = 0.0
    viscousfriction: float = 0.0


DATA: dict[SensorType, type[SensorData]] = {
    kind.type: kind
    for kind in (
        CameraSensorData,
        LaserSensorData,
        JointEncoderSensorData,
        Force6DSensorData,
        IMUSensorData,
        OdometrySensorData,
        TactileSensorData,
        ActuatorSensorData,
    )
}
"""The class of each kind of data."""


def copied(data: SensorData) -> SensorData:
    """Return a measurement with arrays of its own."""
    values = {one.name: getattr(data, one.name) for one in fields(data)}
    return replace(data, **{name: value.copy() for name, value in values.items() if isinstance(value, np.ndarray)})
