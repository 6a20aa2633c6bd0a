"""``<Sensor>``: the kind of a sensor and what is fixed about it."""

from collections.abc import Mapping
from functools import partial
from typing import NamedTuple

from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import is_true, leading_numbers, numbers, vector
from ravemj.formats.sensor_tags import SensorTag, described, is_text, sensor_tags
from ravemj.model.scene import SENSOR_COLOR, SENSOR_KINDS, Device, Intrinsics, Rgb, SensorKind


class SensorElement(NamedTuple):
    """What a ``<Sensor>`` says.

    Attributes:
        type: OpenRAVE's name of its kind, or None for a frame without a device.
        device: What is fixed about it.
        is_on: Whether it measures from the start.
        color: Colour in which viewers draw it.
    """

    type: str | None = None
    device: Device | None = None
    is_on: bool = False
    color: Rgb = SENSOR_COLOR


class _Sensor:
    """An open ``<Sensor>``."""

    def __init__(self, context: Context, kind: SensorKind) -> None:
        self.context = context
        self.type = kind.name
        self.device = kind.device
        self.is_on = False
        self.color = SENSOR_COLOR

    def describe(self, element: Element, tag: SensorTag) -> None:
        """Read an element that the tables shared with COLLADA describe."""
        if is_text(self.device, tag):
            self.device = described(self.device, tag, " ".join(element.text.split()))
        elif tag.numbers:
            self.device = described(self.device, tag, numbers(element, tag.numbers, self.context.diagnostics))
        else:
            self.device = described(self.device, tag, leading_numbers(element.text).values)

    def switch(self, element: Element) -> None:
        """Read whether it measures from the start."""
        self.is_on = is_true(element.text.strip())

    def paint(self, element: Element) -> None:
        """Read the colour of what viewers draw."""
        self.color = vector(element, self.context.diagnostics, self.color)


COMMON_TAGS: dict[str, Tag[_Sensor]] = {
    "power": Tag(_Sensor.switch, "1: it measures from the start"),
    "color": Tag(_Sensor.paint, "of what viewers draw: red, green, blue from 0 to 1"),
}
DEVICE_ATTRIBUTES = {
    "type": ", ".join(kind.name for kind in SENSOR_KINDS.values()),
    "file": "read in its place",
    "name": "takes no effect; the name is that of the AttachedSensor",
}
DEVICE_IGNORED_ATTRIBUTES = {"args": "no sensor here takes arguments"}
COMMON_IGNORED = reasons(NO_EFFECT_HERE, "hardware_id")
_CAMERA_IGNORED = {
    "framerate": "pictures are taken when somebody asks for them",
    **reasons(
        NO_EFFECT_HERE, "focal_length", "gain", "measurement_time", "format", "sensor_reference", "target_region",
        "distortion_model", "distortion_coeffs",
    ),
}  # fmt: skip


def device_tags(kind: SensorKind) -> Mapping[str, Tag[_Sensor]]:
    """Return the table of what only a kind of sensor has."""
    shared = sensor_tags(kind.device).items()
    return {name.lower(): Tag(partial(_describe, tag=tag), tag.meaning) for name, tag in shared}


def device_ignored(kind: SensorKind) -> Mapping[str, str]:
    """Return what only a kind of sensor has and is left out, and why."""
    return _CAMERA_IGNORED if isinstance(kind.device, Intrinsics) else {}


def _describe(sensor: _Sensor, element: Element, tag: SensorTag) -> None:
    sensor.describe(element, tag)


def read_device(element: Element, context: Context) -> SensorElement:
    """Read a ``<Sensor>``; with ``file``, that of the file."""
    context.check_attributes(element, DEVICE_ATTRIBUTES, DEVICE_IGNORED_ATTRIBUTES)
    root = context.include(element)
    found = SensorElement() if root is None or root.tag != "sensor" else read_device(root, context)
    name = element.attributes.get("type")
    if name is None:
        return found
    kind = SENSOR_KINDS.get(next(iter(name.split()), "").lower())
    if kind is None:
        context.diagnostics.error("unknown-interface", f"there is no sensor of type '{name}'", element.source)
        return SensorElement()
    sensor = _Sensor(context, kind)
    tags, ignored = {**device_tags(kind), **COMMON_TAGS}, {**device_ignored(kind), **COMMON_IGNORED}
    context.walk(element, tags, ignored, sensor)
    problem = sensor.device.problem() if sensor.is_on else None
    if problem is not None:
        context.diagnostics.warn("bad-sensor", f"the sensor stays off: {problem}", element.source)
    return SensorElement(kind.name, sensor.device, sensor.is_on and problem is None, sensor.color)
