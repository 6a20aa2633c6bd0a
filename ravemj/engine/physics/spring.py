"""A spring between a point of a link and a place in the world: how people pull things while physics runs."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.physics.body import PhysicalBody
from ravemj.engine.simulation import BodyState

_FREQUENCY = 15.0
"""Natural frequency of what hangs on it [rad/s]: it comes along within a fifth of a second, and hangs 4 cm low."""


@dataclass(eq=False)
class Spring:
    """A spring, and a damper that keeps it from swinging; it is as stiff as suits the mass that it feels.

    Attributes:
        state: The body.
        link: Index of its link.
        point: The point, in the link [m], shape (3,).
        goal: The place, in the world [m], shape (3,).
    """

    state: BodyState
    link: int
    point: Floats
    goal: Floats

    @property
    def place(self) -> Floats:
        """Where the point is now, in the world [m], shape (3,)."""
        T_world_link = self.state.link_transform(self.link)
        return T_world_link[:3, :3] @ self.point + T_world_link[:3, 3]

    def act(self, body: PhysicalBody, applied: Floats) -> None:
        """Let the spring act during the next time step.

        The force is m (w^2 d - 2 w v), critically damped, with d the way to the goal, v the velocity of the point and m
        the mass that is felt there: the inverse of the mean of the diagonal of J M^-1 J^T.

        Args:
            body: The body in the model of physics.
            applied: The other forces on the links of this model, shape (bodies, 6).
        """
        model, data, body_id = body.model, body.data, int(body.body_ids[self.link])
        mujoco.mj_forward(model, data)
        place = data.xpos[body_id] + data.xmat[body_id].reshape(3, 3) @ self.point
        jacobian, answers = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, place, body_id)
        mujoco.mj_solveM(model, data, answers, jacobian)
        mobility = float(np.einsum("ij,ij->", jacobian, answers)) / 3
        if mobility > 0:  # nothing else moves the link
            pull = _FREQUENCY**2 * (self.goal - place) - 2 * _FREQUENCY * (jacobian @ data.qvel)
            force = pull / mobility
            wrench = np.concatenate([force, np.cross(place - data.xipos[body_id], force)])
            data.xfrc_applied[body_id] = applied[body_id] + wrench
