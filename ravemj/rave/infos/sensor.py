"""Descriptions of sensors: resolution, range, calibration."""

# Users may put any value into fields.
# pyright: reportUnknownArgumentType=false, reportUnknownLambdaType=false
# The tables of infos are their private state, and users may put any value into their fields.
# pyright: reportPrivateUsage=false

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Floats, Vec3
from ravemj.errors import ArgumentError, RavemjError
from ravemj.model import scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.base import TEXT, Entry, Form, Info, Json, info, info_class, json_field, vector

PINHOLE = {"fx": (0, 0), "fy": (1, 1), "cx": (0, 2), "cy": (1, 2)}
"""Row and column of each element of a camera matrix, by name."""


def _number_of_matrix(place: tuple[int, int]) -> Form:
    """Return the JSON conversion of one element of a matrix."""

    def read(value: float, scale: float, present: Any) -> Floats:  # noqa: ANN401 - what users put into the field
        del scale
        matrix = np.array(present, dtype=float)
        matrix[place] = value
        return matrix

    return Form(lambda matrix, scale: float(np.asarray(matrix, dtype=float)[place]), read)


@info_class
class CameraIntrinsics(Info):
    """Intrinsics of a camera: its matrix and lens distortion. Rendered pictures are not distorted.

    Attributes:
        K: The camera matrix [pixels], shape (3, 3).
        distortion_model: The name of the distortion model; empty for none.
        distortion_coeffs: The coefficients of the distortion model.
        focal_length: The focal length of the lens [m].
    """

    _called = "Sensor.CameraIntrinsics"

    K: ArrayLike = json_field("", default=np.eye(3))
    distortion_model: str = json_field("distortionModel", TEXT, default="")
    distortion_coeffs: Sequence[float] = ()
    focal_length: float = 0.01

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        return (*(Entry(key, "K", _number_of_matrix(place)) for key, place in PINHOLE.items()), *super()._json(obj))


@info_class
class SensorGeometry(Info):
    """Base class of the constant properties of sensors; each kind of sensor has a subclass.

    Attributes:
        hardware_id: The manufacturer's identifier.
    """

    _type = SensorType.Invalid

    hardware_id: str = ""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise RavemjError("SensorGeometry stands for all kinds of geometry: make a CameraGeomData, for instance")

    def GetType(self) -> SensorType:
        """Return the kind of sensor."""
        return self._type


@info_class
class CameraGeomData(SensorGeometry):
    """Image size and intrinsics of a camera.

    Attributes:
        intrinsics: The camera matrix and the lens.
        width: The width of the image [pixels].
        height: The height of the image [pixels].
        measurement_time: The exposure time [s].
        gain: The gain.
        target_region: The name of the region that the camera observes.
    """

    _type = SensorType.Camera

    intrinsics: CameraIntrinsics = json_field("intrinsics", info(CameraIntrinsics), default=CameraIntrinsics())
    width: int = 0
    height: int = 0
    measurement_time: float = 1.0
    gain: float = 1.0
    target_region: str = json_field("targetRegion", TEXT, default="")

    @property
    def KK(self) -> Floats:
        """The camera matrix [pixels], shape (3, 3)."""
        return np.asarray(self.intrinsics.K, dtype=float)

    @KK.setter
    def KK(self, matrix: ArrayLike) -> None:
        self.intrinsics.K = np.array(matrix, dtype=float)  # pyright: ignore[reportConstantRedefinition] - as above


@info_class
class LaserGeomData(SensorGeometry):
    """Field of view and range of a laser scanner.

    Attributes:
        min_angle: The first angle of a scan [rad], and optionally one about a second axis, which is not used.
        max_angle: The last angle of a scan [rad], likewise.
        min_range: The minimum measured distance [m].
        max_range: The maximum measured distance [m].
        resolution: The step of the angles [rad], optionally with one about the second axis, which is not used.
        time_increment: Time between two measurements [s].
        time_scan: Time between two scans [s].
    """

    _type = SensorType.Laser

    min_angle: Sequence[float] = (0.0, 0.0)
    max_angle: Sequence[float] = (0.0, 0.0)
    resolution: Sequence[float] = (0.0, 0.0)
    min_range: float = 0.0
    max_range: float = 0.0
    time_increment: float = 0.0
    time_scan: float = 0.0


@info_class
class SpinningLaserGeomData(LaserGeomData):
    """Laser scanner whose scan plane rotates about a second axis, ``BaseSpinningLaser2D``.

    OpenRAVE reads its properties from XML only, and has no class for them.

    Attributes:
        spin_axis: The direction of the axis, in the sensor frame.
        spin_position: A point on the axis, in the sensor frame [m].
        spin_speed: The angular velocity of the plane [rad/s].
    """

    spin_axis: Sequence[float] = (1.0, 0.0, 0.0)
    spin_position: Sequence[float] = (0.0, 0.0, 0.0)
    spin_speed: float = 0.0


@info_class
class FlashLidarGeomData(LaserGeomData):
    """Camera that measures distances, ``BaseFlashLidar3D``. The angles of laser scanners do not apply.

    OpenRAVE reads its properties from XML only, and has no class for them.

    Attributes:
        intrinsics: The camera matrix, in units of rays.
        width: The number of columns of rays.
        height: The number of rows of rays.
    """

    intrinsics: CameraIntrinsics = json_field("intrinsics", info(CameraIntrinsics), default=CameraIntrinsics())
    width: int = 0
    height: int = 0


@info_class
class JointEncoderGeomData(SensorGeometry):
    """Resolution of the encoders of a joint.

    Attributes:
        resolution: The step of each DOF of the joint [rad or m].
    """

    _type = SensorType.JointEncoder

    resolution: Sequence[float] = ()


@info_class
class Force6DGeomData(SensorGeometry):
    """Calibration of a force-torque sensor.

    Attributes:
        polarity: The sign of the measurements, 1 or -1.
        correction_matrix: The 6x6 matrix that multiplies a measurement, 36 numbers row by row.
    """

    _type = SensorType.Force6D

    polarity: int = 1
    correction_matrix: Sequence[float] = ()


@info_class
class IMUGeomData(SensorGeometry):
    """Timing of an inertial measurement unit.

    Attributes:
        time_measurement: Time between two measurements [s].
    """

    _type = SensorType.IMU

    time_measurement: float = 0.0


@info_class
class OdometryGeomData(SensorGeometry):
    """Body whose motion an odometry sensor measures.

    Attributes:
        targetid: The name of the body.
    """

    _type = SensorType.Odometry

    targetid: str = json_field("targetId", default="")


@info_class
class TactileGeomData(SensorGeometry):
    """Geometry of a tactile sensor.

    Attributes:
        thickness: The thickness of the skin [m].
    """

    _type = SensorType.Tactile

    thickness: float = 0.0


@info_class
class ActuatorGeomData(SensorGeometry):
    """Limits of an actuator.

    Attributes:
        maxtorque: The maximum torque [N m].
        maxcurrent: The maximum current [A].
        nominalcurrent: The continuous current [A].
        maxvelocity: The maximum velocity [rad/s].
        maxacceleration: The maximum acceleration [rad/s^2].
        maxjerk: The maximum jerk [rad/s^3].
        staticfriction: The static friction [N m].
        viscousfriction: The viscous friction [N m s/rad].
    """

    _type = SensorType.Actuator

    maxtorque: float = json_field("maxTorque", default=0.0)
    maxcurrent: float = json_field("maxCurrent", default=0.0)
    nominalcurrent: float = json_field("nominalCurrent", default=0.0)
    maxvelocity: float = json_field("maxVelocity", default=0.0)
    maxacceleration: float = json_field("maxAcceleration", default=0.0)
    maxjerk: float = json_field("maxJerk", default=0.0)
    staticfriction: float = json_field("staticFriction", default=0.0)
    viscousfriction: float = json_field("viscousFriction", default=0.0)


_DESCRIBED: Mapping[type, type[SensorGeometry]] = {
    scene.Intrinsics: CameraGeomData,
    scene.Laser: LaserGeomData,
    scene.FlashLidar: FlashLidarGeomData,
    scene.ForceTorque: Force6DGeomData,
    scene.Imu: IMUGeomData,
    scene.Odometry: OdometryGeomData,
    scene.JointEncoder: JointEncoderGeomData,
    scene.Tactile: TactileGeomData,
}
"""Info class of each device class."""

_OTHER_NAMES = {
    "correction_matrix": "correction",
    "targetid": "target",
    "time_measurement": "scan_time",
    "time_scan": "scan_time",
}
"""Device attributes of info fields, if their names differ. Fields without a device attribute are only stored."""


def geometry_of(device: scene.Device) -> SensorGeometry:
    """Return the constant properties of a device as a new info."""
    made = _described(device)()
    for field, name, kind in _shared(made, device):
        value = getattr(device, name)
        setattr(made, field, (value, 0.0) if _is_angle(field, kind) else value)
    if isinstance(device, scene.Intrinsics | scene.FlashLidar):
        cast("CameraGeomData", made).intrinsics = intrinsics_of(device)
    return made


def sensor_type(device: scene.Device) -> SensorType:
    """Return OpenRAVE's sensor type of a device."""
    return _DESCRIBED[type(device)]._type


def device_of(geometry: SensorGeometry, before: scene.Device) -> scene.Device | None:
    """Return a device with the properties of an info.

    Args:
        geometry: The info.
        before: The previous device, or one of its kind. It supplies the properties that the info does not have.

    Returns:
        The device; None if the info describes another kind of sensor.

    Raises:
        ArgumentError: a field has wrong numbers.
    """
    if type(geometry) not in {_described(before), _DESCRIBED[type(before)]}:  # plain lasers have no fields for the spin
        return None
    changes: dict[str, Any] = {}
    if isinstance(geometry, CameraGeomData | FlashLidarGeomData):
        changes |= _pinhole(geometry.intrinsics)
    for field, name, kind in _shared(geometry, before):
        read = _first_angle if _is_angle(field, kind) else _READERS[kind]
        changes[name] = read(getattr(geometry, field), field)
    return replace(before, **changes)


def intrinsics_of(camera: scene.Intrinsics | scene.FlashLidar) -> CameraIntrinsics:
    """Return the camera matrix of a device as ``CameraIntrinsics``."""
    return CameraIntrinsics(np.array([[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]]))


def _described(device: scene.Device) -> type[SensorGeometry]:
    spins = isinstance(device, scene.Laser) and device.spins
    return SpinningLaserGeomData if spins else _DESCRIBED[type(device)]


def _shared(geometry: SensorGeometry, device: scene.Device) -> Iterator[tuple[str, str, Any]]:
    """Yield the names, in info and device, of each property that both have, and its type in the device."""
    types = {field.name: field.type for field in fields(device)}
    for field in fields(geometry):
        name = _OTHER_NAMES.get(field.name, field.name)
        if name in types:
            yield field.name, name, types[name]


def _is_angle(field: str, kind: Any) -> bool:  # noqa: ANN401 - a type
    """Return whether an info field has an angle for each of two axes; devices have only the first of these angles."""
    return kind is float and field in {"min_angle", "max_angle", "resolution"}


def _first_angle(values: ArrayLike, name: str) -> float:
    angles = _numbers(values, name)
    if not angles:
        raise ArgumentError("LaserGeomData: min_angle, max_angle and resolution should hold a number each, or two")
    return angles[0]


def _pinhole(intrinsics: CameraIntrinsics) -> dict[str, float]:
    K = checked_numbers(intrinsics.K, "intrinsics.K")
    if K.shape != (3, 3):
        raise ArgumentError(f"intrinsics.K: has shape {K.shape}, and should have shape (3, 3)")
    return {name: float(K[place]) for name, place in PINHOLE.items()}


def _numbers(values: ArrayLike, name: str) -> tuple[float, ...]:
    return tuple(checked_numbers(values, name).ravel().tolist())


def _number(value: float, name: str) -> float:
    numbers = _numbers(value, name)
    if len(numbers) != 1:
        raise ArgumentError(f"{name}: is {value!r}, and should be a number")
    return numbers[0]


def _count(value: float, name: str) -> int:
    number = _number(value, name)
    if not number.is_integer():  # infinities and NaN, too
        raise ArgumentError(f"{name}: is {value!r}, and should be a whole number")
    return int(number)


_READERS: Mapping[Any, Callable[[Any, str], Any]] = {
    float: _number,
    int: _count,
    str: lambda value, name: str(value),
    Vec3: vector,
    tuple[float, ...]: _numbers,
}
"""Conversions of info fields to device values, by type."""
