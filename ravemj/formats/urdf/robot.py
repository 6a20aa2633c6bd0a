"""``<robot>``: conversion of a URDF to a body."""

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ravemj.errors import Diagnostics, LimitError, SourceError
from ravemj.formats.openrave_xml.context import Context
from ravemj.formats.openrave_xml.tree import Document, Element, parse, parse_file
from ravemj.formats.urdf import OR_URDF, arms, check_robot
from ravemj.formats.urdf.elements import check_children, children, named
from ravemj.formats.urdf.joint import UrdfJoint, follow, make_joint, read_frame
from ravemj.formats.urdf.link import read_groups, read_link
from ravemj.formats.urdf.packages import Packages, given_packages
from ravemj.formats.urdf.shapes import UrdfShapeReader
from ravemj.formats.urdf.tree import RobotTree
from ravemj.model.builder import BodyBuilder, LinkBuilder
from ravemj.model.scene import KinBody

NO_SRDF = "none"

_KNOWN = ("link", "joint", "material")
_LEFT_OUT = ("gazebo", "transmission", "ros2_control", "sensor", "calibration", "safety_controller", "loop_joint")
_VERSIONS = {"1.0", "1.1", "1.2", "1"}


def read_robot(root: Element, context: Context, given: Mapping[str, str]) -> BodyBuilder:
    """Read a URDF, and its SRDF if there is one.

    Args:
        root: The element ``<robot>``.
        context: The context of the reading.
        given: Attributes passed by the caller, such as the SRDF; see ``ravemj.formats.urdf.GIVEN``.

    Raises:
        SourceError: the document is not a valid robot.
    """
    check_robot(root)
    check_children(root, _KNOWN, context, _LEFT_OUT)
    _note_left_out(root, context)
    version = root.attributes.get("version", "1.0")
    if version not in _VERSIONS:
        message = f"the version '{version}' of URDF is not known; the file is read as version 1.2"
        context.diagnostics.warn("unknown-version", message, root.source)
    elements = named(children(root, "link"), "link")
    if not elements:
        raise SourceError("there is no <link> in it", root.source)
    frames = [read_frame(joint, elements, context) for joint in named(children(root, "joint"), "joint").values()]
    floating = _floating(frames, elements, context)
    sources = {name: element.source for name, element in elements.items()}
    tree = RobotTree(sources, [joint for joint in frames if joint.type != "floating"], floating)
    _check_roots(tree, context)
    body = BodyBuilder(is_robot=True, source=root.source, name=_name(root, context))
    _add_parts(body, tree, elements, root, context, given)
    _add_srdf(body, tree, root, context, given)
    return body


def settle(body: BodyBuilder, context: Context) -> KinBody:
    """Return the frozen body; clamped initial values are reported together, since legged robots have many."""
    findings = Diagnostics()
    frozen = body.freeze(findings)
    moved = [finding for finding in findings if finding.code == "value-outside-limits"]
    for finding in findings:
        if finding.code != "value-outside-limits":
            context.diagnostics.add(finding)
    if moved:
        others = f" (and {len(moved) - 1} more joints of it)" if len(moved) > 1 else ""
        context.diagnostics.add(replace(moved[0], message=f"{moved[0].message}{others}"))
    return frozen


def _name(root: Element, context: Context) -> str:
    """Return the robot's name as one word, as OpenRAVE requires; by default the file's name."""
    name = root.attributes.get("name", "").strip()
    if not name:
        name = Path(root.source.file).stem
        message = f"<robot> has no name; it is called '{name}' like the file"
        context.diagnostics.warn("no-name", message, root.source, 'write name="…"')
    word = "_".join("".join(letter if letter.isprintable() else " " for letter in name).split())
    if word != root.attributes.get("name", word):
        message = f"the robot is called '{word}': names of bodies are one word"
        context.diagnostics.warn("changed-name", message, root.source)
    return word


def _note_left_out(root: Element, context: Context) -> None:
    """Report unused elements, once for each tag."""
    inner = (part for child in root.children if child.spelled in {"link", "joint"} for part in child.children)
    left_out = [child for child in (*root.children, *inner) if child.spelled in _LEFT_OUT]
    for tag, count in Counter(child.spelled for child in left_out).items():
        first = next(child for child in left_out if child.spelled == tag)
        context.diagnostics.note("left-out", f"<{tag}> is left out, {count} in the file", first.source)


def _floating(frames: list[UrdfJoint], elements: Mapping[str, Element], context: Context) -> dict[str, UrdfJoint]:
    """Return the floating joints by child link; they are omitted, since bodies of OpenRAVE float by default.

    Raises:
        SourceError: the parent of a floating joint has shapes, or another joint carries it.
    """
    carried = {joint.child for joint in frames}
    for joint in frames:
        if joint.type != "floating":
            continue
        parent = elements[joint.parent]
        if joint.parent in carried or children(parent, "visual") or children(parent, "collision"):
            message = f"floating joint '{joint.name}' has six DOFs, and OpenRAVE has no such joint"
            hint = "make each part a robot of its own; only a root without shapes may carry a floating joint"
            raise SourceError(message, joint.element.source, hint)
        message = f"floating joint '{joint.name}' is left out: '{joint.child}' becomes a root"
        context.diagnostics.warn("floating-joint", message, joint.element.source, "place the body with SetTransform")
    return {joint.child: joint for joint in frames if joint.type == "floating"}


def _check_roots(tree: RobotTree, context: Context) -> None:
    roots = [name for name in tree.roots if name not in tree.floating]
    if len(roots) > 1:
        names = ", ".join(f"'{name}'" for name in roots)
        message = f"there are {len(roots)} links that no joint carries: {names}; ROS wants one"
        context.diagnostics.error("several-roots", message, tree.links[roots[1]], "join them by fixed joints")


def _add_parts(
    body: BodyBuilder,
    tree: RobotTree,
    elements: Mapping[str, Element],
    root: Element,
    context: Context,
    given: Mapping[str, str],
) -> None:
    """Add links and joints to a body: the root first, the others in the order of the file or of their names."""
    shapes = UrdfShapeReader(context, Packages(root.source.file, context.access, _packages(root, given)))
    for material in children(root, "material"):
        first = shapes.materials.get(material.attributes.get("name", ""))
        shapes.define(material)
        if first is not None:
            message = f"material '{material.attributes['name']}' is defined in line {first.source.line}, too"
            context.diagnostics.warn("repeated-tag", message, material.source, "write it once")
    links = {name: read_link(element, shapes) for name, element in elements.items()}
    _add_groups(links, elements, shapes)
    if shapes.textures is not None:
        context.diagnostics.note("left-out", "<texture> is left out: shapes have one colour", shapes.textures)
    for start in tree.roots:
        if start in tree.floating:
            links[start].pose = tree.floating[start].T_parent_child
        for name in tree.descendants(start)[1:]:
            joint = tree.above[name]
            links[name].pose = links[joint.parent].pose @ joint.T_parent_child
    by_name = given.get("like") == OR_URDF
    rest = [name for name in (sorted(links) if by_name else links) if name != tree.roots[0]]
    body.links = [links[name] for name in (tree.roots[0], *rest)]
    indices = {link.name: index for index, link in enumerate(body.links)}
    built = {name: make_joint(joint, indices, context) for name, joint in tree.joints.items()}
    follow(tree.joints, built, context)
    tree.followers |= {name for name, joint in built.items() if joint.equations is not None}
    body.joints = [built[name] for name in (sorted(built) if by_name else built)]


def _add_groups(links: Mapping[str, LinkBuilder], elements: Mapping[str, Element], shapes: UrdfShapeReader) -> None:
    """Add or_urdf's geometry groups to all links; a group is empty if a link has no shapes for it."""
    groups = {name: read_groups(element, shapes) for name, element in elements.items()}
    for group in dict.fromkeys(group for own_groups in groups.values() for group in own_groups):
        for name, link in links.items():
            link.add_to_group(group, groups[name].get(group, ()))


def _packages(root: Element, given: Mapping[str, str]) -> dict[str, str]:
    try:
        return given_packages(given.get("packages", ""))
    except ValueError as error:
        raise SourceError(f"packages: {error}", root.source) from None


def _add_srdf(body: BodyBuilder, tree: RobotTree, root: Element, context: Context, given: Mapping[str, str]) -> None:
    """Apply the SRDF to a body; if there is none, add guessed manipulators."""
    wanted, state, like = given.get("srdf", ""), given.get("state", ""), given.get("like", "")
    if like == OR_URDF and not wanted:
        wanted, body.is_robot = NO_SRDF, False
    document = _srdf(wanted, root, context)
    if document is not None:
        from ravemj.formats.urdf.srdf import add_srdf  # noqa: PLC0415 - many robots have none

        try:
            add_srdf(body, tree, document, context, state)
        except SourceError as error:
            if state or isinstance(error, LimitError):
                raise
            context.diagnostics.error("broken-file", error.message, error.source, error.hint)
    elif state:
        raise SourceError(f"there is no state '{state}': the robot has no SRDF", root.source, "name one with --srdf")
    if not body.manipulators and wanted != NO_SRDF:
        body.manipulators = arms.guess(tree, root, context)


def _srdf(wanted: str, root: Element, context: Context) -> Document | None:
    """Return the SRDF: ``wanted`` as a path or XML text, by default the file beside the URDF; None if there is none."""
    if wanted == NO_SRDF:
        return None
    budget = context.documents.budget
    if wanted.lstrip().startswith("<"):
        return parse(wanted.encode(), f"SRDF of {root.source.file}", None, budget)
    path = context.find(wanted, root.source, "") if wanted else _srdf_beside(root, context)
    if path is None:
        return None
    context.access.files.setdefault(path, root.source)
    return parse_file(path, root.source, budget)


def _srdf_beside(root: Element, context: Context) -> str | None:
    """Return the path of the SRDF beside a URDF or in ``../srdf``; None if there is none."""
    folder, file = os.path.split(root.source.file)
    name = f"{file.partition('.')[0]}.srdf"
    for path in (os.path.join(folder, name), os.path.join(folder, os.pardir, "srdf", name)):
        if context.access.permits(path) and os.path.isfile(path):
            return os.path.normpath(path)
    return None
