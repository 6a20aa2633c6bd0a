"""The whole MJCF document."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import ZERO, Floats, conjugate, rotate, rows_from_wxyz
from ravemj.errors import Diagnostics, Source
from ravemj.formats.mjcf.equality import EqualityWriter
from ravemj.formats.mjcf.excludes import WeldGroups, excluded_pairs
from ravemj.formats.mjcf.geoms import GeomWriter
from ravemj.formats.mjcf.inertia import inertia_attributes, is_rounding, legal_inertial
from ravemj.formats.mjcf.lines import Attribute, Lines, pose_attributes
from ravemj.model.joints import moving_direction, relative_pose
from ravemj.model.look import (
    FILL,
    HORIZON,
    KEY,
    LINES,
    SKY,
    STUDIO_PREFIX,
    ZENITH,
    Light,
    first_rotation,
)
from ravemj.model.scene import Axis, Joint, KinBody, Link, Mesh, Scene, View
from ravemj.model.shape_bodies import MASSLESS

ASSETS = "assets"
"""Folder of the meshes, beside the MJCF file."""

_SKY_SIZE, _GRID_SIZE = 32, 128
"""Texels along a side of a face of the sky, and of a cell of the floor's grid."""

MECHANISM_MEMORY = "1M"
"""Working memory of a model without contacts; MuJoCo's default is several times the model's own size, for each body."""

_MANY_BODIES = 1000

Actuators = Literal["position", "velocity", "torque"]


class Options(NamedTuple):
    """Options of a translation.

    Attributes:
        free_bases: Whether bodies without a static link can fall, as OpenRAVE's physics engines have it; else every
            root is fixed to the world.
        actuators: The kind of actuator for each DOF, or None.
        decomposed: Whether meshes collide as several convex parts (with CoACD) in place of one hull.
        excludes: Whether pairs of links that OpenRAVE never tests are excluded by name.
        mechanism_only: Whether only links and joints are written, without shapes and without what acts when time runs,
            and every root gets a free joint.
    """

    free_bases: bool = False
    actuators: Actuators | None = None
    decomposed: bool = False
    excludes: bool = True
    mechanism_only: bool = False


class BodyNames(NamedTuple):
    """Names of the parts of a body in the MJCF.

    Attributes:
        links: Name of the MuJoCo body of each link.
        joints: For each joint, active ones and then passive ones, the names of the MuJoCo joints that it became; none
            for one that moves no link: a weld, a passive one that follows nothing, and one that closes a loop.
        geoms: For each link, how many geoms each of its geometries became; they stand in this order.
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
        sources: For each line of the text, the place that it comes from, or None.
        names: Names of the parts of each body of the scene, in the order of the bodies.
        altered: Links, as (body, link) indices, whose inertia MuJoCo would refuse; the text has the nearest legal one.
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
        """Return where a line of the text comes from; lines count from 1."""
        return self.sources[line - 1] if 0 < line <= len(self.sources) else None


def write(scene: Scene, diagnostics: Diagnostics, options: Options | None = None) -> Mjcf:
    """Translate a scene.

    Args:
        scene: What to translate.
        diagnostics: Takes a warning for every value that MuJoCo would refuse and every name that clashes.
        options: What to add; None: nothing.
    """
    options = options or Options()
    writer = _Writer(diagnostics, options)
    if not options.mechanism_only:
        _write_lights(writer.bodies, scene.view or View())
    for index, body in enumerate(scene.bodies):
        writer.write_body(index, body)
    out = Lines()
    out.open("mujoco")
    out.element("compiler", angle="radian", autolimits=True, fusestatic=False, meshdir=ASSETS)
    if scene.gravity is not None:
        out.element("option", gravity=scene.gravity)
    if options.mechanism_only:
        out.element("size", memory=MECHANISM_MEMORY)
    else:
        memory = _memory(writer.bodies.text)
        if memory:
            out.element("size", memory=memory)
        _write_look(out, scene.view or View(), writer.geometries.lines)
    out.section("worldbody", writer.bodies)
    out.section("contact", writer.excludes)
    out.section("tendon", writer.equalities.tendons)
    out.section("equality", writer.equalities.equalities)
    out.section("actuator", writer.actuators)
    out.close("mujoco")
    text = "\n".join(out.text) + "\n"
    return Mjcf(text, writer.geometries.meshes, tuple(out.sources), tuple(writer.names), tuple(writer.altered))


def _memory(lines: Sequence[str]) -> str:
    """Return the working memory that MuJoCo needs to sort out the pairs of many bodies; empty if its default suffices.

    That grows with the square of the DOFs alone (60 bytes, measured on MuJoCo 4.0), and the need with that of the
    bodies (4.05 bytes).
    """
    bodies = sum("<body " in line for line in lines)
    dofs = sum(("<joint " in line) + 6 * ("<freejoint" in line) for line in lines)
    if bodies < _MANY_BODIES or 4 * dofs > bodies:
        return ""
    return f"{(5 * bodies**2 + 64 * dofs**2) // 2**20 + 32}M"


def _write_look(out: Lines, view: View, meshes: Lines) -> None:
    """Write lights, the classes of geoms, the background and the meshes."""
    level = HORIZON if view.background is None else view.background
    out.open("visual")
    x, y, z = _first_rotation(view)[:, 2].tolist()  # along which MuJoCo's own viewers look at first
    azimuth, elevation = math.degrees(math.atan2(y, x)), math.degrees(math.atan2(z, math.hypot(x, y)))
    out.element("global", azimuth=round(azimuth, 6) % 360.0, elevation=round(elevation, 6))
    out.element("headlight", active=1, **_light_attributes(FILL))
    out.element("rgba", fog=(*level, 1.0), haze=(*level, 1.0))
    out.close("visual")
    out.open("default")
    out.open("default", **{"class": "visual"})
    out.element("geom", contype=0, conaffinity=0, group=2)
    out.close("default")
    out.open("default", **{"class": "collision"})
    out.element("geom", group=3)
    out.close("default")
    out.close("default")
    out.open("asset")
    top, bottom = (ZENITH, level) if view.background is None else (level, level)
    size: dict[str, Attribute] = {"width": _SKY_SIZE, "height": 6 * _SKY_SIZE}
    out.element("texture", name="background", type="skybox", builtin="gradient", rgb1=top, rgb2=bottom, **size)
    grid: dict[str, Attribute] = {"width": _GRID_SIZE, "height": _GRID_SIZE}
    lines: dict[str, Attribute] = {"mark": "edge", "markrgb": (LINES, LINES, LINES), "rgb1": (1.0, 1.0, 1.0)}
    out.element("texture", name="floor", type="2d", builtin="flat", **lines, **grid)
    out.element("material", name="floor", texture="floor")
    out.text += meshes.text
    out.sources += meshes.sources
    out.close("asset")


def _light_attributes(light: Light) -> dict[str, Attribute]:
    parts = {"ambient": light.ambient, "diffuse": light.diffuse, "specular": light.specular}
    return {name: (part, part, part) for name, part in parts.items()}


def _first_rotation(view: View) -> Floats:
    """Return ``R_world_camera`` of the first camera."""
    camera = view.T_world_camera
    return first_rotation() if camera is None else np.array(rows_from_wxyz(camera.wxyz))


def _write_lights(out: Lines, view: View) -> None:
    """Write the lights of pictures, as they are for the first camera."""
    R_world_camera = _first_rotation(view)
    for name, light in (("key", KEY), ("sky", SKY)):
        direction = tuple(light.direction_in_world(R_world_camera).round(6).tolist())
        attributes: dict[str, Attribute] = {"castshadow": light.casts_shadows, **_light_attributes(light)}
        out.element("light", name=f"{STUDIO_PREFIX}{name}", type="directional", dir=direction, **attributes)


@dataclass(slots=True)
class _Names:
    """The names in use, so that each is given once."""

    diagnostics: Diagnostics
    taken: dict[str, set[str]] = field(default_factory=lambda: {"body": {"world"}, "joint": set[str]()})

    def give(self, kind: str, body: KinBody, name: str) -> str:
        """Return a name that no other part of this kind has: the part's own if that is free."""
        unique = name
        while unique in self.taken[kind]:
            unique = f"{body.name}/{unique}"
        if unique != name:
            message = f"the {kind} '{name}' of '{body.name}' is called '{unique}' in the MJCF, where names are unique"
            self.diagnostics.warn("renamed", message, body.source)
        self.taken[kind].add(unique)
        return unique


class _Writer:
    """The sections of the document, filled body by body."""

    def __init__(self, diagnostics: Diagnostics, options: Options) -> None:
        self.diagnostics = diagnostics
        self.options = options
        self.bodies = Lines(2)
        self.excludes = Lines(2)
        self.actuators = Lines(2)
        self.geometries = GeomWriter(diagnostics, decomposed=options.decomposed)
        self.equalities = EqualityWriter(diagnostics, Lines(2), Lines(2))
        self.names: list[BodyNames] = []
        self.altered: list[tuple[int, int]] = []
        self._given = _Names(diagnostics)

    def write_body(self, index: int, body: KinBody) -> None:
        """Write the tree of links of a body, root links first, and what belongs to it in other sections."""
        joints = body.all_joints
        names = BodyNames(
            links=tuple(self._given.give("body", body, link.name or f"link{i}") for i, link in enumerate(body.links)),
            joints=tuple(
                self._joint_names(body, joint, i < len(body.joints), joint.name or f"joint{i}")
                for i, joint in enumerate(joints)
            ),
            geoms=(),
        )
        welds = WeldGroups()
        self.names.append(names._replace(geoms=self._write_tree(index, body, names, joints, welds)))
        if self.options.mechanism_only:
            return
        if self.options.excludes:
            for first, second in excluded_pairs(body, welds):
                self.excludes.element("exclude", body1=names.links[first], body2=names.links[second])
        self.equalities.write(joints, names.joints)
        if self.options.actuators is not None:
            for joint, joint_names in zip(body.joints, names.joints, strict=False):
                self._write_actuators(joint, joint_names, self.options.actuators)

    def _joint_names(self, body: KinBody, joint: Joint, active: bool, name: str) -> tuple[str, ...]:
        follows = joint.mimic is not None and joint.mimic.expression is not None and len(body.joints) > 0
        if not joint.places_child or joint.static or not (active or follows) or joint.axes[0].direction == ZERO:
            return ()
        first = self._given.give("joint", body, name)
        one = len(joint.axes) == 1 or joint.kind == "spherical"
        return (first,) if one else (first, self._given.give("joint", body, f"{name}_1"))

    def _write_tree(
        self, index: int, body: KinBody, names: BodyNames, joints: tuple[Joint, ...], welds: WeldGroups
    ) -> tuple[tuple[int, ...], ...]:
        """Write the links; return for each how many geoms its geometries became."""
        geoms: list[tuple[int, ...]] = [()] * len(body.links)
        placing = {joint.child: number for number, joint in enumerate(joints) if joint.places_child}
        children: dict[int, list[int]] = {}
        for child, number in placing.items():
            children.setdefault(joints[number].parent, []).append(child)
        free = self.options.free_bases and not any(link.static for link in body.links)
        free = free or self.options.mechanism_only
        pending = [(link, False) for link in reversed(range(len(body.links))) if link not in placing]
        while pending:
            link, is_done = pending.pop()
            if is_done:
                self.bodies.close("body")
                continue
            number = placing.get(link)
            joint = None if number is None else joints[number]
            joint_names = () if number is None else names.joints[number]
            self._open_link(body, link, names.links[link], joint, bool(joint_names))
            is_free = joint is None and free
            if is_free:
                self.bodies.element("freejoint", body.links[link].source)
            self._write_inertial(index, link, body.links[link])
            if joint is not None:
                self._write_joint(joint, joint_names)
            shapes = () if self.options.mechanism_only else body.links[link].geometries
            written = [self.geometries.write(geometry, self.bodies) for geometry in shapes]
            geoms[link] = tuple(count for count, _ in written)
            parent = None if joint is None else joint.parent
            solid = any(collides for _, collides in written)
            welds.add(link, parent, moves=is_free or bool(joint_names), solid=solid)
            pending.append((link, True))
            if link in children:
                pending.extend((child, False) for child in sorted(children[link], reverse=True))
        return tuple(geoms)

    def _open_link(self, body: KinBody, index: int, name: str, joint: Joint | None, moves: bool) -> None:
        link = body.links[index]
        if joint is None:
            pose = link.T_world_link
        elif moves:
            pose = joint.T_parent_child
        elif body.joints:
            pose = relative_pose(joint, [axis.value for axis in joint.axes])
        else:  # nothing was placed by joints
            pose = body.links[joint.parent].T_world_link.inverse() @ link.T_world_link
        self.bodies.comment(str(link.source), link.source)
        self.bodies.open("body", link.source, name=name, **pose_attributes(pose))

    def _write_inertial(self, body_index: int, link_index: int, link: Link) -> None:
        inertial = legal_inertial(link.inertial)
        if inertial is not link.inertial:
            self.altered.append((body_index, link_index))
            if replace(link.inertial, com=ZERO) != MASSLESS and not is_rounding(inertial, link.inertial):
                message = f"MuJoCo refuses the mass or inertia of '{link.name}'; the MJCF has the nearest legal one"
                self.diagnostics.warn("raised-inertia", message, link.source)
        self.bodies.element("inertial", link.source, **inertia_attributes(inertial))

    def _write_joint(self, joint: Joint, names: tuple[str, ...]) -> None:
        position = joint.T_parent_child.inverse().apply(joint.anchor)
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
                axis=rotate(conjugate(joint.T_parent_child.wxyz), moving_direction(joint, index)),
                **_range(axis),
                ref=axis.reference or None,
                armature=axis.armature if self.options.actuators and axis.armature else None,
                actuatorfrcrange=(-axis.max_torque, axis.max_torque) if axis.max_torque else None,
            )

    def _write_actuators(self, joint: Joint, names: tuple[str, ...], kind: Actuators) -> None:
        if joint.is_ball and names:
            message = f"joint '{joint.name}' is spherical, and gets no actuator"
            self.diagnostics.warn("no-actuator", message, joint.source)
            return
        for name, axis in zip(names, joint.axes, strict=False):
            torque = (-axis.max_torque, axis.max_torque) if axis.max_torque else None
            limits = None if axis.circular else (axis.lower, axis.upper)
            speed = (-axis.max_velocity, axis.max_velocity)
            forms: dict[Actuators, tuple[str, dict[str, Attribute | None]]] = {
                "torque": ("motor", {"ctrlrange": torque}),
                "velocity": ("velocity", {"kv": 10.0, "ctrlrange": speed, "forcerange": torque}),
                "position": ("position", {"kp": 100.0, "kv": 10.0, "ctrlrange": limits, "forcerange": torque}),
            }
            tag, attributes = forms[kind]
            self.actuators.element(tag, joint.source, name=name, joint=name, **attributes)


def _range(axis: Axis) -> dict[str, Attribute | None]:
    if axis.circular or not axis.lower < axis.upper:
        return {"limited": False}
    return {"range": (axis.lower, axis.upper)}
