"""``<Joint>``: two links, a frame, and the numbers of its axes."""

import math
from dataclasses import dataclass, field, replace

from ravemj.core.transforms import ZERO, Pose, Vec3, not_subnormal, rotate, scale
from ravemj.errors import SourceError
from ravemj.formats.openrave_xml.actuator import GearedMotor, read_motor
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tags import IGNORED, Tag, reasons
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.openrave_xml.values import (
    hadamard,
    is_false,
    leading_numbers,
    number_list,
    numbers,
    scale_attribute,
    vector,
    word,
)
from ravemj.formats.parameters import PARAMETER_MEANING
from ravemj.model.builder import BodyBuilder, JointBuilder
from ravemj.model.mimic import Equations
from ravemj.model.scene import AXES, NO_PARAMETERS, UNLIMITED, Axis, JointKind, Parameters

_KINDS: dict[str, JointKind] = {"hinge": "hinge", "slider": "slider", "hinge2": "hinge2", "spherical": "spherical"}
_DEFAULT_LIMIT: dict[JointKind, float] = {"hinge": math.pi, "slider": 10.0, "hinge2": math.pi, "spherical": 100.0}
_NAMED = 20  # links that an error lists
_PLAIN_AXIS = Axis(ZERO)
_UNIT: tuple[Vec3, Vec3, Vec3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(slots=True)
class _JointElement:
    context: Context
    body: BodyBuilder
    kind: JointKind
    scale: Vec3
    circular: bool  # the first axis
    axes: list[dict[str, float]]
    links: list[int] = field(default_factory=list[int])
    T_scope_frame: Pose = field(default_factory=Pose)
    anchor: Vec3 = ZERO
    directions: dict[int, Vec3] = field(default_factory=dict[int, Vec3])
    stops: bool = False
    motor: GearedMotor | None = None
    negative: dict[str, Element] = field(default_factory=dict[str, Element])
    parameters: Parameters = NO_PARAMETERS

    def read_body(self, element: Element) -> None:
        """Read the name of the joint's first link, then of its second, case-insensitively (test errors-50)."""
        name = word(element, self.context.diagnostics)
        link = self.body.find_link_any_case(name)
        if link is None:
            more = ["…"] if len(self.body.links) > _NAMED else []
            known = ", ".join([link.name for link in self.body.links[:_NAMED]] + more) or "none"
            raise SourceError(f"there is no Body '{name}' before this joint", element.source, f"there are: {known}")
        if len(self.links) > 1:
            message = f"the joint names a third Body, '{name}', which OpenRAVE takes for the second"
            self.context.diagnostics.warn("third-body", message, element.source, "name two")
        self.links = [*self.links[:1], link]

    def read_frame(self, element: Element) -> None:
        self.T_scope_frame = frame_of_link(self.body, element, self.context)

    def read_anchor(self, element: Element) -> None:
        self.anchor = hadamard(self.scale, vector(element, self.context.diagnostics, self.anchor))

    def read_direction(self, element: Element) -> None:
        """Read an axis direction: ``axis`` or, for two axes, ``axis1`` and then ``axis2`` (test random-xml-127)."""
        index = 1 if element.tag == "axis2" else 0
        if self.kind == "hinge2" and index == 1 and 0 not in self.directions:
            raise SourceError(
                f"OpenRAVE refuses <{element.spelled}> before <axis1>", element.source, "write axis1 first"
            )
        if (element.tag == "axis") != (self.kind in {"hinge", "slider"}):  # joint-53
            message = f"<{element.spelled}> has no effect on a joint of type {self.kind}"
            self.context.diagnostics.warn("ignored-tag", message, element.source)
            return
        axis = not_subnormal(vector(element, self.context.diagnostics, self.directions.get(index, ZERO)))
        length = math.hypot(*axis)
        if length == 0.0:  # errors-27
            raise SourceError("the axis of a joint cannot be 0 0 0", element.source)
        self.directions[index] = scale(axis, 1 / length)

    def read_limits(self, element: Element) -> None:
        """Read a pair of limits for each axis; ``limitsdeg`` is in degrees, except for prismatic axes."""
        if self.stops:  # errors-31
            raise SourceError(f"<{element.spelled}> cannot be mixed with <lostop> and <histop>", element.source)
        values = number_list(element, self.context.diagnostics)
        wanted = 2 * len(self.axes)
        if len(values) != wanted:  # joint-14
            message = f"<{element.spelled}> holds {len(values)} numbers where {wanted} should stand; it has no effect"
            self.context.diagnostics.warn("number-count", message, element.source)
            return
        factor = math.pi / 180 if element.tag == "limitsdeg" and self.kind != "slider" else 1.0
        for index, axis in enumerate(self.axes):
            lower, upper = sorted(value * factor for value in values[2 * index : 2 * index + 2])  # joint-12
            if not self.circular or index > 0:
                axis.update(lower=lower, upper=upper)
            elif (lower, upper) != (0.0, 0.0):  # as ravemj writes them, where other axes have limits
                message = f"<{element.spelled}> has no effect on a circular joint"
                self.context.diagnostics.warn("ignored-tag", message, element.source)

    def read_stop(self, element: Element) -> None:
        """Read the deprecated ``lostop`` or ``histop`` [deg, sliders: m], which reverses all axes (test joint-17)."""
        factor = 1.0 if self.kind == "slider" else math.pi / 180
        limit = "lower" if element.tag == "lostop" else "upper"
        before = [axis[limit] for axis in self.axes]
        values = numbers(element, len(self.axes), self.context.diagnostics, before)
        for index, value in enumerate(values):
            if not self.circular or index > 0:
                self.axes[index][limit] = value * factor
        self.stops = True

    def read_resolution(self, element: Element) -> None:
        """Read the resolution of each axis, or one number for all axes (test gap-38)."""
        self._set_all(element, "resolution", 1.0 if self.kind == "slider" else math.pi / 180)
        if len(leading_numbers(element.text).values) == 1:
            for axis in self.axes:
                axis["resolution"] = self.axes[0]["resolution"]

    def read_number(self, element: Element) -> None:
        self._set_all(element, _NUMBERS[element.tag], math.pi / 180 if element.tag.endswith("deg") else 1.0)

    def read_actuator(self, element: Element) -> None:
        self.motor = read_motor(element, self.context)

    def read_parameter(self, element: Element) -> None:
        self.parameters = self.context.with_parameter(self.parameters, element)

    def _set_all(self, element: Element, name: str, factor: float) -> None:
        """Read a number for each axis, by default the axis's value so far; multiply it by ``factor`` (test gap-38)."""
        before = [axis[name] if name in axis else float(getattr(_PLAIN_AXIS, name)) for axis in self.axes]
        values = numbers(element, len(self.axes), self.context.diagnostics, before)
        if name in _NOT_NEGATIVE:
            self.negative.pop(name, None)  # a later number that is none makes up for it (random-xml-24)
            if min(values) < 0:
                self.negative[name] = element
        for axis, value in zip(self.axes, values, strict=True):
            axis[name] = value * factor


OTHER_NUMBERS = {
    "hardmaxvel": "hard_max_velocity",
    "hardmaxaccel": "hard_max_acceleration",
    "maxjerk": "max_jerk",
    "hardmaxjerk": "hard_max_jerk",
    "wrapoffset": "wrap_offset",
}
"""Fields of ``Axis`` by the tags of rare numbers; all tags but the first are ravemj's own."""

_NUMBERS = {
    "initial": "reference",
    "weight": "weight",
    "maxvel": "max_velocity",
    "maxveldeg": "max_velocity",
    "maxaccel": "max_acceleration",
    "maxacceldeg": "max_acceleration",
    "maxtorque": "max_torque",
    "maxinertia": "max_inertia",
    **OTHER_NUMBERS,
}
_NOT_NEGATIVE = {"max_velocity", "max_acceleration", "max_torque", "max_inertia"}

JOINT_TAGS: dict[str, Tag[_JointElement]] = {
    "body": Tag(_JointElement.read_body, "twice: the names of the Bodies that it joins"),
    "offsetfrom": Tag(_JointElement.read_frame, "name of the Body that anchor and axis are relative to", once=True),
    "anchor": Tag(_JointElement.read_anchor, "a point on the axis [m]", once=True),
    "axis": Tag(_JointElement.read_direction, "direction x y z, of a hinge or slider", once="axis"),
    "axis1": Tag(_JointElement.read_direction, "first axis of a hinge2", once="axis1"),
    "axis2": Tag(_JointElement.read_direction, "second axis of a hinge2", once="axis2"),
    "limits": Tag(_JointElement.read_limits, "lower and upper [rad, m]", once=True),
    "limitsrad": Tag(_JointElement.read_limits, "lower and upper [rad, m]", once=True),
    "limitsdeg": Tag(_JointElement.read_limits, "lower and upper [deg; of a slider m]", once=True),
    "lostop": Tag(_JointElement.read_stop, "deprecated: lower limit [deg, m]; turns the axis round"),
    "histop": Tag(_JointElement.read_stop, "deprecated: upper limit [deg, m]; turns the axis round"),
    "initial": Tag(_JointElement.read_number, "the value at the poses of the file [rad, m]", once="initial"),
    "parameter": Tag(_JointElement.read_parameter, PARAMETER_MEANING),
    "weight": Tag(_JointElement.read_number, "in distances between configurations", once="weight"),
    "resolution": Tag(_JointElement.read_resolution, "step of planners [deg, m]", once=True),
    "maxvel": Tag(_JointElement.read_number, "[rad/s, m/s]", once="maxvel"),
    "maxveldeg": Tag(_JointElement.read_number, "[deg/s]", once="maxvel"),
    "maxaccel": Tag(_JointElement.read_number, "[rad/s², m/s²]", once="maxaccel"),
    "maxacceldeg": Tag(_JointElement.read_number, "[deg/s²]", once="maxaccel"),
    "maxtorque": Tag(_JointElement.read_number, "[N m, N]", once="maxtorque"),
    "maxinertia": Tag(_JointElement.read_number, "[kg m², kg]; 0: unknown", once="maxinertia"),
    "hardmaxvel": Tag(_JointElement.read_number, "what planners never exceed [rad/s, m/s]; 0: nothing"),
    **dict.fromkeys(
        ("hardmaxaccel", "maxjerk", "hardmaxjerk", "wrapoffset"),
        Tag(_JointElement.read_number, "ravemj's own, named like OpenRAVE's getter"),
    ),
    "actuator": Tag(_JointElement.read_actuator, "see below"),
}
JOINT_IGNORED = {
    **reasons(IGNORED, "maxforce", "mode", "axis3"),
}
JOINT_ATTRIBUTES = {
    "name": "name of the joint",
    "type": "hinge, slider, hinge2, spherical; OpenRAVE refuses universal, and takes others for a hinge",
    "enable": "false: passive, without a DOF",
    "circular": "true: the first axis turns without end",
    "scalegeometry": "one factor or three, of the anchor",
    "mimic_pos": "equation of the value that it follows",
    "mimic_vel": "its partial derivatives",
    "mimic_accel": "its second derivatives",
    "mimic": "deprecated: joint, factor and offset",
}


def read_joint(body: BodyBuilder, element: Element, context: Context) -> None:
    """Read a ``<Joint>`` and append it to the body.

    Raises:
        SourceError: it names links that do not exist, or has impossible numbers.
    """
    context.check_attributes(element, JOINT_ATTRIBUTES, {})
    if element.attributes.get("type", "").lower() == "universal":  # the body stays (joint-22)
        body.refusal = SourceError("OpenRAVE refuses joints of type 'universal'", element.source, "write two hinges")
        return
    kind = _read_kind(element, context)
    circular = not is_false(element.attributes.get("circular", "false"))
    spans = [UNLIMITED if circular and index == 0 else _DEFAULT_LIMIT[kind] for index in range(len(AXES[kind]))]
    limits: list[dict[str, float]] = [{"lower": -span, "upper": span} for span in spans]
    reader = _JointElement(context, body, kind, scale_attribute(element, context.diagnostics), circular, limits)
    context.walk(element, JOINT_TAGS, JOINT_IGNORED, reader)
    for limit in reader.negative.values():
        raise SourceError(f"<{limit.spelled}> is {limit.text.strip()}, and cannot be negative", limit.source)
    if len(reader.links) != 2:
        raise SourceError(
            f"the joint names {len(reader.links)} bodies; a joint needs two", element.source, "add <Body> elements"
        )
    if reader.links[0] == reader.links[1]:  # errors-14
        body.refusal = SourceError("the joint names the same body twice", element.source)
        return
    first, second = reader.links
    # Of a static and another link the static one comes first, and link 0 stays where it is (gap-07, joint-29).
    exchanged = first != 0 and body.links[second].static and not body.links[first].static
    if exchanged:
        first, second = second, first
    T_first_scope = body.links[first].pose.inverse()
    T_first_frame = T_first_scope @ reader.T_scope_frame
    axes = tuple(
        replace(
            Axis(_direction(reader, index, T_first_frame, exchanged=exchanged), circular=circular and index == 0),
            **numbers,
        )
        for index, numbers in enumerate(reader.axes)
    )
    if reader.motor is not None:
        axes = tuple(reader.motor.driven(axis, turns=kind != "slider") for axis in axes)
    body.joints.append(
        JointBuilder(
            name=element.attributes.get("name", ""),
            kind=kind,
            links=(first, second),
            T_first_second=T_first_scope @ body.links[second].pose,
            anchor=T_first_frame.apply(ZERO if kind == "slider" else reader.anchor),  # dropped, as in random-xml-0
            axes=axes,
            enabled=not is_false(element.attributes.get("enable", "true")),
            equations=_equations(element, context),
            parameters=reader.parameters,
            source=element.source,
        )
    )


def _direction(reader: _JointElement, index: int, frame: Pose, *, exchanged: bool) -> Vec3:
    """Return the direction of a joint's axis, or OpenRAVE's default direction, in the first link's frame.

    If the two links were ``exchanged``, a given direction is reversed. The default is z, whatever the order of the
    links (test errors-26); a slider without an axis gets the zero vector and does not move.
    """
    direction = _UNIT[index] if reader.kind == "spherical" else reader.directions.get(index)
    if direction is not None:
        turned = rotate(frame.wxyz, direction)
        return scale(turned, -1.0) if reader.stops != exchanged else turned
    if reader.kind == "slider":
        return ZERO
    return _UNIT[index] if reader.kind == "hinge2" else _UNIT[2]


def frame_of_link(body: BodyBuilder, element: Element, context: Context) -> Pose:
    """Return the pose of the link named by an ``<offsetfrom>``; an unknown name is ignored (tests errors-29, -30)."""
    name = word(element, context.diagnostics)
    link = body.find_link(name)
    if link is None:
        message = f"there is no Body '{name}' to take an offset from; read as if the tag were not there"
        context.diagnostics.error("unknown-body", message, element.source)
        return Pose()
    return body.links[link].pose


def _read_kind(element: Element, context: Context) -> JointKind:
    kind = element.attributes.get("type", "hinge").lower()
    if kind not in _KINDS:
        message = f"there is no joint of type '{kind}'; OpenRAVE takes a hinge"
        context.diagnostics.warn("unknown-type", message, element.source)
    return _KINDS.get(kind, "hinge")


def _equations(element: Element, context: Context) -> Equations | None:
    attributes = element.attributes
    if any(name.startswith("mimic_") for name in attributes):
        return Equations(*(attributes.get(f"mimic_{part}", "") for part in ("pos", "vel", "accel")))
    if "mimic" not in attributes:
        return None
    from ravemj.model.expressions import ExpressionError, linear_mimic  # noqa: PLC0415 - deprecated, so rarely wanted

    try:
        return Equations(*linear_mimic(attributes["mimic"]))
    except ExpressionError as error:
        context.diagnostics.warn("bad-mimic", error.message, element.source)
        return Equations()
