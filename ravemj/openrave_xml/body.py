"""``<Robot>``, ``<KinBody>`` and ``<Body>``: scopes that fill one body, in document order.

A nested ``<KinBody>`` or ``<Robot>`` and an included file add to the body of the outermost element. The transform
of an element acts at its end, once, on the links that were made inside it.
"""

from collections.abc import Callable

from ravemj.builder import BodyBuilder, LinkBuilder
from ravemj.openrave_xml.context import IGNORED, NOT_YET, Context, reasons
from ravemj.openrave_xml.geometry import read_geometry
from ravemj.openrave_xml.joint import frame_of_link, read_joint
from ravemj.openrave_xml.mass import DefaultMassReader, MassReader, MassRule, link_inertial
from ravemj.openrave_xml.tree import Element
from ravemj.openrave_xml.values import ROTATIONS, Placement, is_false
from ravemj.scene import KinBody
from ravemj.transforms import Pose


class _Scope:
    """An open ``<Robot>`` or ``<KinBody>``."""

    def __init__(self, body: BodyBuilder, context: Context) -> None:
        self.body = body
        self.context = context
        self.placement = Placement()
        self.default_mass = DefaultMassReader(context)

    def read(self, element: Element) -> None:
        """Read a whole element: its file, its children, and what its end tag does."""
        first_link = len(self.body.links)
        self._include(element)
        first_renamed = len(self.body.links), len(self.body.joints)
        tags, ignored = (_ROBOT_TAGS, ROBOT_IGNORED) if element.tag == "robot" else (_KINBODY_TAGS, KINBODY_IGNORED)
        self.context.walk(element, tags, ignored, self)
        self.body.name = element.attributes.get("name", "") or self.body.name
        self._prefix(element.attributes.get("prefix", ""), *first_renamed)
        if self.placement.moves:
            T_outer_scope = self.placement.pose
            for link in self.body.links[first_link:]:
                link.pose = T_outer_scope @ link.pose

    def _include(self, element: Element) -> None:
        """Read the file of an element as if it stood inside an element like it."""
        root = self.context.include(element)
        if root is None:
            return
        attributes = {name: value for name, value in element.attributes.items() if name != "file"}
        wrapper = Element(element.tag, element.spelled, attributes, "", [root], root.source)
        _Scope(self.body, self.context).read(wrapper)

    def _prefix(self, prefix: str, first_link: int, first_joint: int) -> None:
        for part in (*self.body.links[first_link:], *self.body.joints[first_joint:]):
            part.name = prefix + part.name

    def nest(self, element: Element) -> None:
        """Read a nested ``<Robot>`` or ``<KinBody>`` into the same body."""
        check_scope_attributes(element, self.context)
        _Scope(self.body, self.context).read(element)

    def translate(self, element: Element) -> None:
        """Read a ``<Translation>`` of the whole element."""
        self.placement.translate(element, self.context.diagnostics)

    def turn(self, element: Element) -> None:
        """Read a rotation of the whole element."""
        self.placement.turn(element, self.context.diagnostics)

    def read_default_mass(self, element: Element) -> None:
        """Read the ``<Mass>`` that the following Bodies share."""
        self.default_mass.read(element)

    def read_link(self, element: Element) -> None:
        """Read a ``<Body>``."""
        read_link(self.body, element, self.context, self.default_mass.rule)

    def read_joint(self, element: Element) -> None:
        """Read a ``<Joint>``."""
        read_joint(self.body, element, self.context)

    def read_adjacent(self, element: Element) -> None:
        """Read a pair of links that never collide."""
        names = element.text.split()[:2]
        links = [link for name in names if (link := self.body.find_link(name)) is not None]
        if len(links) == 2:
            self.body.adjacent.append((min(links), max(links)))
        else:
            message = f"<{element.spelled}> needs the names of two Bodies above it, and holds '{element.text.strip()}'"
            self.context.diagnostics.warn("unknown-body", message, element.source)


_PLACEMENT_TAGS: dict[str, Callable[[_Scope, Element], None]] = {
    "translation": _Scope.translate,
    **dict.fromkeys(ROTATIONS, _Scope.turn),
}
_ROBOT_TAGS: dict[str, Callable[[_Scope, Element], None]] = {
    **_PLACEMENT_TAGS,
    "robot": _Scope.nest,
    "kinbody": _Scope.nest,
}
ROBOT_IGNORED = reasons(NOT_YET, "manipulator", "attachedsensor", "controller", "jointvalues", "sendcommand")
_KINBODY_TAGS: dict[str, Callable[[_Scope, Element], None]] = {
    **_PLACEMENT_TAGS,
    "kinbody": _Scope.nest,
    "body": _Scope.read_link,
    "joint": _Scope.read_joint,
    "mass": _Scope.read_default_mass,
    "adjacent": _Scope.read_adjacent,
}
KINBODY_IGNORED = {
    **reasons("OpenRAVE overlooks it here; write it in each Geom", "diffusecolor", "ambientcolor"),
    **reasons(NOT_YET, "jointvalues", "modelsdir", "transparency", "sendcommand"),
}
SCOPE_ATTRIBUTES = {"name", "prefix", "file"}
SCOPE_IGNORED_ATTRIBUTES = reasons(NOT_YET, "type", "scalegeometry", "skipgeometry", "makejoinedlinksadjacent")


def read_body(element: Element, context: Context) -> KinBody:
    """Read an outermost ``<Robot>`` or ``<KinBody>``."""
    check_scope_attributes(element, context)
    body = BodyBuilder(element.tag == "robot", element.source)
    _Scope(body, context).read(element)
    return body.freeze(context.diagnostics)


def check_scope_attributes(element: Element, context: Context) -> None:
    """Report the attributes of a ``<Robot>`` or ``<KinBody>`` that nothing reads."""
    context.check_attributes(element, SCOPE_ATTRIBUTES, SCOPE_IGNORED_ATTRIBUTES)


class _LinkScope:
    """An open ``<Body>``, new or re-opened by its name."""

    def __init__(self, body: BodyBuilder, link: LinkBuilder, mass: MassReader, context: Context) -> None:
        self.body = body
        self.link = link
        self.mass = mass
        self.context = context
        self.placement = Placement(link.pose)
        self.T_scope_offset = Pose()

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
        geometry = read_geometry(element, self.context)
        if geometry is not None:
            self.link.geometries.append(geometry)

    def read_mass(self, element: Element) -> None:
        """Read a ``<Mass>``."""
        self.mass.read(element)


_LINK_TAGS: dict[str, Callable[[_LinkScope, Element], None]] = {
    "translation": _LinkScope.translate,
    **dict.fromkeys(ROTATIONS, _LinkScope.turn),
    "offsetfrom": _LinkScope.read_offset,
    "geom": _LinkScope.read_geometry,
    "geometry": _LinkScope.read_geometry,
    "mass": _LinkScope.read_mass,
}
LINK_IGNORED = {"body": NOT_YET}
LINK_ATTRIBUTES = {"name", "type", "enable"}
LINK_IGNORED_ATTRIBUTES = {"file": NOT_YET, "scalegeometry": NOT_YET, "skipgeometry": IGNORED}


def read_link(body: BodyBuilder, element: Element, context: Context, default_mass: MassRule | None) -> None:
    """Read a ``<Body>``: a new link, or one more piece of the link of that name."""
    context.check_attributes(element, LINK_ATTRIBUTES, LINK_IGNORED_ATTRIBUTES)
    name = element.attributes.get("name")
    existing = None if name is None else body.find_link(name)
    link = LinkBuilder(name or "", element.source) if existing is None else body.links[existing]
    scope = _LinkScope(body, link, MassReader(context, default_mass), context)
    context.walk(element, _LINK_TAGS, LINK_IGNORED, scope)
    link.pose = scope.T_scope_offset @ scope.placement.pose
    link.inertial = link_inertial(scope.mass.rule or default_mass, link.geometries)
    link.enabled = not is_false(element.attributes.get("enable", "true"))
    if "type" in element.attributes:
        link.static = element.attributes["type"].lower() == "static"
    if existing is None:
        body.links.append(link)
