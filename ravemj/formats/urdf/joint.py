"""``<joint>``: frames, axes, limits, and mimic joints."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ravemj.core.transforms import Pose, Vec3, not_subnormal, rotate, scale
from ravemj.errors import SourceError
from ravemj.formats.openrave_xml.context import Context, did_you_mean
from ravemj.formats.openrave_xml.tree import Element
from ravemj.formats.urdf.elements import (
    attribute,
    check_children,
    known_name,
    number_of,
    numbers_of,
    only,
    origin_of,
)
from ravemj.model.builder import JointBuilder
from ravemj.model.mimic import Equations
from ravemj.model.scene import UNLIMITED, Axis, JointKind

_KINDS: dict[str, JointKind] = {
    "revolute": "hinge",
    "continuous": "hinge",
    "prismatic": "slider",
    "fixed": "hinge",
    "floating": "hinge",
}
_REFUSED = {"planar": "write two prismatic joints and a continuous one, with links without shapes between them"}
_KNOWN = ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "calibration", "safety_controller")
_FIRST_AXIS: Vec3 = (1.0, 0.0, 0.0)
_WITHOUT_LIMIT = {"revolute": math.pi, "prismatic": 1.0}
"""Upper limits [rad or m] by type of joints without ``<limit>``; the revolute one is or_urdf's."""

_SLOW = 1e-4  # how far the length of an axis may be from 1 without a warning
_ROUNDING = 1e-13
_DEFAULTS = Axis(_FIRST_AXIS)


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint of a URDF.

    Attributes:
        element: Its element.
        name: Its name.
        type: Its URDF type.
        parent: Name of the link that carries it.
        child: Name of the link that it moves.
        T_parent_child: Pose of the child at the value 0.
    """

    element: Element
    name: str
    type: str
    parent: str
    child: str
    T_parent_child: Pose


def read_frame(element: Element, links: Mapping[str, object], context: Context) -> UrdfJoint:
    """Read the links and frames of a joint.

    Raises:
        SourceError: it has no such links, or a type that ravemj cannot represent.
    """
    check_children(element, _KNOWN, context, ("sensor", "gazebo", "hardwareInterface", "transmission"))
    kind = attribute(element, "type")
    if kind not in _KINDS:
        what = f"a joint of type '{kind}' has no counterpart here" if kind in _REFUSED else f"no joint type '{kind}'"
        hint = _REFUSED.get(kind) or did_you_mean(kind, _KINDS) or f"there are: {', '.join(_KINDS)}"
        raise SourceError(what, element.source, hint)
    ends: list[str] = []
    for tag in ("parent", "child"):
        end = only(element, tag, context)
        if end is None:
            raise SourceError(f"joint '{element.attributes['name']}' has no <{tag}>", element.source)
        ends.append(known_name(attribute(end, "link"), links, "link", end))
    if ends[0] == ends[1]:
        raise SourceError(f"joint '{element.attributes['name']}' joins '{ends[0]}' to itself", element.source)
    return UrdfJoint(element, element.attributes["name"], kind, ends[0], ends[1], origin_of(element, context))


def make_joint(joint: UrdfJoint, links: Mapping[str, int], context: Context) -> JointBuilder:
    """Return the joint of a body; ``links`` are indices of links by name."""
    origin, moves = joint.T_parent_child, joint.type != "fixed"
    axis = _axis(joint, context) if moves else Axis(_FIRST_AXIS)
    return JointBuilder(
        name=joint.name,
        kind=_KINDS[joint.type],
        links=(links[joint.parent], links[joint.child]),
        T_first_second=origin,
        anchor=origin.position,
        axes=(replace(axis, direction=rotate(origin.wxyz, axis.direction)),),
        enabled=moves,
        source=joint.element.source,
    )


def _axis(joint: UrdfJoint, context: Context) -> Axis:
    """Return the axis of a joint that moves, in the joint's frame."""
    limits = _limits(joint, context)
    dynamics = only(joint.element, "dynamics", context)
    numbers = {} if dynamics is None else {
        "viscous_friction": number_of(dynamics, "damping", 0.0),
        "coulomb_friction": number_of(dynamics, "friction", 0.0),
    }  # fmt: skip
    return replace(Axis(_direction(joint, context), circular=joint.type == "continuous"), **limits, **numbers)


def _direction(joint: UrdfJoint, context: Context) -> Vec3:
    element = only(joint.element, "axis", context)
    if element is None:
        return _FIRST_AXIS
    x, y, z = numbers_of(element, "xyz", 3)
    axis = not_subnormal((x, y, z))
    length = math.hypot(*axis)
    if length == 0.0:
        raise SourceError(f"the axis of joint '{joint.name}' is 0 0 0", element.source, "write its direction")
    if abs(math.hypot(x, y, z) - 1) > _SLOW:
        message = f"the axis of joint '{joint.name}' has not the length 1; it is normalized"
        context.diagnostics.warn("axis-length", message, element.source)
    is_unit = abs(length - 1) < _ROUNDING  # then it stays as it is, and so does a file that is written again
    return axis if is_unit else scale(axis, 1 / length)


def _limits(joint: UrdfJoint, context: Context) -> dict[str, float]:
    """Return the position, velocity and effort limits of a joint, as fields of ``Axis``."""
    element, diagnostics = only(joint.element, "limit", context), context.diagnostics
    turns = joint.type == "continuous"
    if element is None:
        if turns:
            return {"lower": -UNLIMITED, "upper": UNLIMITED}
        reach = _WITHOUT_LIMIT[joint.type]
        message = f"joint '{joint.name}' has no <limit>; it is read with {-reach:.4g} and {reach:.4g}"
        diagnostics.error("missing-limit", message, joint.element.source, "write its lower, upper, effort and velocity")
        return {"lower": -reach, "upper": reach}
    lower, upper = (number_of(element, name, 0.0) for name in ("lower", "upper"))
    if turns:
        lower, upper = -UNLIMITED, UNLIMITED
    elif lower > upper:
        message = f"the lower limit of joint '{joint.name}' is above the upper one; they are exchanged"
        diagnostics.warn("exchanged-limits", message, element.source)
        lower, upper = upper, lower
    elif lower == upper and only(joint.element, "mimic", context) is None:
        message = f"joint '{joint.name}' cannot move: its lower and upper limits are equal"
        diagnostics.warn("no-room", message, element.source, 'write type="continuous" if it turns without end')
    missing = [name for name in ("effort", "velocity") if name not in element.attributes]
    if missing:
        message = f"the <limit> of joint '{joint.name}' has no {' and no '.join(missing)}, which ROS demands"
        diagnostics.warn("missing-limit", message, element.source)
    return {"lower": lower, "upper": upper, **_rates(joint, element, context)}


def _rates(joint: UrdfJoint, element: Element, context: Context) -> dict[str, float]:
    """Return the effort, velocity, acceleration and jerk limits in a ``<limit>``, as fields of ``Axis``."""
    rates = {"max_torque": abs(number_of(element, "effort", 0.0))}
    velocity = abs(number_of(element, "velocity", _DEFAULTS.max_velocity))
    if not velocity:
        message = f"the velocity limit of joint '{joint.name}' is 0; it counts as {_DEFAULTS.max_velocity:g}"
        context.diagnostics.warn("zero-velocity", message, element.source, "planners could not move it")
    rates["max_velocity"] = velocity or _DEFAULTS.max_velocity
    for name in ("drake:acceleration", "acceleration", "jerk"):
        rate = abs(number_of(element, name, 0.0))
        if rate:
            rates[f"max_{name.removeprefix('drake:')}"] = rate
    return rates


def follow(joints: Mapping[str, UrdfJoint], built: Mapping[str, JointBuilder], context: Context) -> None:
    """Set the mimic equations of joints with ``<mimic>``."""
    for name, joint in joints.items():
        element = only(joint.element, "mimic", context)
        if element is None or joint.type in {"fixed", "floating"}:
            continue
        leader = attribute(element, "joint")
        if leader == name or leader not in built:
            problem = "itself" if leader == name else f"joint '{leader}', which does not exist"
            message = f"joint '{name}' follows {problem}; it moves on its own"
            context.diagnostics.error("bad-mimic", message, element.source, did_you_mean(leader, built))
            continue
        factor, offset = number_of(element, "multiplier", 1.0), number_of(element, "offset", 0.0)
        built[name].equations = Equations(f"{leader}*{factor!r}+{offset!r}", f"|{leader} {factor!r}", "")
        built[name].axes = (_with_room(built[name].axes[0], built[leader].axes[0], factor, offset),)


def _with_room(axis: Axis, leader: Axis, factor: float, offset: float) -> Axis:
    """Return a mimic joint's axis; an empty range is replaced by the range that follows from the leader's."""
    if axis.circular or axis.lower < axis.upper:
        return axis
    lower, upper = sorted((leader.lower * factor + offset, leader.upper * factor + offset))
    return replace(axis, lower=lower, upper=upper)
