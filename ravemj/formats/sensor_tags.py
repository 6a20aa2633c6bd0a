"""Meanings of the elements of a ``<sensor>``, shared by readers and writers of OpenRAVE XML and COLLADA."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from ravemj.formats import settled
from ravemj.model.scene import (
    Device,
    FlashLidar,
    ForceTorque,
    Imu,
    Intrinsics,
    JointEncoder,
    Laser,
    Odometry,
    Tactile,
)

_DEGREE = math.radians(1)


class SensorTag(NamedTuple):
    """An element that describes a sensor.

    Attributes:
        fields: The field of the device for each of its numbers; "" for a number without meaning.
        meaning: Description of its content.
        unit: Factor from the element's unit to the field's.
        size: Number of values of a single field; 0 for any.
    """

    fields: tuple[str, ...]
    meaning: str
    unit: float = 1.0
    size: int = 1

    @property
    def numbers(self) -> int:
        """Number of values in the element; 0 for any."""
        return len(self.fields) if self.size == 1 else self.size


def _distances(lengths: str) -> dict[str, SensorTag]:
    return {
        "min_range": SensorTag(("min_range",), lengths),
        "max_range": SensorTag(("max_range",), lengths),
        "minrange": SensorTag(("min_range",), "as min_range"),
        "maxrange": SensorTag(("max_range",), "as max_range"),
        "distance_range": SensorTag(("min_range", "max_range"), f"both {lengths}"),
    }


_TIMES = {
    "time_scan": SensorTag(("scan_time",), "time between measurements [s]"),
    "scantime": SensorTag(("scan_time",), "as time_scan"),
    "measurement_time": SensorTag(("scan_time",), "as time_scan"),
}
_PINHOLE = {
    "KK": SensorTag(("fx", "fy", "cx", "cy"), "fx fy cx cy [pixels]"),
    "intrinsic": SensorTag(("fx", "", "cx", "", "fy", "cy"), "fx 0 cx 0 fy cy [pixels]"),
    "width": SensorTag(("width",), "[pixels]"),
    "height": SensorTag(("height",), "[pixels]"),
    "image_dimensions": SensorTag(("width", "height"), "width and height [pixels]; channels may follow", size=0),
}
_COVARIANCES = ("rotation_covariance", "angular_velocity_covariance", "linear_acceleration_covariance")

_TAGS: Mapping[type, Mapping[str, SensorTag]] = {
    Intrinsics: _PINHOLE,
    Laser: {
        "min_angle": SensorTag(("min_angle",), "first ray, counted from x towards y [deg]", _DEGREE),
        "max_angle": SensorTag(("max_angle",), "last ray [deg]", _DEGREE),
        "resolution": SensorTag(("resolution",), "step between rays [deg]", _DEGREE),
        "minangle": SensorTag(("min_angle",), "as min_angle", _DEGREE),
        "maxangle": SensorTag(("max_angle",), "as max_angle", _DEGREE),
        "angle_range": SensorTag(("min_angle", "max_angle"), "both [deg]", _DEGREE),
        "angle_increment": SensorTag(("resolution",), "as resolution", _DEGREE),
        **_distances("[m]"),
        **_TIMES,
        "time_increment": SensorTag(("time_increment",), "time between rays [s]; only handed on"),
    },
    FlashLidar: {**_PINHOLE, **_distances("[m]"), **_TIMES},
    ForceTorque: {
        "polarity": SensorTag(("polarity",), "sign of what is measured: 1 or -1"),
        "correction_matrix": SensorTag(("correction",), "multiplies force and torque: 36 numbers by rows", size=36),
    },
    Imu: {**_TIMES, **{name: SensorTag((name,), "9 numbers by rows; only handed on", size=9) for name in _COVARIANCES}},
    Odometry: {**_TIMES, "target": SensorTag(("target",), "name of the body that is followed")},
    JointEncoder: {"resolution": SensorTag(("resolution",), "steps of the encoders [rad or m]", size=0)},
    Tactile: {"thickness": SensorTag(("thickness",), "of the skin [m]")},
}


_SPIN_TAGS = {
    "spinaxis": SensorTag(("spin_axis",), "axis about which the plane of the scan turns", size=3),
    "spinpos": SensorTag(("spin_position",), "point on that axis [m]", size=3),
    "spinspeed": SensorTag(("spin_speed",), "how fast it turns [rad/s]"),
}


def sensor_tags(device: Device) -> Mapping[str, SensorTag]:
    """Return the elements that describe a device, by their tags."""
    spins = isinstance(device, Laser) and device.spins
    return {**_TAGS[type(device)], **(_SPIN_TAGS if spins else {})}


def described(device: Device, tag: SensorTag, values: Sequence[float] | str) -> Device:
    """Return a device updated from an element.

    Args:
        device: The device.
        tag: Meaning of the element.
        values: The numbers in the element, or its text if the field is a text; missing numbers are 0.
    """
    first = tag.fields[0]
    if isinstance(values, str):
        return replace(device, **{first: values})
    if isinstance(getattr(device, first), tuple):
        return replace(device, **{first: tuple(value * tag.unit for value in values)})
    padded = (*values, *[0.0] * len(tag.fields))
    named = {field: value * tag.unit for field, value in zip(tag.fields, padded, strict=False) if field}
    whole = {field: int(value) for field, value in named.items() if isinstance(getattr(device, field), int)}
    return replace(device, **named | whole)


def is_text(device: Device, tag: SensorTag) -> bool:
    """Return whether an element contains a text instead of numbers."""
    return isinstance(getattr(device, tag.fields[0]), str)


def written(device: Device, *, collada: bool = False) -> list[tuple[str, str | float | Sequence[float]]]:
    """Return tag and content of each element that describes a device, for values other than the defaults.

    Args:
        device: The device.
        collada: Whether cameras are written as COLLADA's OpenRAVE extensions have them.
    """
    if collada and isinstance(device, Intrinsics):
        matrix = (device.fx, 0, device.cx, 0, device.fy, device.cy)
        return [("intrinsic", matrix), ("image_dimensions", (device.width, device.height, 3))]
    elements: list[tuple[str, str | float | Sequence[float]]] = []
    known: set[str] = set()
    unsaid = type(device)()
    for name, tag in sensor_tags(device).items():
        if known.isdisjoint(tag.fields):
            values = [getattr(device, field) for field in tag.fields]
            if values != [getattr(unsaid, field) for field in tag.fields]:
                elements.append((name, _content(values, tag)))
        known.update(tag.fields)
    return elements


def _content(values: "list[Any]", tag: SensorTag) -> str | float | Sequence[float]:
    """Return the content of a sensor's element from its values [SI], converted to the tag's unit."""
    in_degrees = [settled.degrees(value) if tag.unit == _DEGREE else value for value in values]
    return in_degrees if len(in_degrees) > 1 else in_degrees[0]
