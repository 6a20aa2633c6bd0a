"""Loads on bodies during a physics step: forces, motors, and the spring of interactive dragging."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.kinematics import NO_QPOS
from ravemj.engine.physics.body import PhysicalBody
from ravemj.engine.simulation import BodyState

_FREQUENCY = 15.0
"""Natural frequency of the dragging spring [rad/s]: it settles within 0.2 s, and sags by 4 cm."""


@dataclass
class Motor:
    """Motor: joints driven at given velocities [rad/s or m/s], shape (len(dofs),)."""

    dofs: Ints
    velocities: Floats


class Loads:
    """External forces and joint torques of a body for the next time step, and a motor that stays until released."""

    def __init__(self, state: BodyState, motor: Motor | None = None) -> None:
        self._state = state
        self.motor = motor
        links = len(state.scene.links)
        self.torques = np.zeros(len(state.scene.dof_axes))  # on the DOFs [N m or N]
        self._forces, self._levers, self._moments = np.zeros((links, 3)), np.zeros((links, 3)), np.zeros((links, 3))

    def next(self) -> "Loads":
        """Return the loads of the following step: only the motor."""
        return Loads(self._state, self.motor)

    def push(self, link: int, force: Floats, position: Floats, *, add: bool) -> None:
        """Apply a force [N] to a link at a position [m], both in the world; ``add`` keeps earlier forces."""
        T_world_link = self._state.link_transform(link)
        center = T_world_link[:3, :3] @ self._state.scene.links[link].inertial.com + T_world_link[:3, 3]
        self._forces[link] = force + add * self._forces[link]
        self._levers[link] = np.cross(position - center, force) + add * self._levers[link]

    def turn(self, link: int, moment: Floats, *, add: bool) -> None:
        """Apply a torque [N m], in world axes, to a link; ``add`` keeps earlier torques."""
        self._moments[link] = moment + add * self._moments[link]

    def apply(self, body: PhysicalBody) -> None:
        """Apply the loads to a body in the physics model, until they are replaced."""
        data = body.data
        data.xfrc_applied[body.body_ids] = np.hstack([self._forces, self._levers + self._moments])
        if self.torques.any():
            coupling = self._state.dynamics.couplings.at(self._state.kinematics.values(), second=False)
            columns = coupling.forward(np.eye(len(self.torques)))
            data.qfrc_applied[body.rows] += np.linalg.lstsq(columns.T, self.torques)[0]

    def drive(self, body: PhysicalBody, applied: Floats) -> None:
        """Apply the motor torques with which joints reach their target velocities after a time step.

        The accelerations of the model must be computed; ``applied`` are the other joint forces, shape (nv,).
        """
        if self.motor is None:
            return
        model, data = body.model, body.data
        rows, wanted, limits = _motor_rows(body, self.motor)
        unit = np.zeros((len(rows), model.nv))
        unit[np.arange(len(rows)), rows] = 1.0
        answers = np.zeros_like(unit)
        mujoco.mj_solveM(model, data, answers, unit)
        missing = (wanted - data.qvel[rows]) / model.opt.timestep - data.qacc_smooth[rows]
        torques = np.linalg.solve(answers[:, rows], missing)
        data.qfrc_applied[rows] = applied[rows] + np.clip(torques, -limits, limits)


def _motor_rows(body: PhysicalBody, motor: Motor) -> tuple[Ints, Floats, Floats]:
    """Return the indices of the driven joints in ``qvel``, their velocities and maximum torques."""
    kinematics = body.state.kinematics
    coordinates = body.state.dynamics.tree.of_qpos
    places = np.flatnonzero(kinematics.qpos_indices[motor.dofs] != NO_QPOS)
    dofs = motor.dofs[places]
    rows = body.rows[[coordinates[int(qpos)] for qpos in kinematics.qpos_indices[dofs]]]
    torques = [body.state.scene.dof_axes[int(dof)].max_torque or np.inf for dof in dofs]
    return rows, motor.velocities[places], np.array(torques)


@dataclass(eq=False)
class Spring:
    """Spring between a point of a link and a world position, critically damped.

    Its stiffness is adapted to the effective mass.
    """

    state: BodyState
    link: int
    point: Floats  # in the link [m], shape (3,)
    goal: Floats  # in the world [m], shape (3,)

    @property
    def place(self) -> Floats:
        """Current world position [m] of the link's point where the spring acts, shape (3,)."""
        T_world_link = self.state.link_transform(self.link)
        return T_world_link[:3, :3] @ self.point + T_world_link[:3, 3]

    def act(self, body: PhysicalBody, applied: Floats) -> None:
        """Apply the spring during the next time step, in addition to the forces ``applied``, shape (bodies, 6).

        The force is m (w^2 d - 2 w v), critically damped, with d the vector to the goal, v the velocity of the point
        and m the effective mass: the inverse of the mean of the diagonal of J M^-1 J^T.
        """
        model, data, body_id = body.model, body.data, int(body.body_ids[self.link])
        mujoco.mj_forward(model, data)
        place = data.xpos[body_id] + data.xmat[body_id].reshape(3, 3) @ self.point
        jacobian, answers = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, place, body_id)
        mujoco.mj_solveM(model, data, answers, jacobian)
        mobility = float(np.einsum("ij,ij->", jacobian, answers)) / 3
        if mobility > 0:  # the link is fixed
            pull = _FREQUENCY**2 * (self.goal - place) - 2 * _FREQUENCY * (jacobian @ data.qvel)
            force = pull / mobility
            wrench = np.concatenate([force, np.cross(place - data.xipos[body_id], force)])
            data.xfrc_applied[body_id] = applied[body_id] + wrench
