"""``<kinematics_model>``: links and joints of a body."""

import re
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import (
    UNIT_WXYZ,
    Floats,
    Pose,
    Wxyz,
    multiply,
    rotate,
    wxyz_from_axis_angle,
)
from ravemj.formats.collada.axis import AxisReader
from ravemj.formats.collada.bindings import Bindings
from ravemj.formats.collada.extras import own_techniques
from ravemj.formats.collada.formulas import read_formulas
from ravemj.formats.collada.geometry import GeometryReader
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.physics import NO_MASS, PhysicsScenes
from ravemj.formats.collada.visual import Node, read_pose, rigid_part
from ravemj.formats.meshes.collada.document import Element, child, children, local_name
from ravemj.model.builder import BodyBuilder, JointBuilder, LinkBuilder
from ravemj.model.scene import AXES, JointKind

_MAX_LINKS = 20_000
_SHIFT = 1e-6  # of nodes, below which nobody sees it
_KINDS: dict[str, JointKind] = {axes: kind for kind, axes in AXES.items() if kind != "spherical"}
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.:/-]")


def valid_name(name: str | None) -> str:
    """Replace characters that OpenRAVE does not allow in names by ``_``."""
    return _NOT_IN_NAMES.sub("_", name or "")


Infos = dict[Element, tuple[Element, Element | None]]
"""For each axis, its ``<axis_info>`` in the kinematics system and in the motion system."""


class SceneContext(NamedTuple):
    """Data shared by all bodies of a kinematics scene."""

    library: Library
    bindings: Bindings
    physics: PhysicsScenes
    geometry: GeometryReader


class Names:
    """Names in use, each with its next numeric suffix."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._next = dict.fromkeys(taken, 1)

    def give(self, name: str) -> str:
        """Reserve and return a unique name: the given one, with a numeric suffix if it is in use."""
        unused = name
        while unused in self._next:
            unused = f"{name}_{self._next[name]}"
            self._next[name] += 1
        self._next[unused] = 1
        return unused


class _FoundJoint(NamedTuple):
    """Joint to which an attachment refers.

    Attributes:
        keys: All elements that represent the joint.
        built: The joint.
        values: Bound values of the joint's axes.
        place: Index of the joint's first DOF in the file.
    """

    keys: tuple[Element, ...]
    built: JointBuilder
    values: list[float]
    place: float


_LoopEnd = tuple[Element, int]
"""Attachment of a joint that closes a kinematic loop, and the index of the link that contains it."""


class ModelReader:
    """Reads one instance of a kinematics model into a body.

    Attributes:
        model: The ``<kinematics_model>``.
        links: Indices of links, by ``<link>``.
        joints: Indices of joints, by ``<joint>`` or ``<instance_joint>``, and by axis.
        values: Bound values of the axes of each joint, in the order of the body's joints.
        ends: The ends of joints that close loops.
    """

    def __init__(
        self, scene: SceneContext, body: BodyBuilder, owner: Element, instance: Element, model: Element, infos: Infos
    ) -> None:
        self._scene = scene
        self._library = scene.library
        self._body = body
        self._owner = owner
        self._instance = instance
        self.model = model
        self._infos = infos
        self._root = scene.bindings.node_of(owner, instance, model)
        self._T_world_root = Pose()
        self.links: dict[Element, int] = {}
        self.joints: dict[Element, int] = {}
        self.values: list[list[float]] = []
        self._found: list[_FoundJoint] = []
        self.ends: list[_LoopEnd] = []
        self._link_names = Names(link.name for link in body.links)
        self._dummies = 0

    def read(self) -> None:
        """Read all links, each with its child links."""
        common = child(self.model, "technique_common")
        for link in children(common, "link"):
            parent = None if self._root is None else self._root.parent
            T_world_parent = Pose() if parent is None else rigid_part(parent.world, self._library.source(link))
            self._T_world_root = T_world_parent @ read_pose(self._library, link)
            self._read_link(link, self._root, self._T_world_root)

    def settle(self, others: "list[ModelReader]") -> None:
        """Add joints and mimic equations to the body, after all models of the body are read.

        ``others`` are the readers of these models.
        """
        self._close_loops([end for reader in others for end in reader.ends])
        for joint in sorted(self._found, key=lambda joint: joint.place):  # OpenRAVE's order, where it wrote one
            self.joints |= dict.fromkeys(joint.keys, len(self._body.joints))
            self.values.append(joint.values)
            self._body.joints.append(joint.built)
        read_formulas(self._library, self.model, self.joints, self._body)

    def _close_loops(self, ends: "list[_LoopEnd]") -> None:
        """Add the joints that close kinematic loops, if ravemj wrote them; OpenRAVE's reader ignores all."""
        for start, parent in self.ends:
            path = start.get("joint")
            if next(own_techniques(start), None) is None:
                message = "OpenRAVE does not close the loop of this attachment, and neither does ravemj"
                self._library.warn("ignored-tag", message, start)
            elif local_name(start) == "attachment_start":
                others = (end for end in ends if end[0] is not start and end[0].get("joint") == path)
                end, child_link = next(others, (None, 0))
                if end is None:
                    raise self._library.error("the other end of the loop is missing", start)
                T_parent_frame = read_pose(self._library, start)
                T_parent_child = T_parent_frame @ read_pose(self._library, end).inverse()
                self._add_joint(start, (parent, child_link), T_parent_frame, T_parent_child)

    def _read_link(self, element: Element, node: Node | None, T_world_link: Pose) -> None:
        if len(self._body.links) >= _MAX_LINKS:
            raise self._library.error(f"the body has more than {_MAX_LINKS} links", element)
        link = LinkBuilder(
            self._link_name(element.get("name")), self._library.source(element), T_world_link, inertial=NO_MASS
        )
        index = len(self._body.links)
        self._body.links.append(link)
        self.links[element] = index
        rigid_body = self._scene.physics.of(node)
        if rigid_body is not None:
            link.inertial = rigid_body.inertial(self._library, T_world_link, self._T_world_root)
            link.static = rigid_body.static
        if node is not None:
            self._read_shapes(link, node, T_world_link)
        for attachment in children(element, "attachment_full", "attachment_start", "attachment_end"):
            if local_name(attachment) == "attachment_full":
                self._read_attachment(attachment, index, T_world_link)
            else:
                self.ends.append((attachment, index))

    def _link_name(self, name: str | None) -> str:
        if not name:
            name = f"__dummy{self._dummies}"
            self._dummies += 1
        return self._link_names.give(valid_name(name))

    def _read_shapes(self, link: LinkBuilder, node: Node, T_world_link: Pose) -> None:
        T_link_world = T_world_link.inverse().matrix()

        def pose_in_link(inner: Node) -> Floats:
            if np.abs(T_link_world @ inner.world - np.eye(4)).max() > _SHIFT:
                message = "OpenRAVE draws the triangles of this node as if it had no pose of its own in its link"
                self._library.warn("openrave-bug", message, inner.element, "put the transforms into the vertices")
            return T_link_world @ self._world(inner)

        link.geometries += self._scene.geometry.read(node, pose_in_link, self._scene.bindings.moved)

    def _world(self, node: Node) -> Floats:
        """Return the 4x4 pose of a node in the world as OpenRAVE composes it.

        Below the root link's node, it is the pose of the root link times the transforms from there down to the node.
        For shapes of the root link's node itself, the node's transform is applied twice.
        """
        path = [*node.around()]
        if self._root not in path:
            return node.world
        below = path[: path.index(self._root)] or [node]
        world = self._T_world_root.matrix()
        for inner in reversed(below):
            world = world @ inner.transform
        return world

    def _read_attachment(self, element: Element, parent: int, T_world_parent: Pose) -> None:
        inner = child(element, "link")
        if inner is None:
            self._library.warn("no-link", "there is no link in it; it is left out", element)
            return
        T_parent_frame = read_pose(self._library, element)
        T_parent_child = T_parent_frame @ read_pose(self._library, inner)
        node = self._add_joint(element, (parent, len(self._body.links)), T_parent_frame, T_parent_child)
        self._read_link(inner, node, T_world_parent @ T_parent_child)

    def _add_joint(
        self, attachment: Element, links: tuple[int, int], T_parent_frame: Pose, T_parent_child: Pose
    ) -> Node | None:
        """Read the joint to which an attachment refers; return the node that the joint moves, or None."""
        holder, joint = self._joint(attachment)
        axes = [
            AxisReader(self._library, axis, *self._infos.get(axis, ()))
            for axis in children(joint, "revolute", "prismatic")
        ]
        bound = [self._scene.bindings.of_axis(self._owner, self._instance, axis.element, holder) for axis in axes]
        built = self._built_joint(joint, axes, links, T_parent_frame, T_parent_child)
        written = [None if item is None else item.value for item in bound]
        values = [axis.value(value) for axis, value in zip(axes, written, strict=True)]
        place = min(axis.dof_index for axis in axes)
        keys = (holder, joint, *(axis.element for axis in axes))
        self._found.append(_FoundJoint(keys, built, values[: len(built.axes)], place))
        return next((item.node for item in bound if item is not None and item.node is not None), None)

    def _joint(self, attachment: Element) -> tuple[Element, Element]:
        """Return the element to which an attachment refers, and its ``<joint>``, which may be the same."""
        path = attachment.get("joint") or ""
        resolved = self._library.resolve(path, self.model)
        joint = None if resolved is None else resolved.element
        if joint is not None and local_name(joint) == "instance_joint":
            joint = self._library.follow(joint)
        if resolved is None or joint is None or local_name(joint) != "joint":
            raise self._library.error(f"there is no joint '{path}'", attachment)
        if next(children(joint, "revolute", "prismatic"), None) is None:
            raise self._library.error("the joint has no axis", joint)
        return resolved.element, joint

    def _built_joint(
        self, joint: Element, axes: list[AxisReader], links: tuple[int, int], T_parent_frame: Pose, T_parent_child: Pose
    ) -> JointBuilder:
        kind = self._kind(joint, axes)
        name = valid_name(joint.get("name"))
        turn = T_parent_frame.wxyz
        return JointBuilder(
            name=name or f"dummy{len(self._body.joints) + len(self._found)}",
            kind=kind,
            links=links,
            T_first_second=T_parent_child,
            anchor=T_parent_frame.position,
            axes=tuple(axis.read(rotate(turn, axis.direction)) for axis in axes[: len(AXES[kind])]),
            weld_turn=UNIT_WXYZ if kind == "slider" else _weld_turn(axes[0], T_parent_frame, T_parent_child),
            enabled=all(axis.is_active for axis in axes),
            source=self._library.source(joint),
        )

    def _kind(self, joint: Element, axes: list[AxisReader]) -> JointKind:
        written = "".join("R" if axis.is_revolute else "P" for axis in axes)
        if len(written) == 3 and next(own_techniques(joint), None) is not None:
            return "spherical"
        if written not in _KINDS:
            message = f"a joint with {len(written)} axes is more than ravemj can move; the first counts"
            self._library.warn("unknown-type", message, joint)
        return _KINDS.get(written, _KINDS[written[0]])


def _weld_turn(axis: AxisReader, T_parent_frame: Pose, T_parent_child: Pose) -> Wxyz:
    """Return the orientation of a weld's child in its parent after a rotation by the middle of the written limits."""
    turn = wxyz_from_axis_angle(axis.direction, axis.wrap)
    T_frame_child = T_parent_frame.inverse() @ T_parent_child
    return multiply(T_parent_frame.wxyz, multiply(turn, T_frame_child.wxyz))
