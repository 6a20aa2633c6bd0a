"""Velocities, derivatives and dynamics of a body in its present configuration."""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.dynamics.posture import Inertias, Posture, cross
from ravemj.engine.dynamics.coupling import VelocityMap, rotation_rate
from ravemj.engine.dynamics.tree import Tree
from ravemj.engine.kinematics import BodyKinematics
from ravemj.model.scene import Joint


class BodyDynamics:
    """Derivatives of one body's motion in a compiled model.

    Velocities of links are six numbers in world axes: that of the link's origin [m/s] and the angular one [rad/s].

    Attributes:
        tree: Which joint carries which.
        map: How the joints follow the DOFs.
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        self._kinematics = kinematics
        self._model, self._data = kinematics.model, kinematics.data
        self.tree = Tree(kinematics)
        self.map = VelocityMap(kinematics, self.tree)

    @property
    def armature(self) -> Floats:
        """Inertia of the motors behind their gears, for each mover, shape (movers,)."""
        return self._model.dof_armature[self.tree.dofs]

    @property
    def reference(self) -> Floats:
        """The reference point in the world [m], shape (3,): near the body, so that no digits are lost far away."""
        return self._data.xpos[self._kinematics.body_ids[0]].copy()

    def posture(self, *, second: bool = False) -> Posture:
        """Return where links and axes are now.

        Args:
            second: Whether second derivatives of followers and spherical joints are wanted.
        """
        kinematics, data, tree = self._kinematics, self._data, self.tree
        axes = data.xaxis[tree.joints]
        for mover, body_id in tree.balls:
            axes[mover : mover + 3] = data.xmat[body_id].reshape(3, 3).T
        reference = self.reference
        values = np.zeros(0) if self.map.is_constant else kinematics.values()
        return Posture(
            tree,
            self.map.at(values, second=second),
            axes,
            data.xanchor[tree.joints] - reference,
            data.xpos[kinematics.body_ids] - reference,
            data.xmat[kinematics.body_ids].reshape(-1, 3, 3).transpose(0, 2, 1),
        )

    def jacobian(self, link: int, point: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of a link's motion by the DOF values.

        Args:
            link: Index of the link.
            point: A point of the link, in world coordinates [m], shape (3,).

        Returns:
            Of the point's position and of the link's angular velocity, in world axes, each of shape (3, dof).
        """
        columns = self.posture().jacobian(link, point - self.reference).T
        return columns[:3].copy(), columns[3:].copy()

    def hessian(self, link: int, point: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of ``jacobian`` by the DOF values.

        Returns:
            Two arrays of shape (dof, 3, dof): ``[i, :, j]`` is the derivative of the Jacobian's column j by DOF i.
        """
        posture = self.posture(second=True)
        count, slopes = self.tree.count, posture.slopes
        columns = posture.columns(link, point - self.reference)
        moving, turning = columns[:, :3], columns[:, 3:]
        pairs = _outer_cross(turning, np.stack((moving, turning)))
        before = np.arange(count)[:, None] <= self.tree.carriers  # the first moves the axis of the second
        by_movers = np.zeros((count, 6, count))
        by_movers[:, :3] = np.where(before[:, None], pairs[0], pairs[0].transpose(2, 1, 0))
        by_movers[:, 3:] = np.where(before[:, None], pairs[1], 0.0)
        by_columns = slopes.backward(by_movers.transpose(2, 1, 0))
        hessian = slopes.backward(by_columns.transpose(2, 1, 0))
        for mover, along, dof, value in slopes.second:
            hessian[along, :, dof] += value * columns[mover]
        return hessian[:, :3].copy(), hessian[:, 3:].copy()

    def com_jacobian(self, inertias: Inertias) -> Floats:
        """Return the derivative of the body's centre of mass by the DOF values, shape (3, dof)."""
        posture = self.posture()
        weights = inertias.masses[:, None] / inertias.masses.sum()
        columns = np.zeros((3, self._kinematics.dof))
        coms = posture.coms(inertias)
        for row, direction in zip(columns, np.eye(3), strict=True):
            forces = np.tile(direction, (len(coms), 1)) * weights
            row[:] = posture.slopes.backward(posture.forces(np.concatenate((cross(coms, forces), forces), axis=1)))
        return columns

    def link_velocities(self, rates: Floats, base: Floats) -> Floats:
        """Return the velocities of the links.

        Args:
            rates: Those of the DOFs [rad/s or m/s], shape (dof,).
            base: That of the first link, shape (6,); other links that no joint places are at rest.

        Returns:
            Shape (links, 6).
        """
        posture = self.posture()
        velocities = np.zeros((len(posture.positions), 6))
        velocities[0] = base
        bases = _moved_to_reference(velocities, posture.positions)
        twists = posture.twists(posture.slopes.forward(rates), bases)
        return _moved_to_origins(posture.of_links(twists, bases), posture.positions)

    def joint_velocities(self, velocities: Floats, joints: Sequence[Joint]) -> list[Floats]:
        """Return the velocities of joints, active or passive, that velocities of links show.

        Args:
            velocities: Those of the links, shape (links, 6).
            joints: Which joints.

        Returns:
            For each joint those of its axes [rad/s or m/s], shape (axes,).
        """
        transforms = self._kinematics.link_transforms()
        parents, children = [joint.parent for joint in joints], [joint.child for joint in joints]
        before, after = velocities[parents], velocities[children]
        arms = transforms[children, :3, 3] - transforms[parents, :3, 3]
        moving = after[:, :3] - before[:, :3] - cross(before[:, 3:], arms)
        turning = after[:, 3:] - before[:, 3:]
        directions = np.array([joint.axes[0].direction for joint in joints]).reshape(-1, 3)
        slides = np.array([joint.kind == "slider" for joint in joints], dtype=bool).reshape(-1, 1)
        axes = (transforms[parents, :3, :3] @ directions[:, :, None])[:, :, 0]
        shown = list((axes * np.where(slides, moving, turning)).sum(axis=1, keepdims=True))
        for index, joint in enumerate(joints):
            if joint.kind == "spherical":
                shown[index] = self._ball_velocity(joint, transforms[joint.parent, :3, :3].T @ turning[index])
            elif joint.kind == "hinge2":
                shown[index] = np.linalg.pinv(self._two_axes(joint)) @ turning[index]
        return shown

    def dof_velocities(self, velocities: Floats) -> Floats:
        """Return the velocities of the DOFs that velocities of links show, shape (links, 6) to (dof,)."""
        if not velocities.any():
            return np.zeros(self._kinematics.dof)
        return np.concatenate([np.zeros(0), *self.joint_velocities(velocities, self._kinematics.body.joints)])

    def _two_axes(self, joint: Joint) -> Floats:
        """Return the axes of a ``hinge2`` as columns, shape (3, 2)."""
        names = self._kinematics.names.joints[self._kinematics.body.all_joints.index(joint)]
        ids = [mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in names]
        return self._data.xaxis[ids].T if ids else np.zeros((3, 2))

    def _ball_velocity(self, joint: Joint, turned: Floats) -> Floats:
        """Return the rate of a rotation vector, for an angular velocity in the parent's axes."""
        ball = next((ball for ball in self._kinematics.balls if ball.joint.child == joint.child), None)
        if ball is None:
            return turned
        vector = np.array(ball.to_values(self._data.qpos[ball.qpos].tolist()))
        rate, _ = rotation_rate(vector)
        return np.linalg.inv(rate.T) @ turned  # the left Jacobian is the right one's transpose

    def link_accelerations(
        self, velocities: Floats, growths: Floats, pushes: Mapping[int, Floats] | None = None
    ) -> Floats:
        """Return the accelerations of the links, of their origins and angular, shape (links, 6).

        Links that no joint places go on turning as they do, so that their origins accelerate by ``w x v``.

        Args:
            velocities: Those of the links, shape (links, 6).
            growths: Accelerations of the DOFs [rad/s^2 or m/s^2], shape (dof,).
            pushes: Further accelerations of links that no joint places, shape (6,), linear first.
        """
        posture = self.posture(second=True)
        rates = self.dof_velocities(velocities)
        motion, change = _motion(posture, velocities, rates, growths, pushes)
        spins, origins = motion[:, :3], posture.positions
        moving = motion[:, 3:] + cross(spins, origins)
        linear = change[:, 3:] + cross(change[:, :3], origins) + cross(spins, moving)
        return np.concatenate((linear, change[:, :3]), axis=1)

    def inverse(
        self, velocities: Floats, growths: Floats, inertias: Inertias, pushes: Mapping[int, Floats] | None = None
    ) -> Floats:
        """Return the generalised forces for given accelerations, against the model's gravity.

        Args:
            velocities: Those of the links, shape (links, 6).
            growths: Accelerations of the DOFs [rad/s^2 or m/s^2], shape (dof,).
            inertias: Mass properties of the links.
            pushes: Forces and moments on links at their centres of mass, in world axes, shape (6,), that are added.

        Returns:
            Torques and forces [N m or N], shape (dof,).
        """
        rates = self.dof_velocities(velocities)
        gravity = self._model.opt.gravity.copy()
        return self._inverse(self.posture(second=True), inertias, velocities, rates, growths, gravity, pushes)

    def inverse_components(
        self, velocities: Floats, growths: Floats, inertias: Inertias, pushes: Mapping[int, Floats] | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """Return the parts of ``inverse``: of accelerations, of joint velocities, and of all else."""
        posture = self.posture(second=True)
        rates = self.dof_velocities(velocities)
        none, still, gravity = np.zeros_like(rates), np.zeros_like(velocities), self._model.opt.gravity.copy()
        by_growth = self._inverse(posture, inertias, still, none, growths, np.zeros(3))
        by_velocity = self._inverse(posture, inertias, velocities, rates, none, np.zeros(3))
        by_base = self._inverse(posture, inertias, velocities, none, none, np.zeros(3))
        return (
            by_growth,
            by_velocity - by_base,
            self._inverse(posture, inertias, velocities, none, none, gravity, pushes),
        )

    def _inverse(
        self,
        posture: Posture,
        inertias: Inertias,
        velocities: Floats,
        rates: Floats,
        growths: Floats,
        gravity: Floats,
        pushes: Mapping[int, Floats] | None = None,
    ) -> Floats:
        forces = posture.needed_forces(inertias, *_motion(posture, velocities, rates, growths), gravity)
        coms = posture.coms(inertias)
        for link, push in (pushes or {}).items():
            forces[link, :3] += push[3:] + np.cross(coms[link], push[:3])
            forces[link, 3:] += push[:3]
        slopes = posture.slopes
        motors = self.armature * (slopes.forward(growths) + slopes.bend(rates))
        return slopes.backward(posture.forces(forces) + motors)


def _motion(
    posture: Posture,
    velocities: Floats,
    rates: Floats,
    growths: Floats,
    pushes: Mapping[int, Floats] | None = None,
) -> tuple[Floats, Floats]:
    """Return the links' motions about the reference point and their derivatives, each of shape (links, 6).

    Of the links' velocities, those of links count that no joint places.
    """
    slopes = posture.slopes
    bases = _moved_to_reference(velocities, posture.positions)
    bases_change = None
    if pushes:
        pushed = np.zeros_like(velocities)
        for link, push in pushes.items():
            pushed[link] = push
        bases_change = _moved_to_reference(pushed, posture.positions)
    movers = slopes.forward(rates)
    twists = posture.twists(movers, bases)
    change = posture.accelerations(twists, movers, slopes.forward(growths) + slopes.bend(rates), bases_change)
    return posture.of_links(twists, bases), posture.of_links(change, bases_change)


def _moved_to_reference(velocities: Floats, positions: Floats) -> Floats:
    """Turn velocities of origins and angular ones into motions about the reference point, shape (links, 6)."""
    spins = velocities[:, 3:]
    return np.concatenate((spins, velocities[:, :3] - cross(spins, positions)), axis=1)


def _moved_to_origins(motions: Floats, positions: Floats) -> Floats:
    """Undo ``_moved_to_reference``."""
    spins = motions[:, :3]
    return np.concatenate((motions[:, 3:] + cross(spins, positions), spins), axis=1)


def _outer_cross(turning: Floats, columns: Floats) -> Floats:
    """Return ``turning[a] x columns[:, b]`` as ``[:, a, :, b]``."""
    crossed = np.cross(turning[None, :, None], columns[:, None])
    return crossed.transpose(0, 1, 3, 2)
