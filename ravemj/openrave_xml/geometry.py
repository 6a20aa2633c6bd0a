"""``<Geom>``: a shape of a link, its pose and its colours."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from ravemj.errors import Diagnostics
from ravemj.openrave_xml.context import IGNORED, NOT_YET, Context, reasons
from ravemj.openrave_xml.tree import Element
from ravemj.openrave_xml.values import ROTATIONS, Placement, is_false, number, vector
from ravemj.scene import Box, Capsule, Cylinder, Geometry, Rgb, Shape, Sphere
from ravemj.transforms import ZERO, Pose, Vec3, scale, wxyz_from_axis_angle

_CYLINDER_TURN = Pose(ZERO, wxyz_from_axis_angle((1.0, 0.0, 0.0), math.pi / 2))
"""In XML a cylinder lies along y, in memory along z."""


@dataclass(slots=True)
class _Geom:
    """What the children of a ``<Geom>`` have said so far."""

    diagnostics: Diagnostics
    name: str = ""
    placement: Placement = field(default_factory=Placement)
    half_extents: Vec3 = ZERO
    radius: float = 0.0
    height: float = 0.0
    diffuse: Rgb = (1.0, 1.0, 1.0)
    ambient: Rgb = (0.0, 0.0, 0.0)
    transparency: float = 0.0

    def translate(self, element: Element) -> None:
        self.placement.translate(element, self.diagnostics)

    def turn(self, element: Element) -> None:
        self.placement.turn(element, self.diagnostics)

    def read_half_extents(self, element: Element) -> None:
        self.half_extents = vector(element, self.diagnostics)

    def read_full_extents(self, element: Element) -> None:
        self.half_extents = scale(vector(element, self.diagnostics), 0.5)

    def read_radius(self, element: Element) -> None:
        self.radius = number(element, self.diagnostics)

    def read_height(self, element: Element) -> None:
        self.height = number(element, self.diagnostics)

    def read_diffuse(self, element: Element) -> None:
        self.diffuse = vector(element, self.diagnostics)

    def read_ambient(self, element: Element) -> None:
        self.ambient = vector(element, self.diagnostics)

    def read_transparency(self, element: Element) -> None:
        self.transparency = number(element, self.diagnostics)

    def read_name(self, element: Element) -> None:
        self.name = element.text.strip()


GEOM_TAGS: dict[str, Callable[[_Geom, Element], None]] = {
    "translation": _Geom.translate,
    **dict.fromkeys(ROTATIONS, _Geom.turn),
    "extents": _Geom.read_half_extents,
    "halfextents": _Geom.read_half_extents,
    "fullextents": _Geom.read_full_extents,
    "radius": _Geom.read_radius,
    "height": _Geom.read_height,
    "diffusecolor": _Geom.read_diffuse,
    "ambientcolor": _Geom.read_ambient,
    "transparency": _Geom.read_transparency,
    "name": _Geom.read_name,
}
GEOM_IGNORED = reasons(NOT_YET, "data", "collision", "render", "vertices")
GEOM_ATTRIBUTES = {"type", "name", "render"}
GEOM_IGNORED_ATTRIBUTES = {"modifiable": IGNORED, "group": NOT_YET}

_SHAPES: dict[str, Callable[[_Geom], Shape]] = {
    "box": lambda geom: Box(geom.half_extents),
    "sphere": lambda geom: Sphere(geom.radius),
    "cylinder": lambda geom: Cylinder(geom.radius, geom.height),
    "capsule": lambda geom: Capsule(geom.radius, geom.height),
}


def read_geometry(element: Element, context: Context) -> Geometry | None:
    """Read a ``<Geom>``; one whose type has no shape here is reported and left out."""
    context.check_attributes(element, GEOM_ATTRIBUTES, GEOM_IGNORED_ATTRIBUTES)
    kind = element.attributes.get("type", "box").lower()
    geom = _Geom(context.diagnostics, name=element.attributes.get("name", ""))
    context.walk(element, GEOM_TAGS, GEOM_IGNORED, geom)
    if kind not in _SHAPES:
        message = f"a geometry of type '{kind}' is left out: {NOT_YET}"
        context.diagnostics.warn("unsupported-geometry", message, element.source)
        return None
    pose = geom.placement.pose
    return Geometry(
        shape=_SHAPES[kind](geom),
        T_link_geometry=pose @ _CYLINDER_TURN if kind == "cylinder" else pose,
        name=geom.name,
        diffuse=geom.diffuse,
        ambient=geom.ambient,
        transparency=geom.transparency,
        visible=not is_false(element.attributes.get("render", "true")),
        source=element.source,
    )
