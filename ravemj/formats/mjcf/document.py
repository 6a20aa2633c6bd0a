"""The whole MJCF document."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravemj.core.caching import cached_property
from ravemj.core.transforms import UNMOVED, ZERO, Vec3, conjugate, rotate
from ravemj.errors import Diagnostics, Origin, Source
from ravemj.formats.mjcf.actuators import joint_motor, warn_of_ball, write_actuator
from ravemj.formats.mjcf.equality import EqualityWriter
from ravemj.formats.mjcf.excludes import WeldGroups, excluded_pairs
from ravemj.formats.mjcf.geoms import MjcfGeomWriter
from ravemj.formats.mjcf.inertia import inertia_attributes, is_rounding, legal_inertial
from ravemj.formats.mjcf.lines import Attribute, XmlLines, pose_attributes
from ravemj.formats.mjcf.look import write_lights, write_look
from ravemj.formats.mjcf.merging import Merging
from ravemj.formats.mjcf.options import Options
from ravemj.formats.mjcf.records import PREFIX, StoredNames, body_text
from ravemj.formats.mjcf.sensors import SensorWriter
from ravemj.formats.mjcf.tidy import tidy
from ravemj.model.joints import moving_direction
from ravemj.model.scene import Axis, Joint, KinBody, Mesh, Scene, View
from ravemj.model.shape_bodies import MASSLESS

ASSETS = "assets"
"""Folder of the meshes, beside the MJCF file."""

MECHANISM_MEMORY = "1M"
"""Working memory of a model without contacts; MuJoCo's default would be several times as large as the model."""

_MANY_BODIES = 1000

_LEAST_ROOM = 1e-6
"""Half the range [rad or m] written for a movable joint whose limits coincide."""

_LOCK_SOLREF, _LOCK_SOLIMP = (0.004, 1), (0.999, 0.9999, 1e-6)
"""Limit parameters of a joint without range, as stiff as MuJoCo allows, so that a standing robot does not sink."""

TIMESTEP = 0.002
"""MuJoCo's time step [s]."""


class BodyNames(NamedTuple):
    """Names of the parts of a body in the MJCF.

    Attributes:
        links: Name of the MuJoCo body of each link.
        joints: Names of the MuJoCo joints of each joint, active ones and then passive ones; none for joints that move
            no link: welds, and joints that close loops.
        geoms: For each link, the number of geoms of each geometry, in order.
    """

    links: tuple[str, ...]
    joints: tuple[tuple[str, ...], ...]
    geoms: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Mjcf:
    """A translated scene.

    Attributes:
        text: The MJCF document.
        meshes: The meshes, by the name of their files in the folder ``assets``.
        sources: For each line of the text its source in the user's file, or None.
        names: Names of the parts of each body of the scene, in the order of the bodies.
        altered: (body, link) indices of links whose inertia MuJoCo would refuse; the text has the nearest valid one.
    """

    text: str
    meshes: dict[str, Mesh]
    sources: tuple[Source | None, ...]
    names: tuple[BodyNames, ...]
    altered: tuple[tuple[int, int], ...]

    @cached_property
    def assets(self) -> dict[str, str]:
        """The content of the mesh files, by name."""
        from ravemj.formats.meshes.obj import write_obj  # noqa: PLC0415 - most models have no meshes

        return {name: write_obj(mesh) for name, mesh in self.meshes.items()}

    def source_of_line(self, line: int) -> Source | None:
        """Return the source of a line, which is counted from 1."""
        return self.sources[line - 1] if 0 < line <= len(self.sources) else None


def write(scene: Scene, diagnostics: Diagnostics, options: Options | None = None) -> Mjcf:
    """Translate a scene.

    Args:
        scene: The scene.
        diagnostics: Receives a warning for each value that MuJoCo would refuse and each name conflict.
        options: Options of the translation; None for the defaults.
    """
    options = options or Options()
    writer = _MjcfWriter(diagnostics, options)
    if not options.mechanism_only:
        write_lights(writer.bodies, scene.view or View())
    for index, body in enumerate(scene.bodies):
        writer.write_body(index, body)
    out = XmlLines()
    out.open("mujoco")
    out.element("compiler", angle="radian", autolimits=True, fusestatic=False, meshdir=ASSETS)
    _write_option(out, scene, options)
    if options.mechanism_only:
        out.element("size", memory=MECHANISM_MEMORY)
    else:
        memory = _memory(writer.bodies.text)
        if memory:
            out.element("size", memory=memory)
        write_look(out, scene.view or View(), writer.geometries.lines)
    out.section("worldbody", writer.bodies)
    out.section("contact", writer.excludes)
    out.section("tendon", writer.equalities.tendons)
    out.section("equality", writer.equalities.equalities)
    out.section("actuator", writer.actuators)
    out.section("sensor", writer.sensors.lines)
    out.section("custom", writer.texts)
    out.close("mujoco")
    lines = out.text if options.folder is None else map(tidy, out.text)
    text = "\n".join(lines) + "\n"
    return Mjcf(text, writer.geometries.meshes, tuple(out.sources), tuple(writer.names), tuple(writer.altered))


def _write_option(out: XmlLines, scene: Scene, options: Options) -> None:
    """Write gravity, time step and integrator if not MuJoCo's defaults; servos need an implicit integrator."""
    servos = options.actuators in {"position", "velocity"}
    attributes: dict[str, Attribute | None] = {
        "gravity": scene.gravity,
        "timestep": options.timestep,
        "integrator": "implicitfast" if servos else None,
    }
    if any(value is not None for value in attributes.values()):
        out.element("option", **attributes)


def _memory(lines: Sequence[str]) -> str:
    """Return the ``memory`` size, such as "40M", that MuJoCo's broad phase needs; empty if the default suffices.

    In bytes, the default is 60 times the square of the number of DOFs (measured on MuJoCo 4.0), the required memory
    4.05 times the square of the number of bodies.
    """
    bodies = sum("<body " in line for line in lines)
    dofs = sum(("<joint " in line) + 6 * ("<freejoint" in line) for line in lines)
    if bodies < _MANY_BODIES or 4 * dofs > bodies:
        return ""
    return f"{(5 * bodies**2 + 64 * dofs**2) // 2**20 + 32}M"


@dataclass(slots=True)
class _UniqueNames:
    """Names in use in the MJCF, by kind of element."""

    diagnostics: Diagnostics
    taken: dict[str, set[str]] = field(
        default_factory=lambda: {"body": {"world"}, "joint": set[str](), "site": set[str]()}
    )

    def give(self, kind: str, body: KinBody, name: str) -> str:
        """Reserve and return a unique name: ``name`` or, if it is in use, ``name`` prefixed by the body's name.

        A warning is given for a prefixed name.
        """
        unique = name
        while unique in self.taken[kind]:
            unique = f"{body.name}/{unique}"
        if unique != name:
            message = f"the {kind} '{name}' of '{body.name}' is called '{unique}' in the MJCF, where names are unique"
            self.diagnostics.warn("renamed", message, body.source)
        self.taken[kind].add(unique)
        return unique


class _MjcfWriter:
    def __init__(self, diagnostics: Diagnostics, options: Options) -> None:
        self.diagnostics = diagnostics
        self.options = options
        self.bodies = XmlLines(2)
        self.excludes = XmlLines(2)
        self.actuators = XmlLines(2)
        self.geometries = MjcfGeomWriter(
            diagnostics, decomposed=options.decomposed, hull_vertices=options.hull_vertices or None
        )
        timestep = TIMESTEP if options.timestep is None else options.timestep
        solref = (2 * timestep, 1.0) if options.actuators else None  # the largest stiffness that MuJoCo permits
        self.equalities = EqualityWriter(diagnostics, XmlLines(2), XmlLines(2), solref)
        self.names: list[BodyNames] = []
        self.altered: list[tuple[int, int]] = []
        self.texts = XmlLines(2)
        self._given = _UniqueNames(diagnostics)
        self.sensors = SensorWriter(diagnostics, self._given.taken["site"])

    def write_body(self, index: int, body: KinBody) -> None:
        """Write the kinematic tree of a body, root links first, and its elements in other sections."""
        joints = body.all_joints
        joint_names = tuple(
            self._joint_names(body, joint, i < len(body.joints), joint.name or f"joint{i}")
            for i, joint in enumerate(joints)
        )
        merging = Merging(body, joint_names, merges=self.options.merge_fixed)
        links = [
            self._given.give("site" if i in merging.carriers else "body", body, link.name or f"link{i}")
            for i, link in enumerate(body.links)
        ]
        merging.names = links
        names = BodyNames(tuple(links[merging.carrier(i)] for i in range(len(links))), joint_names, ())
        welds = WeldGroups()
        names = names._replace(geoms=self._write_tree(index, body, names, merging, welds))
        self.names.append(names)
        if self.options.mechanism_only:
            return
        pairs: dict[tuple[str, str], None] = {}
        if self.options.excludes:
            named = [(names.links[first], names.links[second]) for first, second in excluded_pairs(body, welds)]
            pairs = dict.fromkeys((first, second) for first, second in named if first != second)
            for first, second in pairs:
                self.excludes.element("exclude", body1=first, body2=second)
        if self.options.folder is not None and not self.options.merge_fixed:
            counts = tuple(map(sum, names.geoms))
            places = tuple(self._source_text(link.source) for link in body.links)
            stored = StoredNames(names.links, names.joints, counts, tuple(pairs), self.options.decomposed, places)
            self.texts.text_element(f"{PREFIX}{body.name}", body_text(body, stored, self.geometries.mesh_name))
        self.equalities.write(joints, names.joints)
        if self.options.sensors:
            self.sensors.write_joints(joints, names.joints)
        if self.options.actuators is not None:
            self._write_actuators(index, body, names.joints)

    def _joint_names(self, body: KinBody, joint: Joint, active: bool, name: str) -> tuple[str, ...]:
        follows = joint.mimic is not None and joint.mimic.expression is not None and len(body.joints) > 0
        moves = active or follows or joint.mimic is None
        if not joint.places_child or joint.static or not moves or joint.axes[0].direction == ZERO:
            return ()
        first = self._given.give("joint", body, name)
        is_single = len(joint.axes) == 1 or joint.kind == "spherical"
        return (first,) if is_single else (first, self._given.give("joint", body, f"{name}_1"))

    def _is_free(self, body: KinBody) -> bool:
        """Return whether the root links of a body get free joints."""
        if self.options.mechanism_only or (self.options.free_robots and body.is_robot):
            return True
        return self.options.free_bases and not any(link.static for link in body.links)

    def _write_tree(
        self, index: int, body: KinBody, names: BodyNames, merging: Merging, welds: WeldGroups
    ) -> tuple[tuple[int, ...], ...]:
        """Write the links of a body; return for each link the number of geoms per geometry."""
        geoms: list[tuple[int, ...]] = [()] * len(body.links)
        free = self._is_free(body)
        pending = [(link, False) for link in reversed(range(len(body.links))) if link not in merging.placing]
        while pending:
            link, is_done = pending.pop()
            if is_done:
                self.bodies.close("body")
                continue
            number = merging.placing.get(link)
            joint = None if number is None else body.all_joints[number]
            joint_names = () if number is None else names.joints[number]
            is_free = joint is None and free
            self._open_link(index, body, link, merging, is_free=is_free)
            if joint is not None:
                self._write_joint(joint, joint_names)
            geoms[link], solid = self._write_shapes(body, link, merging)
            parent = None if joint is None else joint.parent
            welds.add(link, parent, moves=is_free or bool(joint_names), solid=solid)
            if link not in merging.carriers:
                pending.append((link, True))
            pending.extend((child, False) for child in sorted(merging.children.get(link, ()), reverse=True))
        return tuple(geoms)

    def _write_shapes(self, body: KinBody, link: int, merging: Merging) -> tuple[tuple[int, ...], bool]:
        """Write the geoms of a link; return the number of geoms per geometry, and whether any of them collides."""
        if self.options.mechanism_only:
            return (), False
        T_body_link = merging.pose(link)
        shapes = body.links[link].geometries
        if T_body_link is not UNMOVED:
            shapes = [replace(shape, T_link_geometry=T_body_link @ shape.T_link_geometry) for shape in shapes]
        ghost = body.is_robot and not self.options.self_collision
        written = [self.geometries.write(shape, self.bodies, meets_robots=not ghost) for shape in shapes]
        if self.options.folder is not None:
            self.sensors.write_tools(body, link, T_body_link, self.bodies)
        if self.options.sensors:
            self.sensors.write_on_link(body, link, T_body_link, self.bodies)
        return tuple(count for count, _ in written), any(collides for _, collides in written)

    def _open_link(self, index: int, body: KinBody, link: int, merging: Merging, *, is_free: bool) -> None:
        """Write the start tag of a link's ``<body>`` or, for a merged link, a site."""
        described, pose = body.links[link], merging.pose_in_parent(link)
        self.bodies.comment(self._source_text(described.source), described.source)
        attributes = {"name": merging.names[link], **pose_attributes(pose)}
        if link in merging.carriers:
            self.bodies.element("site", described.source, **attributes, group=4)
            return
        self.bodies.open("body", described.source, **attributes)
        if is_free:
            self.bodies.element("freejoint", described.source)
        self._write_inertial(index, link, body, merging)

    def _source_text(self, source: Source) -> str:
        """Return a comment with the source file and line of a link, relative to the model's folder if that is known."""
        folder = self.options.folder
        if folder is None or isinstance(source, Origin) or not os.path.exists(source.file):
            return str(source)
        return str(source._replace(file=os.path.relpath(source.file, folder)))

    def _write_inertial(self, body_index: int, link_index: int, body: KinBody, merging: Merging) -> None:
        link = body.links[link_index]
        inertial = legal_inertial(link.inertial)
        if inertial is not link.inertial:
            self.altered.append((body_index, link_index))
            if replace(link.inertial, com=ZERO) != MASSLESS and not is_rounding(inertial, link.inertial):
                number = merging.placing.get(link_index)
                moved = "" if number is None else f", which hangs on joint '{body.all_joints[number].name}'"
                message = (
                    f"MuJoCo refuses the mass or inertia of '{link.name}'{moved}; the MJCF has the nearest legal one"
                )
                self.diagnostics.warn("raised-inertia", message, link.source)
        self.bodies.element("inertial", link.source, **inertia_attributes(merging.inertial(link_index, inertial)))

    def _write_joint(self, joint: Joint, names: tuple[str, ...]) -> None:
        position = joint_position(joint)
        if joint.is_ball and names:
            self.bodies.element("joint", joint.source, name=names[0], type="ball", pos=position)
            return
        for index, (name, axis) in enumerate(zip(names, joint.axes, strict=False)):
            self.bodies.element(
                "joint",
                joint.source,
                name=name,
                type="slide" if joint.slides(index) else "hinge",
                pos=position,
                axis=joint_axis(joint, index),
                **_range(axis),
                ref=axis.reference or None,
                **(joint_motor(axis) if self.options.actuators else {}),
                actuatorfrcrange=(-axis.max_torque, axis.max_torque) if axis.max_torque else None,
            )

    def _write_actuators(self, index: int, body: KinBody, names: tuple[tuple[str, ...], ...]) -> None:
        gains = self.options.gains[index] if index < len(self.options.gains) else None
        dof = 0
        for joint, joint_names in zip(body.joints, names, strict=False):
            if joint.is_ball and joint_names:
                warn_of_ball(joint, self.diagnostics)
            else:
                for axis, name in enumerate(joint_names):
                    row = (0.0, 0.0, 0.0) if gains is None else gains.row(dof + axis)
                    write_actuator(self.actuators, joint, name, axis, self.options.actuators or "torque", row)
            dof += len(joint.axes)


def joint_position(joint: Joint) -> Vec3:
    """Return the anchor of a joint in the frame of its child, as in MJCF."""
    return joint.T_parent_child.inverse().apply(joint.anchor)


def joint_axis(joint: Joint, index: int) -> Vec3:
    """Return the direction of an axis in the frame of the joint's child."""
    return rotate(conjugate(joint.T_parent_child.wxyz), moving_direction(joint, index))


def _range(axis: Axis) -> dict[str, Attribute | None]:
    if axis.circular:
        return {"limited": False}
    if not axis.lower < axis.upper:  # MuJoCo refuses a range without room
        room = (axis.upper - _LEAST_ROOM, axis.upper + _LEAST_ROOM)
        return {"range": room, "solreflimit": _LOCK_SOLREF, "solimplimit": _LOCK_SOLIMP}
    return {"range": (axis.lower, axis.upper)}
