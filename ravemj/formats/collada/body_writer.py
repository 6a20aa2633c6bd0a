"""Writer of one body: its nodes, kinematics models, rigid bodies and articulated systems."""

from collections.abc import Iterator

from ravemj.core.transforms import UNIT_WXYZ, ZERO, Pose, Vec3, add, conjugate, rotate, scale
from ravemj.errors import Diagnostics, OutputError
from ravemj.formats import settled
from ravemj.formats.collada.extras import PROFILE
from ravemj.formats.collada.geometry_writer import write_pose
from ravemj.formats.collada.kinematics_model import Names, valid_name
from ravemj.formats.collada.mathml_writer import TooDeepError, math_of, read_as_0
from ravemj.formats.collada.sections import Sections
from ravemj.formats.collada.system_writer import SystemWriter
from ravemj.formats.collada.trees import Tree, trees_of
from ravemj.formats.xml_text import XmlText
from ravemj.model.expressions import ExpressionError, joint_variables, parse, partials, substitute
from ravemj.model.inertia import principal_frame, principal_moments
from ravemj.model.joints import relative_pose, reported_anchor, rests, turns_about_z_of_child
from ravemj.model.scene import Joint, KinBody, Mimic

_Z: Vec3 = (0.0, 0.0, 1.0)
DEEPEST = 140
"""Maximum length of a chain of links; the limit of readers is slightly higher."""


class BodyWriter:
    """Writes a body into the libraries of a document."""

    def __init__(self, sections: Sections, diagnostics: Diagnostics, body: KinBody, number: int) -> None:
        self._sections = sections
        self._diagnostics = diagnostics
        self._body = body
        self._number = number
        self._trees = trees_of(body, sections.models)
        sections.models += len(self._trees)
        self._T_root_links: dict[int, Pose] = {}
        self._joint_names = _joint_names(body)
        self._model_of_joint = {joint: tree.model for tree in self._trees for joint in tree.joints}
        self._joints = body.all_joints
        self._variables = joint_variables([joint.name for joint in self._joints])
        self._loops: dict[int, list[int]] = {}  # joints that close loops, by each of their links
        for index in (index for tree in self._trees for index in tree.joints):
            joint = self._joints[index]
            for link in () if joint.places_child else {joint.parent, joint.child}:
                self._loops.setdefault(link, []).append(index)

    def write(self) -> None:
        """Write all elements of the body."""
        nodes = self._sections.nodes
        for tree in self._trees:
            with nodes.inside("node", id=f"visual{tree.number}", name=self._body.name):
                if tree.links:
                    write_pose(nodes, settled.pose(self._body.links[tree.root].T_world_link))
                self._write_model(tree)
            self._write_physics(tree)
        SystemWriter(self._sections, self._diagnostics, self._body, self._number, self._trees).write()

    def _write_model(self, tree: Tree) -> None:
        out = self._sections.kinematics_models
        with out.inside("kinematics_model", id=tree.model, name=self._body.name), out.inside("technique_common"):
            for index in tree.joints:
                self._check_weld(self._joints[index])
                self._write_joint(index, self._joints[index])
            if tree.links:
                self._write_link(tree, tree.root, None, 0)
            for index in tree.joints:
                self._write_formula(index, self._joints[index].mimic)

    def _write_formula(self, index: int, mimic: Mimic | None) -> None:
        if mimic is None or mimic.expression is None:
            return
        out, joint = self._sections.kinematics_models, self._joints[index]
        try:
            position = math_of(mimic.expression, self._joint_path)
        except TooDeepError:
            message = f"the equation of joint '{joint.name}' is nested too deep for COLLADA; it is left out"
            self._diagnostics.warn("not-written", message, joint.source)
            return
        unread = sorted(read_as_0(mimic.expression.root))
        if unread:
            message = f"OpenRAVE reads {', '.join(unread)} in the equation of joint '{joint.name}' as 0 in COLLADA"
            self._diagnostics.warn("openrave-bug", message, joint.source, "save as OpenRAVE XML")
        with out.inside("formula", sid=f"formula{index}"):
            out.element_inside("target", "param", self._joint_path(f"joint{index}"))
            with out.inside("technique_common"):
                out.append(position)
            with out.inside("technique", profile="OpenRAVE"):
                with out.inside("equation", type="position"):
                    out.append(position)
                for kind, text in (("first_partial", mimic.velocity), ("second_partial", mimic.acceleration)):
                    for name, partial in self._partials(joint, text):
                        with out.inside("equation", type=kind, target=self._joint_path(name)):
                            out.append(partial)

    def _partials(self, joint: Joint, text: str) -> Iterator[tuple[str, XmlText]]:
        """Yield variable and equation of each partial derivative in ``text``; report invalid ones, and omit them."""
        names, known = self._variables, set(self._variables.values())
        try:
            equations = partials(text)
        except ExpressionError:
            self._leave_out(joint, f"the derivatives '{text}'")
            return
        for name, equation in equations.items():
            variable = substitute(name, names)
            if variable not in known:
                continue
            try:
                yield variable, math_of(parse(substitute(equation, names), known), self._joint_path)
            except (ExpressionError, TooDeepError):
                self._leave_out(joint, f"the derivative '{equation}' by '{name}'")

    def _leave_out(self, joint: Joint, what: str) -> None:
        self._diagnostics.warn("not-written", f"joint '{joint.name}': cannot write {what}; left out", joint.source)

    def _joint_path(self, variable: str) -> str:
        """Return the COLLADA path of the joint that ``variable`` represents in mimic equations."""
        index = int(variable.removeprefix("joint"))
        return f"{self._model_of_joint[index]}/joint{index}"

    def _write_joint(self, index: int, joint: Joint) -> None:
        """Write type and axes of a joint, in the joint's frame, which is parallel to the parent link's."""
        out = self._sections.kinematics_models
        with out.inside("joint", sid=f"joint{index}", name=self._joint_names[index]):
            for place, direction in enumerate(self._directions(joint)):
                kind = "prismatic" if joint.slides(place) else "revolute"
                out.element_inside(kind, "axis", direction, sid=f"axis{place}")
            if joint.kind == "spherical":
                with out.inside("extra", type=PROFILE):
                    out.element("technique", profile=PROFILE)

    def _directions(self, joint: Joint) -> list[Vec3]:
        """Return a joint's axis directions in its own frame; arbitrary for fixed hinges, where readers ignore them."""
        if self._is_bare(joint):
            return [_Z]
        # OpenRAVE turns the axes of a weld with its child, but for those of a slider.
        turns_with_child = joint.static and len(self._body.joints) > 0 and joint.kind != "slider"
        turn = conjugate(joint.T_parent_child.wxyz) if turns_with_child else UNIT_WXYZ
        directions = [rotate(turn, axis.direction) for axis in joint.axes]
        return [direction if direction == ZERO else settled.direction(direction) for direction in directions]

    def _is_bare(self, joint: Joint) -> bool:
        """Return whether the joint is a fixed hinge, whose axis OpenRAVE replaces by the child's z axis."""
        return joint.static and joint.kind == "hinge" and len(self._body.joints) > 0

    def _check_weld(self, joint: Joint) -> None:
        """Warn if the axis of a fixed hinge is not the child's z axis, which OpenRAVE assigns to it."""
        if self._is_bare(joint) and not turns_about_z_of_child(joint):
            message = f"the axis of the weld '{joint.name}' is left out: in COLLADA it is the z axis of its child"
            self._diagnostics.warn("not-written", message, joint.source)

    def _write_link(self, tree: Tree, index: int, joint: int | None, depth: int) -> None:
        """Write a link and its scene node; recursively also the joints and links below it."""
        if depth > DEEPEST:
            raise OutputError(f"COLLADA readers take no body with more than {DEEPEST} links in a row")
        body, links, nodes = self._body, self._sections.kinematics_models, self._sections.nodes
        link = body.links[index]
        anchor, T_frame_link = (ZERO, Pose()) if joint is None else self._joint_frames(joint)
        parent = None if joint is None else self._joints[joint].parent
        T_root_parent = Pose() if parent is None else self._T_root_links[parent]
        self._T_root_links[index] = T_root_parent @ Pose(anchor) @ T_frame_link
        node = f"node{self._number}.{index}"
        with (
            links.inside("link", sid=f"link{index}", name=link.name),
            nodes.inside("node", id=node, sid=f"node{index}", name=link.name or None),
        ):
            if joint is not None:
                write_pose(links, T_frame_link)
                nodes.element("translate", anchor)
                for place, direction in enumerate(self._directions(self._joints[joint])):
                    sid = f"joint{self._number}.{joint}_axis{place}"
                    if self._joints[joint].slides(place):
                        nodes.element("translate", ZERO, sid=sid)
                    else:
                        nodes.element("rotate", (*direction, 0.0), sid=sid)
                write_pose(nodes, T_frame_link)
            for place, geometry in enumerate(link.geometries):
                self._sections.geometry.write(geometry, f"geometry{self._number}.{index}.{place}", nodes)
            for placing in tree.placing.get(index, ()):
                with links.inside("attachment_full", joint=f"{tree.model}/joint{placing}"):
                    links.element("translate", self._joint_frames(placing)[0])
                    self._write_link(tree, self._joints[placing].child, placing, depth + 1)
            self._write_loops(index)

    def _write_loops(self, link: int) -> None:
        """Write the attachments of ``link`` to joints that close kinematic loops."""
        out = self._sections.kinematics_models
        for index in self._loops.get(link, ()):
            joint, path = self._joints[index], self._joint_path(f"joint{index}")
            anchor, T_frame_child = self._joint_frames(index)
            if joint.parent == link:
                with out.inside("attachment_start", joint=path):
                    self._write_loop_end(Pose(anchor))
            if joint.child == link:
                with out.inside("attachment_end", joint=path):
                    self._write_loop_end(settled.pose(T_frame_child.inverse()))

    def _write_loop_end(self, T_link_frame: Pose) -> None:
        out = self._sections.kinematics_models
        write_pose(out, T_link_frame)
        with out.inside("extra", type=PROFILE):
            out.element("technique", profile=PROFILE)

    def _joint_frames(self, index: int) -> tuple[Vec3, Pose]:
        """Return a joint's origin in the parent link, and the child's pose in the joint's frame at joint value 0."""
        joint, T_parent_child = self._joints[index], self._rest_pose(index)
        anchor = settled.position(joint.anchor if rests(self._body, index) else reported_anchor(joint))
        T_frame_child = Pose(add(T_parent_child.position, scale(anchor, -1.0)), T_parent_child.wxyz)
        return anchor, settled.pose(T_frame_child)

    def _rest_pose(self, index: int) -> Pose:
        """Return the pose of a joint's child link in its parent link that corresponds to joint value 0 in the file."""
        joint = self._joints[index]
        if not self._body.joints:  # joints place nothing
            parent, child = (self._body.links[index].T_world_link for index in (joint.parent, joint.child))
            return parent.inverse() @ child
        if rests(self._body, index):
            return relative_pose(joint, settled.values(joint))
        return relative_pose(joint, [0.0] * len(joint.axes))

    def _write_physics(self, tree: Tree) -> None:
        """Write a rigid body for each link; mass frames are relative to the tree's root link."""
        models, scene = self._sections.physics_models, self._sections.physics_scene
        root = f"#node{self._number}.{tree.root}"
        with (
            models.inside("physics_model", id=f"p{tree.model}"),
            scene.inside("instance_physics_model", url=f"#p{tree.model}", parent=root),
        ):
            for index in tree.links:
                link = self._body.links[index]
                node = f"#node{self._number}.{index}"
                scene.element("instance_rigid_body", body=f"rigid{index}", target=node)
                T_root_mass = settled.pose(self._T_root_links[index] @ principal_frame(link.inertial))
                with models.inside("rigid_body", sid=f"rigid{index}"), models.inside("technique_common"):
                    models.element("dynamic", not link.static)
                    models.element("mass", link.inertial.mass)
                    with models.inside("mass_frame"):
                        write_pose(models, T_root_mass)
                    models.element("inertia", settled.numbers(principal_moments(link.inertial).tolist()))


def _joint_names(body: KinBody) -> dict[int, str]:
    """Return joint names by index, unique also after readers normalize them.

    Names that normalization does not change have priority.
    """
    names, used = [joint.name for joint in body.all_joints], Names(())
    order = sorted(range(len(names)), key=lambda index: not names[index] or valid_name(names[index]) != names[index])
    return {index: used.give(valid_name(names[index]) or f"joint{index}") for index in order}
