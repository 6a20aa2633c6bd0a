"""Measurements of sensors: one class for each kind of sensor."""

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
    """The base class of measurements. Each kind of sensor has a class of its own.

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
        transform: ``T_world_camera`` at the time of the picture, shape (4, 4); z forward, y down.
        imagedata: The pixels, shape (height, width, 3), uint8, RGB, top row first.
        intrinsics: The intrinsics of the camera.
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
    """A scan of a laser, in the world frame.

    Attributes:
        positions: The origin of all rays [m], shape (1, 3).
        ranges: The vectors from the origin to the hits [m], shape (n, 3), in the order of the angles; those of a flash
            lidar column by column. A ray without a hit has its direction times the maximum range.
        intensity: 1 for each ray that hits something, else 0, shape (n,).
    """

    type: ClassVar[SensorType] = SensorType.Laser

    positions: Floats = field(default_factory=_nothing)
    ranges: Floats = field(default_factory=_nothing)
    intensity: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class JointEncoderSensorData(SensorData):
    """Values of a robot's joints.

    Attributes:
        encoderValues: Values of all DOFs [rad or m], rounded to the resolution, shape (dof,).
        encoderVelocity: Velocities [rad/s or m/s], shape (dof,).
        resolution: The steps of the encoders [rad or m], shape (dof,); 0 for exact values.
    """

    type: ClassVar[SensorType] = SensorType.JointEncoder

    encoderValues: Floats = field(default_factory=_nothing)
    encoderVelocity: Floats = field(default_factory=_nothing)
    resolution: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class Force6DSensorData(SensorData):
    """The force and torque that the parent link exerts on the sensor's link, in sensor axes.

    Attributes:
        force: The force on the link [N], shape (3,). At rest it carries the weight of the link and of its children, so
            it points upwards. A polarity of -1 reverses it.
        torque: Torque about the sensor's origin [N m], shape (3,).
    """

    type: ClassVar[SensorType] = SensorType.Force6D

    force: Floats = field(default_factory=_nothing)
    torque: Floats = field(default_factory=_nothing)


@dataclass(eq=False, slots=True)
class IMUSensorData(SensorData):
    """Orientation, angular velocity and acceleration; the latter two in sensor axes.

    Attributes:
        rotation: Orientation in the world as a quaternion [w, x, y, z], shape (4,).
        angular_velocity: Angular velocity [rad/s], shape (3,).
        linear_acceleration: The proper acceleration [m/s^2], shape (3,): the acceleration minus gravity, so at rest it
            points upwards.
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
    """A pose and a velocity, in the world frame.

    Attributes:
        pose: ``T_world_sensor``, or ``T_world_body`` of the target, shape (4, 4).
        linear_velocity: Velocity of the frame's origin [m/s], shape (3,).
        angular_velocity: Angular velocity [rad/s], shape (3,).
        pose_covariance: Covariance of the pose, shape (6, 6).
        velocity_covariance: Covariance of the velocities, shape (6, 6).
        targetid: The name of the target body; empty for the sensor itself.
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
    """Contact forces on a tactile skin, in the sensor frame.

    Attributes:
        positions: The contact points on the link [m], shape (n, 3).
        forces: The forces on the link at these points [N], shape (n, 3).
        force_covariance: Covariance of a force, shape (3, 3).
        thickness: Thickness of the skin [m].
    """

    type: ClassVar[SensorType] = SensorType.Tactile

    positions: Floats = field(default_factory=_nothing)
    forces: Floats = field(default_factory=_nothing)
    force_covariance: Floats = field(default_factory=_nothing)
    thickness: float = 0.0


class _ActuatorState(IntEnum):
    """The state of motion of an actuator."""

    Undefined = 0
    Idle = 1
    Moving = 2
    Stalled = 3
    Braked = 4


@dataclass(eq=False, slots=True)
class ActuatorSensorData(SensorData):
    """The state of an actuator.

    Attributes:
        state: The state of motion.
        measuredcurrent: Measured current [A].
        measuredtemperature: Temperature [degrees Celsius].
        appliedcurrent: Commanded current [A].
        maxtorque: Torque limit [N m].
        maxcurrent: Current limit [A].
        nominalcurrent: Continuous current [A].
        maxvelocity: Velocity limit [rad/s].
        maxacceleration: Acceleration limit [rad/s^2].
        maxjerk: Jerk limit [rad/s^3].
        staticfriction: Static friction [N m].
        viscousfriction: Viscous friction [N m s/rad].
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
    """Return a copy of a measurement that shares no arrays with it."""
    values = {one.name: getattr(data, one.name) for one in fields(data)}
    return replace(data, **{name: value.copy() for name, value in values.items() if isinstance(value, np.ndarray)})
