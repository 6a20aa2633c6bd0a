"""``<Sensor>``: type and constant properties of a sensor."""

from collections.abc import Mapping
from functools import partial
from typing import NamedTuple

from ravemj.core.transforms import Pose
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS, Context, Placed, did_you_mean
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import is_true, number_list, numbers, vector
from ravemj.formats.sensor_tags import SensorTag, described, is_text, sensor_tags
from ravemj.model.scene import (
    SENSOR_COLOR,
    SENSOR_KINDS,
    AttachedSensor,
    Device,
    Intrinsics,
    Rgb,
    SensorKind,
    needs_link,
)


class SensorElement(NamedTuple):
    """A parsed ``<Sensor>``.

    Attributes:
        type: OpenRAVE's name of the sensor type, or None for a frame without a device.
        device: Its constant properties.
        is_on: Whether it measures from the start.
        color: Colour in which viewers draw it.
        pose: Its own pose; sensors on a robot have that of the ``<AttachedSensor>`` instead.
        name: Its name.
    """

    type: str | None = None
    device: Device | None = None
    is_on: bool = False
    color: Rgb = SENSOR_COLOR
    pose: Pose = Pose()
    name: str = ""


class _SensorScope(Placed):
    def __init__(self, context: Context, device: Device) -> None:
        super().__init__(context)
        self.device = device
        self.is_on = False
        self.color = SENSOR_COLOR

    def describe(self, element: Element, tag: SensorTag) -> None:
        """Read a property of the sensor; ``tag`` is from the tables shared with COLLADA."""
        if is_text(self.device, tag):
            self.device = described(self.device, tag, " ".join(element.text.split()))
        elif tag.numbers:
            self.device = described(self.device, tag, numbers(element, tag.numbers, self.context.diagnostics))
        else:
            self.device = described(self.device, tag, number_list(element, self.context.diagnostics))

    def switch(self, element: Element) -> None:
        self.is_on = is_true(element.text.strip())

    def paint(self, element: Element) -> None:
        self.color = vector(element, self.context.diagnostics, self.color)


COMMON_TAGS: dict[str, Tag[_SensorScope]] = {
    "power": Tag(_SensorScope.switch, "1: it measures from the start"),
    "color": Tag(_SensorScope.paint, "of what viewers draw: red, green, blue from 0 to 1"),
}
DEVICE_ATTRIBUTES = {
    "type": ", ".join(kind.name for kind in SENSOR_KINDS.values()),
    "file": "read in its place",
    "name": "name of a sensor of the environment; one in an AttachedSensor has the name of that",
}
DEVICE_IGNORED_ATTRIBUTES = {"args": "no sensor here takes arguments"}
COMMON_IGNORED = reasons(NO_EFFECT_HERE, "hardware_id", "sendcommand")
_CAMERA_IGNORED = {
    "framerate": "pictures are taken when somebody asks for them",
    **reasons(
        NO_EFFECT_HERE, "focal_length", "gain", "measurement_time", "format", "sensor_reference", "target_region",
        "distortion_model", "distortion_coeffs",
    ),
}  # fmt: skip
_IN_FILE = dict.fromkeys(
    (tag.lower() for kind in SENSOR_KINDS.values() for tag in (*sensor_tags(kind.device), *COMMON_TAGS)),
    "the file says what the sensor is like; OpenRAVE reads nothing here without a type",
)


def device_tags(kind: SensorKind) -> Mapping[str, Tag[_SensorScope]]:
    """Return the tags specific to a sensor type."""
    shared = sensor_tags(kind.device).items()
    return {name.lower(): Tag(partial(_SensorScope.describe, tag=tag), tag.meaning) for name, tag in shared}


def device_ignored(kind: SensorKind) -> Mapping[str, str]:
    """Return the ignored tags specific to a sensor type, with reasons."""
    return _CAMERA_IGNORED if isinstance(kind.device, Intrinsics) else {}


def read_device(element: Element, context: Context) -> SensorElement:
    """Read the ``<Sensor>`` of an ``<AttachedSensor>``; if it names a ``file``, read the sensor in that file."""
    return _read(element, context, {}, reasons("the AttachedSensor says where it is", *PLACEMENT_TAGS))


def read_sensor(element: Element, context: Context) -> AttachedSensor | None:
    """Read a ``<Sensor>`` without a robot; None, with an error, if its type is unknown."""
    sensor = _read(element, context, PLACEMENT_TAGS, {})
    if sensor.device is None:
        if "type" not in element.attributes:
            message = "<Sensor> is of no type, and is left out"
            context.diagnostics.error("unknown-interface", message, element.source, 'write type="…", or file="…"')
        return None
    problem = "it measures what its link feels, and is on none" if needs_link(sensor.device) else None
    if problem is not None:
        hint = "put it into an <AttachedSensor> of a robot"
        context.diagnostics.warn("bad-sensor", f"the sensor stays off: {problem}", element.source, hint)
    return AttachedSensor(
        name=sensor.name,
        link=None,
        T_link_sensor=sensor.pose,
        type=sensor.type,
        device=sensor.device,
        source=element.source,
        is_on=sensor.is_on and problem is None,
        color=sensor.color,
    )


def _read(
    element: Element, context: Context, placement: Mapping[str, Tag[_SensorScope]], ignored: Mapping[str, str]
) -> SensorElement:
    """Read a ``<Sensor>``; without a ``type``, read its ``file`` and apply the element's pose and name."""
    context.check_attributes(element, DEVICE_ATTRIBUTES, DEVICE_IGNORED_ATTRIBUTES)
    root = context.include(element)
    from_file = SensorElement() if root is None or root.tag != "sensor" else _read(root, context, placement, ignored)
    type_name, name = element.attributes.get("type"), element.attributes.get("name", from_file.name)
    if type_name is None:
        place = _SensorScope(context, Intrinsics())
        context.walk(element, placement, {**ignored, **_IN_FILE}, place)
        return from_file._replace(pose=place.placement.pose, name=name)
    kind = SENSOR_KINDS.get(next(iter(type_name.split()), "").lower())
    if kind is None:
        hint = did_you_mean(type_name, [sensor_kind.name for sensor_kind in SENSOR_KINDS.values()])
        context.diagnostics.error(
            "unknown-interface", f"there is no sensor of type '{type_name}'", element.source, hint
        )
        return SensorElement()
    sensor = _SensorScope(context, kind.device)
    tags = {**device_tags(kind), **COMMON_TAGS, **placement}
    context.walk(element, tags, {**device_ignored(kind), **COMMON_IGNORED, **ignored}, sensor)
    problem = sensor.device.problem() if sensor.is_on else None
    if problem is not None:
        context.diagnostics.warn("bad-sensor", f"the sensor stays off: {problem}", element.source)
    is_on = sensor.is_on and problem is None
    return SensorElement(kind.name, sensor.device, is_on, sensor.color, sensor.placement.pose, name)
