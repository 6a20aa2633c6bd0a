"""The constant properties of sensors: resolution, range, calibration."""

# Users put anything into fields.
# pyright: reportUnknownArgumentType=false, reportUnknownLambdaType=false

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import RavemjError
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.base import Info, info_class, json_field
from ravemj.rave.infos.json import TEXT, Entry, Form, Json, info

PINHOLE = {"fx": (0, 0), "fy": (1, 1), "cx": (0, 2), "cy": (1, 2)}
"""The numbers of a camera matrix and their places in it."""


def _number_of_matrix(place: tuple[int, int]) -> Form:
    """Return the JSON form of one number of a matrix."""

    def read(value: float, scale: float, present: Any) -> Floats:  # noqa: ANN401 - what users put into the field
        del scale
        matrix = np.array(present, dtype=float)
        matrix[place] = value
        return matrix

    return Form(lambda matrix, scale: float(np.asarray(matrix, dtype=float)[place]), read)


@info_class
class CameraIntrinsics(Info):
    """The intrinsics of a camera: its matrix and the distortion of its lens. Rendered pictures have no distortion.

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
    """The base class of the constant properties of sensors. Each kind of sensor has a class of its own.

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
    """The image size and the intrinsics of a camera.

    Attributes:
        intrinsics: The camera matrix and the lens.
        width: The width of the image [pixels].
        height: The height of the image [pixels].
        measurement_time: The exposure time [s].
        gain: The gain.
        target_region: The name of the region that the camera looks at.
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
    """The field of view and the range of a laser scanner.

    Attributes:
        min_angle: The first angle of a scan [rad], about the first and the second axis.
        max_angle: The last angle of a scan [rad], likewise.
        min_range: The smallest distance that is measured [m].
        max_range: The greatest distance that is measured [m].
        resolution: The step of the angles [rad], likewise.
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
    """A laser scanner whose plane turns about a second axis, ``BaseSpinningLaser2D``.

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
    """A camera that measures distances, ``BaseFlashLidar3D``. The angles of laser scanners do not apply.

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
    """The resolution of the encoders of a joint.

    Attributes:
        resolution: The step of each DOF of the joint [rad or m].
    """

    _type = SensorType.JointEncoder

    resolution: Sequence[float] = ()


@info_class
class Force6DGeomData(SensorGeometry):
    """The calibration of a force-torque sensor.

    Attributes:
        polarity: The sign of the measurements, 1 or -1.
        correction_matrix: The 6x6 matrix that multiplies a measurement, 36 numbers row by row.
    """

    _type = SensorType.Force6D

    polarity: int = 1
    correction_matrix: Sequence[float] = ()


@info_class
class IMUGeomData(SensorGeometry):
    """The timing of an inertial measurement unit.

    Attributes:
        time_measurement: Time between two measurements [s].
    """

    _type = SensorType.IMU

    time_measurement: float = 0.0


@info_class
class OdometryGeomData(SensorGeometry):
    """The body whose motion an odometry sensor measures.

    Attributes:
        targetid: The name of the body.
    """

    _type = SensorType.Odometry

    targetid: str = json_field("targetId", default="")


@info_class
class TactileGeomData(SensorGeometry):
    """The shape of a tactile sensor.

    Attributes:
        thickness: The thickness of the skin [m].
    """

    _type = SensorType.Tactile

    thickness: float = 0.0


@info_class
class ActuatorGeomData(SensorGeometry):
    """The limits of an actuator.

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
