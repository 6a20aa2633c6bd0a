"""``<scene>``: the bodies of a document, and its sensors without a robot."""

from typing import NamedTuple

from ravemj.core.transforms import Vec3, inverse
from ravemj.formats.collada.bindings import read_bindings
from ravemj.formats.collada.geometry import GeometryReader
from ravemj.formats.collada.kinematics_model import Infos, ModelReader, SceneContext, valid_name
from ravemj.formats.collada.library import Library
from ravemj.formats.collada.physics import NO_MASS, PhysicsScenes
from ravemj.formats.collada.robot import ExtraReader, interface_kind
from ravemj.formats.collada.sensor import read_loose
from ravemj.formats.collada.supplement import SupplementReader
from ravemj.formats.collada.visual import Node, expand, rigid_part
from ravemj.formats.limits import check_count
from ravemj.formats.meshes.collada.document import ColladaDocument, Element, child, children, local_name, words
from ravemj.model.builder import BodyBuilder, LinkBuilder
from ravemj.model.scene import AttachedSensor

_MAX_DEPTH = 20
_GRAVITY: dict[str, Vec3] = {"X_UP": (-9.797930195020351, 0.0, 0.0), "Y_UP": (0.0, -9.797930195020351, 0.0)}
"""OpenRAVE's gravity [m/s^2] for files whose up axis is not z."""
_MOST_SYSTEMS = 1000


class Content(NamedTuple):
    """The content of a document.

    Attributes:
        bodies: Bodies with kinematics, articulated systems first.
        others: Bodies that consist of a node of the visual scene only.
        gravity: Gravitational acceleration [m/s^2], or None.
        sensors: Sensors without a robot.
        description: Description in its ``<asset>``.
    """

    bodies: list[BodyBuilder]
    others: list[BodyBuilder]
    gravity: Vec3 | None
    sensors: list[AttachedSensor]
    description: str = ""


def read_document(library: Library, document: ColladaDocument, wanted: str = "") -> Content:
    """Read all bodies of a document.

    Args:
        library: The documents.
        document: The document to read.
        wanted: The id of an articulated system or model to read a single body; empty for all bodies.

    Raises:
        SourceError: It has impossible content, or the body does not exist.
    """
    scene = child(document.root, "scene")
    instance = child(scene, "instance_visual_scene")
    visual = None if instance is None else library.follow(instance)
    root = None if visual is None else expand(library, visual)
    physics = PhysicsScenes(library, scene, root)
    up = " ".join(words(child(document.root, "asset", "up_axis")))
    gravity = physics.gravity or _GRAVITY.get(up)
    geometry = GeometryReader(library)
    bodies: list[BodyBuilder] = []
    sensors: list[AttachedSensor] = []
    shown: set[Node] = set()
    for kinematics in children(scene, "instance_kinematics_scene"):
        element = library.follow(kinematics)
        if element is not None:
            bindings = read_bindings(library, kinematics, element, root)
            shared = SceneContext(library, bindings, physics, geometry)
            shown |= bindings.moved
            for kind in ("instance_articulated_system", "instance_kinematics_model"):
                read = (_body(shared, item, wanted) for item in children(element, kind))
                bodies += [body for body in read if body is not None]
            sensors += read_loose(library, element)
    if wanted:
        if not bodies:
            raise library.error(f"there is no articulated system '{wanted}' in the scene", document.root)
        return Content(bodies, [], gravity, [])
    if len(bodies) == 1:
        bodies[0].element = ""
    taken = {node for inner in shown for node in inner.around()}
    nodes = [] if root is None else [node for node in root.nodes if node not in taken]
    others = [body for node in nodes if (body := _node_body(library, geometry, node)) is not None]
    subject = child(document.root, "asset", "subject")
    description = "" if subject is None else subject.text or ""
    return Content(bodies, others, gravity, sensors, description)


class _System(NamedTuple):
    """Nested articulated systems, the outermost first, and their models; without systems, a single model."""

    systems: list[Element]
    models: list[Element]
    infos: Infos

    @property
    def id(self) -> str:
        """Id of the outermost system, else of the model; empty if it has none."""
        return (self.systems or self.models)[0].get("id") or ""

    def has(self, name: str) -> bool:
        """Return whether a system or model has this id or sid, or is instantiated by this URL."""
        parts = (*self.systems, *self.models)
        return any(name in (part.get("id"), part.get("sid"), (part.get("url") or "").lstrip("#")) for part in parts)


def _body(scene: SceneContext, instance: Element, wanted: str) -> BodyBuilder | None:
    """Return the body of an instance of a system or model; None if it is not the one wanted, or has no model."""
    parts = _System([], [], {})
    is_system = local_name(instance) == "instance_articulated_system"
    if is_system:
        _take_apart(scene, instance, parts, {}, 0)
    else:
        parts.models.append(instance)
    if wanted and not parts.has(wanted) and wanted != instance.get("sid"):
        return None
    is_robot = is_system and interface_kind(instance, *parts.systems) != "kinbody"
    here = scene.library.document_of(instance)
    others = (system for system in parts.systems if scene.library.document_of(system) is not here)
    other = next(others, None)
    body = BodyBuilder(is_robot, scene.library.source(instance if other is None else other))  # of the defining file
    readers: list[ModelReader] = []
    for item in parts.models:
        model = scene.library.follow(item)
        if model is not None:
            readers.append(ModelReader(scene, body, instance, item, model, parts.infos))
            readers[-1].read()
    if not readers:
        return None
    body.element = parts.id if other is None else ""
    for reader in readers:
        reader.settle(readers)
    model = readers[0].model
    body.name = valid_name(model.get("name") or model.get("id") or instance.get("name"))
    body.check_joint_names()
    links = {element: index for reader in reversed(readers) for element, index in reader.links.items()}
    joints = {element: index for reader in reversed(readers) for element, index in reader.joints.items()}
    values = [values for reader in readers for values in reader.values]
    ExtraReader(scene.library, body, [reader.model for reader in readers], links, joints).read(parts.systems)
    supplement = SupplementReader(
        scene.library,
        scene.geometry,
        body,
        {element: body.links[index] for element, index in links.items()},
        {element: body.joints[index] for element, index in joints.items()},
        values,
    )
    for system in reversed(parts.systems):  # what refers to a system has the last word
        supplement.read(system)
    chosen = [value for joint, own in zip(body.joints, values, strict=True) if joint.active for value in own]
    body.joint_values = chosen if any(chosen) else None
    return body


def _take_apart(
    scene: SceneContext, instance: Element, parts: _System, motions: dict[Element, Element], depth: int
) -> None:
    """Collect in ``parts`` the systems and models that an instance of a system contains, recursively.

    ``motions`` are the ``<axis_info>`` elements of the enclosing ``<motion>`` elements, by axis.
    """
    system = scene.library.follow(instance)
    if system is None or depth > _MAX_DEPTH:
        return
    check_count(len(parts.systems), _MOST_SYSTEMS, "articulated systems in a body", scene.library.source(instance))
    parts.systems.append(system)
    motion, kinematics = child(system, "motion"), child(system, "kinematics")
    if motion is not None:
        inner = {**motions, **_axis_infos(scene, motion)}
        for item in children(motion, "instance_articulated_system"):
            _take_apart(scene, item, parts, inner, depth + 1)
    if kinematics is not None:
        for axis, info in _axis_infos(scene, kinematics).items():
            parts.infos[axis] = (info, motions.get(info, motions.get(axis)))
        parts.models.extend(children(kinematics, "instance_kinematics_model"))


def _axis_infos(scene: SceneContext, part: Element) -> dict[Element, Element]:
    """Return the ``<axis_info>`` elements of a system's ``<kinematics>`` or ``<motion>``, by axis."""
    infos: dict[Element, Element] = {}
    for info in children(child(part, "technique_common"), "axis_info"):
        axis = scene.library.resolve(info.get("axis") or "", part)
        if axis is None:
            scene.library.warn("broken-reference", f"there is no axis '{info.get('axis')}'", info)
        else:
            infos[axis.element] = info
    return infos


def _node_body(library: Library, geometry: GeometryReader, node: Node) -> BodyBuilder | None:
    """Return the single-link body that OpenRAVE creates for a scene node; None if the node has no geometry."""
    source = library.source(node.element)
    name = valid_name(node.name)
    T_world_link = rigid_part(node.world, source)
    T_link_world = inverse(T_world_link.matrix())
    shapes = geometry.read(node, lambda inner: T_link_world @ inner.world)
    if not shapes:
        return None
    body = BodyBuilder(is_robot=False, source=source, name=name)
    body.links.append(LinkBuilder(name, source, T_world_link, shapes, inertial=NO_MASS))
    return body
