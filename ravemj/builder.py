"""The mutable body that readers fill in document order, and that becomes a frozen ``scene.KinBody``.

OpenRAVE re-opens links by name, moves and renames what was read before, and merges nested bodies; only the end
of a body's outermost element settles it. ``BodyBuilder.freeze`` then decides parents, measures the joint values
from the poses of the links, and places the links by them, as OpenRAVE does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ravemj import hierarchy, scene
from ravemj.errors import Diagnostics, Source
from ravemj.joints import measured_value, place_links
from ravemj.transforms import ZERO, Pose, Vec3, rotate, scale

DEFAULT_INERTIAL = scene.Inertial(1.0, ZERO, ((0.4, 0.0, 0.0), (0.0, 0.4, 0.0), (0.0, 0.0, 0.4)))
"""A link without mass properties weighs 1 kg, like a unit sphere."""


@dataclass(slots=True)
class LinkBuilder:
    """A link in the making; ``pose`` is in the frame of the element that is open."""

    name: str
    source: Source
    pose: Pose = field(default_factory=Pose)
    geometries: list[scene.Geometry] = field(default_factory=list[scene.Geometry])
    inertial: scene.Inertial = DEFAULT_INERTIAL
    static: bool = False
    enabled: bool = True


@dataclass(slots=True, kw_only=True)
class JointBuilder:
    """A joint as listed: anchor and axis directions are in the frame of the first listed link."""

    name: str
    kind: scene.JointKind
    links: tuple[int, int]
    T_first_second: Pose
    anchor: Vec3
    axes: tuple[scene.Axis, ...]
    active: bool
    source: Source

    @property
    def fixed(self) -> bool:
        """True for a weld."""
        return all(axis.lower == axis.upper and not axis.circular for axis in self.axes)


@dataclass(slots=True)
class BodyBuilder:
    """A body in the making."""

    is_robot: bool
    source: Source
    name: str = ""
    links: list[LinkBuilder] = field(default_factory=list[LinkBuilder])
    joints: list[JointBuilder] = field(default_factory=list[JointBuilder])
    adjacent: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])

    def find_link(self, name: str) -> int | None:
        """Return the index of the first link of that name, or None."""
        return next((index for index, link in enumerate(self.links) if link.name == name), None)

    def find_link_any_case(self, name: str) -> int | None:
        """Return the index of the first link of that name in any letter case, or None."""
        wanted = name.lower()
        return next((index for index, link in enumerate(self.links) if link.name.lower() == wanted), None)

    def freeze(self, diagnostics: Diagnostics) -> scene.KinBody:
        """Settle the body.

        Args:
            diagnostics: Takes a warning for every value that is moved into its limits.
        """
        active = [joint for joint in self.joints if joint.active]
        listed = active + [joint for joint in self.joints if not joint.active]
        edges = [hierarchy.Edge(joint.links, joint.fixed, joint.active) for joint in listed]
        decided = hierarchy.decide([link.static for link in self.links], edges)
        poses = [link.pose for link in self.links]
        joints = [
            _measured(_directed(joint, swap, index in decided.order), poses, diagnostics)
            for index, (joint, swap) in enumerate(zip(listed, decided.swapped, strict=True))
        ]
        if active:
            place_links(poses, [joints[index] for index in decided.order])
        return scene.KinBody(
            name=self.name,
            is_robot=self.is_robot,
            links=tuple(_frozen_link(link, pose) for link, pose in zip(self.links, poses, strict=True)),
            joints=tuple(joints[: len(active)]),
            passive_joints=tuple(joints[len(active) :]),
            adjacent=tuple(self.adjacent),
            source=self.source,
        )


def _directed(joint: JointBuilder, swap: bool, places_child: bool) -> scene.Joint:
    """Return the joint with parent and child decided; swapping turns its axes round."""
    parent, child = joint.links
    T_parent_child, anchor, axes = joint.T_first_second, joint.anchor, joint.axes
    if swap:
        parent, child = child, parent
        T_parent_child = T_parent_child.inverse()
        anchor = T_parent_child.apply(anchor)
        axes = tuple(replace(axis, direction=scale(rotate(T_parent_child.wxyz, axis.direction), -1.0)) for axis in axes)
    return scene.Joint(
        name=joint.name,
        kind=joint.kind,
        parent=parent,
        child=child,
        T_parent_child=T_parent_child,
        anchor=anchor,
        axes=axes,
        places_child=places_child,
        source=joint.source,
    )


def _measured(joint: scene.Joint, poses: Sequence[Pose], diagnostics: Diagnostics) -> scene.Joint:
    """Return the joint with the values that the poses of its links show, moved into its limits."""
    T_parent_child = poses[joint.parent].inverse() @ poses[joint.child]
    axes = tuple(_measured_axis(joint, axis, T_parent_child, diagnostics) for axis in joint.axes)
    return replace(joint, axes=axes)


def _measured_axis(joint: scene.Joint, axis: scene.Axis, now: Pose, diagnostics: Diagnostics) -> scene.Axis:
    if joint.static:
        return replace(axis, value=0.0)
    measured = measured_value(joint, axis, now)
    value = min(max(measured, axis.lower), axis.upper)
    if value != measured:
        diagnostics.warn(
            "value-outside-limits",
            f"joint '{joint.name}' loads at {value:.6g}, not at {measured:.6g}, which its limits "
            f"[{axis.lower:.6g}, {axis.upper:.6g}] exclude",
            joint.source,
        )
    return replace(axis, value=value)


def _frozen_link(link: LinkBuilder, pose: Pose) -> scene.Link:
    return scene.Link(
        name=link.name,
        T_world_link=pose,
        inertial=link.inertial,
        geometries=tuple(link.geometries),
        static=link.static,
        enabled=link.enabled,
        source=link.source,
    )
