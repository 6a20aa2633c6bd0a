"""The constant properties of sensors: resolution, range, calibration."""

from collections.abc import Sequence
from dataclasses import field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.transforms import Floats
from ravemj.errors import RavemjError
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.base import Info, info_class
from ravemj.rave.infos.json import PLAIN, TEXT, Entry, Json, info


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

    K: ArrayLike = field(default_factory=lambda: np.eye(3))
    distortion_model: str = ""
    distortion_coeffs: Sequence[float] = ()
    focal_length: float = 0.01

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return _INTRINSICS_JSON

    def SerializeJSON(self, unitScale: float = 1.0, options: object = None) -> Json:
        """Return the intrinsics in OpenRAVE's JSON format, see ``Info``.

        Args:
            unitScale: Multiplies all lengths.
            options: Not used.
        """
        matrix = np.asarray(self.K, dtype=float)
        numbers = {"fx": matrix[0, 0], "fy": matrix[1, 1], "cx": matrix[0, 2], "cy": matrix[1, 2]}
        return {key: float(number) for key, number in numbers.items()} | super().SerializeJSON(unitScale, options)

    def DeserializeJSON(self, obj: Json, unitScale: float = 1.0, options: object = None) -> None:
        """Set fields from OpenRAVE's JSON format, see ``Info``.

        Args:
            obj: A result of ``SerializeJSON``, or a part of one.
            unitScale: Multiplies all lengths.
            options: Not used.
        """
        super().DeserializeJSON(obj, unitScale, options)
        matrix = np.array(self.K, dtype=float)
        for key, place in {"fx": (0, 0), "fy": (1, 1), "cx": (0, 2), "cy": (1, 2)}.items():
            matrix[place] = obj.get(key, matrix[place])
        self.K = matrix  # pyright: ignore[reportConstantRedefinition] - OpenRAVE's name, no constant


_INTRINSICS_JSON = (
    Entry("focalLength", "focal_length", PLAIN),
    Entry("distortionModel", "distortion_model", TEXT),
    Entry("distortionCoeffs", "distortion_coeffs", PLAIN),
)


_PINHOLE_JSON = (
    Entry("intrinsics", "intrinsics", info(CameraIntrinsics)),
    Entry("width", "width", PLAIN),
    Entry("height", "height", PLAIN),
)


@info_class
class SensorGeometry(Info):
    """The base class of the constant properties of sensors. Each kind of sensor has a class of its own.

    Attributes:
        hardware_id: The manufacturer's identifier.
    """

    _called = "SensorGeometry"
    _internal = ("sensor_type",)
    _type = SensorType.Invalid
    _keys: ClassVar[Sequence[tuple[str, str]]] = ()

    hardware_id: str = ""

    def __init__(self, *args: object, **kwargs: object) -> None:
        raise RavemjError("SensorGeometry stands for all kinds of geometry: make a CameraGeomData, for instance")

    @classmethod
    def sensor_type(cls) -> SensorType:
        """Return the kind of sensor that objects of this class describe."""
        return cls._type

    def GetType(self) -> SensorType:
        """Return the kind of sensor."""
        return self._type

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        del obj
        return [Entry(key, name, PLAIN) for key, name in (("hardwareId", "hardware_id"), *self._keys)]


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

    _called = "CameraGeomData"
    _type = SensorType.Camera

    intrinsics: CameraIntrinsics = field(default_factory=CameraIntrinsics)
    width: int = 0
    height: int = 0
    measurement_time: float = 1.0
    gain: float = 1.0
    target_region: str = ""

    @property
    def KK(self) -> Floats:
        """The camera matrix [pixels], shape (3, 3)."""
        return np.asarray(self.intrinsics.K, dtype=float)

    @KK.setter
    def KK(self, matrix: ArrayLike) -> None:
        self.intrinsics.K = np.array(matrix, dtype=float)  # pyright: ignore[reportConstantRedefinition] - as above

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        return [
            *super()._json(obj),
            *_PINHOLE_JSON,
            Entry("measurementTime", "measurement_time", PLAIN),
            Entry("gain", "gain", PLAIN),
            Entry("targetRegion", "target_region", TEXT),
        ]


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

    _called = "LaserGeomData"
    _type = SensorType.Laser
    _keys = (
        *(("minAngle", "min_angle"), ("maxAngle", "max_angle"), ("resolution", "resolution")),
        *(("minRange", "min_range"), ("maxRange", "max_range")),
        *(("timeIncrement", "time_increment"), ("timeScan", "time_scan")),
    )

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

    _called = "SpinningLaserGeomData"
    _keys = (
        *LaserGeomData._keys,
        *(("spinAxis", "spin_axis"), ("spinPosition", "spin_position"), ("spinSpeed", "spin_speed")),
    )

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

    _called = "FlashLidarGeomData"

    intrinsics: CameraIntrinsics = field(default_factory=CameraIntrinsics)
    width: int = 0
    height: int = 0

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        return [*super()._json(obj), *_PINHOLE_JSON]


@info_class
class JointEncoderGeomData(SensorGeometry):
    """The resolution of the encoders of a joint.

    Attributes:
        resolution: The step of each DOF of the joint [rad or m].
    """

    _called = "JointEncoderGeomData"
    _type = SensorType.JointEncoder
    _keys = (("resolution", "resolution"),)

    resolution: Sequence[float] = ()


@info_class
class Force6DGeomData(SensorGeometry):
    """The calibration of a force-torque sensor.

    Attributes:
        polarity: The sign of the measurements, 1 or -1.
        correction_matrix: The 6x6 matrix that multiplies a measurement, 36 numbers row by row.
    """

    _called = "Force6DGeomData"
    _type = SensorType.Force6D
    _keys = (("polarity", "polarity"), ("correctionMatrix", "correction_matrix"))

    polarity: int = 1
    correction_matrix: Sequence[float] = ()


@info_class
class IMUGeomData(SensorGeometry):
    """The timing of an inertial measurement unit.

    Attributes:
        time_measurement: Time between two measurements [s].
    """

    _called = "IMUGeomData"
    _type = SensorType.IMU
    _keys = (("timeMeasurement", "time_measurement"),)

    time_measurement: float = 0.0


@info_class
class OdometryGeomData(SensorGeometry):
    """The body whose motion an odometry sensor measures.

    Attributes:
        targetid: The name of the body.
    """

    _called = "OdometryGeomData"
    _type = SensorType.Odometry
    _keys = (("targetId", "targetid"),)

    targetid: str = ""


@info_class
class TactileGeomData(SensorGeometry):
    """The shape of a tactile sensor.

    Attributes:
        thickness: The thickness of the skin [m].
    """

    _called = "TactileGeomData"
    _type = SensorType.Tactile
    _keys = (("thickness", "thickness"),)

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

    _called = "ActuatorGeomData"
    _type = SensorType.Actuator

    maxtorque: float = 0.0
    maxcurrent: float = 0.0
    nominalcurrent: float = 0.0
    maxvelocity: float = 0.0
    maxacceleration: float = 0.0
    maxjerk: float = 0.0
    staticfriction: float = 0.0
    viscousfriction: float = 0.0
