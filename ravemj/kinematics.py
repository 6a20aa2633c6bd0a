"""Joint values and link poses of one body: the map between OpenRAVE's DOFs and MuJoCo's ``qpos``.

The index maps are made once for a compiled model. Nothing here recompiles it.
"""

import itertools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np

from ravemj.following import evaluation_order
from ravemj.joints import measured_values, rotation_vector, wxyz_from_rotation_vector
from ravemj.scene import Axis, Joint, KinBody
from ravemj.transforms import Floats, Ints, Pose, Wxyz, conjugate, inverse, multiply, rows_from_wxyz, wxyz_from_rows

if TYPE_CHECKING:
    from ravemj.mjcf import BodyNames

LARGEST = float(np.finfo(np.float64).max)
WELDED = -1
FEW = 20
"""Up to so many DOFs a loop over plain floats is faster than numpy."""


class Ball(NamedTuple):
    """A spherical joint: three DOFs that are a rotation vector, and a quaternion in ``qpos``."""

    joint: Joint
    dofs: slice
    qpos: slice

    def to_qpos(self, vector: Sequence[float]) -> tuple[float, float, float, float]:
        """Return MuJoCo's quaternion; it turns in the child's axes, the rotation vector in the parent's."""
        rest = self.joint.T_parent_child.wxyz
        turned = wxyz_from_rotation_vector((vector[0], vector[1], vector[2]))
        return multiply(conjugate(rest), multiply(turned, rest))

    def to_values(self, wxyz: Sequence[float]) -> tuple[float, float, float]:
        """Return the rotation vector of MuJoCo's quaternion."""
        rest = self.joint.T_parent_child.wxyz
        w, x, y, z = wxyz
        return rotation_vector(multiply(rest, multiply((w, x, y, z), conjugate(rest))))


class Follower(NamedTuple):
    """A mimic joint: its value is a function of the values of all joints.

    Attributes:
        joint: Its index among the active joints followed by the passive ones.
        qpos: Where its value is in ``qpos``, or ``WELDED`` where it moves no link.
        axis: Its limits.
        evaluate: The function of the first values of all joints.
    """

    joint: int
    qpos: int
    axis: Axis
    evaluate: Callable[[Sequence[float]], float]


class Configuration(NamedTuple):
    """Where the links of a body are, and why: what ``BodyKinematics.restore`` needs.

    Attributes:
        qpos: The body's part of MuJoCo's ``qpos``.
        positions: Positions of the links in their parents at rest, shape (links, 3).
        quaternions: Their orientations, wxyz, shape (links, 4).
        passive: The values of the passive joints.
        displaced: Whether links are where their joints do not place them.
    """

    qpos: Floats
    positions: Floats
    quaternions: Floats
    passive: list[list[float]]
    displaced: bool


class BodyKinematics:
    """Reads and writes the configuration of one body in a compiled model.

    Attributes:
        body: What the file says.
        model: The model.
        data: Its state.
        dof: Number of degrees of freedom.
        lower: Lower limits, shape (dof,); of circular joints the limits that OpenRAVE reports.
        upper: Upper limits, shape (dof,).
        circular: For each DOF, whether it turns without end, shape (dof,).
        names: What the links and joints are called in the model.
        roots: Indices of the links that no joint places; the first link is one.
        displaced: Whether links are where their joints do not place them; ``set_values`` ends that.
        body_ids: MuJoCo's index of each link, shape (links,).
        qpos_indices: Where each DOF is in ``qpos``, shape (dof,); -1 for that of a joint that moves no link, and for
            those of a spherical joint.
        first_dofs: First DOF of each active joint.
        followers: The mimic joints, each behind those that it depends on.
        balls: The spherical joints.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, body: KinBody, names: "BodyNames") -> None:
        self.model, self.data = model, data
        self._qpos, self._xpos, self._xmat = data.qpos, data.xpos, data.xmat
        self.followers: list[Follower] = []
        self.describe(body)
        self.names = names
        self.body_ids = np.array([mujoco.mj_name2id(model, _BODY, name) for name in names.links], dtype=int)
        self.roots = np.flatnonzero(model.body_parentid[self.body_ids] == 0).tolist()
        self._rest = (model.body_pos[self.body_ids], model.body_quat[self.body_ids])
        self._own_qpos = _all_qpos(model, names)
        self.displaced = False
        sizes = (len(joint.axes) for joint in body.joints)
        self.first_dofs = list(itertools.accumulate(sizes, initial=0))[:-1]
        self.balls = self._find_balls(names)
        self.qpos_indices = self._find_qpos(names)
        self.followers = self._find_followers(names)
        self._free = self.qpos_indices >= 0
        self._to_qpos = _index_range(self.qpos_indices[self._free])
        self._plain = bool(self._free.all()) and not self.followers
        self._loose = self._find_loose(names)
        self._links = _index_range(self.body_ids)
        self._homogeneous = np.zeros((len(self.body_ids), 4, 4))
        self._homogeneous[:, 3, 3] = 1.0
        self._passive_values = [[axis.value for axis in joint.axes] for joint in body.passive_joints]

    def describe(self, body: KinBody) -> None:
        """Take over a description of the body with other limits; its links and joints are the same."""
        self.body = body
        axes = body.dof_axes
        self.dof = len(axes)
        self.lower = np.array([axis.lower for axis in axes])
        self.upper = np.array([axis.upper for axis in axes])
        self.circular = np.array([axis.circular for axis in axes], dtype=bool)
        self._lowest = np.where(self.circular, -LARGEST, self.lower)
        self._highest = np.where(self.circular, LARGEST, self.upper)
        bounds = list(zip(self._lowest.tolist(), self._highest.tolist(), strict=True))
        self._bounds = bounds if self.dof <= FEW else None
        self._joints = (*body.joints, *body.passive_joints)
        for place, follower in enumerate(self.followers):
            axis = self._joints[follower.joint].axes[0]
            if axis is not follower.axis:
                self.followers[place] = follower._replace(axis=axis, evaluate=self._compiled(follower.joint))

    def _find_balls(self, names: "BodyNames") -> list[Ball]:
        balls: list[Ball] = []
        for joint, first, joint_names in zip(self.body.joints, self.first_dofs, names.joints, strict=False):
            if joint.kind == "spherical" and joint_names:
                address = _qpos_index(self.model, joint_names[0])
                balls.append(Ball(joint, slice(first, first + 3), slice(address, address + 4)))
        return balls

    def _find_qpos(self, names: "BodyNames") -> Ints:
        indices: list[int] = []
        for joint, joint_names in zip(self.body.joints, names.joints, strict=False):
            if joint.kind == "spherical" or not joint_names:
                indices += [WELDED] * len(joint.axes)
            else:
                indices += [_qpos_index(self.model, name) for name in joint_names]
        return np.array(indices, dtype=int)

    def _find_followers(self, names: "BodyNames") -> list[Follower]:
        """Return the mimic joints to evaluate; none without a DOF, as OpenRAVE then never sets a value."""
        if not self.body.joints:
            return []
        mimics = {index: joint.mimic for index, joint in enumerate(self._joints) if joint.mimic is not None}
        followers: list[Follower] = []
        for index in evaluation_order(mimics):
            if mimics[index].expression is not None:
                joint_names = names.joints[index]
                qpos = _qpos_index(self.model, joint_names[0]) if joint_names else WELDED
                axis = self._joints[index].axes[0]
                followers.append(Follower(index, qpos, axis, self._compiled(index)))
        return followers

    def _compiled(self, joint: int) -> Callable[[Sequence[float]], float]:
        """Return what a mimic joint follows, as a function of the first values of all joints."""
        equation = self._joints[joint].equation
        assert equation is not None
        return equation.compiled([f"joint{index}" for index in range(len(self._joints))])

    def _find_loose(self, names: "BodyNames") -> list[tuple[int, Joint]]:
        """Return the joints that close a loop, with their first DOF."""
        joints = zip(self.first_dofs, self.body.joints, names.joints, strict=False)
        return [(first, joint) for first, joint, found in joints if not found and not joint.static]

    def values(self) -> Floats:
        """Return the joint values [rad or m], shape (dof,); a copy.

        A weld's is 0; a joint that closes a loop has the value that the poses of its links show.
        """
        if self._plain:
            return self._qpos[self._to_qpos].copy()
        values = np.zeros(self.dof)
        values[self._free] = self._qpos[self._to_qpos]
        for ball in self.balls:
            values[ball.dofs] = ball.to_values(self._qpos[ball.qpos].tolist())
        for dof, joint in self._loose:
            T_parent_child = self.link_pose(joint.parent).inverse() @ self.link_pose(joint.child)
            values[dof : dof + len(joint.axes)] = measured_values(joint, T_parent_child)
        return values

    def set_values(self, values: Floats, *, limit_followers: bool = True) -> None:
        """Set the joint values and place the links: forward kinematics, no limits of DOFs checked.

        Args:
            values: Joint values [rad or m], shape (dof,).
            limit_followers: Whether mimic joints stop at their limits.
        """
        self.write_values(values, limit_followers=limit_followers)
        mujoco.mj_kinematics(self.model, self.data)

    def write_values(self, values: Floats, *, limit_followers: bool = True) -> None:
        """Write the joint values, as ``set_values``, and leave the links for ``mj_kinematics`` to place."""
        if self.displaced:
            self.undo_displacement()
        if self._plain:
            self._qpos[self._to_qpos] = values
        else:
            self._qpos[self._to_qpos] = values[self._free]
            for ball in self.balls:
                self._qpos[ball.qpos] = ball.to_qpos(values[ball.dofs].tolist())
            if self.followers:
                self._follow(values, limit_followers=limit_followers)

    def rest_transform(self, link: int) -> Floats:
        """Return the pose of a link in its parent where no joint between them has moved, shape (4, 4)."""
        positions, quaternions = self._rest
        w, x, y, z = quaternions[link].tolist()
        transform = np.eye(4)
        transform[:3, :3] = rows_from_wxyz((w, x, y, z))
        transform[:3, 3] = positions[link]
        return transform

    def undo_displacement(self) -> None:
        """Let the joints place the links again that ``place_links`` put elsewhere; the roots stay."""
        positions, quaternions = self._rest
        for link in set(range(len(self.body_ids))) - set(self.roots):
            self.model.body_pos[self.body_ids[link]] = positions[link]
            self.model.body_quat[self.body_ids[link]] = quaternions[link]
        self.displaced = False

    def set_transform(self, T_world_link0: Floats) -> None:
        """Move the body rigidly: all links, with the joint values as they are.

        Args:
            T_world_link0: Pose of the first link, shape (4, 4).
        """
        if self.roots != [0]:
            motion = T_world_link0 @ inverse(self.link_transform(0))
            for link in self.roots:
                self.write_root(link, motion @ self.link_transform(link))
        if 0 in self.roots:
            self.write_root(0, T_world_link0)
        mujoco.mj_kinematics(self.model, self.data)

    def write_root(self, link: int, T_world_link: Floats) -> None:
        """Write the pose of a link that no joint places, and leave it for ``mj_kinematics`` to place."""
        body_id = self.body_ids[link]
        self.model.body_pos[body_id] = T_world_link[:3, 3]
        self.model.body_quat[body_id] = wxyz_from_rows(T_world_link[:3, :3].tolist())

    def set_root_wxyz(self, wxyz: Wxyz) -> None:
        """Write the orientation of the first link as this quaternion rather than its negative."""
        self.model.body_quat[self.body_ids[0]] = wxyz
        self.update()

    def configuration(self) -> "Configuration":
        """Return all that ``restore`` needs, also in another model of the same body."""
        return Configuration(
            self._qpos[self._own_qpos],
            self.model.body_pos[self.body_ids],
            self.model.body_quat[self.body_ids],
            [list(values) for values in self._passive_values],
            self.displaced,
        )

    def restore(self, configuration: "Configuration") -> bool:
        """Write a configuration, and leave the links for ``mj_kinematics`` to place.

        Returns:
            False, and nothing is written, if it is that of another set of joints.
        """
        if configuration.qpos.shape != self._own_qpos.shape or len(configuration.positions) != len(self.body_ids):
            return False
        self._qpos[self._own_qpos] = configuration.qpos
        self.model.body_pos[self.body_ids] = configuration.positions
        self.model.body_quat[self.body_ids] = configuration.quaternions
        self._passive_values = [list(values) for values in configuration.passive]
        self.displaced = configuration.displaced
        return True

    def _follow(self, values: Floats, *, limit_followers: bool) -> None:
        known = self.first_values(values)
        for follower in self.followers:
            value = follower.evaluate(known)
            if limit_followers and not follower.axis.circular:
                value = min(max(value, follower.axis.lower), follower.axis.upper)
            known[follower.joint] = value
            self._passive_values[follower.joint - len(self.body.joints)][0] = value
            if follower.qpos != WELDED:
                self._qpos[follower.qpos] = value

    def first_values(self, values: Floats) -> list[float]:
        """Return the first value of each joint, active ones and then passive ones, for given DOF values."""
        plain = values.tolist()
        return [plain[first] for first in self.first_dofs] + [passive[0] for passive in self._passive_values]

    def passive_values(self, index: int) -> Floats:
        """Return the values of a passive joint [rad or m], shape (axes,); a copy."""
        return np.array(self._passive_values[index])

    def update(self) -> None:
        """Place the links by what was written."""
        mujoco.mj_kinematics(self.model, self.data)

    def within_limits(self, values: Floats) -> bool:
        """Return whether all values are finite numbers inside the limits; circular joints have none."""
        if self._bounds is None:
            return bool(((self._lowest <= values) & (values <= self._highest)).all())
        for value, (lower, upper) in zip(values.tolist(), self._bounds, strict=True):  # noqa: SIM110 - faster than all
            if not lower <= value <= upper:
                return False
        return True

    def link_transforms(self) -> Floats:
        """Return ``T_world_link`` of every link, shape (links, 4, 4); a copy."""
        transforms = self._homogeneous.copy()
        transforms[:, :3, 3] = self._xpos[self._links]
        transforms[:, :3, :3] = self._xmat[self._links].reshape(-1, 3, 3)
        return transforms

    def link_transform(self, link: int) -> Floats:
        """Return ``T_world_link`` of one link, shape (4, 4); a copy."""
        transform = np.eye(4)
        body_id = self.body_ids[link]
        transform[:3, 3] = self._xpos[body_id]
        transform[:3, :3] = self._xmat[body_id].reshape(3, 3)
        return transform

    def link_pose(self, link: int) -> Pose:
        """Return ``T_world_link`` of one link."""
        body_id = self.body_ids[link]
        (x, y, z), (w, i, j, k) = self._xpos[body_id].tolist(), self.data.xquat[body_id].tolist()
        return Pose((x, y, z), (w, i, j, k))


_BODY = mujoco.mjtObj.mjOBJ_BODY
_BALL = int(mujoco.mjtJoint.mjJNT_BALL)


def _qpos_index(model: mujoco.MjModel, joint_name: str) -> int:
    return int(model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, joint_name)])


def _all_qpos(model: mujoco.MjModel, names: "BodyNames") -> Ints:
    """Return the places of all joints of a body in ``qpos``."""
    places: list[int] = []
    for name in (name for joint_names in names.joints for name in joint_names):
        joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        first, width = int(model.jnt_qposadr[joint]), 4 if int(model.jnt_type[joint]) == _BALL else 1
        places.extend(range(first, first + width))
    return np.array(places, dtype=int)


def _index_range(indices: Ints) -> slice | Ints:
    """Return the indices as a slice if they follow one another, since slices are faster."""
    plain = indices.tolist()
    first = plain[0] if plain else 0
    if plain == list(range(first, first + len(plain))):
        return slice(first, first + len(plain))
    return indices
