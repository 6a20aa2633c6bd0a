"""``<Body>``: a link, new or re-opened by its name."""

from collections.abc import Callable

from ravemj.builder import BodyBuilder, LinkBuilder
from ravemj.openrave_xml.context import IGNORED, NOT_YET, Context
from ravemj.openrave_xml.geometry import GeometryScope, read_geometries
from ravemj.openrave_xml.joint import frame_of_link
from ravemj.openrave_xml.mass import MassReader, MassRule, link_inertial
from ravemj.openrave_xml.tree import Element
from ravemj.openrave_xml.values import ROTATIONS, Placement, hadamard, is_false, scale_attribute
from ravemj.transforms import Pose


class _LinkScope:
    """An open ``<Body>``."""

    def __init__(
        self, body: BodyBuilder, link: LinkBuilder, mass: MassReader, context: Context, geometry_scope: GeometryScope
    ) -> None:
        self.body = body
        self.link = link
        self.mass = mass
        self.context = context
        self.geometry_scope = geometry_scope
        self.placement = Placement(link.pose, geometry_scope.scale)
        self.T_scope_offset: Pose | None = None
        self.skip_geometry = False

    def translate(self, element: Element) -> None:
        """Read a ``<Translation>``."""
        self.placement.translate(element, self.context.diagnostics)

    def turn(self, element: Element) -> None:
        """Read a rotation."""
        self.placement.turn(element, self.context.diagnostics)

    def read_offset(self, element: Element) -> None:
        """Read the name of the link that the pose is relative to."""
        self.T_scope_offset = frame_of_link(self.body, element, self.context)

    def read_geometry(self, element: Element) -> None:
        """Read a ``<Geom>``."""
        if not self.skip_geometry:
            self.link.geometries.extend(read_geometries(element, self.geometry_scope, self.context))

    def read_mass(self, element: Element) -> None:
        """Read a ``<Mass>``."""
        self.mass.read(element)


LINK_TAGS: dict[str, Callable[[_LinkScope, Element], None]] = {
    "translation": _LinkScope.translate,
    **dict.fromkeys(ROTATIONS, _LinkScope.turn),
    "offsetfrom": _LinkScope.read_offset,
    "geom": _LinkScope.read_geometry,
    "geometry": _LinkScope.read_geometry,
    "mass": _LinkScope.read_mass,
}
LINK_IGNORED = {"body": NOT_YET}
LINK_ATTRIBUTES = {"name", "type", "enable", "scalegeometry"}
LINK_IGNORED_ATTRIBUTES = {"file": NOT_YET, "skipgeometry": IGNORED}


def read_link(
    body: BodyBuilder,
    element: Element,
    context: Context,
    default_mass: MassRule | None,
    geometry_scope: GeometryScope,
    *,
    skip_geometry: bool,
) -> None:
    """Read a ``<Body>``: a new link, or one more piece of the link of that name."""
    context.check_attributes(element, LINK_ATTRIBUTES, LINK_IGNORED_ATTRIBUTES)
    name = element.attributes.get("name")
    existing = None if name is None else body.find_link(name)
    link = LinkBuilder(name or "", element.source) if existing is None else body.links[existing]
    if "scalegeometry" in element.attributes:
        geometry_scope = geometry_scope._replace(scale=hadamard(geometry_scope.scale, scale_attribute(element)))
    mass = MassReader(context, default_mass, geometry_scope.scale)
    scope = _LinkScope(body, link, mass, context, geometry_scope)
    scope.skip_geometry = skip_geometry
    context.walk(element, LINK_TAGS, LINK_IGNORED, scope)
    pose = scope.placement.pose
    link.pose = pose if scope.T_scope_offset is None else scope.T_scope_offset @ pose
    link.inertial = link_inertial(scope.mass.rule or default_mass, link.geometries)
    link.enabled = not is_false(element.attributes.get("enable", "true"))
    if "type" in element.attributes:
        link.static = element.attributes["type"].lower() == "static"
    if existing is None:
        body.links.append(link)
