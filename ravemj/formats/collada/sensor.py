"""Sensors: OpenRAVE's ``<sensor>``, and ravemj's extra for sensors without a robot."""

import math
from collections.abc import Iterator
from dataclasses import replace

from ravemj.core.transforms import Pose
from ravemj.formats import settled
from ravemj.formats.collada.extras import inside_extra, own_techniques
from ravemj.formats.collada.geometry_writer import write_pose
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.visual import read_pose
from ravemj.formats.meshes.collada.document import Element, child, children, local_name, numbers, words
from ravemj.formats.sensor_tags import described, is_text, sensor_tags, written
from ravemj.formats.xml_text import XmlText
from ravemj.model.scene import SENSOR_COLOR, AttachedSensor, Device, needs_link, sensor_kind


def read_sensor(
    library: Library, place: Element, technique: Element, link: int | None, T_link_sensor: Pose
) -> AttachedSensor:
    """Read a sensor.

    Args:
        library: The documents.
        place: The element with the name of the sensor.
        technique: The element with the ``<instance_sensor>``; without one, the sensor is a frame without a device.
        link: The index of the link that carries the sensor, or None.
        T_link_sensor: The pose of the sensor in the link; without a link, in the world.
    """
    instance = child(technique, "instance_sensor")
    sensor = None if instance is None else library.follow(instance, "sensor")
    kind = None if sensor is None else sensor_kind(_device_type(sensor))
    built = AttachedSensor(
        name=place.get("name", ""),
        link=link,
        T_link_sensor=T_link_sensor,
        type=None if sensor is None else sensor.get("type"),
        device=None if sensor is None or kind is None else _device(library, sensor, kind.device),
        source=library.source(place),
    )
    if sensor is None:
        return built
    color = numbers(child(sensor, "color")).tolist()
    if len(color) >= 3 and all(map(math.isfinite, color)):
        built = replace(built, color=(color[0], color[1], color[2]))
    if built.device is None or not library.truth(child(sensor, "power"), False):
        return built
    problem = built.device.problem()
    if problem is not None:
        library.warn("bad-sensor", f"the sensor stays off: {problem}", sensor)
    return replace(built, is_on=problem is None)


def read_loose(library: Library, scene: Element) -> Iterator[AttachedSensor]:
    """Yield the sensors without a robot of a kinematics scene."""
    for technique in own_techniques(scene):
        for element in children(technique, "sensor"):
            sensor = read_sensor(library, element, element, None, read_pose(library, element))
            can_measure = sensor.device is not None and not needs_link(sensor.device)
            yield replace(sensor, is_on=sensor.is_on and can_measure)


def _device(library: Library, sensor: Element, device: Device) -> Device:
    """Return ``device`` with the properties in a ``<sensor>``; elements that are no properties of it are skipped."""
    tags = {name.lower(): tag for name, tag in sensor_tags(device).items()}
    for element in children(sensor):
        tag = tags.get(local_name(element).lower())
        if tag is None:
            continue
        values = numbers(element).tolist()
        if is_text(device, tag):
            device = described(device, tag, " ".join(words(element)))
        elif all(map(math.isfinite, values)) and len(values) >= tag.numbers:
            device = described(device, tag, values)
        else:
            message = f"it holds {len(values)} numbers, and should hold {tag.numbers or ''} finite ones"
            library.warn("number-count", message, element)
    return device


def _device_type(sensor: Element) -> str:
    """Return the type of a ``<sensor>``: the interface that it names, else its ``type`` attribute."""
    for technique in children(child(sensor, "interface_type"), "technique"):
        named = " ".join(words(child(technique, "interface")))
        if named:
            return named
    return sensor.get("type", "")


def write_device(out: XmlText, library: XmlText, name: str, sensor: AttachedSensor) -> None:
    """Write a sensor into the library with an id, and a reference to it; nothing for a frame without a device."""
    if sensor.type is None:
        return
    out.element("instance_sensor", url=f"#{name}")
    with library.inside("sensor", id=name, type=sensor.type):
        for tag, content in () if sensor.device is None else written(sensor.device, collada=True):
            library.element(tag, content)
        if sensor.is_on:
            library.element("power", 1)
        if sensor.color != SENSOR_COLOR:
            library.element("color", sensor.color)


def write_loose(out: XmlText, library: XmlText, sensors: tuple[AttachedSensor, ...]) -> None:
    """Write the sensors without a robot into a kinematics scene; only ``read_loose`` reads them."""
    if not sensors:
        return
    with inside_extra(out):
        for number, sensor in enumerate(sensors):
            with out.inside("sensor", name=sensor.name):
                write_pose(out, settled.pose(sensor.T_link_sensor))
                write_device(out, library, f"sensor{number}", sensor)
