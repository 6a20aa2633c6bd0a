"""Random OpenRAVE models, and a printer of OpenRAVE XML that shares nothing with ravemj.

``draw_scene`` makes a ``SceneModel`` out of choices, which come from hypothesis (``scenes``) or from a seed
(``RandomChoices``). ``scene_node`` turns it into elements in one of several spellings, ``xml`` into plain text,
``disguised`` into text that reads the same though it looks different, and ``split`` into files that include each other.
"""

import math
import os
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeVar
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

PROFILE = os.environ.get("HYPOTHESIS_PROFILE")
DEV = PROFILE == "dev"

T = TypeVar("T")
Vector = tuple[float, float, float]


def examples(count: int) -> settings:
    """Return the settings of a property: a quarter of the examples, or all of them with HYPOTHESIS_PROFILE=ci.

    They are the same each time, and are shown as they were drawn when one fails. HYPOTHESIS_PROFILE=dev draws new ones
    each time, twenty times as many, and makes the failing one small.
    """
    share = {"ci": 1.0, "dev": 20.0}.get(PROFILE or "", 0.25)
    return settings(
        max_examples=round(count * share),
        derandomize=not DEV,
        database=None,
        phases=[Phase.explicit, Phase.generate, Phase.shrink] if DEV else [Phase.explicit, Phase.generate],
        suppress_health_check=[
            HealthCheck.function_scoped_fixture,
            HealthCheck.too_slow,
            HealthCheck.data_too_large,
            HealthCheck.large_base_example,
        ],
    )


class Choices(Protocol):
    """Where decisions come from."""

    def integer(self, lower: int, upper: int) -> int: ...


class RandomChoices:
    """Decisions from a seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def integer(self, lower: int, upper: int) -> int:
        return self._random.randint(lower, upper)


@dataclass(frozen=True)
class DrawnChoices:
    """Decisions that hypothesis makes, and can shrink."""

    draw: Callable[[st.SearchStrategy[int]], int]

    def integer(self, lower: int, upper: int) -> int:
        return self.draw(st.integers(lower, upper))


def chance(choices: Choices, percent: int) -> bool:
    return choices.integer(0, 99) >= 100 - percent


def one_of(choices: Choices, options: Sequence[T]) -> T:
    return options[choices.integer(0, len(options) - 1)]


def number(choices: Choices, lower: float, upper: float) -> float:
    """Draw a number, most often of three decimals."""
    value = choices.integer(math.ceil(lower * 1000), math.floor(upper * 1000)) / 1000
    return value * (1 - 1 / 7e9) if chance(choices, 10) else value


def vector(choices: Choices, size: float) -> Vector:
    return (number(choices, -size, size), number(choices, -size, size), number(choices, -size, size))


# ---------------------------------------------------------------------------------------------------- the models


@dataclass(frozen=True)
class Move:
    """A ``<Translation>``."""

    vector: Vector


@dataclass(frozen=True)
class Turn:
    """A rotation element; ``spelling`` is one of SPELLINGS."""

    axis: Vector
    degrees: float
    spelling: str


SPELLINGS = ("axis", "matrix", "quaternion")
Transform = tuple[Move | Turn, ...]


@dataclass(frozen=True)
class GeomModel:
    kind: str
    numbers: dict[str, tuple[float, ...]]
    transform: Transform = ()
    look: dict[str, tuple[float, ...]] = field(default_factory=dict)
    name: str = ""
    visible: bool = True


@dataclass(frozen=True)
class MassModel:
    kind: str
    numbers: dict[str, tuple[float, ...]]


@dataclass(frozen=True)
class LinkModel:
    name: str
    transform: Transform
    offset_from: str = ""
    geoms: tuple[GeomModel, ...] = ()
    mass: MassModel | None = None
    static: bool = False
    enabled: bool = True


@dataclass(frozen=True)
class MimicModel:
    """f = constant + sum of slope * leader, or of slope * sin(leader)."""

    constant: float
    terms: tuple[tuple[float, str, bool], ...]

    def text(self) -> str:
        parts = [f"{slope!r}*sin({name})" if wave else f"{slope!r}*{name}" for slope, name, wave in self.terms]
        return "+".join([*parts, repr(self.constant)])

    def value(self, leaders: dict[str, float]) -> float:
        parts = (slope * (math.sin(leaders[name]) if wave else leaders[name]) for slope, name, wave in self.terms)
        return self.constant + sum(parts)


@dataclass(frozen=True)
class JointModel:
    name: str
    kind: str
    first: str
    second: str
    offset_from: str = ""
    anchor: Vector | None = None
    axes: tuple[Vector, ...] = ()
    limits: tuple[tuple[float, float], ...] | None = None
    circular: bool = False
    initial: float = 0.0
    enabled: bool = True
    mimic: MimicModel | None = None
    numbers: dict[str, float] = field(default_factory=dict)

    @property
    def active(self) -> bool:
        return self.enabled and self.mimic is None


@dataclass(frozen=True)
class ScopeModel:
    """A ``<Robot>`` or ``<KinBody>``; the items are what is inside, in document order."""

    robot: bool
    transform: Transform
    items: tuple["LinkModel | JointModel | ScopeModel", ...]
    scale: tuple[float, ...] = ()
    default_mass: MassModel | None = None

    def parts(self) -> "Iterator[LinkModel | JointModel]":
        """Yield links and joints in document order."""
        for item in self.items:
            if isinstance(item, ScopeModel):
                yield from item.parts()
            else:
                yield item


@dataclass(frozen=True)
class BodyModel:
    name: str
    scope: ScopeModel
    prefix: str = ""
    effector: str = ""
    sensor: str = ""
    gripper: tuple[str, ...] = ()
    adjacent_joints: bool = True

    @property
    def links(self) -> list[LinkModel]:
        return [part for part in self.scope.parts() if isinstance(part, LinkModel)]

    @property
    def joints(self) -> list[JointModel]:
        return [part for part in self.scope.parts() if isinstance(part, JointModel)]


@dataclass(frozen=True, repr=False)
class SceneModel:
    bodies: tuple[BodyModel, ...]
    background: Vector | None = None

    def __repr__(self) -> str:
        return xml(scene_node(self))


WELD = {kind: ((0.0, 0.0),) * count for kind, count in (("hinge", 1), ("slider", 1), ("hinge2", 2), ("spherical", 3))}
"""Limits that hold a joint of each kind in its place."""


# ---------------------------------------------------------------------------------------------------- drawing models


@dataclass(frozen=True)
class Taste:
    """What the models are made of.

    Attributes:
        kinds: Kinds of joints.
        bodies: Most bodies of a scene.
        links: Most links of a body.
        trees: Whether all joints are enabled, move, and lead away from link 0, which alone may be static.
        plain: No scales, no prefixes.
    """

    kinds: tuple[str, ...] = ("hinge", "slider", "hinge", "spherical", "hinge2")
    bodies: int = 3
    links: int = 6
    trees: bool = False
    mimics: bool = True
    plain: bool = False


def draw_transform(choices: Choices, most: int = 3, size: float = 1.0) -> Transform:
    def draw_one() -> Move | Turn:
        if chance(choices, 50):
            return Move(vector(choices, size))
        axis = vector(choices, 2.0) if chance(choices, 50) else one_of(choices, [(0, 0, 1), (0, 2, 0), (-1, 0, 0)])
        degrees = number(choices, -400, 400) if chance(choices, 50) else one_of(choices, [90.0, 180.0, -90.0, 45.0])
        return Turn(axis if any(axis) else (0, 0, 1), degrees, one_of(choices, SPELLINGS))

    return tuple(draw_one() for _ in range(choices.integer(0, most)))


_STEMS = ("link", "Arm", "b-", "é", "x.y", "A<&>", "it's", '"q"', "[0]")


def draw_name(choices: Choices, index: int) -> str:
    """Draw a name that no other index has in any letter case."""
    return f"{one_of(choices, _STEMS)}{index}"


def draw_geom(choices: Choices) -> GeomModel:
    def length() -> float:
        return number(choices, 0.001, 0.5)

    kind = one_of(choices, ("box", "sphere", "cylinder", "capsule", "container", "trimesh", "none"))
    sizes: dict[str, tuple[float, ...]] = {}
    if kind == "box":
        sizes[one_of(choices, ("extents", "halfextents", "fullextents"))] = (length(), length(), length())
    elif kind in {"sphere", "cylinder", "capsule"}:
        sizes["radius"] = (length(),)
        if kind != "sphere":
            sizes["height"] = (length(),)
    elif kind == "container":
        inner = (length(), length(), length())
        sizes["outer_extents"] = tuple(part + length() for part in inner)
        sizes["inner_extents"] = inner
    elif kind == "trimesh":
        corners = [vector(choices, 0.5) for _ in range(4)]
        faces = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]
        sizes["vertices"] = tuple(part for face in faces for corner in face for part in corners[corner])
    look: dict[str, tuple[float, ...]] = {}
    if chance(choices, 30):
        look["diffuseColor"] = tuple(number(choices, 0, 1) for _ in range(3))
        look["transparency"] = (number(choices, 0, 1),)
    name = f"geom{choices.integer(0, 9)}" if chance(choices, 20) else ""
    return GeomModel(kind, sizes, draw_transform(choices, 2, 0.3), look, name, not chance(choices, 10))


def draw_mass(choices: Choices, kinds: Sequence[str]) -> MassModel:
    kind = one_of(choices, kinds)
    numbers: dict[str, tuple[float, ...]] = {}
    numbers[one_of(choices, ("density", "total")) if kind != "custom" else "total"] = (number(choices, 0.1, 9),)
    if kind == "mimicgeom":
        numbers = {"density": (number(choices, 1, 5000),)}
    if kind == "sphere":
        numbers["radius"] = (number(choices, 0.01, 1),)
    if kind == "custom":
        numbers["com"] = vector(choices, 0.3)
        a, b, c = (number(choices, 0.01, 1) for _ in range(3))
        turned = rotation_matrix(vector(choices, 1), number(choices, -180, 180))
        numbers["inertia"] = tuple((turned @ np.diag([b + c, a + c, a + b]) @ turned.T).ravel().tolist())
    return MassModel(kind, numbers)


def draw_body(choices: Choices, name: str, taste: Taste) -> BodyModel:
    """Draw a body: links, a tree of joints over them, and how elements nest around both."""
    count = choices.integer(1, taste.links)
    links = [_draw_link(choices, index, taste) for index in range(count)]
    robot = chance(choices, 50)
    edges = _draw_edges(choices, count, taste)
    scope, scopes = _draw_scopes(choices, links, robot, taste)
    owners = [next(index for index, scope in enumerate(scopes) if link.name in scope) for link in links]
    joints = [
        _draw_joint(choices, f"j{index}" if chance(choices, 70) else draw_name(choices, index), edge, links, taste)
        for index, edge in enumerate(edges)
    ]
    joints = [
        joint
        if joint.enabled or owners[edge[0]] == owners[edge[1]]
        else replace(joint, limits=WELD[joint.kind], circular=False, initial=0.0)
        for joint, edge in zip(joints, edges, strict=True)
    ]
    mimics = _draw_mimics(choices, joints, taste) if taste.mimics else joints
    joints = mimics if any(joint.active for joint in mimics) else joints  # without a DOF nothing follows
    placed, _ = _with_joints(choices, scope, [], joints)
    reached = _reached(links[0].name, joints)
    arm = robot and any(joint.active for joint in joints) and chance(choices, 60)
    return BodyModel(
        name,
        placed,
        prefix="p_" if robot and not taste.plain and chance(choices, 20) else "",
        effector=one_of(choices, reached) if arm else "",
        sensor=one_of(choices, links).name if robot and chance(choices, 30) else "",
        gripper=tuple(joint.name for joint in joints if robot and chance(choices, 15)),
        adjacent_joints=not chance(choices, 10),
    )


def _reached(start: str, joints: Sequence[JointModel]) -> list[str]:
    found = [start]
    for link in found:
        for joint in joints:
            found += [b for a, b in ((joint.first, joint.second), (joint.second, joint.first)) if a == link]
            found = list(dict.fromkeys(found))
    return found


def _draw_link(choices: Choices, index: int, taste: Taste) -> LinkModel:
    return LinkModel(
        draw_name(choices, index),
        draw_transform(choices),
        geoms=tuple(draw_geom(choices) for _ in range(choices.integer(0, 2))),
        mass=draw_mass(choices, ("mimicgeom", "sphere", "box", "custom")) if chance(choices, 50) else None,
        static=index == 0 and chance(choices, 20),
        enabled=not chance(choices, 10),
    )


def _draw_edges(choices: Choices, count: int, taste: Taste) -> list[tuple[int, int]]:
    """Draw a tree over the links; now and then a leaf stays alone. Either link may be listed first."""
    order = list(range(count))
    for place in range(count - 1):
        other = choices.integer(place, count - 1)
        order[place], order[other] = order[other], order[place]
    edges = [(one_of(choices, order[:place]), order[place]) for place in range(1, count)]
    if not taste.trees and chance(choices, 20):
        ends = [link for edge in edges for link in edge]
        edges = [edge for edge in edges if ends.count(edge[1]) > 1 or edge[1] == 0 or not chance(choices, 30)]
    return [(b, a) if chance(choices, 50) else (a, b) for a, b in edges]


def _draw_scopes(
    choices: Choices, links: Sequence[LinkModel], robot: bool, taste: Taste
) -> tuple[ScopeModel, list[list[str]]]:
    """Spread the links over nested elements; return the outermost one, and the links that are directly in each."""
    groups: list[list[LinkModel]] = [[]]
    for link in links:
        if groups[-1] and chance(choices, 25):
            groups.append([])
        groups[-1].append(link)

    def scope(robot: bool, items: tuple[LinkModel | ScopeModel, ...]) -> ScopeModel:
        scale: tuple[float, ...] = ()
        if not taste.plain and chance(choices, 10):
            scale = tuple(number(choices, 0.5, 2) for _ in range(one_of(choices, (1, 3))))
        mass = draw_mass(choices, ("mimicgeom", "sphere", "box")) if not robot and chance(choices, 20) else None
        return ScopeModel(robot, draw_transform(choices), items, scale, mass)

    def with_offsets(group: Sequence[LinkModel]) -> tuple[LinkModel, ...]:
        names = [link.name for link in group]
        return tuple(
            replace(link, offset_from=one_of(choices, names[:index])) if index and chance(choices, 40) else link
            for index, link in enumerate(group)
        )

    parts = [with_offsets(group) for group in groups]
    scopes = [[link.name for link in group] for group in groups]
    if robot:
        inner: tuple[ScopeModel, ...] = tuple(scope(False, part) for part in parts)
        wrapped = scope(True, inner[:1]) if chance(choices, 15) else None
        return scope(True, (wrapped, *inner[1:]) if wrapped else inner), scopes
    return scope(False, (*parts[0], *(scope(False, part) for part in parts[1:]))), scopes


def _draw_joint(
    choices: Choices, name: str, edge: tuple[int, int], links: Sequence[LinkModel], taste: Taste
) -> JointModel:
    kind = one_of(choices, taste.kinds)
    count = {"hinge": 1, "slider": 1, "spherical": 0, "hinge2": 2}[kind]
    axes = tuple(vector(choices, 1) for _ in range(count))
    axes = tuple(axis if any(axis) else (0.0, 1.0, 0.0) for axis in axes)
    enabled = taste.trees or not chance(choices, 15)
    circular = kind == "hinge" and chance(choices, 20)
    limits = None
    if kind != "spherical" and not circular and chance(choices, 50):
        largest = 1.0 if kind == "slider" else 3.1
        limits = tuple(_draw_range(choices, largest) for _ in range(count))
        if not taste.trees and kind in {"hinge", "slider"} and chance(choices, 15):
            limits = WELD[kind]
    initial = 0.0
    if kind in {"hinge", "slider"} and limits not in WELD.values() and chance(choices, 25):
        initial = number(choices, -1.5, 1.5)
    frames = ["", links[edge[0]].name, links[edge[1]].name]
    names = ("weight", "resolution", "maxvel", "maxaccel", "maxtorque")
    return JointModel(
        name,
        kind,
        links[edge[0]].name,
        links[edge[1]].name,
        one_of(choices, frames),
        vector(choices, 1) if chance(choices, 60) else None,
        () if kind == "hinge" and chance(choices, 10) else axes,
        limits,
        circular,
        initial,
        enabled,
        numbers={key: number(choices, 0.1, 20) for key in names if chance(choices, 15)},
    )


def _draw_range(choices: Choices, largest: float) -> tuple[float, float]:
    lower = number(choices, -largest, largest - 0.01)
    return (lower, number(choices, lower + 0.01, max(largest, lower + 0.011)))


def _draw_mimics(choices: Choices, joints: list[JointModel], taste: Taste) -> list[JointModel]:
    """Let some joints follow others, also ones that follow themselves; nothing follows in a circle."""
    leaders: list[JointModel] = []
    result: dict[str, JointModel] = {}
    for listed in reversed(joints) if chance(choices, 50) else joints:
        joint = listed
        single = joint.kind in {"hinge", "slider"}
        if single and leaders and joint.limits not in WELD.values() and chance(choices, 30):
            chosen = list(dict.fromkeys(one_of(choices, leaders).name for _ in range(choices.integer(1, 2))))
            terms = tuple((number(choices, -2, 2), name, chance(choices, 20)) for name in chosen)
            joint = replace(joint, mimic=MimicModel(number(choices, -0.5, 0.5), terms))
            joint = replace(joint, enabled=taste.trees or chance(choices, 80))
        if single:
            leaders.append(joint)
        result[joint.name] = joint
    return [result[joint.name] for joint in joints]


def _with_joints(
    choices: Choices, scope: ScopeModel, known: list[str], joints: Sequence[JointModel]
) -> tuple[ScopeModel, list[JointModel]]:
    """Put each joint somewhere behind its links; return what has found no place yet."""
    waiting, items = list(joints), []
    for item in scope.items:
        if isinstance(item, ScopeModel):
            inner, waiting = _with_joints(choices, item, known, waiting)
            items.append(inner)
        else:
            items.append(item)
            known.append(item.name)
        if scope.robot:
            continue
        ready = [joint for joint in waiting if {joint.first, joint.second, joint.offset_from} <= {*known, ""}]
        last = item is scope.items[-1]
        now = [joint for joint in ready if last or chance(choices, 60)]
        waiting = [joint for joint in waiting if joint not in now]
        items += now
    return replace(scope, items=tuple(items)), waiting


def draw_scene(choices: Choices, taste: Taste | None = None) -> SceneModel:
    taste = taste or Taste()
    bodies = tuple(draw_body(choices, f"body{i}", taste) for i in range(choices.integer(1, taste.bodies)))
    background = tuple(number(choices, 0, 1) for _ in range(3)) if chance(choices, 20) else None
    return SceneModel(bodies, background)


def scenes(taste: Taste | None = None) -> st.SearchStrategy[SceneModel]:
    """Draw scenes: from seeds, or decision by decision, which takes hypothesis long, where it can make them small."""
    if DEV:
        return st.composite(lambda draw: draw_scene(DrawnChoices(draw), taste))()
    return choices().map(lambda chosen: draw_scene(chosen, taste))


def choices() -> st.SearchStrategy[Choices]:
    """Draw where further decisions come from."""
    return st.integers(0, 2**32 - 1).map(RandomChoices)


# ---------------------------------------------------------------------------------------------------- elements


@dataclass
class Node:
    """An element in the making."""

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["Node"] = field(default_factory=list)
    text: str = ""

    def walk(self) -> "Iterator[Node]":
        yield self
        for child in self.children:
            yield from child.walk()


@dataclass(frozen=True)
class Spelling:
    """How to write what can be written in several ways.

    Attributes:
        rotations: One of SPELLINGS, or None: as the model has it.
        degrees: Whether to use the tags in degrees.
    """

    rotations: str | None = None
    degrees: bool = False


def rotation_matrix(axis: Sequence[float], degrees: float) -> np.ndarray:
    """Return the right-handed rotation about an axis of any length (Rodrigues)."""
    length = math.sqrt(sum(part * part for part in axis))
    if length == 0:
        return np.eye(3)
    x, y, z = (part / length for part in axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def _numbers(tag: str, *values: float) -> Node:
    return Node(tag, text=" ".join(repr(float(value)) for value in values))


def _transform_nodes(transform: Transform, spelling: Spelling) -> list[Node]:
    nodes: list[Node] = []
    for step in transform:
        kind = "" if isinstance(step, Move) else spelling.rotations or step.spelling
        if isinstance(step, Move):
            nodes.append(_numbers("Translation", *step.vector))
        elif kind == "axis":
            nodes.append(_numbers("RotationAxis", *step.axis, step.degrees))
        elif kind == "matrix":
            nodes.append(_numbers("RotationMat", *rotation_matrix(step.axis, step.degrees).ravel()))
        else:
            half = math.radians(step.degrees) / 2
            length = math.sqrt(sum(part * part for part in step.axis))
            nodes.append(_numbers("Quat", *(2 * math.cos(half), *(2 * math.sin(half) * p / length for p in step.axis))))
    return nodes


def _geom_node(geom: GeomModel, spelling: Spelling) -> Node:
    attributes = {} if geom.kind == "box" and geom.name else {"type": geom.kind}
    if not geom.visible:
        attributes["render"] = "false"
    node = Node("Geom", attributes, [_numbers(tag, *values) for tag, values in {**geom.numbers, **geom.look}.items()])
    if geom.name:
        node.children.append(Node("name", text=geom.name))
    node.children += _transform_nodes(geom.transform, spelling)
    return node


def _mass_node(mass: MassModel) -> Node:
    return Node("Mass", {"type": mass.kind}, [_numbers(tag, *values) for tag, values in mass.numbers.items()])


def _link_node(link: LinkModel, spelling: Spelling) -> Node:
    node = Node("Body", {"name": link.name, "type": "static" if link.static else "dynamic"})
    if not link.enabled:
        node.attributes["enable"] = "false"
    node.children = _transform_nodes(link.transform, spelling)
    node.children += [_geom_node(geom, spelling) for geom in link.geoms]
    if link.offset_from:
        node.children.append(Node("offsetfrom", text=link.offset_from))
    if link.mass:
        node.children.append(_mass_node(link.mass))
    return node


def _joint_node(joint: JointModel, spelling: Spelling) -> Node:
    node = Node("Joint", {"name": joint.name, "type": joint.kind})
    if joint.circular:
        node.attributes["circular"] = "true"
    if not joint.enabled:
        node.attributes["enable"] = "false"
    if joint.mimic is not None:
        node.attributes["mimic_pos"] = joint.mimic.text()
    node.children = [Node("Body", text=joint.first), Node("Body", text=joint.second)]
    if joint.offset_from:
        node.children.append(Node("offsetfrom", text=joint.offset_from))
    if joint.anchor is not None:
        node.children.append(_numbers("anchor", *joint.anchor))
    tags = ("axis1", "axis2") if joint.kind == "hinge2" else ("axis",)
    node.children += [_numbers(tag, *axis) for tag, axis in zip(tags, joint.axes, strict=False)]
    node.children += _joint_numbers(joint, degrees=spelling.degrees)
    return node


_AXES = {"hinge2": 2, "spherical": 3}


def _joint_numbers(joint: JointModel, *, degrees: bool) -> list[Node]:
    nodes: list[Node] = []
    if joint.limits is not None:
        values = [value for limits in joint.limits for value in limits]
        turns = joint.kind != "slider" and degrees
        nodes.append(_numbers("limitsdeg", *map(math.degrees, values)) if turns else _numbers("limits", *values))
    if joint.initial:
        nodes.append(_numbers("initial", joint.initial))
    for tag, value in joint.numbers.items():
        in_degrees = degrees and tag in {"maxvel", "maxaccel"}
        values = [math.degrees(value) if in_degrees else value] * _AXES.get(joint.kind, 1)
        nodes.append(_numbers(f"{tag}deg" if in_degrees else tag, *values))
    return nodes


def _scope_node(scope: ScopeModel, spelling: Spelling) -> Node:
    node = Node("Robot" if scope.robot else "KinBody")
    if scope.scale:
        node.attributes["scalegeometry"] = " ".join(map(repr, scope.scale))
    if scope.default_mass:
        node.children.append(_mass_node(scope.default_mass))
    transform = _transform_nodes(scope.transform, spelling)
    node.children += transform[:1]  # it acts at the end tag, wherever it stands
    for item in scope.items:
        if isinstance(item, ScopeModel):
            node.children.append(_scope_node(item, spelling))
        else:
            make = _link_node if isinstance(item, LinkModel) else _joint_node
            node.children.append(make(item, spelling))  # pyright: ignore[reportArgumentType]
    node.children += transform[1:]
    return node


def body_node(body: BodyModel, spelling: Spelling | None = None) -> Node:
    node = _scope_node(body.scope, spelling or Spelling())
    node.attributes["name"] = body.name
    if body.prefix:
        node.attributes["prefix"] = body.prefix
    if not body.adjacent_joints:
        node.attributes["makejoinedlinksadjacent"] = "0"
    if body.effector:
        parts = [Node("base", text=body.links[0].name), Node("effector", text=body.effector)]
        parts.append(Node("joints", text=" ".join(body.gripper)))
        parts.append(_numbers("closingdirection", *(1.0 for _ in body.gripper)))
        node.children.append(Node("Manipulator", {"name": "arm"}, [*parts, _numbers("Translation", 0, 0, 0.1)]))
    if body.sensor:
        device = Node("Sensor", {"type": "BaseCamera"}, [_numbers("KK", 500, 500, 320, 240), Node("width", text="640")])
        node.children.append(Node("AttachedSensor", {"name": "eye"}, [Node("link", text=body.sensor), device]))
    return node


def scene_node(scene: SceneModel, spelling: Spelling | None = None) -> Node:
    node = Node("Environment", children=[body_node(body, spelling) for body in scene.bodies])
    if scene.background is not None:
        node.children.insert(0, _numbers("bkgndcolor", *scene.background))
    return node


# ---------------------------------------------------------------------------------------------------- text


def xml(node: Node, indent: str = "") -> str:
    """Return plain text, an element a line."""
    attributes = "".join(f" {name}={quoteattr(value)}" for name, value in node.attributes.items())
    start = f"{indent}<{node.tag}{attributes}"
    if node.children:
        inner = "".join(xml(child, indent + "  ") for child in node.children)
        return f"{start}>\n{inner}{indent}</{node.tag}>\n"
    return f"{start}>{escape(node.text)}</{node.tag}>\n" if node.text else f"{start}/>\n"


_BLANKS = (" ", "\n", "\t", "  \r\n ", " \n\n ")
_BETWEEN = (
    "", "", "\n", "  ", "\n\n\t", "<!-- a > b -->", "<!---->\n", "<?hint x='<y>'?>", "stray text",
    "<unknownTag a='1'><Body name='no'/></unknownTag>", "<![CDATA[<Body name='no'/>]]>", "<a:b/>",
)  # fmt: skip


def disguised(node: Node, choices: Choices) -> str:
    """Return text that reads the same: other letter case, order, quotes, spaces, comments, CDATA, unknown elements."""
    return _Disguise(choices).element(node)


class _Disguise:
    def __init__(self, choices: Choices) -> None:
        self.choices = choices

    def element(self, node: Node) -> str:
        attributes = list(node.attributes.items())
        if chance(self.choices, 10):
            attributes.append(("unknownAttribute", "<&>"))
        if len(attributes) > 1 and chance(self.choices, 50):
            attributes.reverse()
        tag = self._cased(node.tag)
        start = tag + "".join(self._attribute(name, value) for name, value in attributes)
        inner = "".join(self._between() + self.element(child) for child in node.children)
        if node.children:
            inner += self._between()
        elif node.text:
            inner = self._content(node.text)
        if not inner and chance(self.choices, 50):
            return f"<{start}{self._one_of('/>', ' />')}"
        return f"<{start}>{inner}</{tag}{self._one_of('', ' ')}>"

    def _one_of(self, *options: str) -> str:
        return one_of(self.choices, options)

    def _between(self) -> str:
        return self._one_of(*_BETWEEN)

    def _cased(self, name: str) -> str:
        return self._one_of(name, name.lower(), name.upper(), name.swapcase())

    def _attribute(self, name: str, value: str) -> str:
        if name in {"type", "enable", "circular", "render"}:
            value = self._cased(value)
        single = escape(value, {"'": "&#39;", '"': "&#x22;"})
        quoted = self._one_of(quoteattr(value), f"'{single}'")
        return f"{self._one_of(' ', '  ', chr(10))}{self._cased(name)}{self._one_of('=', ' = ')}{quoted}"

    def _piece(self, text: str) -> str:
        references = "".join(f"&#{ord(letter)};" for letter in text)
        return self._one_of(escape(text), f"<![CDATA[{text}]]>", references)

    def _content(self, text: str) -> str:
        words = text.split() or [""]
        cut = self.choices.integer(0, len(words[0]))
        parts = [self._piece(words[0][:cut]), self._one_of("", "<!-- x -->", "<?y z?>"), self._piece(words[0][cut:])]
        for word in words[1:]:
            parts += [self._one_of(*_BLANKS), self._piece(word) if chance(self.choices, 20) else escape(word)]
        return "".join([self._one_of("", " ", "\n\t"), *parts, self._one_of("", " ", "<!-- 7 -->")])


def document(node: Node, choices: Choices) -> bytes:
    """Return a disguised document in one of the encodings that can write it."""
    text = disguised(node, choices)
    behind = one_of(choices, ("", "\n", "<!-- end -->", "<Robot name='never'/>", "garbage </", "<"))
    encodings = ["utf-8", "utf-16", "utf-8-sig"]
    if all(ord(letter) < 256 for letter in text):
        encodings.append("iso-8859-1")
    encoding = one_of(choices, encodings)
    declared = "utf-8" if encoding == "utf-8-sig" else encoding
    head = f'<?xml version="1.0" encoding="{declared}"?>\n'
    if encoding in {"utf-8", "utf-8-sig"} and chance(choices, 50):
        head = one_of(choices, ("", "<!DOCTYPE x>", "<!-- first -->\n", "<?a b?>"))
    return (head + text + behind).encode(encoding)


def split(root: Node, choices: Choices, percent: int = 50) -> dict[str, str]:
    """Move the content of bodies into files of their own, nested ones too; return all files, the first one first."""
    files: dict[str, str] = {"main.xml": ""}

    def moved(node: Node, folder: str, depth: int) -> Node:
        if node.tag not in {"Robot", "KinBody", "Environment"}:
            return node
        # An including tag counts after all of its file, also after KinBodies that are nested there.
        stays = "makejoinedlinksadjacent" in node.attributes
        into_file = depth > 0 and chance(choices, percent) and not stays
        inner_folder = os.path.join(folder, one_of(choices, ("", "sub", "models x"))) if into_file else folder
        children = [moved(child, inner_folder, depth + 1) for child in node.children]
        if not into_file:
            return replace(node, children=children)
        path = os.path.join(inner_folder, f"part{len(files)}.xml")
        files[path] = xml(Node(node.tag, children=children))
        name = os.path.relpath(path, folder or ".")
        return replace(node, attributes={**node.attributes, "file": name}, children=[])

    top = moved(root, "", 0)
    files["main.xml"] = xml(top)
    return files
