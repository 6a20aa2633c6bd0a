"""``<Robot>``, ``<KinBody>`` and ``<Body>``: scopes that fill one body, in document order.

Nested ``<KinBody>`` and ``<Robot>`` elements and included files add to the body of the outermost element. The transform
of an element is applied once, at its end, to the links created inside it.
"""

from dataclasses import replace

from ravemj.core.transforms import Vec3
from ravemj.errors import SourceError
from ravemj.formats.collada import is_collada
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS, Context, Placed
from ravemj.formats.openrave_xml.geom import GeometryScope
from ravemj.formats.openrave_xml.joint import read_joint
from ravemj.formats.openrave_xml.link import read_link
from ravemj.formats.openrave_xml.mass import DefaultMass
from ravemj.formats.openrave_xml.other_files import add_collada, add_mesh, add_urdf, is_mesh
from ravemj.formats.openrave_xml.prefix import Marks, add_prefix, youngest_first
from ravemj.formats.openrave_xml.robot import check_sensors, read_attached_sensor, read_manipulator
from ravemj.formats.openrave_xml.tags import NO_EFFECT_HERE, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import (
    ChildTransform,
    Numbers,
    hadamard,
    is_true,
    leading_numbers,
    number,
    number_list,
    scale_attribute,
    words,
)
from ravemj.formats.urdf import is_urdf
from ravemj.model.builder import BodyBuilder, GrabBuilder
from ravemj.model.scene import KinBody


class _Scope(Placed):
    """Reading state of a ``<Robot>`` or ``<KinBody>``; ``depth`` is 0 for the outermost one."""

    def __init__(self, body: BodyBuilder, context: Context, scale: Vec3, depth: int, *, skip_geometry: bool) -> None:
        super().__init__(context, ChildTransform(scale=scale))
        self.body = body
        self.scale = scale
        self.depth = depth
        self.skip_geometry = skip_geometry
        self.default_mass = DefaultMass(context)
        self.geometry_scope = GeometryScope(None, scale)
        self.joint_values: list[float] | None = None
        self.transparency: float | None = None

    def read(self, element: Element) -> None:
        """Read an element: its included file, then its children, then the attributes that apply at its end."""
        first_link = len(self.body.links)
        if "file" in element.attributes:
            self._include(element)
        self._join_links(element)
        marks = Marks.of(self.body)
        tags, ignored = (ROBOT_TAGS, ROBOT_IGNORED) if element.tag == "robot" else (KINBODY_TAGS, KINBODY_IGNORED)
        self.context.walk(element, tags, ignored, self)
        self.body.name = element.attributes.get("name", "") or self.body.name  # the last to end with a name gives it
        prefix = element.attributes.get("prefix", "")
        if prefix:
            add_prefix(prefix, self.body, marks, whole=element.tag == "robot")
        if self.transparency is not None:  # of all shapes that the body has so far (geom-35)
            for link in self.body.links:
                link.geometries = [replace(part, transparency=self.transparency) for part in link.geometries]
        if element.tag == "robot":
            self.body.manipulators = youngest_first(self.body.manipulators, marks.manipulators)
            self.body.sensors = youngest_first(self.body.sensors, marks.sensors)
        if self.placement.moves:
            T_outer_scope = self.placement.pose
            for link in self.body.links[first_link:]:
                link.pose = T_outer_scope @ link.pose

    def _include(self, element: Element) -> None:
        """Read the included file of an element as if its root were a nested element."""
        name = element.attributes["file"]
        if is_mesh(name):
            path = self.context.find(name, element.source)
            if path is not None:
                add_mesh(self.body, path, self.scale, element.source, self.context)
            return
        if is_collada(name):
            marks = Marks.of(self.body)
            add_collada(self.body, name, element.source, self.context, self.scale, skip_geometry=self.skip_geometry)
            add_prefix(element.attributes.get("prefix", ""), self.body, marks, whole=True)
            return
        root = self.context.include(element)
        if root is None:
            return
        if is_urdf(root):
            marks = Marks.of(self.body)
            add_urdf(self.body, root, element, self.context, skip_geometry=self.skip_geometry)
            add_prefix(element.attributes.get("prefix", ""), self.body, marks, whole=True)
            return
        self.body.source = root.source if self.depth == 0 else self.body.source
        attributes = {key: value for key, value in element.attributes.items() if key != "file"}
        wrapper = Element(element.tag, element.spelled, attributes, root.source, children=[root], complete=True)
        inner = _Scope(self.body, self.context, self.scale, self.depth + 1, skip_geometry=self.skip_geometry)
        before = self.body.parts()
        try:
            inner.read(wrapper)
        except SourceError as error:
            if self.depth > 0 and (element.tag == "kinbody" or any(before[1:])):
                raise  # the whole body goes (random-xml-143); of a Robot without parts what came before stays (-120)
            self.context.diagnostics.error("broken-file", error.message, error.source, error.hint)
            self.body.set_parts(before)

    def _join_links(self, element: Element) -> None:
        """Read the KinBody attribute ``makeJoinedLinksAdjacent``; the element that opens last has precedence.

        An element that includes a file opens after the root of the file. See the conformance tests gap-17, gap-18 and
        gap-19.
        """
        if element.tag == "robot":
            return
        text = element.attributes.get("makejoinedlinksadjacent")
        values, rest = Numbers([1.0], "") if text is None else leading_numbers(text)
        self.body.joined_links_adjacent = bool(values and int(values[0]))
        if rest or not values:
            message = f'makejoinedlinksadjacent="{text}" counts as 0: OpenRAVE reads a whole number'
            self.context.diagnostics.warn("openrave-bug", message, element.source, "write 1 or 0")

    def nest(self, element: Element) -> None:
        self.context.check_attributes(element, SCOPE_ATTRIBUTES, {})
        scale = hadamard(self.scale, scale_attribute(element, self.context.diagnostics))
        inner = _Scope(self.body, self.context, scale, self.depth + 1, skip_geometry=self.skip_geometry)
        inner.read(element)
        # Those of the Robot win, and those of included files are lost (robot-13, environment-13).
        if self.depth == 0 and element.tag == "kinbody" and self.body.is_robot and self.joint_values is None:
            self.joint_values = inner.joint_values

    def read_default_mass(self, element: Element) -> None:
        self.default_mass.read(element)

    def read_link(self, element: Element) -> None:
        mass = self.default_mass.rule()
        read_link(self.body, element, self.context, mass, self.geometry_scope, skip_geometry=self.skip_geometry)

    def read_grabbed(self, element: Element) -> None:
        self.context.check_attributes(element, GRABBED_ATTRIBUTES, {})
        grabbed = Placed(self.context)
        self.context.walk(element, PLACEMENT_TAGS, {}, grabbed)
        link, body, ignored = (element.attributes.get(name, "") for name in ("link", "body", "ignored"))
        links = [self.body.find_link(name) for name in (link, *ignored.split())]
        known = [self.body.links[index] for index in links if index is not None]
        if None in links:
            message = f"<{element.spelled}> names a link of '{link} {ignored}' that is not above it; it is left out"
            self.context.diagnostics.warn("unknown-body", message, element.source)
        else:
            self.body.grabs.append(GrabBuilder(body, known[0], grabbed.placement.pose, tuple(known[1:])))

    def read_adjacent(self, element: Element) -> None:
        names = words(element.text)[:2]
        links = [link for name in names if (link := self.body.find_link(name)) is not None]
        if len(links) == 2:
            self.body.adjacent.append((min(links), max(links)))
        else:
            message = f"<{element.spelled}> needs the names of two Bodies above it, and holds '{element.text.strip()}'"
            self.context.diagnostics.warn("unknown-body", message, element.source)

    def read_models_folder(self, element: Element) -> None:
        self.geometry_scope = self.geometry_scope._replace(models_folder=element.text.strip())

    def read_transparency(self, element: Element) -> None:
        self.transparency = number(element, self.context.diagnostics)

    def read_joint_values(self, element: Element) -> None:
        self.joint_values = number_list(element, self.context.diagnostics)

    def read_joint(self, element: Element) -> None:
        read_joint(self.body, element, self.context)

    def read_manipulator(self, element: Element) -> None:
        read_manipulator(self.body, element, self.context)

    def read_sensor(self, element: Element) -> None:
        read_attached_sensor(self.body, element, self.context)

    def read_controller(self, element: Element) -> None:
        """Warn that a ``<Controller>`` is ignored; after joints, it is an error as in OpenRAVE (test robot-24)."""
        if self.body.joints:
            hint = "leave it out: robots have a controller without asking"
            raise SourceError("OpenRAVE cannot attach a controller while it reads a robot", element.source, hint)
        message = f"<{element.spelled}> is left out: {NO_EFFECT_HERE}"
        self.context.diagnostics.warn("ignored-tag", message, element.source)


_SCOPE_TAGS: dict[str, Tag[_Scope]] = {
    **PLACEMENT_TAGS,
    "jointvalues": Tag(_Scope.read_joint_values, "values of all DOFs [rad, m]", once=True),
    "grabbed": Tag(_Scope.read_grabbed, "ravemj's own: a body that a link holds, its pose there, and ignored links"),
}
ROBOT_TAGS: dict[str, Tag[_Scope]] = {
    **_SCOPE_TAGS,
    "robot": Tag(_Scope.nest, "nested: adds to the same body"),
    "kinbody": Tag(_Scope.nest, "nested: adds to the same body"),
    "manipulator": Tag(_Scope.read_manipulator, "see below"),
    "attachedsensor": Tag(_Scope.read_sensor, "see below"),
    "controller": Tag(
        _Scope.read_controller,
        "it has no effect on the model; behind joints it ends the reading, as in OpenRAVE",
        left_out=True,
    ),
}
GRABBED_ATTRIBUTES = {"body": "the held body", "link": "the link that holds it", "ignored": "links that may touch it"}
ROBOT_IGNORED = {
    **reasons(NO_EFFECT_HERE, "sendcommand"),
    "conveyorjoint": "a plugin of OpenRAVE's makes links of it that ride along a trajectory; MuJoCo has no such joint",
}
KINBODY_TAGS: dict[str, Tag[_Scope]] = {
    **_SCOPE_TAGS,
    "kinbody": Tag(_Scope.nest, "nested: adds to the same body"),
    "body": Tag(_Scope.read_link, "a link: see below"),
    "joint": Tag(_Scope.read_joint, "see below"),
    "mass": Tag(_Scope.read_default_mass, "the default of the Bodies that follow: see below"),
    "adjacent": Tag(_Scope.read_adjacent, "names of two Bodies that never collide"),
    "modelsdir": Tag(_Scope.read_models_folder, "where meshes of the following Bodies are looked for first"),
    "transparency": Tag(_Scope.read_transparency, "of all shapes, from 0 to 1", once=True),
}
KINBODY_IGNORED = {
    **reasons("OpenRAVE overlooks it here; write it in each Geom", "diffusecolor", "ambientcolor"),
    **reasons(NO_EFFECT_HERE, "sendcommand"),
}
SCOPE_ATTRIBUTES = {
    "name": "name of the body; no spaces",
    "prefix": "put before the names of the parts",
    "file": "read first; XML, or a mesh, which becomes one static link",
    "type": "`CollisionMapRobot` and `Conveyor` are plain bodies here; unknown classes are an error",
    "scalegeometry": "one factor or three, of positions and meshes",
    "skipgeometry": "true: without shapes",
    "srdf": "of a URDF in `file`: its SRDF",
    "state": "of a URDF in `file`: the group state of its SRDF that gives the joint values",
    "packages": "of a URDF in `file`: folders of packages, NAME=FOLDER",
    "makejoinedlinksadjacent": "0: links at a joint can collide",
}


_PLUGIN_CLASSES = {"collisionmaprobot", "conveyor"}
"""Classes of bodies that every OpenRAVE installation has, which are read as plain bodies."""


def read_body(element: Element, context: Context) -> tuple[KinBody, SourceError | None]:
    """Read an outermost ``<Robot>`` or ``<KinBody>``.

    Returns:
        The body, and the error that OpenRAVE raises after adding it to the environment, if any.

    Raises:
        SourceError: OpenRAVE refuses the body before adding it to the environment.
    """
    context.check_attributes(element, SCOPE_ATTRIBUTES, {})
    body = BodyBuilder(element.tag == "robot", element.source)
    skip_geometry = is_true(element.attributes.get("skipgeometry", "false"))
    scope = _Scope(body, context, scale_attribute(element, context.diagnostics), 0, skip_geometry=skip_geometry)
    scope.read(element)
    body.joint_values = scope.joint_values
    _check_type(element, body, context)
    body.check_joint_names()
    check_sensors(body, context.diagnostics)
    return body.freeze(context.diagnostics), body.refusal


def _check_type(element: Element, body: BodyBuilder, context: Context) -> None:
    """Report a ``type`` other than that of a plain body.

    If the element has a type and includes a file, discard the content of the file, as OpenRAVE does.
    """
    kind = element.attributes.get("type")
    if kind is None:
        return
    if "file" in element.attributes:  # errors-49
        message = "OpenRAVE throws away what it read from the file of an element that also has a type"
        context.diagnostics.warn("openrave-bug", message, element.source, "leave out the type")
        body.forget_names()
        body.links.clear()
        body.joints.clear()
        body.manipulators.clear()
        body.sensors.clear()
        body.adjacent.clear()
    if kind.lower() in _PLUGIN_CLASSES:
        message = f"what the class '{kind}' adds to a body is left out"
        context.diagnostics.warn("ignored-type", message, element.source)
    elif kind.lower() not in {"genericrobot", "kinbody", ""}:  # errors-43
        message = f"there is no class '{kind}' for bodies here; read as a plain one"
        context.diagnostics.error("unknown-interface", message, element.source)
