"""The data of sensors: what the engine and renderers measure at a place, in OpenRAVE's classes."""

import copy
import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ErrorCode, RavemjError
from ravemj.graphics.rendering import Camera, Look, Pinhole
from ravemj.graphics.simulation_renderer import Format
from ravemj.model import scene
from ravemj.rave.infos.sensor_devices import intrinsics_of
from ravemj.rave.sensor_data import (
    CameraSensorData,
    Force6DSensorData,
    IMUSensorData,
    JointEncoderSensorData,
    LaserSensorData,
    OdometrySensorData,
    SensorData,
    TactileSensorData,
)

if TYPE_CHECKING:
    from ravemj.engine.collision.world import CollisionWorld
    from ravemj.engine.physics import Physics
    from ravemj.engine.sensing import Scan
    from ravemj.rave.environment import Environment


class Place(NamedTuple):
    """Where a sensor is: ``T_world_sensor``, and the body and index of the link that carry it; None without a robot."""

    T_world_sensor: Floats
    carrier: tuple[BodyState, int] | None

    @property
    def link(self) -> tuple[BodyState, int]:
        """Body and link that carry the sensor; what measures them is on one."""
        assert self.carrier is not None
        return self.carrier


class Instrument:
    """Measures in one environment what one device can, and remembers what that takes. Callers hold the lock.

    Attributes:
        spin_angle: How far the plane of a laser has turned [rad].
        scanned: What a laser measured last, and the world that it met; None before.
    """

    def __init__(self, env: "Environment") -> None:
        self._env = env
        self._deviation, self._random = 0.0, np.random.default_rng()
        self.restart()

    def restart(self) -> None:
        """Forget the past."""
        self.spin_angle = 0.0
        self.scanned: tuple[Scan, CollisionWorld] | None = None
        self._velocity: Floats | None = None
        self._acceleration = np.zeros(3)

    def take_over(self, other: "Instrument") -> None:
        """Go on like another instrument of the same device: with its noise, its turn and its velocity."""
        self._deviation, self._random = other._deviation, copy.deepcopy(other._random)
        self.spin_angle = other.spin_angle
        self._velocity, self._acceleration = other._velocity, other._acceleration

    def set_noise(self, deviation: float, seed: int | None) -> None:
        """Add normally distributed noise to what is measured from now on."""
        self._deviation, self._random = deviation, np.random.default_rng(seed)

    def _noisy(self, numbers: Floats) -> Floats:
        return numbers + self._random.normal(0.0, self._deviation, numbers.shape) if self._deviation else numbers

    def advance(self, device: scene.Device, place: Place, timestep: float) -> None:
        """Let time pass [s]: lasers spin, and changes of velocity are accelerations."""
        if isinstance(device, scene.Laser) and device.spins:
            self.spin_angle = math.remainder(self.spin_angle + device.spin_speed * timestep, math.tau)
        elif isinstance(device, scene.Imu) and timestep > 0:
            from ravemj.engine.sensing import motion_at  # noqa: PLC0415 - slow to import

            velocity, _ = motion_at(*place.link, place.T_world_sensor[:3, 3])
            if self._velocity is not None:
                self._acceleration = (velocity - self._velocity) / timestep
            self._velocity = velocity

    def rays_pose(self, device: scene.Device, place: Place) -> Floats:
        """Return the pose in the world of what a device looks with, shape (4, 4): lasers spin."""
        if not (isinstance(device, scene.Laser) and device.spins):
            return place.T_world_sensor
        from ravemj.engine.sensing import spun  # noqa: PLC0415 - slow to import

        return spun(device, place.T_world_sensor, self.spin_angle)

    def measured(self, device: scene.Device, place: Place, stamp: int) -> SensorData:
        """Return what a device without a problem measures at a place and time [microseconds].

        Raises:
            RavemjError: it measures forces, and the environment has no physics; or it follows a body that is not there.
        """
        return _MEASURES[type(device)](self, device, place, stamp)

    def picture(self, device: scene.Intrinsics, place: Place, stamp: int) -> CameraSensorData:
        """Return a camera's picture."""
        env, (camera, form) = self._env, _camera(device, place)
        picture = env.renderer.render(camera, Look.of_sensor(env.own_background), form, drawings=False)
        if self._deviation:
            picture = np.clip(np.rint(self._noisy(picture.astype(float))), 0, 255).astype(np.uint8)
        return CameraSensorData(stamp, place.T_world_sensor, picture, intrinsics_of(device))

    def depth_image(self, device: scene.Intrinsics, place: Place) -> NDArray[np.float32]:
        """Return how far away is what a camera sees [m], shape (height, width); infinite where nothing is."""
        return self._env.renderer.depth(*_camera(device, place))

    def segmentation_image(self, device: scene.Intrinsics, place: Place) -> Ints:
        """Return body and link that each pixel shows, shape (height, width, 2); 0 and -1 where nothing is."""
        geoms = self._env.renderer.segment(*_camera(device, place))
        return self._env.simulation.collisions().labels(geoms)

    def scan(self, device: scene.Laser | scene.FlashLidar, place: Place, stamp: int) -> LaserSensorData:
        """Return a laser's scan."""
        from ravemj.engine.sensing import scan  # noqa: PLC0415 - slow to import

        world = self._env.simulation.collisions()
        found = scan(world, device, self.rays_pose(device, place))
        if self._deviation:
            found = found._replace(distances=np.where(found.is_hit, self._noisy(found.distances), found.distances))
        self.scanned = found, world
        ranges = found.distances[:, None] * found.directions
        return LaserSensorData(stamp, found.origin[None], ranges, found.is_hit.astype(np.float64))

    def force(self, device: scene.ForceTorque, place: Place, stamp: int) -> Force6DSensorData:
        """Return the force and torque on a link."""
        from ravemj.engine.sensing import corrected, wrench  # noqa: PLC0415 - slow to import

        felt = wrench(self._needed_physics(), *place.link, place.T_world_sensor)
        force, torque = corrected(device, *felt)
        return Force6DSensorData(stamp, self._noisy(force), self._noisy(torque))

    def touch(self, device: scene.Tactile, place: Place, stamp: int) -> TactileSensorData:
        """Return where a link is touched."""
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
        """Return the physics of the bodies as they are now; None where there is none."""
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
