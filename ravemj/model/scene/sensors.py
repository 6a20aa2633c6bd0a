"""Sensors: constant properties of each type, and their validation."""

# ruff: noqa: D102 - ``problem`` always returns the reason why a sensor cannot measure, or None

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

from ravemj.core.transforms import ZERO, Vec3
from ravemj.model.scene.record import Record

MOST_RAYS = 1_000_000
"""Maximum number of rays per measurement; a larger number indicates a wrong unit."""

_WIDEST = 16_384
"""Maximum number of pixels along a side of an image; OpenGL's limit."""

SENSOR_COLOR: Vec3 = (0.5, 0.5, 1.0)
"""Default colour of a sensor in viewers."""

NO_COVARIANCE = (0.0,) * 9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Intrinsics(Record):
    """Pinhole camera: u = fx x / z + cx, v = fy y / z + cy [pixels], z forward and y down."""

    fx: float = 0.0
    fy: float = 0.0
    cx: float = 0.0
    cy: float = 0.0
    width: int = 0
    height: int = 0

    def problem(self) -> str | None:
        return _nonsense_pinhole(self) or (
            None
            if max(self.width, self.height) <= _WIDEST
            else f"the picture is {self.width} x {self.height} pixels, and can have {_WIDEST} along a side"
        )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Laser(Record):
    """Laser that scans the xy plane of its frame, with angles from x towards y.

    Attributes:
        min_angle: First angle of a scan [rad].
        max_angle: Maximum angle of a scan [rad].
        resolution: Angle between rays [rad].
        min_range: Start distance of a ray [m].
        max_range: End distance of a ray [m].
        scan_time: Time between scans [s].
        time_increment: Time between the rays of a real scanner [s]; here all rays of a scan have the same time.
        spins: Whether the scan plane rotates.
        spin_axis: Rotation axis, of any length.
        spin_position: A point on the rotation axis [m].
        spin_speed: Rotation speed [rad/s].
    """

    min_angle: float = -math.pi / 2
    max_angle: float = math.pi / 2
    resolution: float = 0.01
    min_range: float = 0.03
    max_range: float = 100.0
    scan_time: float = 0.0
    time_increment: float = 0.0
    spins: bool = False
    spin_axis: Vec3 = (1.0, 0.0, 0.0)
    spin_position: Vec3 = ZERO
    spin_speed: float = 0.0

    def problem(self) -> str | None:
        angles = self.min_angle, self.max_angle, self.resolution
        if not _are_finite(angles):
            return f"its angles are {angles}, and should be finite"
        spin = *self.spin_axis, *self.spin_position, self.spin_speed
        if not _are_finite(spin) or not any(self.spin_axis):
            return f"its spin is {spin}, and should be an axis that is not 0 0 0, a point and a speed"
        if self.resolution <= 0 or self.max_angle < self.min_angle:
            return (
                f"it has no rays from {self.min_angle:g} to {self.max_angle:g} rad in steps of {self.resolution:g}; "
                "give a resolution above 0, and max_angle not below min_angle"
            )
        return (
            _too_many((self.max_angle - self.min_angle) / self.resolution + 1)
            or _nonsense_range(self.min_range, self.max_range)
            or _nonsense_time(self.scan_time)
        )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FlashLidar(Record):
    """Camera that measures distances: a ray through each integer pixel (u, v), from 0.

    Attributes:
        fx: Focal length along the columns [pixels].
        fy: Focal length along the rows [pixels].
        cx: Column of the principal point [pixels].
        cy: Row of the principal point [pixels].
        width: Columns.
        height: Rows.
        min_range: Start distance of a ray [m].
        max_range: End distance of a ray [m].
        scan_time: Time between scans [s].
    """

    fx: float = 500.0
    fy: float = 500.0
    cx: float = 250.0
    cy: float = 250.0
    width: int = 64
    height: int = 64
    min_range: float = 0.0
    max_range: float = 100.0
    scan_time: float = 0.0

    def problem(self) -> str | None:
        return (
            _nonsense_pinhole(self)
            or _too_many(float(self.width) * self.height)
            or _nonsense_range(self.min_range, self.max_range)
            or _nonsense_time(self.scan_time)
        )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ForceTorque(Record):
    """Force-torque sensor.

    Attributes:
        polarity: Sign of the measurements: 1 or -1.
        correction: Matrix that multiplies force and torque, 6 x 6 by rows; empty for none.
    """

    polarity: int = 1
    correction: tuple[float, ...] = ()

    def problem(self) -> str | None:
        if self.polarity not in {1, -1}:
            return f"its polarity is {self.polarity}, and should be 1 or -1"
        if len(self.correction) not in {0, 36} or not _are_finite(self.correction):
            return f"its correction matrix has {len(self.correction)} numbers, and should have 36 finite ones"
        return None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Imu(Record):
    """Inertial measurement unit; covariances are 3 x 3 matrices by rows, which are not used but passed on.

    Attributes:
        scan_time: Time between measurements [s].
        rotation_covariance: Covariance of the orientation [rad^2].
        angular_velocity_covariance: Covariance of the angular velocity [rad^2/s^2].
        linear_acceleration_covariance: Covariance of the acceleration [m^2/s^4].
    """

    scan_time: float = 0.0
    rotation_covariance: tuple[float, ...] = NO_COVARIANCE
    angular_velocity_covariance: tuple[float, ...] = NO_COVARIANCE
    linear_acceleration_covariance: tuple[float, ...] = NO_COVARIANCE

    def problem(self) -> str | None:
        return _nonsense_time(self.scan_time)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Odometry(Record):
    """Odometry sensor.

    Attributes:
        scan_time: Time between measurements [s].
        target: Name of the tracked body; empty for the sensor itself.
    """

    scan_time: float = 0.0
    target: str = ""

    def problem(self) -> str | None:
        return _nonsense_time(self.scan_time)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class JointEncoder(Record):
    """Joint encoder: measures the values of a robot's joints.

    Attributes:
        resolution: Step of the encoders [rad or m]: one for each DOF, or one for all; 0 or empty means exact.
    """

    resolution: tuple[float, ...] = ()

    def problem(self) -> str | None:
        if not _are_finite(self.resolution) or min(self.resolution, default=0.0) < 0:
            return f"its resolution is {self.resolution}, and should be numbers from 0"
        return None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Tactile(Record):
    """Tactile skin on a link.

    Attributes:
        thickness: Its thickness [m].
    """

    thickness: float = 0.0

    def problem(self) -> str | None:
        is_sane = math.isfinite(self.thickness) and self.thickness >= 0
        return None if is_sane else f"its thickness is {self.thickness}, and should be a length from 0"


Device = Intrinsics | Laser | FlashLidar | ForceTorque | Imu | Odometry | JointEncoder | Tactile


class SensorKind(NamedTuple):
    """Type of sensor.

    Attributes:
        name: OpenRAVE's name of the type in XML.
        device: The default properties.
    """

    name: str
    device: Device


_SPELLINGS: Mapping[str, str] = MappingProxyType(
    {"baselaser1d": "baselaser2d", "baseflashlaser": "baseflashlidar3d", "baseencoder": "basejointencoder"}
)
"""Sensor type names that only COLLADA uses, and their canonical names; lower case without underscores."""

SENSOR_KINDS: Mapping[str, SensorKind] = MappingProxyType(
    {
        name.lower(): SensorKind(name, device)
        for name, device in (
            ("BaseCamera", Intrinsics()),
            ("BaseLaser2D", Laser()),
            ("BaseSpinningLaser2D", Laser(spins=True)),
            ("BaseFlashLidar3D", FlashLidar()),
            ("BaseForce6D", ForceTorque()),
            ("BaseJointEncoder", JointEncoder()),
            ("BaseIMU", Imu()),
            ("BaseOdometry", Odometry()),
            ("BaseTactile", Tactile()),
        )
    }
)
"""Sensor types by lower-case name."""


def sensor_kind(name: str) -> SensorKind | None:
    """Return the sensor type of a name in OpenRAVE's or COLLADA's spelling and any letter case, or None."""
    plain = name.lower().replace("_", "").replace("pinhole", "")
    return SENSOR_KINDS.get(_SPELLINGS.get(plain, plain))


def needs_link(device: Device) -> bool:
    """Return whether a sensor measures quantities of its link, and so requires a robot."""
    return not isinstance(device, Intrinsics | Laser | FlashLidar)


def _are_finite(numbers: Iterable[float]) -> bool:
    return all(map(math.isfinite, numbers))


def _nonsense_pinhole(camera: Intrinsics | FlashLidar) -> str | None:
    numbers = camera.fx, camera.fy, camera.cx, camera.cy
    if not _are_finite(numbers) or min(camera.fx, camera.fy) <= 0:
        return f"its fx, fy, cx, cy are {numbers}, and should be finite, fx and fy above 0 [pixels]"
    if min(camera.width, camera.height) <= 0:
        return f"it is {camera.width} x {camera.height} pixels; give width and height"
    return None


def _too_many(count: float) -> str | None:
    return None if count <= MOST_RAYS else f"it has {count:,.0f} rays, and can have {MOST_RAYS:,}"


def _nonsense_range(least: float, greatest: float) -> str | None:
    is_sane = _are_finite((least, greatest)) and 0 <= least < greatest
    return None if is_sane else f"its range goes from {least:g} to {greatest:g} m, and should go up from 0 or more"


def _nonsense_time(seconds: float) -> str | None:
    is_sane = math.isfinite(seconds) and seconds >= 0
    return None if is_sane else f"the time between its measurements is {seconds} s, and should be 0 or more"
