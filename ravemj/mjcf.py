"""A ``Scene`` becomes MJCF: text, and for every line the place in the user's file that it comes from.

Pure text, written by hand: MuJoCo's own writer keeps six digits, turns inertias and moves meshes. Here numbers
keep all their digits, every element has its own line, and names stay as they are.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import numpy as np

from ravemj.adjacency import adjacent_pairs
from ravemj.errors import Diagnostics, Source
from ravemj.joints import relative_pose
from ravemj.scene import Box, Capsule, Cylinder, Geometry, Inertial, Joint, KinBody, Rgb, Scene, Shape, Sphere, View
from ravemj.transforms import ZERO, Pose, Vec3, conjugate, rotate

Attribute = str | float | bool | tuple[float, ...]

SMALLEST = 1e-10
"""The least size [m], mass [kg] and moment of inertia [kg m^2] that is written; MuJoCo wants them positive."""


@dataclass(frozen=True, slots=True)
class BodyNames:
    """What a body's parts are called in the MJCF.

    Attributes:
        links: Name of the MuJoCo body of each link.
        joints: For each active joint the name of the MuJoCo joint of its axis; None where it moves no link: for a weld,
            and for a joint that closes a loop.
    """

    links: tuple[str, ...]
    joints: tuple[str | None, ...]


@dataclass(frozen=True, slots=True)
class Mjcf:
    """A translated scene.

    Attributes:
        text: The MJCF document.
        sources: For each line of the text, the place that it comes from, or None.
        names: Names of the parts of each body of the scene, in the order of the bodies.
        altered: Links, as (body, link) indices, whose inertia MuJoCo would refuse; the text has the nearest legal one.
    """

    text: str
    sources: tuple[Source | None, ...]
    names: tuple[BodyNames, ...]
    altered: tuple[tuple[int, int], ...]

    def source_of_line(self, line: int) -> Source | None:
        """Return where a line of the text comes from; lines count from 1."""
        return self.sources[line - 1] if 0 < line <= len(self.sources) else None


def write(scene: Scene, diagnostics: Diagnostics) -> Mjcf:
    """Translate a scene.

    Args:
        scene: What to translate.
        diagnostics: Takes a warning for every value that MuJoCo would refuse and every name that clashes.
    """
    writer = _Writer(diagnostics)
    writer.begin(scene.view or View())
    for index, body in enumerate(scene.bodies):
        writer.write_body(index, body)
    writer.end(scene)
    return Mjcf("\n".join(writer.lines) + "\n", tuple(writer.sources), tuple(writer.names), tuple(writer.altered))


class _Writer:
    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics
        self.lines: list[str] = []
        self.sources: list[Source | None] = []
        self.names: list[BodyNames] = []
        self.altered: list[tuple[int, int]] = []
        self._indent = 0
        self._taken = {"body": {"world"}, "joint": set[str]()}

    def element(self, tag: str, source: Source | None = None, /, **attributes: Attribute | None) -> None:
        """Write an element without children."""
        self._line(f"<{tag}{_attributes(attributes)}/>", source)

    def open(self, tag: str, source: Source | None = None, /, **attributes: Attribute | None) -> None:
        """Write a start tag."""
        self._line(f"<{tag}{_attributes(attributes)}>", source)
        self._indent += 1

    def close(self, tag: str) -> None:
        """Write an end tag."""
        self._indent -= 1
        self._line(f"</{tag}>")

    def _line(self, text: str, source: Source | None = None) -> None:
        self.lines.append("  " * self._indent + text)
        self.sources.append(source)

    def begin(self, view: View) -> None:
        """Write everything up to the bodies."""
        self.open("mujoco")
        self.element("compiler", angle="radian", autolimits=True, fusestatic=False)
        self._begin_visual()
        self.open("default")
        self.open("default", **{"class": "visual"})
        self.element("geom", contype=0, conaffinity=0, group=2)
        self.close("default")
        self.open("default", **{"class": "collision"})
        self.element("geom", group=3)
        self.close("default")
        self.close("default")
        self.open("asset")
        self.element("texture", name="background", type="skybox", builtin="flat", width=8, height=48, **_flat(view))
        self.close("asset")
        self.open("worldbody")
        self.element("light", type="directional", dir=(-0.4, 0.4, -1.0), diffuse=(0.4, 0.4, 0.4), specular=ZERO)

    def _begin_visual(self) -> None:
        self.open("visual")
        self.element(
            "headlight", active=1, ambient=(0.35, 0.35, 0.35), diffuse=(0.4, 0.4, 0.4), specular=(0.05, 0.05, 0.05)
        )
        self.close("visual")

    def end(self, scene: Scene) -> None:
        """Write everything behind the bodies."""
        self.close("worldbody")
        excluded = [(names, pair) for body, names in self._named(scene) for pair in sorted(adjacent_pairs(body))]
        if excluded:
            self.open("contact")
            for names, (first, second) in excluded:
                self.element("exclude", body1=names.links[first], body2=names.links[second])
            self.close("contact")
        self.close("mujoco")

    def _named(self, scene: Scene) -> Iterator[tuple[KinBody, BodyNames]]:
        return zip(scene.bodies, self.names, strict=True)

    def write_body(self, index: int, body: KinBody) -> None:
        """Write the tree of links of a body, root links first."""
        joints = (*body.joints, *body.passive_joints)
        names = BodyNames(
            links=tuple(self._name("body", body, link.name or f"link{i}") for i, link in enumerate(body.links)),
            joints=tuple(
                self._name("joint", body, joint.name or f"joint{i}")
                if joint.places_child and not joint.static
                else None
                for i, joint in enumerate(body.joints)
            ),
        )
        self.names.append(names)
        placing = {joint.child: joint for joint in joints if joint.places_child}
        children: dict[int, list[int]] = {}
        for child, joint in placing.items():
            children.setdefault(joint.parent, []).append(child)
        joint_names = {joint.child: name for joint, name in zip(body.joints, names.joints, strict=True) if name}
        pending = [(link, False) for link in reversed(range(len(body.links))) if link not in placing]
        while pending:
            link, is_done = pending.pop()
            if is_done:
                self.close("body")
                continue
            self._open_link(index, body, names.links[link], link, placing.get(link), joint_names.get(link))
            pending.append((link, True))
            pending.extend((child, False) for child in reversed(sorted(children.get(link, ()))))

    def _name(self, kind: str, body: KinBody, name: str) -> str:
        """Return a name that no other part of this kind has: the part's own if that is free."""
        unique = name
        while unique in self._taken[kind]:
            unique = f"{body.name}/{unique}"
        if unique != name:
            message = f"the {kind} '{name}' of '{body.name}' is called '{unique}' in the MJCF, where names are unique"
            self.diagnostics.warn("renamed", message, body.source)
        self._taken[kind].add(unique)
        return unique

    def _open_link(
        self, index: int, body: KinBody, name: str, link_index: int, joint: Joint | None, joint_name: str | None
    ) -> None:
        link = body.links[link_index]
        if joint is None:
            pose = link.T_world_link
        elif joint_name is None:
            pose = relative_pose(joint, [axis.value for axis in joint.axes])
        else:
            pose = joint.T_parent_child
        self._line(f"<!-- {str(link.source).replace('--', '- -')} -->", link.source)
        self.open("body", link.source, name=name, **_pose(pose))
        inertial = legal_inertial(link.inertial)
        if inertial != link.inertial:
            self.altered.append((index, link_index))
            message = f"MuJoCo refuses the mass or inertia of '{link.name}'; the MJCF has the nearest legal one"
            self.diagnostics.warn("raised-inertia", message, link.source)
        self.element("inertial", link.source, pos=inertial.com, mass=inertial.mass, **_inertia(inertial))
        if joint is not None and joint_name is not None:
            self._write_joint(joint, joint_name)
        for geometry in link.geometries:
            self._write_geometry(geometry)

    def _write_joint(self, joint: Joint, name: str) -> None:
        axis = joint.axes[0]
        child_wxyz = conjugate(joint.T_parent_child.wxyz)
        self.element(
            "joint",
            joint.source,
            name=name,
            type={"hinge": "hinge", "slider": "slide"}[joint.kind],
            pos=joint.T_parent_child.inverse().apply(joint.anchor),
            axis=rotate(child_wxyz, axis.direction),
            limited=False if axis.circular else None,
            range=None if axis.circular else (axis.lower, axis.upper),
            ref=axis.reference or None,
            actuatorfrcrange=(-axis.max_torque, axis.max_torque) if axis.max_torque else None,
        )

    def _write_geometry(self, geometry: Geometry) -> None:
        kind, size = _shape(geometry.shape)
        legal = tuple(max(part, SMALLEST) for part in size)
        if legal != size:
            message = f"MuJoCo refuses a {kind} of size {_text(size)}; the MJCF has {_text(legal)}"
            self.diagnostics.warn("raised-size", message, geometry.source)
        self.element(
            "geom",
            geometry.source,
            **{"class": None if geometry.visible else "collision"},
            type=kind,
            size=legal,
            **_pose(geometry.T_link_geometry),
            rgba=(*geometry.diffuse, 1.0 - geometry.transparency),
        )


def legal_inertial(inertial: Inertial) -> Inertial:
    """Return the nearest mass properties that MuJoCo takes: positive, and no moment above the sum of the others."""
    mass = max(inertial.mass, SMALLEST) if math.isfinite(inertial.mass) else SMALLEST
    finite = np.nan_to_num(np.array(inertial.inertia), nan=0.0, posinf=0.0, neginf=0.0)
    moments, axes = np.linalg.eigh(finite)
    small, middle, large = (max(float(moment), SMALLEST) for moment in moments)
    legal = np.array([max(small, large - middle), middle, large])
    if mass == inertial.mass and np.all(legal <= moments * (1 + 1e-12)):
        return inertial
    xx, xy, xz, _, yy, yz, _, _, zz = ((axes * legal) @ axes.T).ravel().tolist()
    return Inertial(mass, inertial.com, ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))


def _inertia(inertial: Inertial) -> dict[str, Attribute]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertial.inertia
    if xy == xz == yz == 0.0:
        return {"diaginertia": (xx, yy, zz)}
    return {"fullinertia": (xx, yy, zz, xy, xz, yz)}


def _shape(shape: Shape) -> tuple[str, tuple[float, ...]]:
    match shape:
        case Box(half_extents):
            return "box", half_extents
        case Sphere(radius):
            return "sphere", (radius,)
        case Cylinder(radius, height):
            return "cylinder", (radius, height / 2)
        case Capsule(radius, height):
            return "capsule", (radius, height / 2)


def _pose(pose: Pose) -> dict[str, Attribute]:
    """Return the attributes of a pose; a part that does nothing is left out."""
    attributes: dict[str, Attribute] = {}
    if any(pose.position):
        attributes["pos"] = pose.position
    if any(pose.wxyz[1:]):
        attributes["quat"] = pose.wxyz
    return attributes


def _flat(view: View) -> dict[str, Attribute]:
    colour: Rgb | Vec3 = view.background
    return {"rgb1": colour, "rgb2": colour}


def _attributes(attributes: dict[str, Attribute | None]) -> str:
    return "".join(f" {name}={quoteattr(_text(value))}" for name, value in attributes.items() if value is not None)


def _text(value: Attribute) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return " ".join(_text(part) for part in value)
    return repr(int(value) if abs(value) < 1e15 and value == int(value) else value)
