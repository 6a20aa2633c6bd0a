"""``<Body>``: a new link, or more content of an existing one."""

from dataclasses import replace

from ravemj.core.transforms import UNMOVED, Pose
from ravemj.errors import Diagnostics
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS, Context, Placed
from ravemj.formats.openrave_xml.geom import GEOM_ATTRIBUTES, GeometryScope, read_geometries
from ravemj.formats.openrave_xml.joint import frame_of_link
from ravemj.formats.openrave_xml.mass import MassRule, link_inertial, read_mass
from ravemj.formats.openrave_xml.tags import IGNORED, Tag
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import ChildTransform, hadamard, is_false, scale_attribute
from ravemj.formats.parameters import PARAMETER_MEANING
from ravemj.model.builder import BodyBuilder, LinkBuilder
from ravemj.model.scene import OWN_SHAPES


class _LinkScope(Placed):
    """Reading state of a ``<Body>``."""

    def __init__(
        self,
        body: BodyBuilder,
        link: LinkBuilder,
        start: Pose,
        mass: MassRule | None,
        context: Context,
        geometry_scope: GeometryScope,
        *,
        skip_geometry: bool,
    ) -> None:
        super().__init__(context, ChildTransform(start, geometry_scope.scale))
        self.body = body
        self.link = link
        self.mass = mass
        self.geometry_scope = geometry_scope
        self.T_scope_offset: Pose | None = None
        self.skip_geometry = skip_geometry

    def read(self, element: Element) -> None:
        """Read the attributes, the included file, and the children."""
        self.context.check_attributes(element, LINK_ATTRIBUTES, LINK_IGNORED_ATTRIBUTES)
        self.link.enabled = not is_false(element.attributes.get("enable", "true"))
        self.link.self_collision_ignored = is_false(element.attributes.get("selfcollision", "true"))
        name = element.attributes.get("name", self.link.name)
        if name != self.link.name:  # a Body in a Body renames the link (gap-20)
            index = self.body.find_link(self.link.name)
            if index is not None:
                self.body.forget_names(index)
            self.link.name = name
        if "file" in element.attributes:
            self._include(element)
        self.context.walk(element, LINK_TAGS, {}, self)

    def _include(self, element: Element) -> None:
        """Read the file that ``<Body file="…">`` names, as if its content were in the element."""
        root = self.context.include(element)
        if root is not None and root.tag == "body":
            self.read_nested(root)
        elif root is not None:
            message = f"the file of a Body has to hold a <Body>, and holds a <{root.spelled}>; it is skipped"
            self.context.diagnostics.warn("unknown-tag", message, root.source)

    @property
    def pose(self) -> Pose:
        """Pose of the link as defined by the elements read so far."""
        pose = self.placement.pose
        return pose if self.T_scope_offset is None else self.T_scope_offset @ pose

    def read_nested(self, element: Element) -> None:
        """Read a nested ``<Body>``: it extends this link, and its pose displaces all shapes read so far."""
        older = len(self.link.geometries)
        geometry_scope = _scaled(self.geometry_scope, element, self.context.diagnostics)
        inner = _LinkScope(
            self.body, self.link, UNMOVED, None, self.context, geometry_scope, skip_geometry=self.skip_geometry
        )
        inner.read(element)
        if inner.pose != UNMOVED:
            self.link.geometries = [
                replace(geometry, T_link_geometry=inner.pose @ geometry.T_link_geometry)
                for geometry in self.link.geometries
            ]
        if older and inner.pose != UNMOVED:
            message = "the transform of a Body in a Body moves the shapes before it too"
            self.context.diagnostics.warn("openrave-bug", message, element.source, "put the inner Body first")
        if inner.mass is not None:
            message = "OpenRAVE discards the Mass of a Body in a Body"
            self.context.diagnostics.warn("openrave-bug", message, element.source, "put it into the outer Body")

    def read_offset(self, element: Element) -> None:
        self.T_scope_offset = frame_of_link(self.body, element, self.context)

    def read_geometry(self, element: Element) -> None:
        if self.skip_geometry:
            self.context.check_attributes(element, GEOM_ATTRIBUTES, {})
            return
        shapes = read_geometries(element, self.geometry_scope, self.context)
        group = element.attributes.get("group", OWN_SHAPES)
        if group == OWN_SHAPES:  # geom-36
            self.link.geometries += shapes
        else:
            self.link.add_to_group(group, shapes)

    def read_parameter(self, element: Element) -> None:
        self.link.parameters = self.context.with_parameter(self.link.parameters, element)

    def read_mass(self, element: Element) -> None:
        self.mass = read_mass(element, self.mass, self.geometry_scope.scale, self.context)


LINK_TAGS: dict[str, Tag[_LinkScope]] = {
    **PLACEMENT_TAGS,
    "offsetfrom": Tag(_LinkScope.read_offset, "name of the Body that the pose is relative to", once=True),
    "geom": Tag(_LinkScope.read_geometry, "see below"),
    "geometry": Tag(_LinkScope.read_geometry, "the same as Geom"),
    "mass": Tag(_LinkScope.read_mass, "see below"),
    "parameter": Tag(_LinkScope.read_parameter, PARAMETER_MEANING),
    "body": Tag(
        _LinkScope.read_nested,
        "more of the same link; its transform moves all shapes so far, its Mass is discarded, as in OpenRAVE",
    ),
}
LINK_ATTRIBUTES = {
    "name": "name of the link; a known one goes on with that link",
    "type": "static: never moves",
    "enable": "false: takes no part in collisions",
    "scalegeometry": "one factor or three, of positions and meshes",
    "file": "a file with a Body, read as if it stood in this one",
    "selfcollision": "ravemj's own; false: is not tested against other links of its body",
}
LINK_IGNORED_ATTRIBUTES = {"skipgeometry": IGNORED}


def read_link(
    body: BodyBuilder,
    element: Element,
    context: Context,
    mass: MassRule | None,
    geometry_scope: GeometryScope,
    *,
    skip_geometry: bool,
) -> None:
    """Read a ``<Body>``: a new link, or more content of the existing link with this name."""
    name = element.attributes.get("name")
    existing = None if name is None else body.find_link(name)
    # A known name, also an empty one, goes on with that link; a Body without the attribute is new (transform-26).
    link = LinkBuilder(name or "", element.source) if existing is None else body.links[existing]
    geometry_scope = _scaled(geometry_scope, element, context.diagnostics)
    scope = _LinkScope(body, link, link.pose, mass, context, geometry_scope, skip_geometry=skip_geometry)
    scope.read(element)
    link.pose, rule = scope.pose, scope.mass
    inertial = link_inertial(rule, link.geometries)
    if existing is not None and rule is None and inertial.mass != link.inertial.mass:
        message = (
            f"link '{link.name}' weighs {inertial.mass:g} kg and no longer {link.inertial.mass:g} kg: "
            "OpenRAVE computes the mass anew where a Body of the same name goes on with a link"
        )
        context.diagnostics.warn("openrave-bug", message, element.source, "repeat the <Mass>, or write it here only")
    link.inertial = inertial
    _check_density(link, rule, element, context)
    if rule is not None and rule.by_total and rule.total and not link.inertial.mass:
        number = "NaN, as in OpenRAVE, and computed with as 0" if link.inertial.undefined else "0"
        message = f"link '{link.name}' has no shape with a volume: its mimicgeom mass is {number}, not {rule.total:g}"
        code = "undefined-mass" if link.inertial.undefined else "openrave-bug"
        context.diagnostics.warn(code, message, element.source, "write the mass as type custom")
    if "type" in element.attributes:
        kind = element.attributes["type"].lower()
        link.static = kind == "static"
        if kind not in {"static", "dynamic"}:
            message = f"there is no Body of type '{kind}'; OpenRAVE takes a dynamic one"
            context.diagnostics.warn(
                "unknown-type", message, element.source, "write static for a Body that never moves"
            )
    if existing is None:
        body.links.append(link)


def _scaled(scope: GeometryScope, element: Element, diagnostics: Diagnostics) -> GeometryScope:
    if "scalegeometry" not in element.attributes:
        return scope
    return scope._replace(scale=hadamard(scope.scale, scale_attribute(element, diagnostics)))


def _check_density(link: LinkBuilder, rule: MassRule | None, element: Element, context: Context) -> None:
    """Warn if a density has no effect because no shape of the link has a volume."""
    fills = rule is not None and rule.kind == "mimicgeom" and not rule.by_total and rule.density > 0
    if fills and link.geometries and not link.inertial.mass:
        message = f"link '{link.name}' weighs nothing: no shape of it has a volume that its density could fill"
        hint = "close the mesh, or write the mass as type custom"
        context.diagnostics.warn("no-volume", message, element.source, hint)
