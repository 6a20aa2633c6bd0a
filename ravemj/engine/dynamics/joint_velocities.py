"""Joint velocities computed from link velocities, which are the state in OpenRAVE."""

from collections.abc import Sequence

import numpy as np

from ravemj.core.transforms import Floats, Ints, cross_rows
from ravemj.engine.dynamics.coupling import rotation_rate
from ravemj.engine.kinematics import NO_QPOS, BodyKinematics
from ravemj.model.scene import Joint

_ONES = np.ones(3)


class JointAxes:
    """Axes of joints and the links that they connect.

    Links are given by link index; ``ids`` and attributes named ``..._ids`` contain MuJoCo's indices.
    """

    def __init__(self, joints: Sequence[Joint], body_ids: Ints, ids: Ints | None = None) -> None:
        """Store joints and MuJoCo's indices of their axes; ``ids`` is None unless each joint has exactly one axis."""
        self.ids = ids
        self.parents = np.array([joint.parent for joint in joints], dtype=int)
        self.children = np.array([joint.child for joint in joints], dtype=int)
        self.parent_ids = body_ids[self.parents]
        self.directions = np.array([joint.axes[0].direction for joint in joints]).reshape(-1, 3, 1)  # in the parents
        self.slides = np.array([index for index, joint in enumerate(joints) if joint.kind == "slider"], dtype=int)
        self.slide_parents = self.parents[self.slides]
        self.slide_parent_ids, self.slide_child_ids = self.parent_ids[self.slides], body_ids[self.children[self.slides]]
        self.special = [(index, joint) for index, joint in enumerate(joints) if len(joint.axes) > 1]
        self._seen: tuple[Floats, Floats, Floats] | None = None

    def relative(self, velocities: Floats) -> tuple[Floats, Floats]:
        """Return the velocities of child links relative to their parents, for link velocities, shape (links, 6).

        The result is cached, since ``velocities`` is immutable and used in many configurations.

        Returns:
            The relative angular velocity of the child link, or for a slider the relative velocity of the child's
            origin, shape (joints, 3); and for each slider the matrix of the cross product with its parent's angular
            velocity, shape (sliders, 3, 3).
        """
        if self._seen is None or self._seen[0] is not velocities:
            apart = velocities.take(self.children, 0) - velocities.take(self.parents, 0)
            relative = apart[:, 3:].copy()
            relative[self.slides] = apart[self.slides, :3]
            spins = velocities[self.slide_parents, 3:]
            self._seen = velocities, relative, cross_rows(spins[:, None], np.eye(3)).transpose(0, 2, 1)
        return self._seen[1:]


class JointVelocities:
    """Computes joint velocities of a body from link velocities."""

    def __init__(self, kinematics: BodyKinematics) -> None:
        self._kinematics = kinematics
        joints, places = kinematics.body.joints, kinematics.qpos_indices
        has_ids = len(places) == len(joints) and NO_QPOS not in places
        ids = np.searchsorted(kinematics.model.jnt_qposadr, places) if has_ids else None
        self._of_dofs = JointAxes(joints, kinematics.body_ids, ids)

    def of_joints(self, joints: Sequence[Joint], velocities: Floats) -> list[Floats]:
        """Return the velocities of joints, active or passive, from link velocities, shape (links, 6).

        For each joint, the result has the velocities of its axes [rad/s or m/s], shape (axes,).
        """
        return self._shown(velocities, JointAxes(joints, self._kinematics.body_ids))

    def of_dofs(self, velocities: Floats) -> Floats:
        """Return the DOF velocities, shape (dof,), from link velocities, shape (links, 6)."""
        if not np.count_nonzero(velocities):  # faster than ``any``
            return np.zeros(self._kinematics.dof)
        if self._of_dofs.special:
            return np.concatenate([np.zeros(0), *self._shown(velocities, self._of_dofs)])
        return self._of_first_axes(velocities, self._of_dofs)

    def _shown(self, velocities: Floats, of: JointAxes) -> list[Floats]:
        shown = list(self._of_first_axes(velocities, of)[:, None])
        for index, joint in of.special:
            turning = velocities[joint.child, 3:] - velocities[joint.parent, 3:]
            if joint.kind == "spherical":
                rotation = self._kinematics.data.xmat[self._kinematics.body_ids[joint.parent]].reshape(3, 3)
                shown[index] = self._spherical_velocity(joint, rotation.T @ turning)
            else:
                shown[index] = self._two_rates(joint, velocities)
        return shown

    def _of_first_axes(self, velocities: Floats, of: JointAxes) -> Floats:
        kinematics, data = self._kinematics, self._kinematics.data
        kinematics.place()
        if of.ids is None or kinematics.displaced:
            rotations = data.xmat.take(of.parent_ids, 0).reshape(-1, 3, 3)
            axes = np.matmul(rotations, of.directions)[:, :, 0]
        else:
            axes = data.xaxis.take(of.ids, 0)
        relative, crossings = of.relative(velocities)
        if len(slides := of.slides):
            arms = data.xpos.take(of.slide_child_ids, 0) - data.xpos.take(of.slide_parent_ids, 0)
            relative = relative.copy()
            relative[slides] -= np.matmul(crossings, arms[:, :, None])[:, :, 0]
        return (axes * relative).dot(_ONES)

    def _two_rates(self, joint: Joint, velocities: Floats) -> Floats:
        data, model = self._kinematics.data, self._kinematics.model
        places = self._kinematics.joint_qpos[self._kinematics.body.all_joints.index(joint)]
        if not places:
            return np.zeros(2)
        ids = np.flatnonzero(np.isin(model.jnt_qposadr, places))
        axes, parent, child = data.xaxis[ids], velocities[joint.parent], velocities[joint.child]
        if joint.kind == "hinge2":
            return np.linalg.pinv(axes.T) @ (child[3:] - parent[3:])
        place = data.xpos[self._kinematics.body_ids[joint.child]]
        arm = place - data.xpos[self._kinematics.body_ids[joint.parent]]
        shown = np.concatenate([child[:3] - parent[:3] - cross_rows(parent[3:], arm), child[3:] - parent[3:]])
        columns = [
            [*axis, 0, 0, 0] if joint.slides(index) else [*cross_rows(axis, place - data.xanchor[ids[index]]), *axis]
            for index, axis in enumerate(axes)
        ]
        return np.linalg.pinv(np.array(columns).T) @ shown

    def _spherical_velocity(self, joint: Joint, turning: Floats) -> Floats:
        """Return the rate of a spherical joint's rotation vector, for an angular velocity in the parent's axes."""
        spherical = next(
            (candidate for candidate in self._kinematics.spherical if candidate.joint.child == joint.child), None
        )
        if spherical is None:
            return turning
        vector = np.array(spherical.to_values(self._kinematics.data.qpos[spherical.qpos].tolist()))
        rate, _ = rotation_rate(vector)
        return np.linalg.inv(rate.T) @ turning  # the left Jacobian is the right one's transpose
