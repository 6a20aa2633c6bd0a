"""Inverse dynamics of one body: torques, external forces and motors, converted from MuJoCo's velocities to DOFs."""

import math
from collections.abc import Mapping, Sequence
from typing import Self

import mujoco
import numpy as np

from ravemj.core.transforms import ZERO, Floats, Ints, Vec3, cross_rows
from ravemj.engine.dynamics.coupling import Coupling, CouplingMap
from ravemj.engine.dynamics.joint_velocities import JointVelocities
from ravemj.engine.dynamics.stacked import StackedJacobians, WholeBodyRows, with_base_columns
from ravemj.engine.dynamics.tree import CoordinateTree
from ravemj.engine.kinematics import BodyKinematics
from ravemj.model.scene import Joint


class DerivativeRows:
    """Array for a Jacobian with respect to MuJoCo's velocities, or for generalised forces along these velocities.

    Attributes:
        matrix: MuJoCo's output, shape (..., nv).
    """

    def __init__(self, shape: tuple[int, ...], nv: int, columns: Ints | None) -> None:
        """Allocate an array with a last axis of MuJoCo's ``nv`` velocities.

        ``columns`` are the columns of the DOFs, ``nv`` for a DOF without effect; None if DOFs are coupled.
        """
        count = math.prod(shape)
        self._numbers = np.zeros(count * nv + 1)  # the last number stays 0
        self.matrix = self._numbers[:-1].reshape(*shape, nv)
        if columns is not None:
            firsts = nv * np.arange(count).reshape(*shape, 1)
            self._places = np.where(columns < nv, firsts + columns, count * nv)

    def of_dofs(self, coupling: Floats | None) -> Floats:
        """Return the derivatives with respect to the DOFs, shape (..., dof); a copy.

        Coupled DOFs require their coupling matrix, shape (nv, dof).
        """
        return self._numbers[self._places] if coupling is None else self.matrix.dot(coupling)


AT_REST = 1e-12
"""Speed [rad/s or m/s] that counts as zero: dry friction is discontinuous at 0, and speeds have rounding errors."""


class Motors:
    """Motors of the joints between links, one for each velocity coordinate."""

    def __init__(self, armature: Floats, coulomb: Floats, viscous: Floats) -> None:
        """Store rotor inertia at the joint [kg m^2], Coulomb friction [N m] and viscous friction [N m s/rad].

        Their shape is (coordinates,).
        """
        self._armature, self._coulomb, self._viscous = armature, coulomb, viscous

    @classmethod
    def for_body(cls, kinematics: BodyKinematics, tree: CoordinateTree) -> Self | None:
        """Return the motors of a body; None if all joints are without friction and rotors."""
        data = np.zeros((3, tree.count))
        for joint, places in zip(kinematics.body.all_joints, kinematics.joint_qpos, strict=True):
            for axis, place in zip(joint.axes, places, strict=False):
                numbers = axis.armature, axis.coulomb_friction, axis.viscous_friction
                data[:, tree.of_qpos[place]] = numbers
        return cls(*data) if data.any() else None

    def torques(self, speeds: Floats, accelerations: Floats) -> Floats:
        """Return the torques and forces [N m or N] that motors need at speeds and accelerations of the coordinates.

        Arguments and result have the shape (coordinates, ...).
        """
        armature, coulomb, viscous = (
            coefficient.reshape(-1, *(1,) * (speeds.ndim - 1))
            for coefficient in (self._armature, self._coulomb, self._viscous)
        )
        direction = np.where(np.abs(speeds) > AT_REST, np.sign(speeds), 0.0)
        return armature * accelerations + coulomb * direction + viscous * speeds


class BodyDynamics:
    """Jacobians and dynamics of one body.

    Link velocities are linear (of the link's origin) [m/s], then angular [rad/s], in world axes.

    Attributes:
        free_joint: Name of a passive joint that is neither a weld nor a mimic joint: the DOFs do not determine its
            motion; None if there is none.
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        self._kinematics = kinematics
        self._model, self._data = model, _ = kinematics.model, kinematics.data
        self.tree = CoordinateTree(kinematics)
        self.couplings = CouplingMap(kinematics, self.tree)
        self.motors = Motors.for_body(kinematics, self.tree)
        passive = kinematics.body.passive_joints
        self.free_joint = next((joint.name for joint in passive if joint.mimic is None and not joint.static), None)
        self._body_ids: list[int] = kinematics.body_ids.tolist()
        self._root_ids = model.body_rootid[kinematics.body_ids]
        self._inner = np.arange(model.nv)[kinematics.inner_qvel]
        self._joint_velocities = JointVelocities(kinematics)
        constant = self.couplings.constant
        self._coupling_matrix = None if constant is None else self._matrix(constant)
        columns = self._columns()
        self._are_one_to_one = columns is not None
        self._columns_of_dofs = columns
        self._stacked: dict[int, StackedJacobians] = {}
        self._moving, self._turning = (DerivativeRows((3,), model.nv, columns) for _ in range(2))
        self._forces, self._by_velocity, self._rest = (DerivativeRows((), model.nv, columns) for _ in range(3))
        self._xipos: list[Floats] = list(self._data.xipos)  # views, created once
        self._qvel, self._qacc, self._gravity = self._data.qvel, self._data.qacc, model.opt.gravity
        self._free_fall = (ZERO, np.zeros(3))  # the last gravity: as given, and as an array
        self._velocities: Floats | None = None  # those of the links currently set in the data
        self._velocities_stamp = -1
        self._with_roots: bool = False
        self._are_moving: bool = False
        self._roots_move: bool = False
        self._rates = np.zeros(kinematics.dof)
        self._rest_qacc = np.zeros(model.nv)

    def _columns(self) -> Ints | None:
        """Index of each DOF among MuJoCo's velocities, ``nv`` if its joint is fixed; None if DOFs are coupled."""
        constant = self.couplings.constant
        if constant is None or not self.couplings.is_one_to_one:
            return None
        columns = np.full(self._kinematics.dof, self._model.nv)
        columns[constant.dofs] = self._inner[constant.coordinates]
        return columns

    def _matrix(self, coupling: Coupling) -> Floats:
        """Return the coupling matrix from DOF to MuJoCo velocities, shape (nv, dof)."""
        matrix = np.zeros((self._model.nv, self._kinematics.dof))
        matrix[self._inner] = coupling.forward(np.eye(self._kinematics.dof))
        return matrix

    def _coupling(self, *, second: bool = False) -> Coupling:
        """Return the coupling of MuJoCo's velocities to the DOFs at present; if ``second``, with its derivative."""
        return self.couplings.constant or self.couplings.at(self._kinematics.values(), second=second)

    def _of_dofs(self, rows: DerivativeRows) -> Floats:
        """Return a copy of MuJoCo's Jacobian with a column per DOF, shape (..., dof)."""
        if self._are_one_to_one:
            return rows.of_dofs(None)
        matrix = self._coupling_matrix
        return rows.of_dofs(self._matrix(self._coupling()) if matrix is None else matrix)

    def translation_jacobian(self, link: int, point: Floats) -> Floats:
        """Return the derivative of a link point's world position with respect to the DOF values, shape (3, dof)."""
        self._kinematics.place_coms()
        mujoco.mj_jac(self._model, self._data, self._moving.matrix, None, point, self._body_ids[link])
        return self._of_dofs(self._moving)

    def rotation_jacobian(self, link: int) -> Floats:
        """Return a link's angular velocity, in world axes, per unit velocity of each DOF, shape (3, dof)."""
        self._kinematics.place_coms()
        mujoco.mj_jacBody(self._model, self._data, None, self._turning.matrix, self._body_ids[link])
        return self._of_dofs(self._turning)

    def jacobians(
        self, links: Sequence[int], points: Floats | None = None, dofs: Ints | None = None, *, base: bool = False
    ) -> Floats:
        """Return the Jacobians of world points (k, 3) fixed to links, by default of the links' origins.

        Returns:
            Shape (k, 6, columns): ``translation_jacobian`` of each point above ``rotation_jacobian``. The columns are
                those of ``dofs``, by default all, then optionally those of a base twist, see ``with_base_columns``.
        """
        kinematics, count = self._kinematics, len(links)
        if points is None:
            kinematics.place()
            points = self._data.xpos.take(kinematics.body_ids.take(links), 0)
        stacked = self._stacked.get(count)
        if stacked is None:
            rows = DerivativeRows((count, 6), self._model.nv, self._columns_of_dofs)
            self._stacked[count] = stacked = StackedJacobians(kinematics, rows)
        stacked.fill(links, points)
        jacobians = self._of_dofs(stacked.rows)
        if dofs is not None:
            jacobians = jacobians.take(dofs, 2)
        return with_base_columns(jacobians, points - kinematics.position(0)) if base else jacobians

    def whole_body_rows(self, count: int, dofs: Ints, *, base: bool) -> WholeBodyRows | None:
        """Return a buffer for Jacobians of points and of the centre of mass; None for coupled joints or several roots.

        Args:
            count: Number of points.
            dofs: DOFs of the first columns.
            base: Whether columns of a base twist follow, as in ``with_base_columns``.
        """
        columns = self._columns_of_dofs
        if columns is None or self._kinematics.roots != [0]:
            return None
        return WholeBodyRows(self._kinematics, count, columns.take(dofs), base=base)

    def hessian(self, link: int, point: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of ``translation_jacobian`` and ``rotation_jacobian`` with respect to the DOF values.

        Returns:
            Two arrays of shape (dof, 3, dof): ``[i, :, j]`` is the derivative of column j with respect to DOF i.
        """
        self._kinematics.place_coms()
        moving, turning = self._moving.matrix, self._turning.matrix
        mujoco.mj_jac(self._model, self._data, moving, turning, point, self._body_ids[link])
        chain = np.flatnonzero(self.tree.moves[link])
        columns = np.stack((moving, turning))[:, :, self._inner[chain]].transpose(2, 0, 1)
        spins = columns[:, None, 1]
        moved, turned = (cross_rows(spins, columns[None, :, part]) for part in (0, 1))  # w_a x v_b as [a, b]
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
        """Return the derivative of the body's centre of mass with respect to the DOF values, shape (3, dof)."""
        self._kinematics.place_coms()
        of_root, masses = np.zeros((3, self._model.nv)), self._model.body_subtreemass
        self._moving.matrix[:] = 0.0
        for root in self._kinematics.roots:
            body_id = self._body_ids[root]
            mujoco.mj_jacSubtreeCom(self._model, self._data, of_root, body_id)
            self._moving.matrix[:] += masses[body_id] / masses[0] * of_root
        return self._of_dofs(self._moving)

    def qvel(self, velocities: Floats, rates: Floats) -> Floats:
        """Return MuJoCo's velocities in the body's own model, (nv,), from velocities of root links and of DOFs.

        ``rates`` are the DOF velocities [rad/s or m/s], shape (dof,).
        """
        qvel = np.zeros(self._model.nv)
        if rates.any():
            qvel[self._inner] = self._coupling().forward(rates)
        self._set_roots(qvel, velocities)
        return qvel

    def _set_roots(self, target: Floats, values: Mapping[int, Floats] | Floats) -> None:
        """Write velocities or accelerations of roots, by link: linear in world axes, angular in link axes."""
        self._kinematics.place()
        for root, first in zip(self._kinematics.roots, self._kinematics.root_qvel, strict=True):
            target[first : first + 3] = values[root][:3]
            rotation = self._data.xmat[self._body_ids[root]].reshape(3, 3)
            target[first + 3 : first + 6] = values[root][3:] @ rotation

    def _arms(self) -> Floats:
        """Return the lever arms of MuJoCo's link velocities: reference point to link origin [m], shape (links, 3)."""
        ids = self._kinematics.body_ids
        return self._data.xpos.take(ids, 0) - self._data.subtree_com.take(self._root_ids, 0)

    def _present_velocities(self, arms: Floats) -> Floats:
        """Return the link velocities in MuJoCo's data, shape (links, 6), given the lever arms from ``_arms``."""
        motions = self._data.cvel.take(self._kinematics.body_ids, 0)
        spins = motions[:, :3]
        return np.concatenate((motions[:, 3:] + cross_rows(spins, arms), spins), axis=1)

    def link_velocities(self, rates: Floats, base: Floats) -> Floats:
        """Return the link velocities, shape (links, 6), from DOF velocities and the velocity of the first link, (6,).

        Other root links are at rest.
        """
        velocities = np.zeros((len(self._body_ids), 6))
        velocities[0] = base
        self._kinematics.place_coms()
        self._velocities, self._are_moving = None, True
        self._qvel[:] = self.qvel(velocities, rates)
        mujoco.mj_comVel(self._model, self._data)
        return self._present_velocities(self._arms())

    def joint_velocities(self, velocities: Floats, joints: Sequence[Joint]) -> list[Floats]:
        """Return joint velocities computed from link velocities; see ``JointVelocities``."""
        return self._joint_velocities.of_joints(joints, velocities)

    def dof_velocities(self, velocities: Floats) -> Floats:
        """Return DOF velocities, shape (dof,), computed from link velocities, shape (links, 6)."""
        return self._joint_velocities.of_dofs(velocities)

    def link_accelerations(
        self, velocities: Floats, accelerations: Floats, external: Mapping[int, Floats] | None = None
    ) -> Floats:
        """Return the accelerations of the links, linear (of origins), then angular, shape (links, 6).

        Root links keep their angular velocity, so that their origins accelerate by ``w x v``; ``external`` are
        additional accelerations of root links, shape (6,), linear first.
        """
        data = self._data
        self._set_velocities(velocities)
        self._set_accelerations(accelerations, external)
        self._gravity[:] = 0.0
        arms = self._arms()
        speeds = self._present_velocities(arms)
        mujoco.mj_rnePostConstraint(self._model, data)
        motions = data.cacc.take(self._kinematics.body_ids, 0)
        turning = motions[:, :3]
        linear = motions[:, 3:] + cross_rows(turning, arms) + cross_rows(speeds[:, 3:], speeds[:, :3])
        return np.concatenate((linear, turning), axis=1)

    def _set_velocities(self, velocities: Floats, *, with_roots: bool = True) -> None:
        """Write velocities and derived quantities into MuJoCo's data, unless they are already there.

        Args:
            velocities: Link velocities, shape (links, 6), in an immutable array; they determine those of roots and
                joints.
            with_roots: Whether to set the velocities of the roots, too.
        """
        kinematics = self._kinematics
        kinematics.place_coms()
        is_other, has_moved = velocities is not self._velocities, kinematics.stamp != self._velocities_stamp
        if not (is_other or has_moved) and with_roots == self._with_roots:
            return
        were_moving = self._are_moving
        if is_other:
            self._are_moving, self._roots_move = bool(velocities.any()), bool(velocities[kinematics.roots].any())
        self._velocities, self._velocities_stamp, self._with_roots = velocities, kinematics.stamp, with_roots
        if not (were_moving or self._are_moving):
            return  # MuJoCo's data is 0
        if is_other or has_moved:
            self._rates = self.dof_velocities(velocities)
        self._rest_qacc[...] = 0.0
        self._set_joint_velocities()
        if self._roots_move and with_roots:
            self._set_roots(self._qvel, velocities)
            turning = {root: _turning_acceleration(velocities[root]) for root in kinematics.roots}
            self._set_roots(self._rest_qacc, turning)
        mujoco.mj_comVel(self._model, self._data)

    def _set_joint_velocities(self) -> None:
        """Write the joint velocities, and the accelerations of coupled joints if the DOF velocities stay constant."""
        if self._coupling_matrix is not None:
            self._coupling_matrix.dot(self._rates, self._qvel)
            return
        coupling = self._coupling(second=True)
        self._qvel[...] = 0.0
        self._qvel[self._inner] = coupling.forward(self._rates)
        if coupling.second:
            self._rest_qacc[self._inner] = coupling.bias(self._rates)

    def _set_accelerations(self, accelerations: Floats | None, external: Mapping[int, Floats] | None = None) -> None:
        """Write the sum of DOF, velocity-dependent and root accelerations into ``qacc``.

        ``external`` are the accelerations of root links, by link index.
        """
        qacc = self._qacc
        if accelerations is None:
            qacc[...] = 0.0
        elif self._coupling_matrix is not None:
            self._coupling_matrix.dot(accelerations, qacc)
        else:
            qacc[...] = 0.0
            qacc[self._inner] = self._coupling().forward(accelerations)
        if self._are_moving and (self._roots_move or self._coupling_matrix is None):
            qacc += self._rest_qacc
        if external:
            added = np.zeros_like(qacc)
            none = np.zeros(6)
            self._set_roots(added, {root: external.get(root, none) for root in self._kinematics.roots})
            qacc += added

    def inverse(
        self,
        velocities: Floats,
        accelerations: Floats,
        gravity: Vec3,
        external: Mapping[int, Floats] | None = None,
    ) -> Floats:
        """Return the generalised forces [N m or N], shape (dof,), for link velocities and DOF accelerations.

        ``external`` are additional forces and moments on links at their centres of mass, in world axes, (6,).
        """
        self._set_gravity(gravity)
        self._set_velocities(velocities)
        self._set_accelerations(accelerations)
        self._needed(self._forces.matrix)
        if external:
            self._add_external(self._forces.matrix, external)
        return self._of_dofs(self._forces)

    def _needed(self, forces: Floats) -> None:
        """Write the generalised forces that the motion in MuJoCo's data requires, shape (nv,)."""
        mujoco.mj_rne(self._model, self._data, 1, forces)
        if self.motors is not None:
            inner = self._inner
            forces[inner] += self.motors.torques(self._qvel[inner], self._qacc[inner])

    def inverse_components(
        self,
        velocities: Floats,
        accelerations: Floats,
        gravity: Vec3,
        external: Mapping[int, Floats] | None = None,
    ) -> tuple[Floats, Floats, Floats]:
        """Return the components of ``inverse`` due to accelerations, joint velocities, and the rest (gravity etc.)."""
        self._set_gravity(gravity)
        self._set_velocities(velocities)
        self._set_accelerations(accelerations)
        if self.motors is not None or self._roots_move or self._coupling_matrix is None:
            self._write_parts_of_all(velocities)
        else:
            self._write_parts_of_joints()
        if external:
            self._add_external(self._rest.matrix, external)
        return self._of_dofs(self._forces), self._of_dofs(self._by_velocity), self._of_dofs(self._rest)

    def _write_parts_of_joints(self) -> None:
        """Write the forces due to acceleration, velocity and gravity, given constant coupling, no motors, fixed roots.

        Without accelerations and gravity, ``mj_rne`` returns only the effects of velocity.
        """
        by_acceleration, by_velocity, rest = self._forces.matrix, self._by_velocity.matrix, self._rest.matrix
        mujoco.mj_rne(self._model, self._data, 1, by_acceleration)
        mujoco.mj_rne(self._model, self._data, 0, rest)
        self._gravity[...] = 0.0
        mujoco.mj_rne(self._model, self._data, 0, by_velocity)
        by_acceleration -= rest
        rest -= by_velocity

    def _write_parts_of_all(self, velocities: Floats) -> None:
        """Write the forces of the motion in MuJoCo's data, split into acceleration, joint velocity and all else.

        The part of joint velocities is computed with the base at rest and without gravity.
        """
        by_acceleration, by_velocity, rest = self._forces.matrix, self._by_velocity.matrix, self._rest.matrix
        self._needed(by_acceleration)
        self._set_accelerations(None)
        self._needed(rest)
        self._gravity[...] = 0.0
        self._set_velocities(velocities, with_roots=False)
        self._set_accelerations(None)
        self._needed(by_velocity)
        by_acceleration -= rest
        rest -= by_velocity

    def _set_gravity(self, gravity: Vec3) -> None:
        if gravity is not self._free_fall[0]:
            self._free_fall = (gravity, np.array(gravity))
        self._gravity[...] = self._free_fall[1]

    def _add_external(self, forces: Floats, external: Mapping[int, Floats]) -> None:
        """Add external wrenches on links, at their centres of mass, to the generalised forces."""
        for link, wrench in external.items():
            body_id = self._body_ids[link]
            mujoco.mj_applyFT(self._model, self._data, wrench[:3], wrench[3:], self._xipos[body_id], body_id, forces)


def _turning_acceleration(velocity: Floats) -> Floats:
    """Return the acceleration of a link with constant angular velocity, shape (6,): ``w x v`` of its origin, then 0."""
    return np.concatenate((cross_rows(velocity[3:], velocity[:3]), np.zeros(3)))
