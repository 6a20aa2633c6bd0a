"""Damaged documents: mutations that keep most of them meaningful, and what may come of reading them.

``Fuzzer`` makes documents from a seed: the same seed and number give the same document. ``Trial`` reads one and lets
nothing pass but a scene or a ``RavemjError``.
"""

import functools
import random
import re
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from lxml import etree
from strategies import Node, RandomChoices, SceneModel, document, draw_scene, scene_node, split, xml
from waiting import PATIENCE, time_limit

from ravemj.engine.simulation import Simulation
from ravemj.errors import Diagnostics, RavemjError, RavemjWarning
from ravemj.formats import mjcf
from ravemj.formats.openrave_xml.actuator import ACTUATOR_TAGS
from ravemj.formats.openrave_xml.context import PLACEMENT_TAGS
from ravemj.formats.openrave_xml.environment import ENVIRONMENT_IGNORED
from ravemj.formats.openrave_xml.geom import GEOM_TAGS
from ravemj.formats.openrave_xml.joint import JOINT_ATTRIBUTES, JOINT_TAGS
from ravemj.formats.openrave_xml.sensor import COMMON_TAGS, device_tags
from ravemj.formats.readers import read_file
from ravemj.model.scene import SENSOR_KINDS

REPOSITORY = Path(__file__).resolve().parent.parent
SEEDS = (REPOSITORY / "models", REPOSITORY / "tests" / "data", REPOSITORY / "tests" / "conformance" / "cases")

MAIN = "main.xml"
Files = dict[str, bytes]

# What OpenRAVE knows and what it does not: the reader's own tables, and what they hold no names of.
TAGS = [
    "Environment", "Robot", "KinBody", "Body", "Joint", "Geom", "Mass", "Manipulator", "AttachedSensor", "Sensor",
    "Translation", "RotationAxis", "RotationMat", "Quat", "offsetfrom", "adjacent", "jointvalues", "modelsdir",
    "density", "total", "com", "inertia", "base", "effector", "joints", "closingdirection", "direction", "link",
    "camtrans", "camrotationaxis", "camrotmat", "camrotaxis", "bkgndcolor", "PhysicsEngine", "odeproperties", "gravity",
    "Controller", "transparency", "unknown", *ACTUATOR_TAGS, *ENVIRONMENT_IGNORED,
    *GEOM_TAGS, *JOINT_TAGS, *COMMON_TAGS, *PLACEMENT_TAGS,
    *(tag for kind in SENSOR_KINDS.values() for tag in device_tags(kind)),
]  # fmt: skip
ATTRIBUTES = sorted({"prefix", "file", "scalegeometry", "skipgeometry", "makejoinedlinksadjacent", "render", "group",
    "modifiable", "scale", "unknown", "xmlns", *JOINT_ATTRIBUTES})  # fmt: skip
VALUES = [
    "", "0", "1", "true", "false", "static", "box", "sphere", "cylinder", "capsule", "container", "trimesh", "none",
    "prism", "hinge", "slider", "spherical", "hinge2", "universal", "mimicgeom", "custom", "BaseCamera", "ode",
    "electric_motor",
    "main.xml", "part1.xml", ".", "missing.stl", "/dev/null", "a b", "-1", "2 3 4", "self", "GenericRobot",
]  # fmt: skip
NUMBERS = [
    "0", "-0", "1", "-1", "0.5", "1e-320", "1e-160", "1e-12", "1e10", "1e16", "1e77", "1e154", "1e200", "1e308",
    "-1e308",
    "1e309", "nan", "inf", "-inf", "1,2", "0x10", "1e", "+.5", "5.", "3.14159265358979", "360", "99999999999999999999",
    "1e-5", "word", "1_0", "--1", "²", "٣",
]  # fmt: skip
EQUATIONS = [
    "j0", "2*j0+1", "-j0", "sin(j0)", "j0^2", "1/j0", "sqrt(j0)", "log(j0-1)", "j0+j1", "j0*j1", "if(j0<0,1,2)",
    "polyroots2(1,j0,-1)", "acos(2+j0)", "j1-j1", "exp(exp(exp(j0+9)))", "j0/0", "x", "(", "j0 j1", "1e400*j0",
    "SSSA(1,1,1,j0)", "0", "1e300*j0", "min(j0,j1)", "joint0", "abs(j0)", "j0%0", "tan(j0)", "floor(j0)", "j0^0.5",
]  # fmt: skip


NAMES = {"name", "body1", "body2", "joint", "joint1", "joint2", "tendon1", "mesh", "file", "class"}
_NOT_FINITE = re.compile(r"\b(?:nan|inf)\b")


# ---------------------------------------------------------------------------------------------------- seeds


def parsed(content: bytes) -> Node | None:
    """Return a file as elements, or None where it is not well-formed."""
    try:
        root = etree.fromstring(content, etree.XMLParser(resolve_entities=False, remove_comments=True, remove_pis=True))
    except etree.XMLSyntaxError:
        return None

    def node(element: etree._Element) -> Node:
        attributes = {str(key): str(value) for key, value in element.attrib.items()}
        children = [node(child) for child in element if isinstance(child.tag, str)]
        return Node(etree.QName(element).localname, attributes, children, "" if children else element.text or "")

    return node(root)


@functools.cache
def seed_documents() -> list[Files]:
    """Return the models of the repository, and the conformance cases where they are at hand."""
    mains = [path for folder in SEEDS for path in sorted(folder.rglob("*.xml"))]
    seeds = [_with_includes(path) for path in mains]
    return [files for files in seeds if parsed(files[MAIN]) is not None]


def _with_includes(path: Path) -> Files:
    """Return a file with those in its folder and below, which it may name."""
    files = {MAIN: path.read_bytes()}
    if path.stem == "case":
        files |= {str(other.relative_to(path.parent)): other.read_bytes() for other in path.parent.rglob("*.xml")}
        files |= {str(other.relative_to(path.parent)): other.read_bytes() for other in path.parent.rglob("*.stl")}
        files.pop(path.name)
    return files


# ---------------------------------------------------------------------------------------------------- mutations


@dataclass
class Mutator:
    """Mutations of a tree of elements, in place."""

    random: random.Random
    root: Node

    def apply(self) -> None:
        weighted: list[tuple[int, Callable[[Sequence[Node]], None]]] = [
            (8, self.change_number),
            (6, self.change_numbers),
            (5, self.change_attribute),
            (4, self.add_attribute),
            (3, self.drop_attribute),
            (4, self.borrow_name),
            (2, self.rename),
            (4, self.drop),
            (4, self.duplicate),
            (4, self.swap),
            (3, self.move),
            (4, self.add_value),
            (3, self.follow),
            (1, self.add_text),
            (1, self.wrap),
        ]
        mutation = self.random.choices([change for _, change in weighted], [weight for weight, _ in weighted])[0]
        mutation(list(self.root.walk()))

    def _word(self) -> str:
        return self.random.choice(self.random.choice([NUMBERS, VALUES, TAGS, ATTRIBUTES]))

    def _values(self, nodes: Sequence[Node]) -> list[Node]:
        return [node for node in nodes if node.text.strip()] or [self.root]

    def _parents(self, nodes: Sequence[Node]) -> list[Node]:
        return [node for node in nodes if node.children] or [self.root]

    def change_number(self, nodes: Sequence[Node]) -> None:
        node = self.random.choice(self._values(nodes))
        words = node.text.split() or ["0"]
        place = self.random.randrange(len(words))
        words[place] = self.random.choice(NUMBERS)
        node.text = " ".join(words)

    def change_numbers(self, nodes: Sequence[Node]) -> None:
        node = self.random.choice(self._values(nodes))
        count = self.random.choice([0, 1, len(node.text.split()), self.random.randrange(12)])
        chosen = self.random.choice([NUMBERS[:8], ["0"], [*NUMBERS[:6], "0.3", "-0.7"]])
        node.text = " ".join(self.random.choice(chosen) for _ in range(count))

    def change_attribute(self, nodes: Sequence[Node]) -> None:
        node = self.random.choice([node for node in nodes if node.attributes] or [self.root])
        name = self.random.choice([*node.attributes, "type"])
        node.attributes[name] = self.random.choice(EQUATIONS) if name.startswith("mimic") else self._word()

    def add_attribute(self, nodes: Sequence[Node]) -> None:
        self.random.choice(nodes).attributes[self.random.choice(ATTRIBUTES)] = self._word()

    def drop_attribute(self, nodes: Sequence[Node]) -> None:
        node = self.random.choice([node for node in nodes if node.attributes] or [self.root])
        node.attributes.pop(self.random.choice([*node.attributes, ""]), None)

    def borrow_name(self, nodes: Sequence[Node]) -> None:
        """Make two things have one name, or one refer to another one."""
        names = [node.attributes["name"] for node in nodes if "name" in node.attributes] or ["a"]
        node = self.random.choice([node for node in nodes if "name" in node.attributes or node.text.isalnum()] or nodes)
        if node.children or "name" in node.attributes:
            node.attributes["name"] = self.random.choice(names)
        else:
            node.text = self.random.choice(names)

    def rename(self, nodes: Sequence[Node]) -> None:
        self.random.choice(nodes).tag = self.random.choice(TAGS)

    def drop(self, nodes: Sequence[Node]) -> None:
        children = self.random.choice(self._parents(nodes)).children
        if children:
            children.pop(self.random.randrange(len(children)))

    def duplicate(self, nodes: Sequence[Node]) -> None:
        children = self.random.choice(self._parents(nodes)).children
        if children:
            children.insert(self.random.randrange(len(children) + 1), copy(self.random.choice(children)))

    def swap(self, nodes: Sequence[Node]) -> None:
        children = self.random.choice(self._parents(nodes)).children
        if children:
            first, second = self.random.randrange(len(children)), self.random.randrange(len(children))
            children[first], children[second] = children[second], children[first]

    def move(self, nodes: Sequence[Node]) -> None:
        """Copy an element to where its like is at home, or to anywhere."""
        node = copy(self.random.choice(nodes))
        alike = [parent for parent in nodes if any(child.tag == node.tag for child in parent.children)]
        target = self.random.choice(alike or nodes) if self.random.random() < 0.7 else self.random.choice(nodes)
        if sum(1 for _ in self.root.walk()) < 2000:
            target.children.insert(self.random.randrange(len(target.children) + 1), node)

    def add_value(self, nodes: Sequence[Node]) -> None:
        text = " ".join(self.random.choice(NUMBERS[:14]) for _ in range(self.random.choice([1, 1, 2, 3, 4, 9])))
        node = Node(self.random.choice(TAGS), text=text)
        children = self.random.choice(self._parents(nodes)).children
        children.insert(self.random.randrange(len(children) + 1), node)

    def follow(self, nodes: Sequence[Node]) -> None:
        """Let a joint follow others."""
        joints = [node for node in nodes if node.tag.lower() == "joint"]
        names = [joint.attributes.get("name", "j0") for joint in joints]
        if joints:
            equation = self.random.choice(EQUATIONS)
            equation = equation.replace("j0", self.random.choice(names)).replace("j1", self.random.choice(names))
            self.random.choice(joints).attributes["mimic_pos"] = equation

    def add_text(self, nodes: Sequence[Node]) -> None:
        self.random.choice(nodes).text = self.random.choice(["", "\t", "x" * 300, "é\u202e]]&gt;", "1 " * 200])

    def wrap(self, nodes: Sequence[Node]) -> None:
        node = self.random.choice(nodes)
        node.children = [replaced(node, self.random.choice(TAGS))]


def copy(node: Node) -> Node:
    return replaced(node, node.tag)


def replaced(node: Node, tag: str) -> Node:
    return Node(tag, dict(node.attributes), [copy(child) for child in node.children], node.text)


def damage(content: bytes, source: random.Random) -> bytes:
    """Damage bytes, as a broken disk or a careless editor would."""
    place, length = source.randrange(len(content) + 1), source.randrange(20)
    kind = source.randrange(5)
    if kind == 0:
        return content[:place]
    if kind == 1:
        return content[:place] + source.choice([b"\0", b"<", b"&", b"]]>", b"\xff", b"&#0;", b"<!--"]) + content[place:]
    if kind == 2:
        return content[:place] + content[place + length :]
    if kind == 3:
        return content[:place] + content[place : place + length] * 3 + content[place + length :]
    try:
        return content.decode().encode(source.choice(["utf-16", "utf-8-sig", "utf-32", "latin-1"]))
    except UnicodeError:
        return content[place:]


class Fuzzer:
    """Makes damaged documents: number n of a seed is always the same.

    Attributes:
        seeds: What is mutated besides random models; more may be added.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self.seeds = list(seed_documents())

    def make(self, number: int) -> Files:
        source = random.Random(f"{self._seed}/{number}")
        files = self._start(source)
        names = [name for name in files if name.endswith(".xml")]
        name = MAIN if source.random() < 0.6 else source.choice(names)
        root = parsed(files[name])
        if root is not None:
            mutator = Mutator(source, root)
            for _ in range(source.choice([1, 1, 1, 2, 2, 3, 5, 9])):
                mutator.apply()
            files[name] = self._text(root, source)
        if source.random() < 0.08:
            files[name] = damage(files[name], source)
        return files

    def _start(self, source: random.Random) -> Files:
        if self.seeds and source.random() < 0.5:
            return dict(source.choice(self.seeds))
        choices = RandomChoices(source.randrange(2**32))
        scene: SceneModel = draw_scene(choices)
        if source.random() < 0.3:
            return {name: text.encode() for name, text in split(scene_node(scene), choices).items()}
        return {MAIN: xml(scene_node(scene)).encode()}

    def _text(self, root: Node, source: random.Random) -> bytes:
        if source.random() < 0.1:
            return document(root, RandomChoices(source.randrange(2**32)))
        return xml(root).encode()


# ---------------------------------------------------------------------------------------------------- trials


def main_file(files: Files) -> str:
    """Return the name of the file that is read; the others are those that it may name."""
    return MAIN if MAIN in files else next(iter(files))


@dataclass
class Outcome:
    """What came of a document.

    Attributes:
        links: How many links were read.
        signature: Codes of all findings, and the kind of failure: two documents with the same one say little more.
        refused: Why MuJoCo refuses the model, or nothing.
    """

    links: int = 0
    signature: frozenset[str] = field(default_factory=frozenset[str])
    refused: str = ""


@dataclass(frozen=True)
class Trial:
    """One reading of one document.

    Attributes:
        seconds: Longest time that it may take.
        deep: Whether to compile the model and to move it.
    """

    seconds: float = PATIENCE
    deep: bool = False

    def run(self, files: Files) -> Outcome:
        """Read a document and translate it.

        Raises:
            BaseException: anything but a ``RavemjError`` goes through.
        """
        with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
            for name, content in files.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            # For reading alone: where the limit interrupts writing, a file stays open, and a later test fails of it.
            with time_limit(self.seconds), warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.simplefilter("ignore", RavemjWarning)
                return self._read(str(Path(folder, main_file(files))))

    def _read(self, path: str) -> Outcome:
        reading = read_file(path)
        for finding in reading.diagnostics:
            assert str(finding)
        links = sum(len(body.links) for body in reading.scene.bodies)
        found = {finding.code for finding in reading.diagnostics}
        if reading.failure is not None:
            assert str(reading.failure)
            found.add(f"failure: {' '.join(reading.failure.message.lower().split()[:3])}")
        diagnostics = Diagnostics()
        text = mjcf.write(reading.scene, diagnostics)
        assert len(text.sources) == text.text.count("\n")
        found |= {finding.code for finding in diagnostics}
        outcome = Outcome(links, frozenset(found))
        root = etree.fromstring(text.text.encode(), etree.XMLParser(huge_tree=True))
        for element in root.iter(etree.Element):
            for name, value in element.attrib.items():
                assert name in NAMES or not _NOT_FINITE.search(value), f"{name} of <{element.tag}> is not finite"
        if self.deep:
            outcome.refused = self._move(reading.scene.bodies)
        return outcome

    def _move(self, bodies: Sequence[mjcf.document.KinBody]) -> str:
        simulation = Simulation()
        for body in bodies:
            simulation.add(body)
        try:
            simulation.compiled()
        except RavemjError as error:
            return error.message
        for state in simulation.bodies:
            kinematics = state.kinematics
            assert kinematics.link_transforms().shape == (len(state.scene.links), 4, 4)
            kinematics.set_values(kinematics.limits.clamp(np.full(kinematics.dof, 0.1)))
            assert kinematics.values().shape == (kinematics.dof,)
        return ""


def smaller(files: Files, fails: Callable[[Files], bool], seconds: float = 20.0) -> Files:
    """Return a small document that still fails: elements, attributes and words go, as far as the time allows."""
    end = time.monotonic() + seconds
    for name in [name for name in files if name != MAIN]:
        without = {key: value for key, value in files.items() if key != name}
        files = without if fails(without) else files
    root = parsed(files[MAIN])
    if root is None or not fails({**files, MAIN: xml(root).encode()}):
        return files
    changed = True
    while changed and time.monotonic() < end:
        changed = False
        for undo in _removals(root):
            changed = fails({**files, MAIN: xml(root).encode()})
            if changed:
                break
            undo()
            if time.monotonic() > end:
                break
    return {**files, MAIN: xml(root).encode()}


def _removals(root: Node) -> Iterator[Callable[[], object]]:
    """Remove one thing after the other from a tree; yield what puts it back."""
    for node in root.walk():
        for index, child in enumerate(list(node.children)):
            del node.children[index]
            yield lambda node=node, index=index, child=child: node.children.insert(index, child)
        for name, value in list(node.attributes.items()):
            del node.attributes[name]
            yield lambda node=node, name=name, value=value: node.attributes.update({name: value})
        words = node.text.split()
        for index in range(len(words)):
            text, node.text = node.text, " ".join(words[:index] + words[index + 1 :])
            yield lambda node=node, text=text: setattr(node, "text", text)
            if words[index] not in {"0", "1"} and not node.children:
                text, node.text = node.text, " ".join([*words[:index], "0", *words[index + 1 :]])
                yield lambda node=node, text=text: setattr(node, "text", text)
