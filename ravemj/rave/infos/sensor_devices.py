"""Converts the sensors of a scene to infos, and back."""

# Users put anything into the fields of infos.
# pyright: reportUnknownArgumentType=false, reportUnknownVariableType=false, reportUnknownMemberType=false
# pyright: reportUnknownLambdaType=false

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.base import vector
from ravemj.rave.infos.sensor import (
    CameraGeomData,
    CameraIntrinsics,
    FlashLidarGeomData,
    Force6DGeomData,
    IMUGeomData,
    JointEncoderGeomData,
    LaserGeomData,
    OdometryGeomData,
    SensorGeometry,
    SpinningLaserGeomData,
    TactileGeomData,
)


def geometry_of(device: scene.Device) -> SensorGeometry:
    """Return the constant properties of a device as a new info."""
    return _CONVERSIONS[type(device)].write(device)


def sensor_type(device: scene.Device) -> SensorType:
    """Return OpenRAVE's sensor type of a device."""
    return _CONVERSIONS[type(device)].described.sensor_type()


def device_of(geometry: SensorGeometry, before: scene.Device) -> scene.Device | None:
    """Return a device with the properties of an info.

    Args:
        geometry: The info.
        before: The device so far, or one of its kind. It keeps the properties that the info has no field for.

    Returns:
        The device; None if the info describes another kind of sensor.

    Raises:
        ArgumentError: a field has wrong numbers.
    """
    conversion = _CONVERSIONS[type(before)]
    return conversion.read(geometry, before) if isinstance(geometry, conversion.described) else None


def _laser_geometry(laser: scene.Laser) -> LaserGeomData:
    made = SpinningLaserGeomData() if laser.spins else LaserGeomData()
    if isinstance(made, SpinningLaserGeomData):
        made.spin_axis, made.spin_position, made.spin_speed = laser.spin_axis, laser.spin_position, laser.spin_speed
    made.min_angle, made.max_angle, made.resolution = (
        (angle, 0.0) for angle in (laser.min_angle, laser.max_angle, laser.resolution)
    )
    made.min_range, made.max_range = laser.min_range, laser.max_range
    made.time_increment, made.time_scan = laser.time_increment, laser.scan_time
    return made


def _laser(geometry: LaserGeomData, before: scene.Laser) -> scene.Laser | None:
    if isinstance(geometry, FlashLidarGeomData):
        return None
    if isinstance(geometry, SpinningLaserGeomData):
        if not before.spins:
            return None
        before = replace(
            before,
            spin_axis=vector(geometry.spin_axis, "spin_axis"),
            spin_position=vector(geometry.spin_position, "spin_position"),
            spin_speed=_number(geometry.spin_speed, "spin_speed"),
        )
    angles = [_numbers(getattr(geometry, name), name) for name in ("min_angle", "max_angle", "resolution")]
    if not all(angles):
        raise ArgumentError("LaserGeomData: min_angle, max_angle and resolution should hold a number each, or two")
    min_range, max_range, scan_time = _reach(geometry)
    return replace(
        before,
        min_angle=angles[0][0],
        max_angle=angles[1][0],
        resolution=angles[2][0],
        min_range=min_range,
        max_range=max_range,
        scan_time=scan_time,
        time_increment=_number(geometry.time_increment, "time_increment"),
    )


def intrinsics_of(camera: scene.Intrinsics | scene.FlashLidar) -> CameraIntrinsics:
    """Return the camera matrix of a device as ``CameraIntrinsics``."""
    return CameraIntrinsics(np.array([[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]]))


def _pinhole(geometry: CameraGeomData | FlashLidarGeomData) -> tuple[float, float, float, float, int, int]:
    K = checked_numbers(geometry.intrinsics.K, "intrinsics.K")
    if K.shape != (3, 3):
        raise ArgumentError(f"intrinsics.K: has shape {K.shape}, and should have shape (3, 3)")
    fx, fy, cx, cy = (float(K[place]) for place in ((0, 0), (1, 1), (0, 2), (1, 2)))
    return fx, fy, cx, cy, _count(geometry.width, "width"), _count(geometry.height, "height")


def _reach(geometry: LaserGeomData) -> tuple[float, float, float]:
    """Return the smallest and greatest distance that rays measure [m], and the time between scans [s]."""
    least, greatest = _number(geometry.min_range, "min_range"), _number(geometry.max_range, "max_range")
    return least, greatest, _number(geometry.time_scan, "time_scan")


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


class _Conversion(NamedTuple):
    """The conversion between devices of one class and their infos.

    Attributes:
        described: The class of the infos.
        write: A function of a device that returns its info.
        read: A function of an info and the device so far that returns the new device, or None.
    """

    described: type[SensorGeometry]
    write: Callable[[Any], SensorGeometry]
    read: Callable[[Any, Any], scene.Device | None]


_CONVERSIONS: Mapping[type, _Conversion] = MappingProxyType(
    {
        scene.Intrinsics: _Conversion(
            CameraGeomData,
            lambda camera: CameraGeomData(intrinsics=intrinsics_of(camera), width=camera.width, height=camera.height),
            lambda geometry, before: scene.Intrinsics(*_pinhole(geometry)),
        ),
        scene.Laser: _Conversion(LaserGeomData, _laser_geometry, _laser),
        scene.FlashLidar: _Conversion(
            FlashLidarGeomData,
            lambda lidar: FlashLidarGeomData(
                intrinsics=intrinsics_of(lidar),
                width=lidar.width,
                height=lidar.height,
                min_range=lidar.min_range,
                max_range=lidar.max_range,
                time_scan=lidar.scan_time,
            ),
            lambda geometry, before: scene.FlashLidar(*_pinhole(geometry), *_reach(geometry)),
        ),
        scene.ForceTorque: _Conversion(
            Force6DGeomData,
            lambda sensor: Force6DGeomData(polarity=sensor.polarity, correction_matrix=sensor.correction),
            lambda geometry, before: scene.ForceTorque(
                _count(geometry.polarity, "polarity"), _numbers(geometry.correction_matrix, "correction_matrix")
            ),
        ),
        scene.Imu: _Conversion(
            IMUGeomData,
            lambda sensor: IMUGeomData(time_measurement=sensor.scan_time),
            lambda geometry, before: replace(before, scan_time=_number(geometry.time_measurement, "time_measurement")),
        ),
        scene.Odometry: _Conversion(
            OdometryGeomData,
            lambda sensor: OdometryGeomData(targetid=sensor.target),
            lambda geometry, before: replace(before, target=str(geometry.targetid)),
        ),
        scene.JointEncoder: _Conversion(
            JointEncoderGeomData,
            lambda sensor: JointEncoderGeomData(resolution=sensor.resolution),
            lambda geometry, before: scene.JointEncoder(_numbers(geometry.resolution, "resolution")),
        ),
        scene.Tactile: _Conversion(
            TactileGeomData,
            lambda sensor: TactileGeomData(thickness=sensor.thickness),
            lambda geometry, before: scene.Tactile(_number(geometry.thickness, "thickness")),
        ),
    }
)
