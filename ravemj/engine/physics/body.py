"""Body in the physics model."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints, cross_rows
from ravemj.engine.model_part import ModelPart
from ravemj.engine.simulation import BodyState


class PhysicalBody:
    """Body in the physics model, in which its roots may be free.

    ``rows`` are the indices of the velocity coordinates of ``state.dynamics.tree`` in ``qvel``.
    """

    def __init__(self, state: BodyState, model: mujoco.MjModel, data: mujoco.MjData, part: ModelPart) -> None:
        self.state, self.part = state, part
        self.model, self.data = model, data
        self.body_ids = part.body_ids
        own = state.kinematics
        places: Ints = np.arange(part.qvel.start, part.qvel.stop)
        self.rows = places[own.inner_qvel] if part.is_free else places
        self._known: Floats | None = None
        self._masks = (model.geom_contype.copy(), model.geom_conaffinity.copy())
        self._enabled = (True,) * len(state.scene.links)

    def take_over(self) -> None:
        """Copy configuration and velocity from the simulation, if they changed."""
        if self.part.stamp != self.state.kinematics.stamp:
            self.part.take(self.state.kinematics)
        velocities = self.state.link_velocities()
        if self._known is None or not np.array_equal(velocities, self._known):
            self._known = velocities
            dynamics = self.state.dynamics
            qvel = dynamics.qvel(velocities, dynamics.dof_velocities(velocities))
            self.data.qvel[self.part.qvel] = qvel if self.part.is_free else qvel[self.state.kinematics.inner_qvel]
        if self._enabled != self.state.link_enabled:
            self._enable_links(self.state.link_enabled)

    def _enable_links(self, enabled: tuple[bool, ...]) -> None:
        model = self.model
        for body_id, is_enabled in zip(self.body_ids, enabled, strict=True):
            geoms = slice(model.body_geomadr[body_id], model.body_geomadr[body_id] + model.body_geomnum[body_id])
            for name, original in zip(("contype", "conaffinity"), self._masks, strict=True):
                masks = original[geoms] * is_enabled
                getattr(model, f"geom_{name}")[geoms] = masks
                getattr(model, f"body_{name}")[body_id] = np.bitwise_or.reduce(masks)
        self._enabled = enabled

    @property
    def can_move(self) -> bool:
        """Whether the body has a moving joint or a free base."""
        return self.part.is_free or len(self.rows) > 0

    def give_velocities(self) -> None:
        """Copy the velocity of the body to the simulation."""
        data, body_ids = self.data, self.body_ids
        spins = data.cvel[body_ids, :3]
        arms = data.xpos[body_ids] - data.subtree_com[self.model.body_rootid[body_ids]]
        velocities = np.concatenate([data.cvel[body_ids, 3:] + cross_rows(spins, arms), spins], axis=1)
        self.state.set_link_velocities(velocities)
        self._known = velocities
