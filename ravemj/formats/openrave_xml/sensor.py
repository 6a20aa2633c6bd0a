"""``<Sensor>``: the kind of a sensor and, of cameras, the intrinsics."""

from dataclasses import replace
from typing import NamedTuple

from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import leading_numbers, number, numbers
from ravemj.model.scene import Intrinsics

_CAMERA_TYPE = "basecamera"
_KNOWN_TYPES = {
    name.lower(): name
    for name in ("BaseCamera", "BaseLaser2D", "BaseSpinningLaser2D", "BaseFlashLidar3D", "BaseForce6D")
}


def known_type(kind: str) -> str | None:
    """Return OpenRAVE's name of a kind of sensor in XML, also where COLLADA spells it another way; None for others."""
    plain = kind.lower().replace("_", "").replace("pinhole", "")
    return _KNOWN_TYPES.get(plain)


class Device(NamedTuple):
    """The device of an attached sensor.

    Attributes:
        type: OpenRAVE's name of its kind, or None for a frame without a device.
        camera: Its intrinsics, of a camera.
    """

    type: str | None = None
    camera: Intrinsics | None = None


class _Camera:
    """An open ``<Sensor type="BaseCamera">``."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.intrinsics = Intrinsics(0.0, 0.0, 0.0, 0.0, 0, 0)

    def read_kk(self, element: Element) -> None:
        """Read fx fy cx cy."""
        fx, fy, cx, cy = numbers(element, 4, self.context.diagnostics)
        self.intrinsics = replace(self.intrinsics, fx=fx, fy=fy, cx=cx, cy=cy)

    def read_intrinsic(self, element: Element) -> None:
        """Read two rows of the camera matrix: fx 0 cx 0 fy cy."""
        fx, _, cx, _, fy, cy = numbers(element, 6, self.context.diagnostics)
        self.intrinsics = replace(self.intrinsics, fx=fx, fy=fy, cx=cx, cy=cy)

    def read_width(self, element: Element) -> None:
        self.intrinsics = replace(self.intrinsics, width=int(number(element, self.context.diagnostics)))

    def read_height(self, element: Element) -> None:
        self.intrinsics = replace(self.intrinsics, height=int(number(element, self.context.diagnostics)))

    def read_dimensions(self, element: Element) -> None:
        """Read width and height; a third number, the channels, may follow."""
        values = [*leading_numbers(element.text).values, 0.0, 0.0]
        self.intrinsics = replace(self.intrinsics, width=int(values[0]), height=int(values[1]))


CAMERA_TAGS: dict[str, Tag[_Camera]] = {
    "kk": Tag(_Camera.read_kk, "fx fy cx cy [pixels]"),
    "intrinsic": Tag(_Camera.read_intrinsic, "fx 0 cx 0 fy cy [pixels]"),
    "width": Tag(_Camera.read_width, "[pixels]"),
    "height": Tag(_Camera.read_height, "[pixels]"),
    "image_dimensions": Tag(_Camera.read_dimensions, "width and height [pixels]; channels may follow"),
}
NO_DEVICE = "of sensors that are no cameras, only kind and place are kept"
DEVICE_ATTRIBUTES = {
    "type": ", ".join(_KNOWN_TYPES.values()),
    "file": "read in its place",
    "name": "takes no effect; the name is that of the AttachedSensor",
}
DEVICE_IGNORED_ATTRIBUTES = {"args": "no sensor here takes arguments"}
CAMERA_IGNORED = reasons(
    NO_EFFECT_HERE, "framerate", "focal_length", "color", "power", "gain", "measurement_time", "format",
    "sensor_reference", "target_region", "hardware_id", "distortion_model", "distortion_coeffs",
)  # fmt: skip


def read_device(element: Element, context: Context) -> Device:
    """Read a ``<Sensor>``; with ``file``, that of the file."""
    context.check_attributes(element, DEVICE_ATTRIBUTES, DEVICE_IGNORED_ATTRIBUTES)
    root = context.include(element)
    found = Device() if root is None or root.tag != "sensor" else read_device(root, context)
    kind = element.attributes.get("type")
    if kind is None:
        return found
    if kind.split()[0].lower() not in _KNOWN_TYPES if kind.strip() else True:
        context.diagnostics.error("unknown-interface", f"there is no sensor of type '{kind}'", element.source)
        return Device()
    name = _KNOWN_TYPES[kind.split()[0].lower()]
    if name.lower() != _CAMERA_TYPE:
        for child in element.children:
            context.leave_out(child, NO_DEVICE)
        return Device(name)
    camera = _Camera(context)
    context.walk(element, CAMERA_TAGS, CAMERA_IGNORED, camera)
    return Device(name, camera.intrinsics)
