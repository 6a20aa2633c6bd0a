"""Names of the parts of bodies in other COLLADA files to which a document refers."""

import os
from collections.abc import Iterator
from typing import NamedTuple
from urllib.parse import quote

from ravemj.core.transforms import Pose
from ravemj.errors import Source, SourceError
from ravemj.formats import settled
from ravemj.formats.collada.axis import AxisReader
from ravemj.formats.collada.bindings import AxisBinding, Bindings, ModelBinding, read_bindings
from ravemj.formats.collada.extras import inside_extra
from ravemj.formats.collada.geometry_writer import write_pose
from ravemj.formats.collada.library import ARCHIVE_SUFFIX, Library
from ravemj.formats.collada.sections import Sections
from ravemj.formats.collada.system_writer import bind_axis, write_grabs
from ravemj.formats.collada.visual import Node, expand
from ravemj.formats.data_folders import find, name_in_data_folders
from ravemj.formats.file_access import FileAccess
from ravemj.formats.meshes.collada.document import ColladaDocument, Element, child, children, local_name
from ravemj.model.scene import KinBody

_MODEL_PARTS = {"instance_kinematics_model", "instance_joint"}
"""Tags of the instances that an axis's path must contain, since several instances may contain the same axis."""
_TOP = "external_node"
"""Prefix of the numbered names of outermost nodes. Inner nodes have other names, so that paths are unique."""


class _BoundAxis(NamedTuple):
    """Joint axis that the file binds to a node.

    Attributes:
        path: Path of the axis in the articulated system.
        target: Name of the node's transform.
        joint: Source of the joint.
        place: Index of the axis in the joint.
        unit: Factor from values in the file to rad or m.
    """

    path: str
    target: str
    joint: Source
    place: int
    unit: float


class _RigidBodies(NamedTuple):
    """Instance of a physics model: its URL, its parent node, and pairs (rigid body, node)."""

    url: str
    parent: str | None
    bodies: tuple[tuple[str, str], ...]


class ExternalBody(NamedTuple):
    """A body in another file.

    Attributes:
        uri: The file, relative to the file that refers to it.
        suffix: Suffix of the ids of its nodes, since a document may contain several copies of them.
        system: The id of its articulated system.
        nodes: The ids of its outermost nodes.
        models: For each kinematics model its path in the articulated system, and the path of its node.
        axes: Its axes.
        links: For each link its source, and its path in the articulated system.
        physics: Instances of physics models with its masses.
        T_world_file: Transform from the file's frame to the world.
    """

    uri: str
    suffix: str
    system: str
    nodes: tuple[str, ...]
    models: tuple[tuple[str, str], ...]
    axes: tuple[_BoundAxis, ...]
    links: dict[Source, str]
    physics: tuple[_RigidBodies, ...]
    T_world_file: Pose = Pose()


def find_external(body: KinBody, number: int, target: str, scheme: str | None = None) -> ExternalBody:
    """Look up the names of a body's parts in the COLLADA file that it was read from.

    Args:
        body: The body.
        number: Its number in the document that will refer to it.
        target: Path of this document.
        scheme: Scheme of URIs of files in the folders of ``OPENRAVE_DATA``; None for relative URIs.

    Raises:
        SourceError: The body was read from another format or from the file that will be replaced, or its file is
            missing or lacks names.
    """
    file, line = body.source.file, body.source.line
    archive, inside, _ = file.partition(f"{ARCHIVE_SUFFIX}/")
    path = archive + ARCHIVE_SUFFIX if inside else file
    if not path.lower().endswith((".dae", ARCHIVE_SUFFIX)):
        raise SourceError("it comes from no COLLADA file", body.source)
    if not os.path.isfile(path):
        raise SourceError("the file that it comes from is gone", body.source)
    if os.path.realpath(path) == os.path.realpath(target):
        raise SourceError("it comes from the file that is going to be replaced", body.source)
    library = Library(FileAccess.opened(path))
    document = library.open_file(path)
    if document.path != file:
        raise SourceError("it comes from a file inside of an archive", body.source)
    return _Finder(library, document, _uri(path, target, scheme), f".body{number}").find(line)


def _uri(path: str, target: str, scheme: str | None) -> str:
    """Return the URI of ``path`` for the file ``target``: relative, or ``scheme`` with a data folder's path."""
    name = name_in_data_folders(path) if scheme else ""
    file = find(name) if name else None
    if file is not None and os.path.samefile(file, path):  # an earlier folder may have another file of that name
        start = f"{scheme}:/"
    else:
        start, name = "", os.path.relpath(path, os.path.dirname(target) or ".")
    return start + quote(name.replace(os.sep, "/"))


class _Finder:
    def __init__(self, library: Library, document: ColladaDocument, uri: str, suffix: str) -> None:
        self._library = library
        self._uri = uri
        self._suffix = suffix
        self._document = document
        self._scene = child(document.root, "scene")
        visual = child(self._scene, "instance_visual_scene")
        shown = None if visual is None else library.follow(visual)
        self._root = None if shown is None else expand(library, shown)

    def find(self, line: int) -> ExternalBody:
        """Return the body whose instance or articulated system is at a line of the file.

        Raises:
            SourceError: There is no such body, or its parts have no names.
        """
        for kinematics in children(self._scene, "instance_kinematics_scene"):
            scene = self._library.follow(kinematics)
            for instance in children(scene, "instance_articulated_system"):
                system = self._library.follow(instance)
                if scene is not None and system is not None and line in (instance.sourceline, system.sourceline):
                    bindings = read_bindings(self._library, kinematics, scene, self._root)
                    return self._described(instance, system, bindings)
        raise SourceError("the file has no such body any more", Source(self._document.path, line))

    def _described(self, instance: Element, system: Element, bindings: Bindings) -> ExternalBody:
        models = [binding for binding in bindings.models if binding.owner is instance]
        axes = [binding for binding in bindings.axes if binding.owner is instance and binding.node is not None]
        shown = [binding.node for binding in models] + [binding.node for binding in axes if binding.node is not None]
        tops = list(dict.fromkeys(_top(node) for node in shown))
        return ExternalBody(
            self._uri,
            self._suffix,
            self._name(system, "id"),
            tuple(self._name(top.element, "id") for top in tops),
            tuple((self._name(model.instance, "sid"), self._path(model.node, tops)) for model in models),
            tuple(self._axis(axis, axis.node, tops) for axis in axes if axis.node is not None),
            dict(self._links(models)),
            tuple(self._physics(tops)),
        )

    def _name(self, element: Element, attribute: str) -> str:
        name = element.get(attribute)
        if not name:
            raise self._library.error(f"the element has no {attribute} by which to refer to it", element)
        return name

    def _path(self, node: Node, tops: list[Node]) -> str:
        """Return the path of a node from its outermost node, which is named by its index in ``tops``."""
        around = [*node.around()][:-2]  # without the outermost one and the scene
        named = [(step.element.get("sid"), step.element.get("id")) for step in reversed(around)]
        names = [sid or f"{identity}{self._suffix}" for sid, identity in named if sid or identity]
        return "/".join((f"{_TOP}{tops.index(_top(node))}", *names))

    def _axis(self, binding: AxisBinding, node: Node, tops: list[Node]) -> _BoundAxis:
        joint = binding.axis.getparent()
        if joint is None:
            raise self._library.error("an axis belongs to a joint", binding.axis)
        through = [item for item in binding.through if local_name(item) in _MODEL_PARTS]
        parts = through if any(local_name(item) == "instance_joint" for item in through) else [*through, joint]
        axes = [*children(joint, "revolute", "prismatic")]
        place = axes.index(binding.axis)
        sids = [sid for item in children(node.element, "rotate", "translate") if (sid := item.get("sid"))]
        return _BoundAxis(
            "/".join(self._name(item, "sid") for item in (*parts, binding.axis)),
            "/".join((self._path(node, tops), *sids[place : place + 1])),
            self._library.source(joint),
            place,
            AxisReader(self._library, binding.axis).value(1.0),
        )

    def _links(self, models: list[ModelBinding]) -> Iterator[tuple[Source, str]]:
        for binding in models:
            model = self._library.follow(binding.instance)
            for link in () if model is None else model.iter("{*}link"):
                if link.get("sid"):
                    yield self._library.source(link), f"{binding.instance.get('sid')}/{link.get('sid')}"

    def _physics(self, tops: list[Node]) -> Iterator[_RigidBodies]:
        for physics in children(self._scene, "instance_physics_scene"):
            for instance in children(self._library.follow(physics), "instance_physics_model"):
                rigid = [
                    (body.get("body") or "", target)
                    for body in children(instance, "instance_rigid_body")
                    if self._is_in(target := (body.get("target") or "").removeprefix("#"), tops)
                ]
                url, parent = instance.get("url") or "", (instance.get("parent") or "").removeprefix("#")
                if rigid:
                    url = f"{self._uri}{url}" if url.startswith("#") else url
                    yield _RigidBodies(url, parent or None, tuple(rigid))

    def _is_in(self, name: str, tops: list[Node]) -> bool:
        node = None if self._root is None else self._root.find(name)
        return node is not None and _top(node) in tops


def _top(node: Node) -> Node:
    """Return a node's outermost ancestor, a direct child of the scene."""
    return [*node.around()][-2]


def write_reference(sections: Sections, body: KinBody, number: int, external: ExternalBody) -> None:
    """Write a body as a reference to another file, with its name, pose, joint values and grabbed bodies."""
    name = f"body{number}"
    out = sections.nodes
    with out.inside("node", id=f"{name}_external", name=body.name):
        write_pose(out, settled.pose(external.T_world_file))
        for place, node in enumerate(external.nodes):
            with out.inside("instance_node", url=f"{external.uri}#{node}", sid=f"{_TOP}{place}"):
                out.element("extra", type="idsuffix", name=external.suffix)
    out = sections.systems
    with out.inside("articulated_system", id=f"{name}_motion"):
        with out.inside("motion"):
            out.element("instance_articulated_system", url=f"{external.uri}#{external.system}", sid=f"{name}_origin")
            out.element("technique_common")
        with inside_extra(out):
            out.element("name", body.name)
            write_grabs(out, body, lambda link: f"{name}_origin/{external.links[body.links[link].source]}")
    _write_bindings(sections, body, name, external)
    out = sections.physics_scene
    for physics in external.physics:
        parent = None if physics.parent is None else f"#{physics.parent}{external.suffix}"
        with out.inside("instance_physics_model", url=physics.url, parent=parent):
            for rigid, target in physics.bodies:
                out.element("instance_rigid_body", body=rigid, target=f"#{target}{external.suffix}")


def _write_bindings(sections: Sections, body: KinBody, name: str, external: ExternalBody) -> None:
    """Instantiate the body in the kinematics scene; bind its models to nodes and its axes to transforms and values."""
    scope, paths = f"{name}_scene", [path for path, _ in external.models] + [axis.path for axis in external.axes]
    out = sections.kinematics_scene
    with out.inside("instance_articulated_system", url=f"#{name}_motion", sid=scope, name=body.name):
        for place, path in enumerate(paths):
            out.element_inside("newparam", "SIDREF", f"{scope}/{name}_origin/{path}", sid=f"{scope}_{place}")
    out = sections.bindings
    for place, (_, node) in enumerate(external.models):
        out.element_inside("bind_kinematics_model", "param", f"{scope}_{place}", node=f"{name}_external/{node}")
    joints = {joint.source: joint for joint in body.joints}
    for place, axis in enumerate(external.axes, len(external.models)):
        joint = joints.get(axis.joint)
        value = 0.0 if joint is None or axis.place >= len(joint.axes) else joint.axes[axis.place].value
        bind_axis(out, f"{name}_external/{axis.target}", f"{scope}_{place}", settled.number(value / axis.unit))
