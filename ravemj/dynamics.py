"""Velocities, Jacobians and inverse dynamics of one body.

MuJoCo knows every joint that moves, followers included, and has a velocity for each. OpenRAVE's DOFs move them all:
``qvel = P(q) dq/dt``, and by virtual work the generalised forces of the DOFs are ``P^T`` times MuJoCo's.
"""

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.kinematics import WELDED, BodyKinematics, Follower
from ravemj.transforms import Floats, rows_from_wxyz

if TYPE_CHECKING:
    from ravemj.expressions import Expression

STEP = 1e-5
"""Step [rad or m] of the difference quotient of P, where P is no constant."""


class BodyDynamics:
    """Derivatives of one body's motion in a compiled model.

    Attributes:
        velocities: DOF velocities [rad/s or m/s], shape (dof,).
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        self._kinematics = kinematics
        self._model, self._data = kinematics.model, kinematics.data
        self.velocities = np.zeros(kinematics.dof)
        self._qvel_of_qpos = _qvel_of_qpos(self._model)
        self._slopes = [self._derivatives(follower) for follower in kinematics.followers]
        self._constant = self._fixed_columns()
        self._is_constant = not kinematics.balls and all(
            not slope.variables for slopes in self._slopes for slope in slopes.values()
        )

    def _derivatives(self, follower: Follower) -> "dict[int, Expression]":
        """Return the partial derivatives of a follower by the index of the joint that it follows."""
        joints = (*self._kinematics.body.joints, *self._kinematics.body.passive_joints)
        mimic = joints[follower.joint].mimic
        if mimic is None or mimic.expression is None:
            return {}
        names = mimic.expression.variables
        return {int(name.removeprefix("joint")): mimic.expression.derivative(name) for name in names}

    def _fixed_columns(self) -> Floats:
        """Return the part of P that joints with plain axes fill."""
        columns = np.zeros((self._model.nv, self._kinematics.dof))
        for dof, qpos in enumerate(self._kinematics.qpos_indices):
            if qpos != WELDED:
                columns[self._qvel_of_qpos[qpos], dof] = 1.0
        return columns

    def velocity_map(self, values: Floats) -> Floats:
        """Return P, the derivative of MuJoCo's velocities by those of the DOFs, shape (nv, dof).

        Args:
            values: Joint values [rad or m], shape (dof,).
        """
        if self._is_constant and not self._slopes:
            return self._constant
        columns = self._constant.copy()
        for ball in self._kinematics.balls:
            start = self._qvel_of_qpos[ball.qpos.start]
            rest = np.array(rows_from_wxyz(ball.joint.T_parent_child.wxyz))
            columns[start : start + 3, ball.dofs] = rest.T @ _rotation_rate(values[ball.dofs])
        self._fill_followers(columns, values)
        return columns

    def _fill_followers(self, columns: Floats, values: Floats) -> None:
        kinematics = self._kinematics
        known = kinematics.first_values(values)
        rows = {index: _unit_row(kinematics.dof, first) for index, first in enumerate(kinematics.first_dofs)}
        for follower, slopes in zip(kinematics.followers, self._slopes, strict=True):
            known[follower.joint] = follower.evaluate(known)
            row = np.zeros(kinematics.dof)
            for leader, slope in slopes.items():
                if leader in rows:
                    named = {name: known[int(name.removeprefix("joint"))] for name in slope.variables}
                    row += slope.evaluate(named) * rows[leader]
            rows[follower.joint] = row
            if follower.qpos != WELDED:
                columns[self._qvel_of_qpos[follower.qpos]] = row

    def _velocity_map_rate(self, values: Floats) -> Floats:
        """Return the time derivative of P along the present velocities."""
        if self._is_constant or not self.velocities.any():
            return np.zeros_like(self._constant)
        step = STEP * self.velocities
        return (self.velocity_map(values + step) - self.velocity_map(values - step)) / (2 * STEP)

    def passive_velocity(self, joint: int) -> float:
        """Return the velocity of a joint without DOFs: that of its equation, or 0 where it follows none [rad/s or m/s].

        Args:
            joint: Its index among the active joints followed by the passive ones.
        """
        qpos = next((one.qpos for one in self._kinematics.followers if one.joint == joint), WELDED)
        if qpos == WELDED:
            return 0.0
        velocities = self.velocity_map(self._kinematics.values()) @ self.velocities
        return float(velocities[self._qvel_of_qpos[qpos]])

    def jacobian(self, link: int, point: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of a link's motion by the DOF values.

        Args:
            link: Index of the link.
            point: A point of the link, in world coordinates [m], shape (3,).

        Returns:
            Of the point's position and of the link's angular velocity, in world axes, each of shape (3, dof).
        """
        translation = np.zeros((3, self._model.nv))
        turning = np.zeros((3, self._model.nv))
        mujoco.mj_comPos(self._model, self._data)
        body_id = int(self._kinematics.body_ids[link])
        mujoco.mj_jac(self._model, self._data, translation, turning, point, body_id)
        columns = self.velocity_map(self._kinematics.values())
        return translation @ columns, turning @ columns

    def inverse(self, accelerations: Floats) -> Floats:
        """Return the generalised forces for given accelerations at the present values and velocities.

        Bodies other than this one are taken to stand still; gravity is the model's.

        Args:
            accelerations: DOF accelerations [rad/s^2 or m/s^2], shape (dof,).

        Returns:
            Torques and forces [N m or N], shape (dof,).
        """
        model, data = self._model, self._data
        values = self._kinematics.values()
        columns = self.velocity_map(values)
        data.qvel[:] = columns @ self.velocities
        data.qacc[:] = columns @ accelerations + self._velocity_map_rate(values) @ self.velocities
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        forces = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 1, forces)
        data.qvel[:] = 0
        data.qacc[:] = 0
        return columns.T @ forces


def _qvel_of_qpos(model: mujoco.MjModel) -> dict[int, int]:
    return dict(zip(model.jnt_qposadr.tolist(), model.jnt_dofadr.tolist(), strict=True))


def _unit_row(length: int, index: int) -> Floats:
    row = np.zeros(length)
    row[index] = 1.0
    return row


def _rotation_rate(vector: Floats) -> Floats:
    """Return the matrix that takes the rate of a rotation vector to the angular velocity in the turned axes.

    The right Jacobian of SO(3): I - (1 - cos a) / a^2 [v] + (a - sin a) / a^3 [v]^2, with a = |v|.
    """
    angle = float(np.linalg.norm(vector))
    x, y, z = vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    if angle < 1e-4:
        return np.eye(3) - cross / 2 + cross @ cross / 6
    first, second = (1 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3
    return np.eye(3) - first * cross + second * cross @ cross
