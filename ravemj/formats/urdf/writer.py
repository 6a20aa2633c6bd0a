"""Writer of URDF: a body becomes the text of a robot, its SRDF, and its meshes as STL.

URDF's joints rotate about the origin of their child and have one axis, so some joints need additional massless links.
Properties that URDF cannot represent are reported once for each kind.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravemj.core.transforms import UNMOVED, ZERO, Pose, Vec3, add, conjugate, cross, dot, rotate, scale
from ravemj.errors import Diagnostics, OutputError, Source
from ravemj.formats.mjcf.merging import Merging
from ravemj.formats.urdf.rpy import numbers, origin_attributes
from ravemj.formats.urdf.shape_writer import ShapeWriter
from ravemj.formats.urdf.srdf_writer import srdf_text
from ravemj.formats.xml_text import XmlText
from ravemj.model.joints import displaced_pose, moving_direction
from ravemj.model.mimic import leaders
from ravemj.model.scene import AXES, UNLIMITED, Axis, Joint, KinBody, Manipulator, Scene
from ravemj.model.shape_bodies import MASSLESS

WORLD = "world"
_NEAR = 1e-12
_DEFAULTS = Axis((1.0, 0.0, 0.0))


class UrdfDocument(NamedTuple):
    """A robot as text: URDF, SRDF, and the content of its meshes by name."""

    urdf: str
    srdf: str
    meshes: dict[str, bytes]


@dataclass
class Losses:
    """Properties that URDF cannot represent, by kind, with the names of their parts."""

    kinds: dict[str, list[str]] = field(default_factory=dict[str, list[str]])

    def add(self, kind: str, name: str) -> None:
        """Record an omitted property of a part."""
        self.kinds.setdefault(kind, []).append(name)

    def report(self, source: Source, diagnostics: Diagnostics) -> None:
        """Report each kind once."""
        for kind, names in self.kinds.items():
            others = f" (and {len(names) - 1} more)" if len(names) > 1 else ""
            diagnostics.warn("not-written", f"{kind}: '{names[0]}'{others}", source)


class _MimicRelation(NamedTuple):
    """Value of a mimic joint: the leader's value times ``multiplier`` plus ``offset``."""

    leader: str
    multiplier: float
    offset: float


def write(scene: Scene, diagnostics: Diagnostics) -> UrdfDocument:
    """Translate the first robot of a scene or, if there is none, the first body.

    Args:
        scene: The scene.
        diagnostics: Receives a warning for each kind of property that URDF cannot represent.

    Raises:
        OutputError: there is no body.
    """
    bodies = sorted((body for body in scene.bodies if body.links), key=lambda body: not body.is_robot)
    if not bodies:
        raise OutputError("there is no body with links to write")
    losses = Losses()
    for other in bodies[1:]:
        losses.add("URDF holds one robot; other bodies are left out", other.name)
    writer = _UrdfWriter(bodies[0], losses)
    document = writer.write()
    losses.report(bodies[0].source, diagnostics)
    return document


class _UrdfWriter:
    """Writes links, then joints in the order that ``Load`` gives them: moving joints, welds, mimic joints."""

    def __init__(self, body: KinBody, losses: Losses) -> None:
        self.body = body
        self.losses = losses
        self.links = _unique([link.name or f"link{index}" for index, link in enumerate(body.links)])
        self.joints = _unique([joint.name or f"joint{index}" for index, joint in enumerate(body.all_joints)])
        self._taken = set(self.links)
        self._shapes = ShapeWriter()
        self._mimics = {index: self._mimic(joint) for index, joint in enumerate(body.all_joints)}
        moving = [("moves",) if self._moves(index, joint) else () for index, joint in enumerate(body.all_joints)]
        self._merging = Merging(body, moving, merges=False)
        self._moving = {index for index, names in enumerate(moving) if names}
        self._link_lines, self._joint_lines = XmlText(1), XmlText(1)
        self._fixed_lines, self._follower_lines = XmlText(1), XmlText(1)

    def write(self) -> UrdfDocument:
        """Return URDF, SRDF and mesh files of the robot."""
        body, losses = self.body, self.losses
        self._note_losses()
        roots = [link for link in range(len(body.links)) if link not in self._merging.placing]
        if len(roots) > 1:
            world = self._new_link(WORLD)
            for root in roots:
                self._fixed(f"{world}_{self.links[root]}", world, self.links[root], body.links[root].T_world_link)
        elif body.links[roots[0]].T_world_link != UNMOVED:
            losses.add("a URDF does not say where its robot stands; it stands at the origin", body.name)
        for index in range(len(body.links)):
            self._link(index)
        for index, joint in enumerate(body.all_joints):
            if self._merging.placing.get(joint.child) == index:
                self._joint(index, joint)
            else:
                losses.add("URDF has no closed loops; a joint that closes one is left out", joint.name)
        arms = [self._tool(arm) for arm in sorted(body.manipulators, key=lambda arm: not arm.gripper_joints)]
        srdf = srdf_text(self._with_welds(), self.links, self.joints, arms, losses.add)
        document = XmlText()
        with document.inside("robot", name=body.name):
            for part in (self._link_lines, self._joint_lines, self._fixed_lines, self._follower_lines):
                document.append(part)
        return UrdfDocument(document.document(), srdf, self._shapes.meshes)

    def _with_welds(self) -> KinBody:
        """Return the body as URDF represents it: fixed joints become welds, joined links are adjacent."""
        joints = [
            joint if index in self._moving else replace(joint, axes=tuple(map(_without_room, joint.axes)))
            for index, joint in enumerate(self.body.all_joints)
        ]
        count = len(self.body.joints)
        return replace(
            self.body,
            joints=tuple(joints[:count]),
            passive_joints=tuple(joints[count:]),
            joined_links_adjacent=True,
        )

    def _note_losses(self) -> None:
        body, losses = self.body, self.losses
        for joint in body.all_joints:
            if any(axis.armature for axis in joint.axes):
                losses.add("inertias of motors are left out", joint.name)
            if any(axis.value for axis in joint.axes) and joint.mimic is None and not joint.static:
                losses.add("the value of a joint is left out; it starts at 0", joint.name)
        self._note_losses_of_links()

    def _note_losses_of_links(self) -> None:
        body, losses = self.body, self.losses
        for sensor in body.sensors:
            losses.add("sensors are left out", sensor.name)
        for grab in body.grabs:
            losses.add("what a robot holds is left out", grab.body)
        for link in body.links:
            if link.static:
                losses.add("that a link is static is left out", link.name)
            if not link.enabled:
                losses.add("that a link does not collide is left out", link.name)

    def _moves(self, index: int, joint: Joint) -> bool:
        if joint.static or joint.axes[0].direction == ZERO:
            return False
        return index < len(self.body.joints) or joint.equation is not None

    def _mimic(self, joint: Joint) -> _MimicRelation | None:
        """Return the mimic relation of a joint; None if it has none, or URDF cannot represent it, which is reported."""
        equation = joint.equation
        if equation is None:
            return None
        followed = leaders(equation)
        if equation.affine is None or len(followed) != 1:
            self.losses.add("URDF's joints follow multiples of one other joint; this one moves on its own", joint.name)
            return None
        slope = next(iter(equation.affine.slopes.values()))
        return _MimicRelation(self.joints[followed[0]], slope, equation.affine.offset)

    def _new_link(self, name: str) -> str:
        """Write a link without mass and shapes, and return its name."""
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        self._link_lines.element("link", name=name)
        return name

    def _fixed(self, name: str, parent: str, child: str, T_parent_child: Pose) -> None:
        out = self._fixed_lines
        with out.inside("joint", name=name, type="fixed"):
            out.element("origin", **origin_attributes(T_parent_child))
            out.element("parent", link=parent)
            out.element("child", link=child)

    def _link(self, index: int) -> None:
        link = self.body.links[index]
        shapes = self._shapes.elements(link, self.losses.add)
        inertial = link.inertial
        is_massless = inertial == replace(MASSLESS, com=inertial.com) or inertial.undefined
        if inertial.undefined:
            self.losses.add("the mass of a link is undefined and left out", link.name)
        if is_massless and not shapes:
            self._link_lines.element("link", name=self.links[index])
            return
        with self._link_lines.inside("link", name=self.links[index]):
            if not is_massless:
                self._inertial(inertial.com, inertial.mass, inertial.inertia)
            for shape in shapes:
                self._link_lines.append(shape)

    def _inertial(self, com: Vec3, mass: float, tensor: tuple[Vec3, Vec3, Vec3]) -> None:
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor
        out = self._link_lines
        with out.inside("inertial"):
            out.element("origin", **origin_attributes(Pose(com)))
            out.element("mass", value=mass)
            out.element("inertia", ixx=xx, ixy=xy, ixz=xz, iyy=yy, iyz=yz, izz=zz)

    def _joint(self, index: int, joint: Joint) -> None:
        """Write a joint; add massless links if it has several axes or its axis misses the child's origin."""
        name, parent, child = self.joints[index], self.links[joint.parent], self.links[joint.child]
        if index not in self._moving:
            self._fixed(name, parent, child, self._merging.pose_in_parent(joint.child))
            return
        zero = displaced_pose(joint, [0.0] * len(joint.axes))
        axes = _axes(joint)
        if len(axes) > 1:
            self.losses.add("URDF's joints have one axis; this one becomes several", joint.name)
        frame = zero
        if len(axes) > 1 or not _turns_at_origin(joint, zero):
            frame = Pose(joint.anchor, zero.wxyz)
        ends = [self._new_link(f"{name}_axis{place or ''}") for place in range(len(axes) - 1)]
        needs_last = frame is not zero
        if needs_last:
            ends.append(self._new_link(f"{name}_axis{len(axes) - 1 or ''}"))
        ends = ends if needs_last else [*ends, child]
        for place, (axis, end) in enumerate(zip(axes, ends, strict=True)):
            own = name if place == 0 else f"{name}_{place}"
            T_parent_child = frame if place == 0 else UNMOVED
            direction = rotate(conjugate(frame.wxyz), axis.direction)
            begin = parent if place == 0 else ends[place - 1]
            mimic = self._mimics[index] if place == 0 else None
            self._moving_joint(own, (begin, end), T_parent_child, replace(axis, direction=direction), mimic,
                               slides=joint.slides(place))  # fmt: skip
        if needs_last:
            self._fixed(f"{name}_fixed", ends[-1], child, frame.inverse() @ zero)

    def _moving_joint(
        self, name: str, ends: tuple[str, str], origin: Pose, axis: Axis, mimic: _MimicRelation | None, *, slides: bool
    ) -> None:
        out = self._joint_lines if mimic is None else self._follower_lines
        kind = "prismatic" if slides else "continuous" if axis.circular else "revolute"
        with out.inside("joint", name=name, type=kind):
            out.element("origin", **origin_attributes(origin))
            out.element("parent", link=ends[0])
            out.element("child", link=ends[1])
            out.element("axis", xyz=numbers(axis.direction))
            reach = {} if axis.circular else {"lower": axis.lower, "upper": axis.upper}
            rates = {"acceleration": axis.max_acceleration, "jerk": axis.max_jerk}
            defaults = {"acceleration": _DEFAULTS.max_acceleration, "jerk": _DEFAULTS.max_jerk}
            others = {rate: value for rate, value in rates.items() if value != defaults[rate]}
            velocity = axis.max_velocity or _DEFAULTS.max_velocity
            out.element("limit", **reach, effort=axis.max_torque, velocity=velocity, **others)
            if axis.viscous_friction or axis.coulomb_friction:
                out.element("dynamics", damping=axis.viscous_friction, friction=axis.coulomb_friction)
            if mimic is not None:
                out.element("mimic", joint=mimic.leader, multiplier=mimic.multiplier, offset=mimic.offset)

    def _tool(self, arm: Manipulator) -> Manipulator:
        """Return a manipulator whose tool frame is its effector's frame; add a link there if the frames differ."""
        if arm.effector is None or arm.T_effector_tool == UNMOVED:
            return arm
        name = f"{arm.name}_tool"
        link = self._new_link(name)
        self._fixed(f"{link}_fixed", self.links[arm.effector], link, arm.T_effector_tool)
        self.links.append(link)
        return replace(arm, effector=len(self.links) - 1)


def _axes(joint: Joint) -> list[Axis]:
    """Return a joint's axes at the value 0 in the parent's frame, in the order from parent to child."""
    if joint.kind != "spherical" or not joint.is_ball:
        return [replace(joint.axes[0], direction=moving_direction(joint, 0)), *joint.axes[1:]]
    units: Sequence[Vec3] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ends = [(-UNLIMITED, UNLIMITED) for _ in AXES["spherical"]]
    return [
        replace(axis, direction=unit, lower=low, upper=high, circular=True)
        for axis, unit, (low, high) in zip(joint.axes, units, ends, strict=True)
    ]


def _without_room(axis: Axis) -> Axis:
    return replace(axis, lower=0.0, upper=0.0, circular=False)


def _turns_at_origin(joint: Joint, zero: Pose) -> bool:
    """Return whether the joint's axis passes through the child's origin at the value 0; True for sliders."""
    if joint.slides():
        return True
    arm = add(zero.position, scale(joint.anchor, -1.0))
    off = cross(arm, joint.axes[0].direction)
    return dot(off, off) <= _NEAR**2


def _unique(names: Sequence[str]) -> list[str]:
    return list(_distinct(names))


def _distinct(names: Sequence[str]) -> Iterator[str]:
    taken: set[str] = set()
    for name in names:
        unique, number = name, 1
        while unique in taken:
            number += 1
            unique = f"{name}_{number}"
        taken.add(unique)
        yield unique
