"""``<Joint>``: two links, a frame, and the numbers of its axis."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from ravemj.builder import BodyBuilder, JointBuilder
from ravemj.errors import SourceError
from ravemj.openrave_xml.context import IGNORED, NOT_YET, Context, reasons
from ravemj.openrave_xml.tree import Element
from ravemj.openrave_xml.values import is_false, leading_numbers, number, vector, word
from ravemj.scene import UNLIMITED, Axis, JointKind
from ravemj.transforms import ZERO, Pose, Vec3, dot, rotate, scale

_KINDS: dict[str, JointKind] = {"hinge": "hinge", "slider": "slider"}
_UNSUPPORTED_KINDS = {"hinge2", "spherical", "universal"}
_DEFAULT_LIMIT = {"hinge": math.pi, "slider": 10.0}


@dataclass(slots=True)
class _JointReader:
    """What the children of a ``<Joint>`` have said so far."""

    context: Context
    body: BodyBuilder
    kind: JointKind
    axis: Axis
    links: list[int] = field(default_factory=list[int])
    T_scope_frame: Pose = field(default_factory=Pose)
    anchor: Vec3 = ZERO
    direction: Vec3 | None = None

    def read_body(self, element: Element) -> None:
        """Take the first name for the first link and every later one for the second."""
        name = word(element)
        link = self.body.find_link_any_case(name)
        if link is None:
            known = ", ".join(link.name for link in self.body.links) or "none"
            raise SourceError(f"there is no Body '{name}' before this joint", element.source, f"there are: {known}")
        self.links[1:] = [link] if self.links else []
        self.links[:1] = self.links[:1] or [link]

    def read_frame(self, element: Element) -> None:
        self.T_scope_frame = frame_of_link(self.body, element, self.context)

    def read_anchor(self, element: Element) -> None:
        self.anchor = vector(element, self.context.diagnostics)

    def read_direction(self, element: Element) -> None:
        x, y, z = vector(element, self.context.diagnostics)
        length = math.sqrt(dot((x, y, z), (x, y, z)))
        if length == 0.0:
            raise SourceError("the axis of a joint cannot be 0 0 0", element.source)
        self.direction = scale((x, y, z), 1 / length)

    def read_limits(self, element: Element) -> None:
        """Read two numbers; in degrees for a hinge's ``limitsdeg``."""
        values = leading_numbers(element.text).values
        if len(values) != 2:
            message = f"<{element.spelled}> holds {len(values)} numbers where 2 should stand; it has no effect"
            self.context.diagnostics.warn("number-count", message, element.source)
            return
        factor = math.pi / 180 if element.tag == "limitsdeg" and self.kind != "slider" else 1.0
        lower, upper = sorted(value * factor for value in values)
        if not self.axis.circular:
            self.axis = replace(self.axis, lower=lower, upper=upper)
        elif (lower, upper) != (0.0, 0.0):
            message = f"<{element.spelled}> has no effect on a circular joint"
            self.context.diagnostics.warn("ignored-tag", message, element.source)

    def read_initial(self, element: Element) -> None:
        self.axis = replace(self.axis, reference=number(element, self.context.diagnostics))

    def read_weight(self, element: Element) -> None:
        self.axis = replace(self.axis, weight=number(element, self.context.diagnostics, 1.0))

    def read_resolution(self, element: Element) -> None:
        factor = 1.0 if self.kind == "slider" else math.pi / 180
        self.axis = replace(self.axis, resolution=number(element, self.context.diagnostics) * factor)

    def read_max_velocity(self, element: Element) -> None:
        self.axis = replace(self.axis, max_velocity=self._not_negative(element))

    def read_max_acceleration(self, element: Element) -> None:
        self.axis = replace(self.axis, max_acceleration=self._not_negative(element))

    def read_max_torque(self, element: Element) -> None:
        self.axis = replace(self.axis, max_torque=self._not_negative(element))

    def _not_negative(self, element: Element) -> float:
        value = number(element, self.context.diagnostics)
        if value < 0:
            raise SourceError(f"<{element.spelled}> is {value:g}, and cannot be negative", element.source)
        return value * (math.pi / 180 if element.tag.endswith("deg") else 1.0)


JOINT_TAGS: dict[str, Callable[[_JointReader, Element], None]] = {
    "body": _JointReader.read_body,
    "offsetfrom": _JointReader.read_frame,
    "anchor": _JointReader.read_anchor,
    "axis": _JointReader.read_direction,
    "limits": _JointReader.read_limits,
    "limitsrad": _JointReader.read_limits,
    "limitsdeg": _JointReader.read_limits,
    "initial": _JointReader.read_initial,
    "weight": _JointReader.read_weight,
    "resolution": _JointReader.read_resolution,
    "maxvel": _JointReader.read_max_velocity,
    "maxveldeg": _JointReader.read_max_velocity,
    "maxaccel": _JointReader.read_max_acceleration,
    "maxacceldeg": _JointReader.read_max_acceleration,
    "maxtorque": _JointReader.read_max_torque,
}
JOINT_IGNORED = {
    **reasons(IGNORED, "maxforce", "mode", "axis3"),
    **reasons(NOT_YET, "axis1", "axis2", "lostop", "histop", "hardmaxvel", "maxinertia", "actuator"),
}
JOINT_ATTRIBUTES = {"name", "type", "enable", "circular"}
JOINT_IGNORED_ATTRIBUTES = reasons(NOT_YET, "mimic_pos", "mimic_vel", "mimic_accel", "mimic", "scalegeometry")


def read_joint(body: BodyBuilder, element: Element, context: Context) -> None:
    """Read a ``<Joint>`` and append it to the body."""
    context.check_attributes(element, JOINT_ATTRIBUTES, JOINT_IGNORED_ATTRIBUTES)
    kind = _read_kind(element, context)
    circular = not is_false(element.attributes.get("circular", "false"))
    limit = UNLIMITED if circular else _DEFAULT_LIMIT[kind]
    reader = _JointReader(context, body, kind, Axis(ZERO, lower=-limit, upper=limit, circular=circular))
    context.walk(element, JOINT_TAGS, JOINT_IGNORED, reader)
    if len(reader.links) != 2:
        raise SourceError(
            f"the joint names {len(reader.links)} bodies; a joint needs two", element.source, "add <Body> elements"
        )
    first, second = (body.links[index].pose for index in reader.links)
    T_first_frame = first.inverse() @ reader.T_scope_frame
    if reader.direction is not None:
        direction = rotate(T_first_frame.wxyz, reader.direction)
    else:
        direction = (0.0, 0.0, 1.0) if kind == "hinge" else ZERO
    body.joints.append(
        JointBuilder(
            name=element.attributes.get("name", ""),
            kind=kind,
            links=(reader.links[0], reader.links[1]),
            T_first_second=first.inverse() @ second,
            anchor=T_first_frame.apply(reader.anchor),
            axes=(replace(reader.axis, direction=direction),),
            active=not is_false(element.attributes.get("enable", "true")) and "mimic_pos" not in element.attributes,
            source=element.source,
        )
    )


def frame_of_link(body: BodyBuilder, element: Element, context: Context) -> Pose:
    """Return the pose of the link that an ``<offsetfrom>`` names; an unknown one counts as absent."""
    name = word(element)
    link = body.find_link(name)
    if link is None:
        message = f"there is no Body '{name}' to take an offset from; read as if the tag were not there"
        context.diagnostics.error("unknown-body", message, element.source)
        return Pose()
    return body.links[link].pose


def _read_kind(element: Element, context: Context) -> JointKind:
    kind = element.attributes.get("type", "hinge").lower()
    if kind in _UNSUPPORTED_KINDS:
        raise SourceError(f"a joint of type '{kind}' cannot be translated: {NOT_YET}", element.source)
    if kind not in _KINDS:
        message = f"there is no joint of type '{kind}'; OpenRAVE takes a hinge"
        context.diagnostics.warn("unknown-type", message, element.source)
    return _KINDS.get(kind, "hinge")
