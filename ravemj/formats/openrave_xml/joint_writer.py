"""Writer of ``<Joint>``, and the link poses relative to which joint values are defined."""

import math
from collections.abc import Sequence
from dataclasses import replace

from ravemj.core.transforms import UNIT_WXYZ, ZERO, Pose, conjugate, rotate
from ravemj.errors import Diagnostics
from ravemj.formats import settled
from ravemj.formats.openrave_xml.joint import OTHER_NUMBERS
from ravemj.formats.openrave_xml.part_names import PartNames
from ravemj.formats.parameters import write_parameters
from ravemj.formats.xml_text import XmlText
from ravemj.model.joints import poses_at, rests, turns_about_z_of_child
from ravemj.model.limits import clamp
from ravemj.model.scene import Axis, Joint, JointKind, KinBody, Mimic

_NEAR = 1e-9  # of points [m] and of unit vectors
_Z = (0.0, 0.0, 1.0)
_PLAIN = Axis(_Z)
_AXIS_TAGS = {"hinge": ("axis",), "slider": ("axis",), "hinge2": ("axis1", "axis2"), "spherical": ()}
_FIRST_AXES: dict[JointKind, JointKind] = {"rp": "slider", "pr": "hinge", "pp": "slider"}


def listed_poses(body: KinBody) -> list[Pose]:
    """Return the link poses to write, at which every moving joint has its ``<initial>`` value."""
    if not body.joints:
        return [link.T_world_link for link in body.links]
    joints = enumerate(body.all_joints)
    return poses_at(body, [[_initial(body, index, axis) for axis in joint.axes] for index, joint in joints])


def needs_values(body: KinBody) -> bool:
    """Return whether a joint value differs from the ``<initial>`` value moved within the limits."""
    axes = (axis for joint in body.joints if not joint.static for axis in joint.axes)
    return any(axis.value != clamp(axis, axis.reference) for axis in axes)


def _initial(body: KinBody, index: int, axis: Axis) -> float:
    """Return the axis value at which link poses are written: the present value of a fixed joint, else the reference."""
    return axis.value if rests(body, index) else axis.reference


def writable(body: KinBody, diagnostics: Diagnostics) -> KinBody:
    """Return a body with supported joints: of a revolute and a prismatic axis of one joint, the first is kept."""
    joints: list[Joint] = []
    for joint in body.all_joints:
        if joint.kind in _FIRST_AXES:
            message = f"OpenRAVE XML has no joint of the type '{joint.kind}'; of '{joint.name}' the first axis is kept"
            diagnostics.warn("not-written", message, joint.source)
            joint = replace(joint, kind=_FIRST_AXES[joint.kind], axes=joint.axes[:1])  # noqa: PLW2901
        joints.append(joint)
    count = len(body.joints)
    return replace(body, joints=tuple(joints[:count]), passive_joints=tuple(joints[count:]))


class JointWriter:
    """Writes the joints of a body."""

    def __init__(self, out: XmlText, diagnostics: Diagnostics, names: PartNames, poses: Sequence[Pose]) -> None:
        self._out = out
        self._diagnostics = diagnostics
        self._names = names
        self._poses = poses

    def write_all(self, body: KinBody) -> None:
        """Write the active joints and then the passive ones."""
        joints = body.all_joints
        # Followers come behind the disabled joints, unless they are disabled themselves.
        last = max((index for index, joint in enumerate(joints) if joint.mimic is None), default=-1)
        for index, joint in enumerate(joints):
            self._write(body, index, joint, disabled=len(body.joints) <= index <= last)

    def _write(self, body: KinBody, index: int, joint: Joint, *, disabled: bool) -> None:
        attributes = {
            "name": self._names.joints[index],
            "type": joint.kind,
            "enable": False if disabled else None,
            "circular": True if joint.axes[0].circular else None,
            **_equations(joint.mimic, self._names),
        }
        with self._out.inside("Joint", **attributes):
            self._out.element("Body", self._names.links[joint.parent])
            self._out.element("Body", self._names.links[joint.child])
            self._write_frame(body, joint)
            initial = [_initial(body, index, axis) for axis in joint.axes]
            if any(initial):
                self._out.element("initial", initial)
            self._write_numbers(joint)
            write_parameters(self._out, joint.parameters)

    def _write_frame(self, body: KinBody, joint: Joint) -> None:
        """Write anchor and axes of a joint in its parent's frame; those of a slider in that of ``_slider_frame``."""
        frame = self._slider_frame(joint) if joint.kind == "slider" else joint.parent
        self._out.element("offsetfrom", self._names.links[frame])
        turns_with_child = joint.static and len(body.joints) > 0  # OpenRAVE moves the frame of a weld to its child
        if joint.kind != "slider" and not turns_with_child:
            self._out.element("anchor", settled.position(joint.anchor))
        if turns_with_child and joint.kind == "hinge":
            self._check_weld(joint)
            return
        T_frame_parent = self._poses[frame].inverse() @ self._poses[joint.parent]
        turn = conjugate(joint.T_parent_child.wxyz) if turns_with_child else UNIT_WXYZ
        for tag, axis in zip(_AXIS_TAGS[joint.kind], joint.axes, strict=False):
            if axis.direction != ZERO:
                in_frame = rotate(T_frame_parent.wxyz, rotate(turn, axis.direction))
                self._out.element(tag, settled.direction(in_frame))

    def _check_weld(self, joint: Joint) -> None:
        """Warn if a weld's axis is not the child's z axis, which OpenRAVE assigns to welds in XML files."""
        if not turns_about_z_of_child(joint):
            message = f"the axis of the weld '{joint.name}' is left out: in OpenRAVE XML it is the z axis of its child"
            self._diagnostics.warn("not-written", message, joint.source)

    def _slider_frame(self, joint: Joint) -> int:
        """Return the link in whose frame a slider is written.

        It is the child if only the child's origin is at the anchor, else the parent.
        """
        parent, child = self._poses[joint.parent], self._poses[joint.child]
        anchor = parent.apply(joint.anchor)
        near = [math.dist(link.position, anchor) < _NEAR for link in (parent, child)]
        return joint.child if near == [False, True] else joint.parent

    def _write_numbers(self, joint: Joint) -> None:
        axes = joint.axes
        first, others = axes[0], axes[1:]
        if others or not first.circular:  # the numbers of a circular axis take no effect
            limits = [0.0, 0.0] if first.circular else [first.lower, first.upper]
            limits += [limit for axis in others for limit in (axis.lower, axis.upper)]
            self._out.element("limitsrad", limits)
        if any(axis.circular for axis in others):
            message = f"joint '{joint.name}' has another circular axis than the first; in OpenRAVE XML it has limits"
            self._diagnostics.warn("not-written", message, joint.source)
        factor = 1.0 if joint.kind == "slider" else 180 / math.pi
        self._out.element("weight", [axis.weight for axis in axes])
        self._out.element("resolution", [settled.number(axis.resolution * factor) for axis in axes])
        self._out.element("maxvel", [axis.max_velocity for axis in axes])
        self._out.element("maxaccel", [axis.max_acceleration for axis in axes])
        if any(axis.own_torque for axis in axes):
            self._out.element("maxtorque", [axis.own_torque for axis in axes])
        for tag, name in {"maxinertia": "max_inertia", **OTHER_NUMBERS}.items():
            values = [getattr(axis, name) for axis in axes]
            if any(value != getattr(_PLAIN, name) for value in values):
                self._out.element(tag, values)
        if any((first.armature, first.coulomb_friction, first.viscous_friction, first.speed_torques)) or (
            first.joint_torque is not None
        ):
            self._write_motor(first, 1.0 if joint.kind == "slider" else 2 * math.pi)

    def _write_motor(self, axis: Axis, turn: float) -> None:
        with self._out.inside("actuator", type="electric_motor"):
            self._out.element("gear_ratio", 1.0)
            if not axis.speed_torques:
                self._out.element("max_instantaneous_torque", axis.max_torque)
            for speed, torque in axis.speed_torques:
                self._out.element("max_speed_torque_point", [speed / turn, torque])
            self._out.element("rotor_inertia", axis.armature)
            self._out.element("coloumb_friction", axis.coulomb_friction)
            self._out.element("viscous_friction", axis.viscous_friction)


def _equations(mimic: Mimic | None, names: PartNames) -> dict[str, str]:
    if mimic is None:
        return {}
    texts = {"mimic_pos": mimic.position, "mimic_vel": mimic.velocity, "mimic_accel": mimic.acceleration}
    return {name: names.equation(text) for name, text in texts.items() if text}
