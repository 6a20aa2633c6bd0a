"""Conversion of trees of MuJoCo bodies to bodies of links and joints."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ravemj.core.transforms import UNMOVED, Pose, rows_from_wxyz
from ravemj.engine.mjcf_reading.compiling import CompiledModel
from ravemj.engine.mjcf_reading.joints import FREE, JointReader
from ravemj.engine.mjcf_reading.motors import joint_torques
from ravemj.engine.mjcf_reading.names import ModelNames, free_name, one_word
from ravemj.engine.mjcf_reading.numbers import as_written, pose, quaternion, symmetric, tensor, vector
from ravemj.engine.mjcf_reading.shapes import GeomReader
from ravemj.errors import Source
from ravemj.model.builder import BodyBuilder, JointBuilder, LinkBuilder
from ravemj.model.scene import Inertial
from ravemj.model.shape_bodies import MASSLESS

WORLD = "world"
"""Name of the body with the world's shapes; its link is named otherwise, since MuJoCo's world body has this name."""


@dataclass
class BodyTree:
    """Child of the world body with its descendants.

    Attributes:
        root: MuJoCo's index of the body.
        builder: The body under construction.
        links: Link index of each MuJoCo body, by MuJoCo's index.
        joints: The moving joints, by MuJoCo's index.
        free: MuJoCo's index of the root's free joint, or None.
    """

    root: int
    builder: BodyBuilder
    links: dict[int, int] = field(default_factory=dict[int, int])
    joints: dict[int, JointBuilder] = field(default_factory=dict[int, JointBuilder])
    free: int | None = None


class TreeReader:
    """Reader of one model's bodies.

    Attributes:
        compiled: The model.
        names: Names of its bodies and joints.
        shapes: Reader of its geoms.
    """

    def __init__(self, compiled: CompiledModel) -> None:
        self.compiled = compiled
        self.names = ModelNames(compiled.model)
        self.shapes = GeomReader(compiled)
        self._model = compiled.model
        self._written = {body.id: body for body in compiled.spec.bodies}
        self._joints = JointReader(compiled, self.names, joint_torques(compiled.model))
        self._poses: dict[int, Pose] = {0: UNMOVED}

    def read(self) -> list[BodyTree]:
        """Return a tree for each child of the world, then one for the shapes of the world itself."""
        trees: dict[int, BodyTree] = {}
        taken = [WORLD]
        for body in range(1, self._model.nbody):
            root = int(self._model.body_rootid[body])
            if root == body:
                name = free_name(one_word(self.names.bodies[body]), taken)
                taken.append(name)
                trees[root] = BodyTree(root, BodyBuilder(is_robot=False, source=self.source(body), name=name))
            self._add(trees[root], body)
        return [*trees.values(), *([self._world()] if self._model.body_geomnum[0] else [])]

    def source(self, body: int) -> Source:
        """Return the position of a body in a file."""
        return self.compiled.document.source(self._model.body(body).name, "body", "worldbody")

    def number_of(self, name: str) -> int:
        """Return MuJoCo's index of a body by name.

        Raises:
            ValueError: there is no such body.
        """
        if name not in self.names.bodies:
            raise ValueError(f"there is no body '{name}'")
        return self.names.bodies.index(name)

    def pose(self, body: int) -> Pose:
        """Return the pose of a body in its parent."""
        model, written = self._model, self._written[body]
        return pose((written.pos, written.quat), (model.body_pos[body], model.body_quat[body]))

    def written_joint(self, joint: int) -> Any:  # noqa: ANN401 - MuJoCo gives no type
        """Return a joint of MuJoCo's editable spec, with the values in the file."""
        return self._joints.written[joint]

    def _world(self) -> BodyTree:
        source = self.source(0)
        builder = BodyBuilder(is_robot=False, source=source, name=WORLD)
        link = LinkBuilder(f"{WORLD}/base", source, inertial=MASSLESS, static=True)
        self.shapes.add(link, 0)
        builder.links.append(link)
        return BodyTree(0, builder, {0: 0})

    def _add(self, tree: BodyTree, body: int) -> None:
        """Add a body after its parent: its joints, the links between them, and its own link."""
        model, builder = self._model, tree.builder
        T_parent_body = self.pose(body)
        parent = int(model.body_parentid[body])
        T_world_body = self._poses[body] = self._poses[parent] @ T_parent_body
        first = int(model.body_jntadr[body])
        joints = list(range(first, first + int(model.body_jntnum[body])))
        if joints and model.jnt_type[joints[0]] == FREE:
            tree.free, joints = joints[0], []
        name = self.names.bodies[body]
        if body == tree.root and joints:
            base = LinkBuilder(self.names.link(f"{name}/base"), self.source(body), T_world_body, static=True)
            builder.links.append(replace(base, inertial=MASSLESS))
            T_parent_body = UNMOVED
        above = tree.links.get(parent, 0)
        link = LinkBuilder(name, self.source(body), T_world_body, inertial=self.inertial(body))
        link.static = body == tree.root and tree.free is None and not joints and not self._is_mocap(body)
        self.shapes.add(link, body)
        between = [self._between(name, joint, body) for joint in joints[:-1]]
        chain = [above, *range(len(builder.links), len(builder.links) + len(between) + 1)]
        builder.links += [*between, link]
        tree.links[body] = len(builder.links) - 1
        for place, joint in enumerate(joints):
            T_first_second = T_parent_body if place == 0 else UNMOVED
            ends = (chain[place], chain[place + 1])
            tree.joints[joint] = self._joints.moving(joint, ends, T_first_second, T_first_second)
            builder.joints.append(tree.joints[joint])
        if not joints and body != tree.root:
            builder.joints.append(self._joints.fixed(body, (above, tree.links[body]), T_parent_body))
        builder.is_robot = builder.is_robot or bool(joints)

    def _between(self, body_name: str, joint: int, body: int) -> LinkBuilder:
        """Return the massless link between two joints of the same body."""
        name = self.names.link(f"{body_name}/{self.names.joints[joint]}")
        return LinkBuilder(name, self.source(body), self._poses[body], inertial=MASSLESS)

    def _is_mocap(self, body: int) -> bool:
        return bool(self._model.body_mocapid[body] >= 0)

    def inertial(self, body: int) -> Inertial:
        """Return the mass properties of a body: as written, or as MuJoCo infers them from its geoms."""
        model, written = self._model, self._written[body]
        mass = float(model.body_mass[body])
        com = vector(as_written(written.ipos, model.body_ipos[body]))
        if mass == 0.0:
            return replace(MASSLESS, com=com)
        moments, wxyz = model.body_inertia[body], model.body_iquat[body]
        rows = tensor(moments, quaternion(wxyz))
        if not written.explicitinertial:
            return Inertial(mass, com, rows)
        xx, yy, zz, xy, xz, yz = (float(part) for part in written.fullinertia)
        full = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if not np.isfinite(full).all():
            rotation = np.array(rows_from_wxyz(quaternion(as_written(written.iquat, wxyz))))
            diagonal = np.array([float(part) for part in written.inertia])
            full = np.diag(diagonal) if (rotation == np.eye(3)).all() else (rotation * diagonal) @ rotation.T
        near = 1e-9 * max(float(np.abs(rows).max()), 1e-12)
        return Inertial(mass, com, symmetric(full) if (np.abs(full - rows) <= near).all() else rows)
