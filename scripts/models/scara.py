"""Writes a SCARA robot as COLLADA 1.5: ``python scripts/models/scara.py models/scara.dae``.

Distances are those of the AdeptOne in R. J. Schilling, "Fundamentals of Robotics: Analysis and Control", Prentice Hall,
1990: a1 = 425 mm, a2 = 375 mm, d1 = 877 mm, d4 = 200 mm, and every link has the frame that Denavit and Hartenberg give
it there. Shapes, colours, masses, limits and speeds are ours.
"""

import math
import sys
from pathlib import Path
from typing import NamedTuple

from lxml import etree

Point = tuple[float, float]
Vector = tuple[float, float, float]

COLOURS = {"paint": "0.93 0.56 0.12", "cast": "0.2 0.22 0.25", "steel": "0.7 0.72 0.75", "rubber": "0.1 0.1 0.11"}
CORNERS = 24  # of a circle


class Prism(NamedTuple):
    """A shape along z: the outline around two circles, whose centres are on the x axis."""

    colour: str
    circles: tuple[tuple[float, float], tuple[float, float]]  # x and radius [m]
    bottom: float
    top: float


class Link(NamedTuple):
    """A link and the joint before it."""

    name: str
    joint: str  # revolute or prismatic; empty for the first
    limits: tuple[float, float]  # [deg or m]
    speed: float  # [deg/s or m/s]
    offset: dict[str, str]  # from the frame of the joint to that of the link, as COLLADA has it
    centre: Vector  # of mass, in the frame of the whole robot where all joints are at 0 [m]
    mass: float  # [kg]
    size: Vector  # of a box with the same moments [m]
    shapes: tuple[Prism, ...]


def disc(colour: str, radius: float, bottom: float, top: float, x: float = 0.0) -> Prism:
    """Return a cylinder."""
    return Prism(colour, ((x, radius), (x, radius)), bottom, top)


LINKS = (
    Link("base", "", (0, 0), 0, {}, (0, 0, 0.4), 60, (0.22, 0.22, 0.8), (
        disc("cast", 0.17, 0, 0.03),
        disc("paint", 0.105, 0.03, 0.76),
        disc("cast", 0.09, 0.76, 0.822),
    )),
    Link("inner", "revolute", (-150, 150), 360, {"translate": "0.425 0 0.877", "rotate": "1 0 0 180"},
         (0.19, 0, 0.877), 14, (0.6, 0.18, 0.11), (
        Prism("paint", ((-0.425, 0.115), (0, 0.09)), -0.055, 0.055),
        disc("cast", 0.07, 0.055, 0.07),
    )),
    Link("outer", "revolute", (-147, 147), 360, {"translate": "0.375 0 0"},
         (0.57, 0, 1.0), 10, (0.48, 0.15, 0.14), (
        disc("cast", 0.07, -0.065, -0.055, -0.375),
        Prism("paint", ((-0.375, 0.09), (0, 0.065)), -0.15, -0.065),
        Prism("cast", ((-0.33, 0.07), (0, 0.05)), -0.22, -0.15),
    )),
    Link("quill", "prismatic", (0, 0.195), 0.5, {},
         (0.8, 0, 0.98), 1.5, (0.04, 0.04, 0.5), (
        disc("steel", 0.018, -0.43, 0.15),
        disc("cast", 0.03, -0.45, -0.43),
    )),
    Link("tool", "revolute", (-270, 270), 720, {"translate": "0 0 0.2"},
         (0.8, 0, 0.71), 0.3, (0.05, 0.05, 0.06), (
        disc("cast", 0.035, -0.055, -0.035),
        disc("steel", 0.01, -0.035, -0.012),
        disc("rubber", 0.018, -0.012, 0),
        Prism("paint", ((0.02, 0.006), (0.028, 0.006)), -0.06, -0.055),
    )),
)  # fmt: skip

JOINTS = range(1, len(LINKS))
HEAD = """<?xml version="1.0" encoding="utf-8"?>
<!--
A SCARA robot, written by scripts/models/scara.py. Distances are those of the AdeptOne in R. J. Schilling, "Fundamentals
of Robotics: Analysis and Control", Prentice Hall, 1990; shapes, colours, masses, limits and speeds are ours.
-->
"""


def main(path: Path) -> None:
    """Write the file."""
    path.write_text(document(), encoding="utf8")


def document() -> str:
    """Return the whole file."""
    tree = tag(
        "COLLADA",
        tag(
            "asset",
            tag("contributor", tag("authoring_tool", "scripts/models/scara.py")),
            tag("unit", meter="1"),
            tag("up_axis", "Z_UP"),
        ),
        tag("library_geometries", *(geometry(name, prism) for link in LINKS for name, prism in named(link))),
        tag("library_effects", *(effect(name) for name in COLOURS)),
        tag("library_materials", *(material(name) for name in COLOURS)),
        tag("library_visual_scenes", tag("visual_scene", node(0), id="vscene")),
        tag("library_kinematics_models", kinematics_model()),
        tag("library_articulated_systems", kinematics(), motion()),
        tag("library_kinematics_scenes", kinematics_scene()),
        tag("library_physics_scenes", physics_scene()),
        tag("library_physics_models", tag("physics_model", *map(rigid_body, range(len(LINKS))), id="pmodel")),
        scene(),
        xmlns="http://www.collada.org/2008/03/COLLADASchema",
        version="1.5.0",
    )
    etree.indent(tree)
    return f"{HEAD}{etree.tostring(tree, encoding='unicode')}\n"


def tag(kind: str, /, *content: "etree._Element | str", **attributes: str) -> "etree._Element":
    """Return an element with elements or a text in it."""
    element = etree.Element(kind, attributes)
    for item in content:
        if isinstance(item, str):
            element.text = item
        else:
            element.append(item)
    return element


def named(link: Link) -> list[tuple[str, Prism]]:
    """Return the shapes of a link with their names."""
    return [(f"{link.name}{number}", prism) for number, prism in enumerate(link.shapes)]


def geometry(name: str, prism: Prism) -> "etree._Element":
    """Return the triangles of a shape: the bottom, the top, and the walls."""
    around = outline(prism)
    count = len(around)
    points = [f"{x:g} {y:g} {z:g}" for z in (prism.bottom, prism.top) for x, y in around]
    bottom = [f"0 {n + 1} {n}" for n in range(1, count - 1)]
    top = [f"{count} {count + n} {count + n + 1}" for n in range(1, count - 1)]
    pairs = [(n, (n + 1) % count) for n in range(count)]
    walls = [f"{a} {b} {count + b}" for a, b in pairs] + [f"{a} {count + b} {count + a}" for a, b in pairs]
    accessor = tag(
        "accessor",
        *(tag("param", name=axis, type="float") for axis in "XYZ"),
        source=f"#{name}-array",
        count=f"{2 * count}",
        stride="3",
    )
    source = tag(
        "source",
        tag("float_array", lines(points, 5), id=f"{name}-array", count=f"{6 * count}"),
        tag("technique_common", accessor),
        id=f"{name}-points",
    )
    triangles = tag(
        "triangles",
        tag("input", semantic="VERTEX", source=f"#{name}-vertices", offset="0"),
        tag("p", lines([*bottom, *top, *walls], 10)),
        count=f"{4 * count - 4}",
        material=prism.colour,
    )
    vertices = tag("vertices", tag("input", semantic="POSITION", source=f"#{name}-points"), id=f"{name}-vertices")
    return tag("geometry", tag("mesh", source, vertices, triangles), id=name, name=name)


def outline(prism: Prism) -> list[Point]:
    """Return the corners around the two circles of a prism, counter-clockwise seen from above."""
    (x0, r0), (x1, r1) = prism.circles
    tilt = math.acos((r0 - r1) / (x1 - x0)) if x1 > x0 else math.pi / 2  # where a tangent touches both
    half = CORNERS // 2

    def arc(x: float, radius: float, begin: float, end: float) -> list[Point]:
        angles = [begin + (end - begin) * step / half for step in range(half + 1)]
        return [(round(x + radius * math.cos(angle), 5), round(radius * math.sin(angle), 5)) for angle in angles]

    second, first = arc(x1, r1, -tilt, tilt), arc(x0, r0, tilt, 2 * math.pi - tilt)
    return [*second, *first] if x1 > x0 else [*second[:-1], *first[:-1]]


def lines(words: list[str], length: int) -> str:
    """Return words in lines of some each."""
    return "\n".join(" ".join(words[start : start + length]) for start in range(0, len(words), length))


def effect(name: str) -> "etree._Element":
    """Return the ``<effect>`` of a colour."""
    phong = tag("phong", *(tag(kind, tag("color", f"{COLOURS[name]} 1")) for kind in ("ambient", "diffuse")))
    return tag("effect", tag("profile_COMMON", tag("technique", phong, sid="common")), id=f"{name}-effect")


def material(name: str) -> "etree._Element":
    """Return the ``<material>`` of a colour."""
    return tag("material", tag("instance_effect", url=f"#{name}-effect"), id=name)


def node(number: int) -> "etree._Element":
    """Return the node of a link, with that of the next link in it."""
    link = LINKS[number]
    axis = [tag("rotate", "0 0 1 0") if link.joint == "revolute" else tag("translate", "0 0 0")] if link.joint else []
    for element in axis:
        element.set("sid", f"axis{number}")
    shapes = [instance_geometry(name, prism.colour) for name, prism in named(link)]
    inner = [node(number + 1)] if number + 1 < len(LINKS) else []
    return tag("node", *axis, *offset(link), *shapes, *inner, id=f"node{number}", sid=f"node{number}", name=link.name)


def offset(link: Link) -> "list[etree._Element]":
    """Return what lies between the frame of a joint and that of its link."""
    return [tag(kind, numbers) for kind, numbers in link.offset.items()]


def instance_geometry(name: str, colour: str) -> "etree._Element":
    """Return a shape in its colour."""
    bound = tag("instance_material", symbol=colour, target=f"#{colour}")
    return tag("instance_geometry", tag("bind_material", tag("technique_common", bound)), url=f"#{name}")


def kinematics_model() -> "etree._Element":
    """Return the joints, and the links behind each other."""
    joints = [joint(number) for number in JOINTS]
    return tag("kinematics_model", tag("technique_common", *joints, kinematic_link(0)), id="kmodel", name="scara")


def joint(number: int) -> "etree._Element":
    """Return the ``<joint>`` before a link."""
    link = LINKS[number]
    return tag("joint", tag(link.joint, tag("axis", "0 0 1"), sid="axis0"), sid=f"joint{number}", name=f"joint{number}")


def kinematic_link(number: int) -> "etree._Element":
    """Return a ``<link>`` with the next one in it."""
    link = tag("link", *offset(LINKS[number]), sid=f"link{number}", name=LINKS[number].name)
    if number + 1 < len(LINKS):
        link.append(tag("attachment_full", kinematic_link(number + 1), joint=f"kmodel/joint{number + 1}"))
    return link


def kinematics() -> "etree._Element":
    """Return the system that says where the joints stop."""
    parameters = [parameter("k_model", "kinematics/kmodel_inst")]
    parameters += [parameter(f"k_axis{n}", f"kinematics/kmodel_inst/joint{n}/axis0") for n in JOINTS]
    instance = tag("instance_kinematics_model", *parameters, url="#kmodel", sid="kmodel_inst")
    infos = [limited(number) for number in JOINTS]
    return tag("articulated_system", tag("kinematics", instance, tag("technique_common", *infos)), id="kinematics")


def limited(number: int) -> "etree._Element":
    """Return the limits of a joint."""
    low, high = (tag(name, value(limit)) for name, limit in zip(("min", "max"), LINKS[number].limits, strict=True))
    active, locked = (tag(name, tag("bool", truth)) for name, truth in (("active", "true"), ("locked", "false")))
    return tag(
        "axis_info", active, locked, tag("limits", low, high), axis=f"kmodel/joint{number}/axis0", sid=f"info{number}"
    )


def motion() -> "etree._Element":
    """Return the system that says how fast the joints move, and what the robot holds things with."""
    parameters = [parameter("m_model", "kinematics/k_model")]
    parameters += [parameter(f"m_axis{n}", f"kinematics/k_axis{n}") for n in JOINTS]
    instance = tag("instance_articulated_system", *parameters, url="#kinematics")
    infos = [
        tag("axis_info", tag("speed", value(speed)), tag("acceleration", value(4 * speed)), axis=f"kinematics/info{n}")
        for n, speed in ((number, LINKS[number].speed) for number in JOINTS)
    ]
    tip = tag("frame_tip", tag("direction", "0 0 1"), link=f"kmodel/link{len(LINKS) - 1}")
    technique = tag("technique", tag("frame_origin", link="kmodel/link0"), tip, profile="OpenRAVE")
    return tag(
        "articulated_system",
        tag("motion", instance, tag("technique_common", *infos)),
        tag("extra", technique, type="manipulator", name="arm"),
        id="motion",
    )


def parameter(name: str, path: str) -> "etree._Element":
    """Return a name for what a path leads to."""
    return tag("newparam", tag("SIDREF", path), sid=name)


def value(number: float) -> "etree._Element":
    """Return a number as limits and speeds have it."""
    return tag("float", f"{number:g}")


def kinematics_scene() -> "etree._Element":
    """Return the scene that the robot moves in."""
    parameters = [
        parameter("s_model", "motion/m_model"),
        *(parameter(f"s_axis{n}", f"motion/m_axis{n}") for n in JOINTS),
    ]
    instance = tag("instance_articulated_system", *parameters, url="#motion", sid="scara", name="scara")
    return tag("kinematics_scene", instance, id="kscene")


def physics_scene() -> "etree._Element":
    """Return what binds masses to nodes."""
    bodies = [tag("instance_rigid_body", body=f"rigid{n}", target=f"#node{n}") for n in range(len(LINKS))]
    model = tag("instance_physics_model", *bodies, url="#pmodel", sid="pmodel_inst", parent="#node0")
    return tag("physics_scene", model, tag("technique_common", tag("gravity", "0 0 -9.81")), id="pscene")


def rigid_body(number: int) -> "etree._Element":
    """Return the mass of a link, spread as in a solid box."""
    link = LINKS[number]
    x, y, z = (size**2 for size in link.size)
    moments = " ".join(f"{link.mass / 12 * total:.4g}" for total in (y + z, x + z, x + y))
    centre = " ".join(f"{part:g}" for part in link.centre)
    common = tag(
        "technique_common",
        tag("dynamic", "true" if number else "false"),
        tag("mass", f"{link.mass:g}"),
        tag("mass_frame", tag("translate", centre)),
        tag("inertia", moments),
    )
    return tag("rigid_body", common, sid=f"rigid{number}")


def scene() -> "etree._Element":
    """Return what is in the world, and which node shows what moves."""
    bound = [
        tag(
            "bind_joint_axis",
            tag("axis", tag("param", f"s_axis{n}")),
            tag("value", value(0)),
            target=f"node0/axis{n}",
        )
        for n in JOINTS
    ]
    model = tag("bind_kinematics_model", tag("param", "s_model"), node="node0")
    return tag(
        "scene",
        tag("instance_physics_scene", url="#pscene"),
        tag("instance_visual_scene", url="#vscene"),
        tag("instance_kinematics_scene", model, *bound, url="#kscene"),
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
