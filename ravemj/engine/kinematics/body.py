"""Kinematics of one body by MuJoCo: joint values, link poses, spherical and mimic joints."""

import itertools
from collections.abc import Sequence
from types import EllipsisType
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats, Ints, Pose, Wxyz, conjugate, inverse, multiply, wxyz_from_rows
from ravemj.engine.compiled import Compiled, write_inertial
from ravemj.engine.kinematics.displacement import fix_to_parents
from ravemj.engine.kinematics.shown_values import ShownValues
from ravemj.model.joints import measured_values, rotation_vector, wxyz_from_rotation_vector
from ravemj.model.limits import Limits
from ravemj.model.mimic import MimicJoints, Multiple
from ravemj.model.scene import Joint, KinBody


class LinkPoses:
    """Collects link poses from MuJoCo's positions and rotations with few numpy calls."""

    def __init__(self, data: mujoco.MjData, body_ids: Ints) -> None:
        self._xpos, self._xmat = data.xpos.reshape(-1), data.xmat.reshape(-1)
        positions, rotations = len(self._xpos), len(self._xmat)
        self._numbers = np.append(np.zeros(positions + rotations), (0.0, 1.0))  # and the constant last row
        self._positions, self._rotations = np.split(self._numbers[:-2], [positions])
        self._places = np.full((len(body_ids), 4, 4), positions + rotations)
        self._places[:, 3, 3] += 1
        self._places[:, :3, 3] = 3 * body_ids[:, None] + np.arange(3)
        self._places[:, :3, :3] = positions + 9 * body_ids[:, None, None] + np.arange(9).reshape(3, 3)

    def matrices(self) -> Floats:
        """Return a copy of the poses, shape (links, 4, 4)."""
        self._positions[...], self._rotations[...] = self._xpos, self._xmat
        return self._numbers[self._places]


class SphericalJoint(NamedTuple):
    """Spherical joint: three DOFs that are a rotation vector, and a quaternion in ``qpos``."""

    joint: Joint
    dofs: slice
    qpos: slice

    def to_qpos(self, vector: Sequence[float]) -> tuple[float, float, float, float]:
        """Return MuJoCo's quaternion, in the child's axes, of a rotation vector in the parent's axes."""
        rest = self.joint.T_parent_child.wxyz
        turned = wxyz_from_rotation_vector((vector[0], vector[1], vector[2]))
        return multiply(conjugate(rest), multiply(turned, rest))

    def to_values(self, wxyz: Sequence[float]) -> tuple[float, float, float]:
        """Return the rotation vector of MuJoCo's quaternion."""
        rest = self.joint.T_parent_child.wxyz
        w, x, y, z = wxyz
        return rotation_vector(multiply(rest, multiply((w, x, y, z), conjugate(rest))))


NO_QPOS = -1
"""Index of a joint that moves no link and so has no ``qpos``."""

_BODY, _JOINT = mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_JOINT


class Configuration(NamedTuple):
    """Saved state of a ``BodyKinematics``."""

    qpos: Floats  # of the body's own model
    positions: Floats  # rest positions of the links in their parents, in MuJoCo's order
    quaternions: Floats  # rest orientations, wxyz
    passive: list[list[float]]  # values of the passive joints; those of mimic joints that move a link are in ``qpos``
    displaced: bool  # whether links are displaced from their joints


class BodyKinematics:
    """The configuration of one body, in a MuJoCo model that has its links and joints but no shapes.

    Each root has a free joint, so that ``qpos`` contains its pose and ``qvel`` its velocity. Writing invalidates the
    link poses; readers call ``place`` first, which runs ``mj_kinematics`` if necessary. The model is compiled once.
    ``stamp`` increases with every write; ``pose_stamp`` is the stamp of the last write of more than joint values.
    """

    def __init__(self, body: KinBody) -> None:
        """Compile a body, in the configuration of its description.

        Raises:
            CompileError: MuJoCo refuses it.
        """
        self.body = body
        compiled = Compiled.mechanism(body)
        self.model, self.data = model, data = compiled.model, compiled.data
        self.qpos, self._xpos, self._xmat = data.qpos, data.xpos, data.xmat.reshape(-1, 3, 3)
        self.stamp = self.pose_stamp = 0
        self._placed_stamp = self._coms_stamp = -1  # ``stamp`` of the last update of poses and centres of mass
        (names,) = compiled.mjcf.names
        self.body_ids = np.array([mujoco.mj_name2id(model, _BODY, name) for name in names.links], dtype=int)
        self._body_ids: list[int] = self.body_ids.tolist()
        # The root links, of which the first link is one. Each has a free joint in ``qpos`` and in ``qvel``.
        self.roots: list[int] = np.flatnonzero(model.body_parentid[self.body_ids] == 0).tolist()
        free = model.body_jntadr[self.body_ids[self.roots]]
        self.root_qpos: list[int] = model.jnt_qposadr[free].tolist()
        self.root_qvel: list[int] = model.jnt_dofadr[free].tolist()
        # The joints between links.
        self.inner_qpos = _others(model.nq, self.root_qpos, 7)
        self.inner_qvel = _others(model.nv, self.root_qvel, 6)
        self._rest = (model.body_pos.copy(), model.body_quat.copy())
        self.displaced = False  # whether links are displaced from their joints; ``set_values`` ends that
        self._find_joints(names.joints)
        # Views are created once, since that takes as long as writing a pose.
        self._one = np.eye(4)
        self._position, self._rotation = self._one[:3, 3], self._one[:3, :3]
        self._link_poses = LinkPoses(data, self.body_ids)
        self._passive_values = [[axis.value for axis in joint.axes] for joint in body.passive_joints]
        self._set_free_passive()
        self.describe(body)
        self.set_values(np.array([axis.value for axis in body.dof_axes]))

    def _find_joints(self, names: tuple[tuple[str, ...], ...]) -> None:
        body = self.body
        # For each joint, active ones and then passive ones, the places of its axes in ``qpos``; none for a joint that
        # moves no link.
        self.joint_qpos = [
            [int(self.model.jnt_qposadr[mujoco.mj_name2id(self.model, _JOINT, name)]) for name in joint_names]
            for joint_names in names
        ]
        sizes = (len(joint.axes) for joint in body.joints)
        self.first_dofs = list(itertools.accumulate(sizes, initial=0))[:-1]
        self.spherical: list[SphericalJoint] = []
        indices: list[int] = []
        for joint, first, places in zip(body.joints, self.first_dofs, self.joint_qpos, strict=False):
            if joint.kind == "spherical" and places:
                joint_slice = slice(places[0], places[0] + 4)
                self.spherical.append(SphericalJoint(joint, slice(first, first + 3), joint_slice))
            indices += places if places and joint.kind != "spherical" else [NO_QPOS] * len(joint.axes)
        self.qpos_indices = np.array(indices, dtype=int)  # of each DOF; NO_QPOS, too, for those of a spherical joint
        self._moving = np.flatnonzero(self.qpos_indices != NO_QPOS)
        self._all_move = len(self._moving) == len(indices)
        self._written, self._places = fixed_view(self.qpos, self.qpos_indices[self._moving])
        self._is_plain = not self.spherical and all(joint.mimic is None for joint in body.all_joints)
        # The values between links for copies: a view where they are consecutive, which saves an index at each.
        self.inner_values = self.qpos[self.inner_qpos] if isinstance(self.inner_qpos, slice) else None
        self._loops = [
            (first, joint)
            for first, joint, places in zip(self.first_dofs, body.joints, self.joint_qpos, strict=False)
            if not places and not joint.static
        ]

    def _set_free_passive(self) -> None:
        """Set passive joints that are not mimic joints to their initial values; afterwards only physics moves them."""
        body, of_passive = self.body, self.joint_qpos[len(self.first_dofs) :]
        for joint, values, places in zip(body.passive_joints, self._passive_values, of_passive, strict=True):
            if joint.mimic is not None or not places:
                continue
            if not body.joints:  # no joint has placed the link
                T_parent_child = body.links[joint.parent].T_world_link.inverse() @ body.links[joint.child].T_world_link
                values[:] = measured_values(joint, T_parent_child)
            if joint.kind == "spherical":
                self.qpos[places[0] : places[0] + 4] = self._passive_ball(joint, places).to_qpos(values)
            else:
                self.qpos[places] = values

    @staticmethod
    def _passive_ball(joint: Joint, places: Sequence[int]) -> SphericalJoint:
        return SphericalJoint(joint, slice(0), slice(places[0], places[0] + 4))

    def describe(self, body: KinBody) -> None:
        """Replace the description; limits and masses may differ, links and joints must be the same."""
        before = self.body.links
        self.body = body
        axes = body.dof_axes
        self.dof = len(axes)
        self.limits = Limits(axes)
        self._find_mimic_joints(body)
        for body_id, link, old in zip(self.body_ids, body.links, before, strict=True):
            if link.inertial is not old.inertial:
                write_inertial(self.model, int(body_id), link.inertial)
                self._touch()

    @cached_property
    def shown_values(self) -> ShownValues:
        """Computes joint values from link poses."""
        return ShownValues(self.body.joints, self.first_dofs)

    def _find_mimic_joints(self, body: KinBody) -> None:
        """Find the mimic joints, and which of them are affine in one DOF."""
        # A body without DOFs has no mimic joints: OpenRAVE never sets a value there.
        self.mimic = MimicJoints(body.all_joints if body.joints else ())
        self._mimic_qpos = {
            mimic.joint: places[0] for mimic in self.mimic.joints if (places := self.joint_qpos[mimic.joint])
        }
        self._multiples = [
            (self.first_dofs[mimic.multiple.leader], mimic.multiple, self._mimic_qpos[mimic.joint])
            for mimic in self.mimic.joints
            if mimic.joint in self._mimic_qpos and mimic.multiple and mimic.multiple.leader < len(self.first_dofs)
        ]
        self._are_multiples = len(self._multiples) == len(self.mimic.joints)

    def _touch(self) -> None:
        """Update ``stamp`` and ``pose_stamp`` after a change of more than joint values."""
        self.stamp += 1
        self.pose_stamp = self.stamp

    def place(self) -> None:
        """Update the poses of the links."""
        if self._placed_stamp != self.stamp:
            mujoco.mj_kinematics(self.model, self.data)
            self._placed_stamp = self.stamp

    def place_coms(self) -> None:
        """Update poses, centres of mass and motion axes, for Jacobians and dynamics."""
        if self._coms_stamp != self.stamp:
            self.place()
            if self.displaced:
                fix_to_parents(self.model, self.data, *self._rest)
            mujoco.mj_comPos(self.model, self.data)
            self._coms_stamp = self.stamp

    def values(self) -> Floats:
        """Return a copy of the joint values [rad or m], shape (dof,).

        Welds are 0; for a joint that closes a loop, the value is computed from the link poses.
        """
        if self._all_move:
            return self._written[self._places].copy()
        values = np.zeros(self.dof)
        values[self._moving] = self._written[self._places]
        for ball in self.spherical:
            values[ball.dofs] = ball.to_values(self.qpos[ball.qpos].tolist())
        for dof, joint in self._loops:
            T_parent_child = self.link_pose(joint.parent).inverse() @ self.link_pose(joint.child)
            values[dof : dof + len(joint.axes)] = measured_values(joint, T_parent_child)
        return values

    def set_values(self, values: Floats, *, clamp_mimic: bool = True) -> None:
        """Set the joint values and thereby the link poses; DOF limits are not checked.

        Args:
            values: Joint values [rad or m], shape (dof,).
            clamp_mimic: Whether to clamp mimic joints to their limits.
        """
        if self.displaced:
            self._undo_displacement()
        self.stamp += 1  # first, so that an interrupt does not leave outdated poses
        self._written[self._places] = values if self._all_move else values[self._moving]
        if self._is_plain:
            return
        if self._are_multiples:
            for dof, multiple, place in self._multiples:
                self.qpos[place] = multiple.follow(values.item(dof), clamp_mimic)
        else:
            self._set_mimic(values, clamp=clamp_mimic)
        for ball in self.spherical:
            self.qpos[ball.qpos] = ball.to_qpos(values[ball.dofs].tolist())

    def _set_mimic(self, values: Floats, *, clamp: bool) -> None:
        known = self.first_values(values)
        self.mimic.evaluate(known, clamp=clamp)
        for mimic in self.mimic.joints:
            if mimic.joint in self._mimic_qpos:
                self.qpos[self._mimic_qpos[mimic.joint]] = known[mimic.joint]
            else:
                self._passive_values[mimic.joint - len(self.first_dofs)][0] = known[mimic.joint]

    def first_values(self, values: Floats) -> list[float]:
        """Return the value of the first axis of each joint, active joints first, for given DOF values."""
        plain = values.tolist()
        active = plain if len(self.first_dofs) == self.dof else [plain[first] for first in self.first_dofs]
        passive = [
            self.qpos.item(places[0]) if places and joint.mimic is None and joint.kind != "spherical" else values[0]
            for joint, values, places in zip(
                self.body.passive_joints, self._passive_values, self.joint_qpos[len(active) :], strict=True
            )
        ]
        return active + passive

    @property
    def multiples(self) -> list[tuple[int, Multiple, int]] | None:
        """For each mimic joint its DOF, affine equation and index in ``qpos``; None if an equation is not affine."""
        return self._multiples if self._are_multiples else None

    def passive_values(self, index: int) -> Floats:
        """Return a copy of the values of a passive joint [rad or m], shape (axes,).

        For a joint that closes a loop, the value is computed from the link poses.
        """
        joint = self.body.passive_joints[index]
        if not (joint.places_child or joint.static) and self.dof:
            return np.array(
                measured_values(joint, self.link_pose(joint.parent).inverse() @ self.link_pose(joint.child))
            )
        values, places = self._passive_values[index], self.joint_qpos[len(self.first_dofs) + index]
        if joint.mimic is not None or not places:
            return np.array([self.qpos[places[0]], *values[1:]] if places else values)
        if joint.kind == "spherical":
            ball = self._passive_ball(joint, places)
            return np.array(ball.to_values(self.qpos[ball.qpos].tolist()))
        return np.array([self.qpos[place] for place in places])

    def set_qpos(self, qpos: Floats, *, inner_only: bool) -> None:
        """Copy MuJoCo's configuration from a model in which simulation moved the body.

        It contains the positions of all joints, including the free joints of roots, unless ``inner_only``.
        """
        self.qpos[self.inner_qpos if inner_only else slice(None)] = qpos
        self._touch()

    def _undo_displacement(self) -> None:
        """Undo ``place_links``: joints determine the link poses again; the roots do not move."""
        self.model.body_pos[:], self.model.body_quat[:] = self._rest
        self.displaced = False
        self._touch()

    def inner_index(self, qpos: int) -> int:
        """Convert an index into ``qpos`` to an index into ``qpos`` without the free joints of the roots."""
        return qpos - 7 * sum(root < qpos for root in self.root_qpos)

    def rest_transform(self, link: int) -> Floats:
        """Return a link's zero-configuration pose in its parent, shape (4, 4)."""
        (x, y, z), (w, i, j, k) = (parts[self.body_ids[link]].tolist() for parts in self._rest)
        return Pose((x, y, z), (w, i, j, k)).matrix()

    def displace(self, link: int, T_parent_link: Floats) -> None:
        """Temporarily override a link's zero-configuration pose; the next ``set_values`` resets it."""
        body_id = self.body_ids[link]
        self.model.body_pos[body_id] = T_parent_link[:3, 3]
        self.model.body_quat[body_id] = wxyz_from_rows(T_parent_link[:3, :3].tolist())
        self.displaced = True
        self._touch()

    def set_root_transform(self, root: int, T_world_link: Floats) -> None:
        """Move a root, given by its index in ``roots``, and its descendants."""
        first = self.root_qpos[root]
        self.qpos[first : first + 3] = T_world_link[:3, 3]
        self.qpos[first + 3 : first + 7] = wxyz_from_rows(T_world_link[:3, :3].tolist())
        self._touch()

    def set_transform(self, T_world_link0: Floats) -> None:
        """Move the body rigidly, keeping joint values, by the pose of its first link, shape (4, 4)."""
        if self.roots == [0]:
            self.set_root_transform(0, T_world_link0)
        elif self.roots:  # the first link may have a parent, if no joint has a DOF
            motion = T_world_link0 @ inverse(self.link_transform(0))
            for root, moved in enumerate([motion @ self.link_transform(link) for link in self.roots]):
                self.set_root_transform(root, T_world_link0 if self.roots[root] == 0 else moved)

    def set_pose(self, T_world_link0: Pose) -> None:
        """Move the body rigidly, like ``set_transform``; the sign of the quaternion is kept."""
        if self.roots == [0]:
            first = self.root_qpos[0]
            self.qpos[first : first + 7] = T_world_link0.position + T_world_link0.wxyz
            self._touch()
        else:
            self.set_transform(T_world_link0.matrix())
            self._set_root_wxyz(T_world_link0.wxyz)

    def _set_root_wxyz(self, wxyz: Wxyz) -> None:
        """Write the orientation of the first link; unlike a rotation matrix, it keeps the quaternion's sign."""
        if 0 in self.roots:
            first = self.root_qpos[self.roots.index(0)]
            self.qpos[first + 3 : first + 7] = wxyz

    def configuration(self) -> Configuration:
        """Return the state, as input of ``restore`` of this or another object for the same body."""
        passive = [list(values) for values in self._passive_values]
        model = self.model
        return Configuration(self.qpos.copy(), model.body_pos.copy(), model.body_quat.copy(), passive, self.displaced)

    def restore(self, configuration: Configuration) -> bool:
        """Restore a configuration.

        Returns:
            False without a change if it belongs to other links and joints.
        """
        qpos, positions, quaternions, passive, displaced = configuration
        if qpos.shape != self.qpos.shape or positions.shape != self.model.body_pos.shape:
            return False
        if len(passive) != len(self._passive_values):
            return False
        self.qpos[:] = qpos
        self.model.body_pos[:], self.model.body_quat[:] = positions, quaternions
        self._passive_values = [list(values) for values in passive]
        self.displaced = displaced
        self._touch()
        return True

    def link_transforms(self) -> Floats:
        """Return a copy of ``T_world_link`` of every link, shape (links, 4, 4)."""
        self.place()
        return self._link_poses.matrices()

    def link_transform(self, link: int) -> Floats:
        """Return a copy of ``T_world_link`` of one link, shape (4, 4)."""
        self.place()
        body_id = self._body_ids[link]
        self._position[...] = self._xpos[body_id]
        self._rotation[...] = self._xmat[body_id]
        return self._one.copy()

    def position(self, link: int) -> Floats:
        """Return the origin of one link in the world [m], shape (3,); a view."""
        self.place()
        return self._xpos[self._body_ids[link]]

    def link_pose(self, link: int) -> Pose:
        """Return ``T_world_link`` of one link."""
        self.place()
        body_id = self.body_ids[link]
        (x, y, z), (w, i, j, k) = self._xpos[body_id].tolist(), self.data.xquat[body_id].tolist()
        return Pose((x, y, z), (w, i, j, k))


def _others(count: int, first: list[int], width: int) -> slice | Ints:
    """Return the indices below ``count`` that are outside the ranges starting at ``first``, of length ``width``."""
    taken = {index for start in first for index in range(start, start + width)}
    return _index_range(np.array([index for index in range(count) if index not in taken], dtype=int))


def fixed_view(numbers: Floats, indices: Ints) -> tuple[Floats, EllipsisType | Ints]:
    """Return an array and an index into it, for frequent writes to some elements.

    For consecutive indices they are a view and ``...``, which is fastest.
    """
    some = _index_range(indices)
    return (numbers[some], ...) if isinstance(some, slice) else (numbers, some)


def _index_range(indices: Ints) -> slice | Ints:
    """Return indices, as a slice if they are consecutive, since slices are faster."""
    plain = indices.tolist()
    first = plain[0] if plain else 0
    if plain == list(range(first, first + len(plain))):
        return slice(first, first + len(plain))
    return indices
