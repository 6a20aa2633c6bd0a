"""Converts the sensors of a scene to infos, and back."""

# The tables of infos are theirs, and users put anything into their fields.
# pyright: reportPrivateUsage=false

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.core.transforms import Vec3
from ravemj.errors import ArgumentError
from ravemj.model import scene
from ravemj.rave.enums import SensorType
from ravemj.rave.infos.base import vector
from ravemj.rave.infos.sensor import (
    PINHOLE,
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
"""The classes of infos that describe devices."""

_OTHER_NAMES = {
    "correction_matrix": "correction",
    "targetid": "target",
    "time_measurement": "scan_time",
    "time_scan": "scan_time",
}
"""The fields of infos that have another name in devices; fields without a counterpart there are only stored."""


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
        before: The device so far, or one of its kind. It keeps the properties that the info has no field for.

    Returns:
        The device; None if the info describes another kind of sensor.

    Raises:
        ArgumentError: a field has wrong numbers.
    """
    if type(geometry) not in {_described(before), _DESCRIBED[type(before)]}:  # a plain laser's keeps how one spins
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
    """Yield the names that an info and a device have for what both know, and the type that it has in the device."""
    types = {one.name: one.type for one in fields(device)}
    for one in fields(geometry):
        name = _OTHER_NAMES.get(one.name, one.name)
        if name in types:
            yield one.name, name, types[name]


def _is_angle(field: str, kind: Any) -> bool:  # noqa: ANN401 - a type
    """Return whether a field has angles about two axes, and the device that about the first."""
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
"""The conversions of fields, by the types that they have in devices."""
