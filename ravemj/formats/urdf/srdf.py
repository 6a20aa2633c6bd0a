"""SRDF: pairs of links that may touch, groups, manipulators, and named configurations."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ravemj.core.transforms import Pose
from ravemj.errors import SourceError
from ravemj.formats.openrave_xml.context import Context, did_you_mean
from ravemj.formats.openrave_xml.tree import Document, Element
from ravemj.formats.urdf.elements import attribute, check_children, children, number_of, vector_of
from ravemj.formats.urdf.joint import UrdfJoint
from ravemj.formats.urdf.link import SPHERES_GROUP
from ravemj.formats.urdf.tree import RobotTree
from ravemj.model.builder import BodyBuilder
from ravemj.model.manipulators import ManipulatorBuilder
from ravemj.model.scene import Geometry, NamedConfiguration, Rgb, Sphere

_KNOWN = (
    "group", "group_state", "end_effector", "disable_collisions", "disable_default_collisions", "enable_collisions",
    "link_sphere_approximation", "virtual_joint", "passive_joint", "joint_property",
)  # fmt: skip
_NOTED = ("virtual_joint", "passive_joint", "joint_property")
_DEEPEST = 50  # groups inside one another
_SPHERE_COLOR: Rgb = (0.7, 0.7, 0.7)


def add_srdf(body: BodyBuilder, tree: RobotTree, document: Document, context: Context, state: str) -> None:
    """Add the data of an SRDF to a body.

    Args:
        body: The body, with its links and joints.
        tree: Its link tree.
        document: The SRDF.
        context: The context of the reading.
        state: Name of the group state that gives the joint values; empty for none.

    Raises:
        SourceError: the SRDF is not well-formed, or does not have the state.
    """
    if document.error is not None:
        raise document.error
    root = document.root
    check_children(root, _KNOWN, context, language="SRDF")
    if root.attributes.get("name", body.name) != body.name:
        message = f"the SRDF is of the robot '{root.attributes['name']}', and the URDF of '{body.name}'"
        context.diagnostics.warn("other-robot", message, root.source)
    for tag in _NOTED:
        elements = children(root, tag)
        if elements:
            context.diagnostics.note(
                "left-out", f"<{tag}> is left out: it has no effect on the model", elements[0].source
            )
    _Srdf(root, body, tree, context).add(state)


@dataclass(slots=True)
class SrdfGroup:
    """A group of an SRDF.

    Attributes:
        element: Its element.
        joints: Names of its joints.
        links: Names of its links.
        tip: End link of its chain; empty if it has no chain.
    """

    element: Element
    joints: dict[str, None] = field(default_factory=dict[str, None])
    links: dict[str, None] = field(default_factory=dict[str, None])
    tip: str = ""


class _Srdf:
    def __init__(self, root: Element, body: BodyBuilder, tree: RobotTree, context: Context) -> None:
        self.root = root
        self.body = body
        self.tree = tree
        self.context = context
        self.elements = {attribute(group, "name"): group for group in children(root, "group")}
        self.groups: dict[str, SrdfGroup] = {}
        for name in self.elements:
            self._group(name, ())

    def add(self, state: str) -> None:
        self._add_pairs()
        self._add_spheres()
        self._add_manipulators()
        self._add_states(state)

    def _unknown(self, what: str, name: str, element: Element, known: Iterable[str]) -> None:
        message = f"the robot has no {what} '{name}'; <{element.spelled}> is left out"
        self.context.diagnostics.warn(f"unknown-{what}", message, element.source, did_you_mean(name, [*known]))

    def _link(self, element: Element, name: str) -> str | None:
        """Return the link that an attribute of an element names; None, with a diagnostic, if it does not exist."""
        link = attribute(element, name)
        if link in self.tree.links:
            return link
        self._unknown("link", link, element, self.tree.links)
        return None

    # Pairs of links

    def _add_pairs(self) -> None:
        """Mark link pairs as adjacent if the SRDF disables their collisions."""
        names = {link.name: index for index, link in enumerate(self.body.links)}
        pairs = self._pairs("disable_collisions", ("link1", "link2"))
        silent = [
            link
            for element in children(self.root, "disable_default_collisions")
            if (link := self._link(element, "link"))
        ]
        pairs += [(link, other) for link in silent for other in names if other != link]
        kept = {frozenset(pair) for pair in self._pairs("enable_collisions", ("link1", "link2"))}
        indices = (
            (names[first], names[two]) for first, two in pairs if frozenset((first, two)) not in kept and first != two
        )
        self.body.adjacent += list(dict.fromkeys((min(pair), max(pair)) for pair in indices))

    def _pairs(self, tag: str, ends: tuple[str, str]) -> list[tuple[str, str]]:
        pairs: list[tuple[str, str]] = []
        for element in children(self.root, tag):
            first, two = (self._link(element, end) for end in ends)
            if first is not None and two is not None:
                pairs.append((first, two))
        return pairs

    def _add_spheres(self) -> None:
        """Fill the links' group ``spheres``; as in or_urdf, centres are in the frame of the first collision shape."""
        for element in children(self.root, "link_sphere_approximation"):
            name = self._link(element, "link")
            if name is None:
                continue
            link = next(candidate for candidate in self.body.links if candidate.name == name)
            T_link_first = next(
                (geometry.T_link_geometry for geometry in link.geometries if not geometry.visible), Pose()
            )
            link.add_to_group(SPHERES_GROUP, [_sphere(sphere, T_link_first) for sphere in children(element, "sphere")])

    # Groups

    def _group(self, name: str, opened: tuple[str, ...]) -> SrdfGroup:
        """Return a group with its subgroups; a listed link includes its parent joint.

        ``opened`` are the names of the groups that contain it.
        """
        if name in self.groups:
            return self.groups[name]
        element = self.elements[name]
        group = SrdfGroup(element)
        if name in opened or len(opened) > _DEEPEST:
            raise SourceError(f"group '{name}' contains itself", element.source)
        for part in element.children:
            if part.spelled in _PARTS:
                _PARTS[part.spelled](self, group, part, (*opened, name))
        self.groups[name] = group
        return group

    def add_group(self, group: SrdfGroup, element: Element, opened: tuple[str, ...]) -> None:
        inner = attribute(element, "name")
        if inner not in self.elements:
            self._unknown("group", inner, element, self.elements)
            return
        subgroup = self._group(inner, opened)
        group.joints |= subgroup.joints
        group.links |= subgroup.links

    def add_link(self, group: SrdfGroup, element: Element, _: tuple[str, ...]) -> None:
        link = self._link(element, "name")
        if link is not None:
            group.links[link] = None
        if link in self.tree.above:
            group.joints[self.tree.above[link].name] = None

    def add_chain(self, group: SrdfGroup, element: Element, _: tuple[str, ...]) -> None:
        base, tip = (self._link(element, name) for name in ("base_link", "tip_link"))
        if base is None or tip is None:
            return
        path = self.tree.path(tip, base)
        if path is None:
            message = f"link '{tip}' does not hang on '{base}'; the <chain> is left out"
            self.context.diagnostics.warn("no-chain", message, element.source)
            return
        group.tip = tip
        group.links |= dict.fromkeys([base, *(joint.child for joint in path)])
        group.joints |= dict.fromkeys(joint.name for joint in path)

    def add_joint(self, group: SrdfGroup, element: Element, _: tuple[str, ...]) -> None:
        name = attribute(element, "name")
        if name in self.tree.joints:
            group.joints[name] = None
            group.links[self.tree.joints[name].child] = None
        elif not any(attribute(joint, "name") == name for joint in children(self.root, "virtual_joint")):
            self._unknown("joint", name, element, self.tree.joints)

    # Manipulators

    def _add_manipulators(self) -> None:
        """Add a manipulator for each end effector, then one for each remaining group that is a serial chain."""
        arms: dict[str, ManipulatorBuilder] = {}
        used: set[str] = set()
        for element in children(self.root, "end_effector"):
            link, own = self._link(element, "parent_link"), element.attributes.get("group", "")
            if link is None:
                continue
            parent = self._parent_group(element, link, own)
            used |= {own, parent or ""}
            gripper = self.groups[own] if own in self.groups and own != parent else None
            joints = [] if gripper is None else [joint for joint in gripper.joints if self._is_dof(joint)]
            base = self._base(self.groups[parent], link) if parent is not None else None
            if base is None and joints and not any(map(self.tree.is_dof, self.tree.path(link) or [])):
                base = link  # a hand without an arm
            if base is None:
                message = f"end effector '{attribute(element, 'name')}' has no arm: no group leads to its parent_link"
                hint = 'write parent_group="…", the group of the arm'
                self.context.diagnostics.warn("no-arm", message, element.source, hint)
                continue
            name = attribute(element, "name")
            arms.setdefault(name, ManipulatorBuilder(name, element.source, base, link, gripper_joints=joints))
        for name, group in self.groups.items():
            if name not in used and name not in arms and (ends := self._serial_ends(group)) is not None:
                arms[name] = ManipulatorBuilder(name, group.element.source, *ends)
        self.body.manipulators = list(arms.values())

    def _parent_group(self, element: Element, link: str, own: str) -> str | None:
        """Return the name of the arm's group for the end effector at ``link`` with the group ``own``, or None.

        It is the attribute ``parent_group``, which or_urdf required. If the attribute is missing, as in current files,
        the arm's group is ``own`` if its chain leads to ``link``, else the group with the fewest joints whose chain
        does; groups whose end link is ``link`` have priority.
        """
        given = element.attributes.get("parent_group", "")
        if given:
            if given in self.groups:
                return given
            self._unknown("group", given, element, self.groups)
            return None
        if own in self.groups and self._leads_to(self.groups[own], link):
            return own
        others = [name for name, group in self.groups.items() if name != own and self._leads_to(group, link)]
        ending = [name for name in others if self.groups[name].tip == link] or others
        return min(ending, key=lambda name: len(self.groups[name].joints), default=None)

    def _leads_to(self, group: SrdfGroup, link: str) -> bool:
        """Return whether a group is a serial chain that ends at a link, apart from fixed joints in between."""
        ends = self._serial_ends(group)
        path = None if ends is None else self.tree.path(link, ends[0])
        dofs = [joint.name for joint in path or [] if self.tree.is_dof(joint)]
        return bool(dofs) and set(dofs) <= group.joints.keys()

    def _serial_ends(self, group: SrdfGroup) -> tuple[str, str] | None:
        """Return base and end link of a group; None if the group is no serial chain, or all its joints are fixed."""
        moving = [name for name in group.joints if self._is_dof(name)]
        if not moving:
            return None
        last = max(moving, key=lambda name: len(self._above(name)))
        if not set(moving) <= {joint.name for joint in self._above(last)}:
            return None
        covered = {joint.name for joint in self.tree.path(group.tip) or []} if group.tip else set[str]()
        end = group.tip if covered >= set(moving) else self.tree.joints[last].child
        base = self._base(group, end)
        return None if base is None else (base, end)

    def _base(self, group: SrdfGroup, link: str) -> str | None:
        """Return the parent link of the group's first joint on the path to ``link``; None if there is no such joint."""
        path = self.tree.path(link) or []
        first = next((joint for joint in path if joint.name in group.joints), None)
        return None if first is None else first.parent

    def _above(self, joint: str) -> list[UrdfJoint]:
        """Return a joint and its ancestors."""
        return self.tree.path(self.tree.joints[joint].child) or []

    def _is_dof(self, joint: str) -> bool:
        return self.tree.is_dof(self.tree.joints[joint])

    # Named configurations

    def _add_states(self, wanted: str) -> None:
        """Store the group states as named configurations, and set the wanted one as the initial state."""
        states: dict[str, dict[str, float]] = {}
        for element in children(self.root, "group_state"):
            values = states.setdefault(attribute(element, "name"), {})
            for joint in children(element, "joint"):
                name = attribute(joint, "name")
                if name in self.tree.joints and self._is_dof(name):
                    values[name] = number_of(joint, "value", 0.0)
        self.body.configurations = [NamedConfiguration(name, tuple(state.items())) for name, state in states.items()]
        if not wanted:
            return
        if wanted not in states:
            hint = did_you_mean(wanted, states) or f"there are: {', '.join(states) or 'none'}"
            raise SourceError(f"there is no group state '{wanted}'", self.root.source, hint)
        self.body.joint_values = _values(self.body, states[wanted])


_PARTS = {"chain": _Srdf.add_chain, "joint": _Srdf.add_joint, "link": _Srdf.add_link, "group": _Srdf.add_group}


def _values(body: BodyBuilder, state: Mapping[str, float]) -> list[float]:
    """Return the values of all DOFs: from ``state``, and for other DOFs the value within limits nearest to 0."""
    axes = {joint.name: joint.axes[0] for joint in body.joints if joint.active}
    nearest = {name: 0.0 if axis.circular else min(max(axis.lower, 0.0), axis.upper) for name, axis in axes.items()}
    return [state.get(name, value) for name, value in nearest.items()]


def _sphere(element: Element, T_link_first: Pose) -> Geometry:
    center = vector_of(element, "center", (0.0, 0.0, 0.0))
    return Geometry(
        shape=Sphere(number_of(element, "radius", 0.0)),
        T_link_geometry=Pose(T_link_first.apply(center)),
        name="",
        diffuse=_SPHERE_COLOR,
        ambient=_SPHERE_COLOR,
        transparency=0.0,
        visible=False,
        source=element.source,
    )
