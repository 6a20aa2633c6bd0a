"""Measurements of sensors: a data class for each kind of sensor, and the device that measures."""

import copy
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.enumerations import NamedInt
from ravemj.core.transforms import Floats, Ints, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ErrorCode, RavemjError
from ravemj.graphics.rendering import Camera, Look, Pinhole
from ravemj.graphics.simulation_renderer import Format
from ravemj.model import scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.sensor import CameraIntrinsics, intrinsics_of

if TYPE_CHECKING:
    from ravemj.engine.collision.world import CollisionWorld
    from ravemj.engine.physics import Physics
    from ravemj.engine.sensing import Scan
    from ravemj.rave.environment import Environment


def _nothing() -> Floats:
    return np.zeros(0)


@dataclass(eq=False, slots=True)
class SensorData:
    """Base class of measurements; each kind of sensor has a subclass.

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
    """Image of a camera.

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
    """Scan of a laser, in the world frame.

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
    """Joint values and velocities of a robot.

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
    """Force and torque that the parent link exerts on the sensor's link, in sensor axes.

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
    """Orientation in the world; angular velocity and acceleration in sensor axes.

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
    """Pose and velocity in the world frame.

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


class _ActuatorState(NamedInt):
    Undefined = 0
    Idle = 1
    Moving = 2
    Stalled = 3
    Braked = 4


@dataclass(eq=False, slots=True)
class ActuatorSensorData(SensorData):
    """State of an actuator.

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
"""Data class of each sensor type."""


def copied(data: SensorData) -> SensorData:
    """Return a copy of a measurement that shares no arrays with it."""
    values = {field_.name: getattr(data, field_.name) for field_ in fields(data)}
    return replace(data, **{name: value.copy() for name, value in values.items() if isinstance(value, np.ndarray)})


class Place(NamedTuple):
    """Sensor mount: ``T_world_sensor``, and the body and link index that carry it; None without a robot."""

    T_world_sensor: Floats
    carrier: tuple[BodyState, int] | None

    @property
    def link(self) -> tuple[BodyState, int]:
        """The body and link index of the mount; an error if the sensor is not on a link."""
        assert self.carrier is not None
        return self.carrier


class Instrument:
    """Measuring device of one sensor in one environment, with its internal state. Callers hold the lock.

    Attributes:
        spin_angle: Rotation angle of the scan plane [rad].
        scanned: The last scan, and the world in which it was made; None at first.
    """

    def __init__(self, env: "Environment") -> None:
        self._env = env
        self._deviation, self._random = 0.0, np.random.default_rng()
        self.restart()

    def restart(self) -> None:
        """Reset the internal state."""
        self.spin_angle = 0.0
        self.scanned: tuple[Scan, CollisionWorld] | None = None
        self._velocity: Floats | None = None
        self._acceleration = np.zeros(3)

    def take_over(self, other: "Instrument") -> None:
        """Copy the state of another instrument of the same device: noise, spin angle and velocity."""
        self._deviation, self._random = other._deviation, copy.deepcopy(other._random)
        self.spin_angle = other.spin_angle
        self._velocity, self._acceleration = other._velocity, other._acceleration

    def set_noise(self, deviation: float, seed: int | None) -> None:
        """Add Gaussian noise of a standard deviation, in the measured unit, to all further measurements."""
        self._deviation, self._random = deviation, np.random.default_rng(seed)

    def _noisy(self, numbers: Floats) -> Floats:
        return numbers + self._random.normal(0.0, self._deviation, numbers.shape) if self._deviation else numbers

    def advance(self, device: scene.Device, place: Place, timestep: float) -> None:
        """Advance by a time step [s]: spin lasers, and update accelerations from velocity differences."""
        if isinstance(device, scene.Laser) and device.spins:
            self.spin_angle = math.remainder(self.spin_angle + device.spin_speed * timestep, math.tau)
        elif isinstance(device, scene.Imu) and timestep > 0:
            from ravemj.engine.sensing import motion_at  # noqa: PLC0415 - slow to import

            velocity, _ = motion_at(*place.link, place.T_world_sensor[:3, 3])
            if self._velocity is not None:
                self._acceleration = (velocity - self._velocity) / timestep
            self._velocity = velocity

    def rays_pose(self, device: scene.Device, place: Place) -> Floats:
        """Return the world pose of the ray frame, shape (4, 4), including the spin of a laser."""
        if not (isinstance(device, scene.Laser) and device.spins):
            return place.T_world_sensor
        from ravemj.engine.sensing import spun  # noqa: PLC0415 - slow to import

        return spun(device, place.T_world_sensor, self.spin_angle)

    def measured(self, device: scene.Device, place: Place, stamp: int) -> SensorData:
        """Return the measurement of a valid device at a mount and time [microseconds].

        Raises:
            RavemjError: the sensor measures forces, and the environment has no physics; or its target body does not
                exist.
        """
        return _MEASURES[type(device)](self, device, place, stamp)

    def picture(self, device: scene.Intrinsics, place: Place, stamp: int) -> CameraSensorData:
        """Return the image of a camera."""
        env, (camera, form) = self._env, _camera(device, place)
        picture = env.renderer.render(camera, Look.of_sensor(env.own_background), form, drawings=False)
        if self._deviation:
            picture = np.clip(np.rint(self._noisy(picture.astype(float))), 0, 255).astype(np.uint8)
        return CameraSensorData(stamp, place.T_world_sensor, picture, intrinsics_of(device))

    def depth_image(self, device: scene.Intrinsics, place: Place) -> NDArray[np.float32]:
        """Return the depths that a camera sees [m], shape (height, width); infinite in the background."""
        return self._env.renderer.depth(*_camera(device, place))

    def segmentation_image(self, device: scene.Intrinsics, place: Place) -> Ints:
        """Return the body and link at each pixel, shape (height, width, 2); 0 and -1 in the background."""
        geoms = self._env.renderer.segment(*_camera(device, place))
        return self._env.simulation.collisions().labels(geoms)

    def scan(self, device: scene.Laser | scene.FlashLidar, place: Place, stamp: int) -> LaserSensorData:
        """Return the scan of a laser."""
        from ravemj.engine.sensing import scan  # noqa: PLC0415 - slow to import

        world = self._env.simulation.collisions()
        measured = scan(world, device, self.rays_pose(device, place))
        if self._deviation:
            measured = measured._replace(
                distances=np.where(measured.is_hit, self._noisy(measured.distances), measured.distances)
            )
        self.scanned = measured, world
        ranges = measured.distances[:, None] * measured.directions
        return LaserSensorData(stamp, measured.origin[None], ranges, measured.is_hit.astype(np.float64))

    def force(self, device: scene.ForceTorque, place: Place, stamp: int) -> Force6DSensorData:
        """Return the force and torque on a link."""
        from ravemj.engine.sensing import corrected, wrench  # noqa: PLC0415 - slow to import

        felt = wrench(self._needed_physics(), *place.link, place.T_world_sensor)
        force, torque = corrected(device, *felt)
        return Force6DSensorData(stamp, self._noisy(force), self._noisy(torque))

    def touch(self, device: scene.Tactile, place: Place, stamp: int) -> TactileSensorData:
        """Return the contacts on a link."""
        from ravemj.engine.sensing import touches  # noqa: PLC0415 - slow to import

        positions, forces = touches(self._needed_physics(), *place.link, place.T_world_sensor)
        return TactileSensorData(stamp, positions, self._noisy(forces), np.zeros((3, 3)), device.thickness)

    def inertial(self, device: scene.Imu, place: Place, stamp: int) -> IMUSensorData:
        """Return orientation, angular velocity and acceleration."""
        from ravemj.engine.sensing import acceleration_at, motion_at  # noqa: PLC0415 - slow to import

        axes, origin = place.T_world_sensor[:3, :3], place.T_world_sensor[:3, 3]
        physics = self._physics()
        if physics is None:
            acceleration = self._acceleration - self._env.simulation.gravity
        else:
            acceleration = acceleration_at(physics, *place.link, origin)
        return IMUSensorData(
            stamp,
            pose_of(place.T_world_sensor).numbers()[:4],
            self._noisy(motion_at(*place.link, origin)[1] @ axes),
            self._noisy(acceleration @ axes),
            np.reshape(device.rotation_covariance, (3, 3)),
            np.reshape(device.angular_velocity_covariance, (3, 3)),
            np.reshape(device.linear_acceleration_covariance, (3, 3)),
        )

    def odometry(self, device: scene.Odometry, place: Place, stamp: int) -> OdometrySensorData:
        """Return pose and velocities."""
        from ravemj.engine.sensing import motion_at  # noqa: PLC0415 - slow to import

        (state, link), pose = place.link, place.T_world_sensor
        if device.target:
            followed = self._env.simulation.body(device.target)
            if followed is None:
                raise RavemjError(f"odometry: there is no body '{device.target}' in the environment")
            state, link, pose = followed, 0, followed.link_transform(0)
        linear, angular = motion_at(state, link, pose[:3, 3])
        pose = pose.copy()
        pose[:3, 3] = self._noisy(pose[:3, 3])
        covariances = np.zeros((6, 6)), np.zeros((6, 6))
        return OdometrySensorData(stamp, pose, linear, angular, *covariances, device.target)

    def encoders(self, device: scene.JointEncoder, place: Place, stamp: int) -> JointEncoderSensorData:
        """Return the values of joints."""
        from ravemj.engine.sensing import encoder_values  # noqa: PLC0415 - slow to import

        state, _ = place.link
        if len(device.resolution) not in {0, 1, state.dof}:
            steps = f"{len(device.resolution)} steps, and the robot has {state.dof} DOFs"
            raise RavemjError(f"joint encoder: its resolution has {steps}; give one for each, or one for all")
        values, velocities, steps = encoder_values(state, device.resolution)
        return JointEncoderSensorData(stamp, self._noisy(values), velocities, steps)

    def _physics(self) -> "Physics | None":
        """Return the simulated dynamics of the present bodies; None if the physics engine does not simulate them."""
        physics = self._env.GetPhysicsEngine().dynamics
        if physics is not None:
            physics.prepare()
        return physics

    def _needed_physics(self) -> "Physics":
        physics = self._physics()
        if physics is None:
            message = "forces are measured while physics is simulated: env.SetPhysicsEngine('mujoco')"
            raise RavemjError(message, ErrorCode.InvalidState)
        return physics


def _camera(device: scene.Intrinsics, place: Place) -> tuple[Camera, Format]:
    pinhole = Pinhole(device.fx, device.fy, device.cx, device.cy)
    return Camera(place.T_world_sensor, calibration=pinhole), Format(device.width, device.height, shadows=False)


_MEASURES: Mapping[type, Callable[[Instrument, Any, Place, int], SensorData]] = MappingProxyType(
    {
        scene.Intrinsics: Instrument.picture,
        scene.Laser: Instrument.scan,
        scene.FlashLidar: Instrument.scan,
        scene.ForceTorque: Instrument.force,
        scene.Imu: Instrument.inertial,
        scene.Odometry: Instrument.odometry,
        scene.JointEncoder: Instrument.encoders,
        scene.Tactile: Instrument.touch,
    }
)
