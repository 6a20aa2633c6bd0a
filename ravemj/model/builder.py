"""Mutable body that readers fill in document order, and that becomes a frozen ``scene.KinBody``.

OpenRAVE re-opens links by name, moves and renames parts read before, and merges nested bodies, so a body is final only
at the end of its outermost element. ``BodyBuilder.freeze`` then determines parent links, computes joint values from the
link poses, and sets the link poses by forward kinematics, as OpenRAVE does.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravemj.core.transforms import UNMOVED, ZERO, Pose, Vec3, Wxyz, add, rotate, scale
from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.model import hierarchy, scene
from ravemj.model.joints import displaced_pose, measured_values, place_links
from ravemj.model.limits import clamp
from ravemj.model.manipulators import ManipulatorBuilder, check_reach, freeze_manipulator
from ravemj.model.mimic import Equations, MimicJoints, NamedJoint, leaders, resolve

_ROUNDING = 1e-9  # of values that were degrees

_Z: Vec3 = (0.0, 0.0, 1.0)

DEFAULT_INERTIAL = scene.Inertial(1.0, ZERO, ((0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0.0, 0.0, 0.4)))
"""Mass properties of a link without any: 1 kg, like a unit sphere."""


@dataclass(slots=True)
class LinkBuilder:
    """Link under construction; ``pose`` is in the frame of the enclosing element."""

    name: str
    source: Source
    pose: Pose = UNMOVED
    geometries: list[scene.Geometry] = field(default_factory=lambda: [])
    inertial: scene.Inertial = DEFAULT_INERTIAL
    static: bool = False
    enabled: bool = True
    groups: tuple[tuple[str, tuple[scene.Geometry, ...]], ...] = ()
    parameters: scene.Parameters = scene.NO_PARAMETERS
    self_collision_ignored: bool = False

    def add_to_group(self, name: str, geometries: Iterable[scene.Geometry]) -> None:
        """Add shapes to a geometry group."""
        groups = dict(self.groups)
        groups[name] = (*groups.get(name, ()), *geometries)
        self.groups = tuple(groups.items())


@dataclass(slots=True, kw_only=True)
class JointBuilder:
    """Joint under construction; anchor and axis directions are in the frame of the first listed link.

    Attributes:
        weld_turn: Rotation that converts the axes of a weld to those that OpenRAVE reports; None means the rotation of
            the child in the parent.
    """

    name: str
    kind: scene.JointKind
    links: tuple[int, int]
    T_first_second: Pose
    anchor: Vec3
    axes: tuple[scene.Axis, ...]
    weld_turn: Wxyz | None = None
    enabled: bool
    equations: Equations | None = None
    parameters: scene.Parameters = scene.NO_PARAMETERS
    source: Source

    @property
    def active(self) -> bool:
        """Whether the joint has DOFs."""
        return self.enabled and self.equations is None

    @property
    def fixed(self) -> bool:
        """Whether the joint is a weld."""
        return all(axis.lower >= axis.upper and not axis.circular for axis in self.axes)


class SensorBuilder(NamedTuple):
    """Attached sensor with the name of its link, which is looked up in the finished body.

    In a robot that OpenRAVE rejects, the sensor stays on the link given here.
    """

    sensor: scene.AttachedSensor
    link_name: str | None = None


class GrabBuilder(NamedTuple):
    """Grabbed body by name, and the grabbing link; link indices are determined at the end."""

    body: str
    link: LinkBuilder
    T_link_body: Pose
    ignored: tuple[LinkBuilder, ...]


@dataclass(slots=True)
class BodyBuilder:
    """Body under construction.

    Attributes:
        joint_values: Values of all DOFs given in the file, or None.
        refusal: Reason why OpenRAVE stops reading after this body, although the body exists; or None.
    """

    is_robot: bool
    source: Source
    name: str = ""
    links: list[LinkBuilder] = field(default_factory=lambda: [])
    joints: list[JointBuilder] = field(default_factory=lambda: [])
    adjacent: list[tuple[int, int]] = field(default_factory=lambda: [])
    joined_links_adjacent: bool = True
    manipulators: list[ManipulatorBuilder] = field(default_factory=lambda: [])
    sensors: list[SensorBuilder] = field(default_factory=lambda: [])
    grabs: list[GrabBuilder] = field(default_factory=lambda: [])
    joint_values: list[float] | None = None
    description: str = ""
    element: str = ""
    configurations: list[scene.NamedConfiguration] = field(default_factory=lambda: [])
    refusal: SourceError | None = None
    _first: dict[str, int] = field(default_factory=dict[str, int])  # link of each name, for links before ``_indexed``
    _first_any_case: dict[str, int] = field(default_factory=dict[str, int])
    _indexed: int = 0

    def parts(self) -> "BodyParts":
        """Return the present parts."""
        return BodyParts(
            self.name, [*self.links], [*self.joints], [*self.adjacent], [*self.manipulators], [*self.sensors]
        )

    def set_parts(self, parts: "BodyParts") -> None:
        """Restore parts that ``parts`` returned earlier."""
        self.forget_names()
        self.name, self.links, self.joints, self.adjacent, self.manipulators, self.sensors = parts

    def check_joint_names(self) -> None:
        """Raise an error if two joints have the same name, unless both have no DOF."""
        seen: dict[str, bool] = {}
        for joint in self.joints:
            if joint.name in seen and (joint.active or seen[joint.name]):
                message = (
                    f"there are two joints '{joint.name}'" if joint.name else "there are two joints without a name"
                )
                self.refusal = self.refusal or SourceError(message, joint.source, "give each a name of its own")
            seen[joint.name] = seen.get(joint.name, False) or joint.active

    def find_link(self, name: str) -> int | None:
        """Return the index of the first link of that name, or None."""
        self._index_links()
        return self._first.get(name)

    def find_link_any_case(self, name: str) -> int | None:
        """Return the index of the first link of that name in any letter case, or None."""
        self._index_links()
        return self._first_any_case.get(name.lower())

    def _index_links(self) -> None:
        for index in range(self._indexed, len(self.links)):
            name = self.links[index].name
            self._first.setdefault(name, index)
            self._first_any_case.setdefault(name.lower(), index)
        self._indexed = len(self.links)

    def forget_names(self, first: int = 0) -> None:
        """Forget the names of the links from index ``first`` on, which will be renamed, moved or removed."""
        for link in self.links[first : self._indexed]:
            for names, name in ((self._first, link.name), (self._first_any_case, link.name.lower())):
                if names.get(name, -1) >= first:
                    del names[name]
        self._indexed = min(self._indexed, first)

    def freeze(self, diagnostics: Diagnostics) -> scene.KinBody:
        """Return the finished body, with a warning for every value that is clamped to its limits.

        Raises:
            SourceError: a number is not finite.
        """
        listed = self._in_order()
        has_dofs = bool(listed and listed[0].active)
        named = [
            NamedJoint(joint.name, len(joint.axes) if joint.active else 0, joint.equations, joint.source)
            for joint in listed
        ]
        mimics = resolve(named, diagnostics)
        decided = self._decide(listed, mimics)
        poses = [link.pose for link in self.links]
        joints = [
            _directed(joint, mimics.get(index), swap=swap, places_child=index in decided.order)
            for index, (joint, swap) in enumerate(zip(listed, decided.swapped, strict=True))
        ]
        if has_dofs:
            joints = [
                _welded(joint, built, diagnostics) if built.fixed else joint
                for joint, built in zip(joints, listed, strict=True)
            ]
            joints = self._settled(joints, poses, diagnostics)
            placing = [joints[index] for index in decided.order]
            place_links(poses, placing, [[axis.value for axis in joint.axes] for joint in placing])
        body = self._frozen(poses, joints, sum(built.active for built in listed))
        manipulators = self._frozen_manipulators(body, diagnostics)
        if self.refusal is not None:
            if self.joint_values is not None:  # OpenRAVE does not reach setting them
                self.joint_values = None
                return self.freeze(Diagnostics())
            sensors = tuple(self._sensor(built) for built in self.sensors)
            return replace(body, manipulators=manipulators, sensors=sensors, has_active_manipulator=False)
        return replace(body, manipulators=manipulators) if manipulators else body

    def _frozen_manipulators(self, body: scene.KinBody, diagnostics: Diagnostics) -> tuple[scene.Manipulator, ...]:
        """Return the manipulators with links, joints and DOFs resolved.

        If a joint of an arm does not move its effector, that manipulator has no gripper, and all later manipulators
        have neither links nor gripper, as in OpenRAVE.
        """
        frozen: list[scene.Manipulator] = []
        names: set[str] = set()
        for built in self.manipulators:
            if built.name in names:
                message = f"there already is a manipulator '{built.name}'; by this name, the first one is found"
                diagnostics.warn("repeated-name", message, built.source, "give each a name of its own")
            arm = freeze_manipulator(built, body, diagnostics)
            try:
                check_reach(arm, body)
            except SourceError as error:
                self.refusal = self.refusal or error
                break
            frozen.append(arm)
            names.add(arm.name)
        rest = self.manipulators[len(frozen) :]
        unfinished = [replace(built, gripper_joints=[]) for built in rest[:1]]
        unfinished += [replace(built, base="", effector="", gripper_joints=[]) for built in rest[1:]]
        return (*frozen, *(freeze_manipulator(built, body, Diagnostics()) for built in unfinished))

    def _frozen(self, poses: Sequence[Pose], joints: Sequence[scene.Joint], active: int) -> scene.KinBody:
        """Return the immutable body without manipulators; ``active`` is the number of active joints, listed first."""
        return scene.KinBody(
            name=self.name,
            is_robot=self.is_robot,
            links=tuple(_frozen_link(link, pose) for link, pose in zip(self.links, poses, strict=True)),
            joints=tuple(joints[:active]),
            passive_joints=tuple(joints[active:]),
            adjacent=tuple(self.adjacent),
            joined_links_adjacent=self.joined_links_adjacent,
            sensors=tuple(self._sensor(built) for built in self.sensors),
            grabs=tuple(self._grabs()),
            description=self.description,
            element=self.element,
            configurations=tuple(self.configurations),
            source=self.source,
        )

    def _grabs(self) -> Iterator[scene.Grab]:
        index_of = {id(link): index for index, link in enumerate(self.links)}
        for built in self.grabs:
            if id(built.link) in index_of:
                ignored = tuple(index_of[id(link)] for link in built.ignored if id(link) in index_of)
                link = index_of[id(built.link)]
                yield scene.Grab(body=built.body, link=link, T_link_body=built.T_link_body, ignored=ignored)

    def _sensor(self, built: SensorBuilder) -> scene.AttachedSensor:
        sensor, name = built
        return sensor if name is None or self.refusal is not None else replace(sensor, link=self.find_link(name))

    def _in_order(self) -> list[JointBuilder]:
        """Return the joints in the order: active, disabled, mimic joints."""
        active = [joint for joint in self.joints if joint.active]
        disabled = [joint for joint in self.joints if not joint.enabled]
        return active + disabled + [joint for joint in self.joints if joint.enabled and not joint.active]

    def _decide(self, listed: Sequence[JointBuilder], mimics: dict[int, scene.Mimic]) -> hierarchy.Hierarchy:
        edges: list[hierarchy.Edge] = []
        for index, joint in enumerate(listed):
            mimic = mimics.get(index)
            follows = leaders(mimic.expression) if mimic is not None and mimic.expression is not None else ()
            passive = tuple(leader for leader in follows if not listed[leader].active)
            edges.append(hierarchy.Edge(joint.links, joint.fixed, joint.active, passive))
        return hierarchy.decide([link.static for link in self.links], edges)

    def _settled(
        self, joints: Sequence[scene.Joint], poses: Sequence[Pose], diagnostics: Diagnostics
    ) -> list[scene.Joint]:
        """Return the joints with their initial values, from the link poses or the file, clamped to the limits."""
        values = [list(measured_values(joint, poses[joint.parent].inverse() @ poses[joint.child])) for joint in joints]
        findings = diagnostics if self.joint_values is None else Diagnostics()
        values = _limited(joints, values, findings)
        active = sum(1 for joint in self.joints if joint.active)
        values = self._asked(joints[:active], values, diagnostics)
        firsts = [joint_values[0] for joint_values in values]
        mimic_joints = MimicJoints(joints)
        mimic_joints.evaluate(firsts)
        for mimic in mimic_joints.joints:
            follower = joints[mimic.joint]
            if follower.places_child and math.isnan(firsts[mimic.joint]):
                message = f"the equation of joint '{follower.name}' has no value where the model starts"
                raise SourceError(message, follower.source, "look for a division by 0, or a root of a negative number")
        for mimic in mimic_joints.joints:
            values[mimic.joint][0] = firsts[mimic.joint]
        return [_at_values(joint, joint_values) for joint, joint_values in zip(joints, values, strict=True)]

    def _asked(
        self, active: Sequence[scene.Joint], values: list[list[float]], diagnostics: Diagnostics
    ) -> list[list[float]]:
        """Replace the active joints' values by those of the file's ``<jointvalues>``, if it has any."""
        if self.joint_values is None:
            return values
        dof = sum(len(joint.axes) for joint in active)
        if len(self.joint_values) != dof:
            message = f"<jointvalues> has {len(self.joint_values)} values, and '{self.name}' has {dof} DOFs; no effect"
            diagnostics.warn("number-count", message, self.source)
            return values
        asked = iter(self.joint_values)
        chosen = [[next(asked) for _ in joint.axes] for joint in active]
        return _limited(active, chosen, diagnostics) + values[len(active) :]


class BodyParts(NamedTuple):
    """Mutable parts of a body under construction; see ``BodyBuilder``."""

    name: str
    links: list[LinkBuilder]
    joints: list[JointBuilder]
    adjacent: list[tuple[int, int]]
    manipulators: list[ManipulatorBuilder]
    sensors: list[SensorBuilder]


def _directed(joint: JointBuilder, mimic: scene.Mimic | None, *, swap: bool, places_child: bool) -> scene.Joint:
    """Return the joint with parent and child assigned; ``swap`` exchanges them and reverses the axes."""
    parent, child = joint.links
    T_parent_child, anchor, axes = joint.T_first_second, joint.anchor, joint.axes
    if swap:
        parent, child = child, parent
        T_parent_child = T_parent_child.inverse()
        anchor = T_parent_child.apply(anchor)
        axes = tuple(replace(axis, direction=scale(rotate(T_parent_child.wxyz, axis.direction), -1.0)) for axis in axes)
        if joint.kind == "slider":  # reported is the anchor of the written poses, not of the value 0 (random-xml-104)
            anchor = add(anchor, scale(axes[0].direction, axes[0].reference))
    return scene.Joint(
        name=joint.name,
        kind=joint.kind,
        parent=parent,
        child=child,
        T_parent_child=T_parent_child,
        anchor=anchor,
        axes=axes,
        places_child=places_child,
        mimic=mimic,
        parameters=joint.parameters,
        source=joint.source,
    )


def _welded(joint: scene.Joint, built: JointBuilder, diagnostics: Diagnostics) -> scene.Joint:
    """Return a weld as OpenRAVE reports it: value and limits 0, axes in the child's orientation."""
    T_parent_child = displaced_pose(joint, [0.0] * len(joint.axes))
    if any(axis.lower for axis in joint.axes):
        message = "a joint between whose limits there is nothing does not move; OpenRAVE moves the limits to 0"
        diagnostics.warn("openrave-bug", message, joint.source)
    turn = T_parent_child.wxyz if built.weld_turn is None else built.weld_turn
    is_z = joint.kind == "hinge"  # regardless of the file
    axes = (replace(axis, direction=rotate(turn, _Z if is_z else axis.direction)) for axis in joint.axes)
    axes = tuple(replace(axis, lower=0.0, upper=0.0, reference=0.0) for axis in axes)
    return replace(joint, T_parent_child=T_parent_child, anchor=T_parent_child.position, axes=axes)


def _at_values(joint: scene.Joint, values: Sequence[float]) -> scene.Joint:
    if [axis.value for axis in joint.axes] == values:  # unchanged in most files; copies are slow
        return joint
    return replace(
        joint, axes=tuple(replace(axis, value=value) for axis, value in zip(joint.axes, values, strict=True))
    )


def _limited(
    joints: Sequence[scene.Joint], values: Sequence[list[float]], diagnostics: Diagnostics
) -> list[list[float]]:
    """Clamp values to the joints' limits, with a warning for each change; mimic joints keep theirs."""
    limited: list[list[float]] = []
    for joint, joint_values in zip(joints, values, strict=True):
        if joint.mimic is not None:  # its value will be computed
            limited.append(joint_values)
            continue
        limited.append([clamp(axis, value) for axis, value in zip(joint.axes, joint_values, strict=True)])
        for axis, value, inside in zip(joint.axes, joint_values, limited[-1], strict=True):
            if abs(value - inside) > _ROUNDING:
                diagnostics.warn(
                    "value-outside-limits",
                    f"joint '{joint.name}' loads at {inside:.6g}, not at {value:.6g}, which its limits "
                    f"[{axis.lower:.6g}, {axis.upper:.6g}] exclude",
                    joint.source,
                )
    return limited


def _frozen_link(link: LinkBuilder, pose: Pose) -> scene.Link:
    if not (math.isfinite(sum(pose.position)) and math.isfinite(sum(pose.wxyz))):
        raise SourceError(f"the pose of link '{link.name}' is not finite", link.source, "look for enormous numbers")
    return scene.Link(
        name=link.name,
        T_world_link=pose,
        inertial=link.inertial,
        geometries=tuple(link.geometries),
        static=link.static,
        enabled=link.enabled,
        groups=link.groups,
        parameters=link.parameters,
        self_collision_ignored=link.self_collision_ignored,
        source=link.source,
    )
