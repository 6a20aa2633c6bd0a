"""Velocities, derivatives and dynamics of a body in its present configuration, by MuJoCo.

The body's own model has a free joint at each root, so a moving base is a velocity like others. What differs from MuJoCo
is arranged around its functions: the coupling of velocity coordinates to DOFs, and the velocities of links, which are
the state in OpenRAVE.
"""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.dynamics.coupling import Coupling, CouplingMap
from ravemj.engine.dynamics.joint_velocities import JointVelocities, cross
from ravemj.engine.dynamics.tree import Tree
from ravemj.engine.kinematics import BodyKinematics, index_range
from ravemj.model.scene import Joint


class BodyDynamics:
    """Derivatives of one body's motion.

    Velocities of links are six numbers in world axes: that of the link's origin [m/s] and the angular one [rad/s].

    Attributes:
        tree: Which joint carries which.
        couplings: How the velocity coordinates follow the DOFs.
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        self._kinematics = kinematics
        self._model, self._data = model, _ = kinematics.model, kinematics.data
        self.tree = Tree(kinematics)
        self.couplings = CouplingMap(kinematics, self.tree)
        self._body_ids: list[int] = kinematics.body_ids.tolist()
        self._inner = np.arange(model.nv)[kinematics.inner_qvel]
        self._moving, self._turning = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        self._forces = np.zeros(model.nv)
        self._joint_velocities = JointVelocities(kinematics)
        self._columns = self._one_to_one_columns()
        constant = self.couplings.constant
        self._coupling_matrix = None if constant is None else self._matrix(constant)
        self._qvel, self._qacc, self._gravity = self._data.qvel, self._data.qacc, model.opt.gravity
        self._velocities: Floats | None = None  # of the links: those that the data are set for
        self._velocities_stamp = -1
        self._with_joints: bool = False
        self._are_moving: bool = False
        self._roots_move: bool = False
        self._rates = np.zeros(kinematics.dof)
        self._rest_qacc = np.zeros(model.nv)

    def _one_to_one_columns(self) -> tuple[slice | Ints, Ints] | None:
        """Return the column of MuJoCo's Jacobians for each DOF, and the DOFs that move nothing; None if DOFs couple."""
        if not self.couplings.is_one_to_one or self.couplings.constant is None:
            return None
        columns = np.zeros(self._kinematics.dof, dtype=int)
        columns[self.couplings.constant.dofs] = self._inner[self.couplings.constant.coordinates]
        idle = np.setdiff1d(np.arange(self._kinematics.dof), self.couplings.constant.dofs)
        return columns if len(idle) else index_range(columns), idle

    def _matrix(self, coupling: Coupling) -> Floats:
        """Return the coupling matrix with a row for each of MuJoCo's velocities, shape (nv, dof)."""
        matrix = np.zeros((self._model.nv, self._kinematics.dof))
        matrix[self._inner] = coupling.forward(np.eye(self._kinematics.dof))
        return matrix

    def _coupling(self, *, second: bool = False) -> Coupling:
        """Return the coupling in the present configuration."""
        return self.couplings.constant or self.couplings.at(self._kinematics.values(), second=second)

    def _of_dof_values(self, jacobian: Floats) -> Floats:
        """Return a derivative by MuJoCo's velocities, shape (..., nv), as one by the DOF values, shape (..., dof)."""
        if self._columns is not None:
            columns, idle = self._columns
            if isinstance(columns, slice):
                return jacobian[..., columns].copy()
            chosen = jacobian.take(columns, axis=-1)
            if len(idle):
                chosen[..., idle] = 0.0
            return chosen
        matrix = self._coupling_matrix
        return jacobian @ (self._matrix(self._coupling()) if matrix is None else matrix)

    def translation_jacobian(self, link: int, point: Floats) -> Floats:
        """Return the derivative of the position of a link's point by the DOF values.

        Args:
            link: Index of the link.
            point: The point, in world coordinates [m], shape (3,).

        Returns:
            Shape (3, dof).
        """
        self._kinematics.place_coms()
        mujoco.mj_jac(self._model, self._data, self._moving, None, point, self._body_ids[link])
        return self._of_dof_values(self._moving)

    def rotation_jacobian(self, link: int) -> Floats:
        """Return a link's angular velocity, in world axes, for each DOF's unit velocity, shape (3, dof)."""
        self._kinematics.place_coms()
        mujoco.mj_jacBody(self._model, self._data, None, self._turning, self._body_ids[link])
        return self._of_dof_values(self._turning)

    def hessian(self, link: int, point: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of ``translation_jacobian`` and ``rotation_jacobian`` by the DOF values.

        Returns:
            Two arrays of shape (dof, 3, dof): ``[i, :, j]`` is the derivative of the Jacobian's column j by DOF i.
        """
        self._kinematics.place_coms()
        mujoco.mj_jac(self._model, self._data, self._moving, self._turning, point, self._body_ids[link])
        chain = np.flatnonzero(self.tree.moves[link])
        columns = np.stack((self._moving, self._turning))[:, :, self._inner[chain]].transpose(2, 0, 1)
        spins = columns[:, None, 1]
        moved, turned = cross(spins, columns[None, :, 0]), cross(spins, columns[None, :, 1])  # w_a x v_b as [a, b]
        before = (chain[:, None] <= self.tree.carriers[chain])[..., None]  # the first moves the axis of the second
        count = self.tree.count
        by_coordinates = np.zeros((count, count, 6))
        by_coordinates[chain[:, None], chain, :3] = np.where(before, moved, moved.transpose(1, 0, 2))
        by_coordinates[chain[:, None], chain, 3:] = np.where(before, turned, 0.0)
        coupling = self._coupling(second=True)
        by_columns = coupling.backward(by_coordinates.transpose(1, 0, 2))
        hessian = coupling.backward(by_columns.transpose(1, 0, 2))
        place_of = {coordinate: place for place, coordinate in enumerate(chain.tolist())}
        for coordinate, along, dof, value in coupling.second:
            if coordinate in place_of:
                hessian[along, dof] += value * columns[place_of[coordinate]].ravel()
        return hessian[:, :, :3].transpose(0, 2, 1).copy(), hessian[:, :, 3:].transpose(0, 2, 1).copy()

    def com_jacobian(self) -> Floats:
        """Return the derivative of the body's centre of mass by the DOF values, shape (3, dof)."""
        self._kinematics.place_coms()
        total, masses = np.zeros_like(self._moving), self._model.body_subtreemass
        for root in self._kinematics.roots:
            body_id = self._body_ids[root]
            mujoco.mj_jacSubtreeCom(self._model, self._data, self._moving, body_id)
            total += masses[body_id] / masses[0] * self._moving
        return self._of_dof_values(total)

    def qvel(self, velocities: Floats, rates: Floats) -> Floats:
        """Return MuJoCo's velocities in the body's own model, shape (nv,).

        Args:
            velocities: Those of the links, of which those of the roots count, shape (links, 6).
            rates: Those of the DOFs [rad/s or m/s], shape (dof,).
        """
        qvel = np.zeros(self._model.nv)
        if rates.any():
            qvel[self._inner] = self._coupling().forward(rates)
        self._set_roots(qvel, velocities)
        return qvel

    def _set_roots(self, target: Floats, values: Mapping[int, Floats] | Floats) -> None:
        """Write velocities or accelerations of roots, by link: linear ones in the world, angular ones in the link."""
        self._kinematics.place()
        for root, first in zip(self._kinematics.roots, self._kinematics.root_qvel, strict=True):
            target[first : first + 3] = values[root][:3]
            rotation = self._data.xmat[self._body_ids[root]].reshape(3, 3)
            target[first + 3 : first + 6] = values[root][3:] @ rotation

    def _arms(self) -> Floats:
        """Return where the links' origins are from the centre that MuJoCo's motions are about [m], shape (links, 3)."""
        ids = self._kinematics.body_ids
        return self._data.xpos[ids] - self._data.subtree_com[self._model.body_rootid[ids]]

    def _present_velocities(self) -> Floats:
        """Return the velocities of the links for those in MuJoCo's data, shape (links, 6)."""
        motions = self._data.cvel[self._kinematics.body_ids]
        spins = motions[:, :3]
        return np.concatenate((motions[:, 3:] + cross(spins, self._arms()), spins), axis=1)

    def link_velocities(self, rates: Floats, base: Floats) -> Floats:
        """Return the velocities of the links.

        Args:
            rates: Those of the DOFs [rad/s or m/s], shape (dof,).
            base: That of the first link, shape (6,); other links that no joint places are at rest.

        Returns:
            Shape (links, 6).
        """
        velocities = np.zeros((len(self._body_ids), 6))
        velocities[0] = base
        self._kinematics.place_coms()
        self._velocities, self._are_moving = None, True
        self._qvel[:] = self.qvel(velocities, rates)
        mujoco.mj_comVel(self._model, self._data)
        return self._present_velocities()

    def joint_velocities(self, velocities: Floats, joints: Sequence[Joint]) -> list[Floats]:
        """Return the velocities of joints that velocities of links show; see ``JointVelocities``."""
        return self._joint_velocities.of(joints, velocities)

    def dof_velocities(self, velocities: Floats) -> Floats:
        """Return the velocities of the DOFs that velocities of links show, shape (links, 6) to (dof,)."""
        return self._joint_velocities.of_dofs(velocities)

    def link_accelerations(
        self, velocities: Floats, accelerations: Floats, external: Mapping[int, Floats] | None = None
    ) -> Floats:
        """Return the accelerations of the links, of their origins and angular, shape (links, 6).

        Links that no joint places go on turning as they do, so that their origins accelerate by ``w x v``.

        Args:
            velocities: Those of the links, shape (links, 6).
            accelerations: Those of the DOFs [rad/s^2 or m/s^2], shape (dof,).
            external: Further accelerations of links that no joint places, shape (6,), linear first.
        """
        data = self._data
        self._set_velocities(velocities)
        self._set_accelerations(accelerations, external)
        self._gravity[:] = 0.0
        speeds = self._present_velocities()
        mujoco.mj_rnePostConstraint(self._model, data)
        motions = data.cacc[self._kinematics.body_ids]
        turning = motions[:, :3]
        linear = motions[:, 3:] + cross(turning, self._arms()) + cross(speeds[:, 3:], speeds[:, :3])
        return np.concatenate((linear, turning), axis=1)

    def _set_velocities(self, velocities: Floats, *, with_joints: bool = True) -> None:
        """Write velocities into MuJoCo's data, with what follows from them; nothing where they are there already.

        Args:
            velocities: Those of the links, shape (links, 6), in an array that is never changed: those of the roots
                count, and what the others show of the joints.
            with_joints: Whether the joints move.
        """
        kinematics = self._kinematics
        kinematics.place_coms()
        is_other, has_moved = velocities is not self._velocities, kinematics.stamp != self._velocities_stamp
        if not (is_other or has_moved) and with_joints == self._with_joints:
            return
        were_moving = self._are_moving
        if is_other:
            self._are_moving, self._roots_move = bool(velocities.any()), bool(velocities[kinematics.roots].any())
        self._velocities, self._velocities_stamp, self._with_joints = velocities, kinematics.stamp, with_joints
        if not (were_moving or self._are_moving):
            return  # all is 0 in MuJoCo's data
        if is_other or has_moved:
            self._rates = self.dof_velocities(velocities)
        self._qvel[:] = self._rest_qacc[:] = 0.0
        if with_joints:
            self._set_joint_velocities()
        if self._roots_move:
            self._set_roots(self._qvel, velocities)
            turning = {root: _turning_acceleration(velocities[root]) for root in kinematics.roots}
            self._set_roots(self._rest_qacc, turning)
        mujoco.mj_comVel(self._model, self._data)

    def _set_joint_velocities(self) -> None:
        """Write the velocities of the joints, and the accelerations that coupled ones have at constant velocities."""
        if self._coupling_matrix is not None:
            np.matmul(self._coupling_matrix, self._rates, out=self._qvel)
            return
        coupling = self._coupling(second=True)
        self._qvel[self._inner] = coupling.forward(self._rates)
        if coupling.second:
            self._rest_qacc[self._inner] = coupling.bias(self._rates)

    def _set_accelerations(self, accelerations: Floats | None, external: Mapping[int, Floats] | None = None) -> None:
        """Write accelerations into MuJoCo's data, on top of those that velocities make.

        Args:
            accelerations: Those of the DOFs, shape (dof,); None: none.
            external: Further accelerations of roots, by link, shape (6,).
        """
        qacc = self._qacc
        qacc[:] = self._rest_qacc
        if external:
            added = np.zeros_like(qacc)
            none = np.zeros(6)
            self._set_roots(added, {root: external.get(root, none) for root in self._kinematics.roots})
            qacc += added
        if accelerations is not None:
            if self._columns is not None and isinstance(self._columns[0], slice):
                qacc[self._columns[0]] += accelerations
            elif self._coupling_matrix is not None:
                qacc += self._coupling_matrix @ accelerations
            else:
                qacc[self._inner] += self._coupling().forward(accelerations)

    def inverse(
        self,
        velocities: Floats,
        accelerations: Floats,
        gravity: Sequence[float],
        external: Mapping[int, Floats] | None = None,
    ) -> Floats:
        """Return the generalised forces for given accelerations.

        Args:
            velocities: Those of the links, shape (links, 6).
            accelerations: Those of the DOFs [rad/s^2 or m/s^2], shape (dof,).
            gravity: Acceleration of free fall [m/s^2], shape (3,).
            external: Forces and moments on links at their centres of mass, in world axes, shape (6,), that are added.

        Returns:
            Torques and forces [N m or N], shape (dof,).
        """
        self._set_velocities(velocities)
        self._set_accelerations(accelerations)
        forces = self._needed_forces(gravity)
        if external:
            self._add_external(forces, external)
        return self._of_dof_values(forces)

    def inverse_components(
        self,
        velocities: Floats,
        accelerations: Floats,
        gravity: Sequence[float],
        external: Mapping[int, Floats] | None = None,
    ) -> tuple[Floats, Floats, Floats]:
        """Return the parts of ``inverse``: of accelerations, of joint velocities, and of all else."""
        # Gravity and the base are in all three motions, so that differences leave what is asked for.
        self._set_velocities(velocities)
        self._set_accelerations(accelerations)
        whole = self._needed_forces(gravity).copy()
        self._set_accelerations(None)
        moving = self._needed_forces(gravity).copy()
        self._set_velocities(velocities, with_joints=False)
        self._set_accelerations(None)
        rest = self._needed_forces(gravity)
        by_acceleration, by_velocity = whole - moving, moving - rest
        if external:
            self._add_external(rest, external)
        return self._of_dof_values(by_acceleration), self._of_dof_values(by_velocity), self._of_dof_values(rest)

    def _needed_forces(self, gravity: Sequence[float]) -> Floats:
        """Return the forces on all coordinates for the motion in MuJoCo's data, shape (nv,); no copy."""
        self._gravity[:] = gravity
        mujoco.mj_rne(self._model, self._data, 1, self._forces)
        return self._forces

    def _add_external(self, forces: Floats, external: Mapping[int, Floats]) -> None:
        """Add forces and moments on links at their centres of mass."""
        for link, wrench in external.items():
            body_id = self._body_ids[link]
            point = self._data.xipos[body_id]
            mujoco.mj_applyFT(self._model, self._data, wrench[:3], wrench[3:], point, body_id, forces)


def _turning_acceleration(velocity: Floats) -> Floats:
    """Return the acceleration of a link that goes on turning as it does, shape (6,): its origin's is ``w x v``."""
    return np.concatenate((np.cross(velocity[3:], velocity[:3]), np.zeros(3)))
