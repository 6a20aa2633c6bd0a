"""What is fixed about sensors: resolutions, ranges, calibration."""

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
    """A pinhole camera: its matrix, and the distortion of its lens, which pictures here do not have.

    Attributes:
        K: Camera matrix [pixels], shape (3, 3).
        distortion_model: Name of the model of distortion; empty: none.
        distortion_coeffs: Its numbers.
        focal_length: Focal length of the lens [m].
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
        """Return the camera as OpenRAVE's JSON has it, see ``Info``.

        Args:
            unitScale: Factor for all lengths.
            options: OpenRAVE's; not used.
        """
        matrix = np.asarray(self.K, dtype=float)
        numbers = {"fx": matrix[0, 0], "fy": matrix[1, 1], "cx": matrix[0, 2], "cy": matrix[1, 2]}
        return {key: float(number) for key, number in numbers.items()} | super().SerializeJSON(unitScale, options)

    def DeserializeJSON(self, obj: Json, unitScale: float = 1.0, options: object = None) -> None:
        """Take over what JSON has, see ``Info``.

        Args:
            obj: What ``SerializeJSON`` returns, or a part of it.
            unitScale: Factor for all lengths.
            options: OpenRAVE's; not used.
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
    """What is fixed about a sensor of any kind; each kind of sensor has its own class.

    Attributes:
        hardware_id: What its maker calls it.
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
    """Image size and intrinsics of a camera.

    Attributes:
        intrinsics: The camera matrix and the lens.
        width: Columns [pixels].
        height: Rows [pixels].
        measurement_time: How long it takes a picture [s].
        gain: Amplification.
        target_region: Name of the region that it looks at.
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
    """Field of view and range of a laser scanner.

    Attributes:
        min_angle: Where a scan begins [rad], of the first and the second axis.
        max_angle: Where it ends.
        min_range: Least distance that is measured [m].
        max_range: Greatest distance [m].
        resolution: Step of the angles [rad].
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
    """A laser scanner whose plane turns about a second axis, ``BaseSpinningLaser2D``; OpenRAVE has it in XML only.

    Attributes:
        spin_axis: The axis, in the sensor's frame.
        spin_position: A point on it [m].
        spin_speed: How fast the plane turns [rad/s].
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
    """A camera that measures distances, ``BaseFlashLidar3D``; OpenRAVE has it in XML only. Angles mean nothing here.

    Attributes:
        intrinsics: The camera matrix [rays].
        width: Columns.
        height: Rows.
    """

    _called = "FlashLidarGeomData"

    intrinsics: CameraIntrinsics = field(default_factory=CameraIntrinsics)
    width: int = 0
    height: int = 0

    def _json(self, obj: Json | None = None) -> Sequence[Entry]:
        return [*super()._json(obj), *_PINHOLE_JSON]


@info_class
class JointEncoderGeomData(SensorGeometry):
    """Steps of a joint's encoders.

    Attributes:
        resolution: For each DOF of the joint its step [rad or m].
    """

    _called = "JointEncoderGeomData"
    _type = SensorType.JointEncoder
    _keys = (("resolution", "resolution"),)

    resolution: Sequence[float] = ()


@info_class
class Force6DGeomData(SensorGeometry):
    """Calibration of a sensor of forces and torques.

    Attributes:
        polarity: Sign of what it measures: 1 or -1.
        correction_matrix: What multiplies its six numbers, 36 numbers by rows.
    """

    _called = "Force6DGeomData"
    _type = SensorType.Force6D
    _keys = (("polarity", "polarity"), ("correctionMatrix", "correction_matrix"))

    polarity: int = 1
    correction_matrix: Sequence[float] = ()


@info_class
class IMUGeomData(SensorGeometry):
    """Timing of an inertial measurement unit.

    Attributes:
        time_measurement: Time between two measurements [s].
    """

    _called = "IMUGeomData"
    _type = SensorType.IMU
    _keys = (("timeMeasurement", "time_measurement"),)

    time_measurement: float = 0.0


@info_class
class OdometryGeomData(SensorGeometry):
    """What an odometry sensor follows.

    Attributes:
        targetid: Name of the body.
    """

    _called = "OdometryGeomData"
    _type = SensorType.Odometry
    _keys = (("targetId", "targetid"),)

    targetid: str = ""


@info_class
class TactileGeomData(SensorGeometry):
    """Shape of a tactile sensor.

    Attributes:
        thickness: Thickness of its skin [m].
    """

    _called = "TactileGeomData"
    _type = SensorType.Tactile
    _keys = (("thickness", "thickness"),)

    thickness: float = 0.0


@info_class
class ActuatorGeomData(SensorGeometry):
    """Limits of an actuator.

    Attributes:
        maxtorque: Torque [N m].
        maxcurrent: Current [A].
        nominalcurrent: Current for long [A].
        maxvelocity: Velocity [rad/s].
        maxacceleration: Acceleration [rad/s^2].
        maxjerk: Jerk [rad/s^3].
        staticfriction: Torque to start [N m].
        viscousfriction: Torque per velocity [N m s/rad].
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
