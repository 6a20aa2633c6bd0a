"""A body that MuJoCo moves."""

from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints, rows_from_wxyz
from ravemj.engine.kinematics import WELDED, BodyKinematics, Configuration
from ravemj.engine.simulation import BodyState
from ravemj.formats.mjcf import BodyNames


class _FreeRoot(NamedTuple):
    """A link that nothing holds.

    Attributes:
        link: Its index.
        qpos: Where its pose is in ``qpos``: position [m] and quaternion wxyz.
        qvel: Where its velocity is in ``qvel``: linear [m/s] in the world, then angular [rad/s] in the link.
    """

    link: int
    qpos: slice
    qvel: slice


class PhysicalBody:
    """A body in the model of physics; the simulation says where it is, and follows.

    Attributes:
        state: The body in the simulation.
        kinematics: The body in the model of physics, where its roots may be free.
        rows: Where the velocities of its joints are in ``qvel``, in the order of ``state.dynamics.tree``.
    """

    def __init__(self, state: BodyState, model: mujoco.MjModel, data: mujoco.MjData, names: BodyNames) -> None:
        self.state = state
        self.kinematics = BodyKinematics(model, data, state.scene, names)
        self.rows = _rows(model, sorted(self.kinematics.body_ids.tolist()))
        self._model, self._data = model, data
        self._free = _free_roots(self.kinematics)
        self._stamp = -1
        self._known: Floats | None = None
        self._masks = (model.geom_contype.copy(), model.geom_conaffinity.copy())
        self._enabled = (True,) * len(state.scene.links)

    def take_over(self) -> None:
        """Go where the body is in the simulation, and as fast, if somebody changed that."""
        if self._stamp != self.state.stamp:
            configuration = self.state.configuration().last_placed
            assert configuration is not None
            self.kinematics.restore(configuration)
            for root in self._free:
                pose = (configuration.positions[root.link], configuration.quaternions[root.link])
                self._data.qpos[root.qpos] = np.concatenate(pose)
            self._stamp = self.state.stamp
        velocities = self.state.link_velocities()
        if self._known is None or not np.array_equal(velocities, self._known):
            self._set_velocities(velocities)
        if self._enabled != self.state.link_enabled:
            self._enable_links(self.state.link_enabled)

    def _set_velocities(self, velocities: Floats) -> None:
        """Move as fast as velocities of the links show, shape (links, 6), in world axes."""
        self._known = velocities
        dynamics = self.state.dynamics
        slopes = dynamics.map.at(self.state.kinematics.values(), second=False)
        self._data.qvel[self.rows] = slopes.forward(dynamics.dof_velocities(velocities))
        for root in self._free:
            w, x, y, z = self._data.qpos[root.qpos][3:].tolist()
            angular = velocities[root.link, 3:] @ np.array(rows_from_wxyz((w, x, y, z)))
            self._data.qvel[root.qvel] = np.concatenate([velocities[root.link, :3], angular])

    def _enable_links(self, enabled: tuple[bool, ...]) -> None:
        """Let the enabled links collide, and no others."""
        model = self._model
        for body_id, is_enabled in zip(self.kinematics.body_ids, enabled, strict=True):
            geoms = slice(model.body_geomadr[body_id], model.body_geomadr[body_id] + model.body_geomnum[body_id])
            for name, original in zip(("contype", "conaffinity"), self._masks, strict=True):
                masks = original[geoms] * is_enabled
                getattr(model, f"geom_{name}")[geoms] = masks
                getattr(model, f"body_{name}")[body_id] = np.bitwise_or.reduce(masks)
        self._enabled = enabled

    @property
    def can_move(self) -> bool:
        """Whether it has a joint, or nothing holds it."""
        return bool(self._free or len(self.rows))

    def give_velocities(self) -> None:
        """Tell the simulation how fast the body moves."""
        data, body_ids = self._data, self.kinematics.body_ids
        spins = data.cvel[body_ids, :3]
        arms = data.xpos[body_ids] - data.subtree_com[self._model.body_rootid[body_ids]]
        velocities = np.hstack([data.cvel[body_ids, 3:] + np.cross(spins, arms), spins])
        self.state.set_link_velocities(velocities)
        self._known = velocities

    def give_configuration(self) -> None:
        """Tell the simulation where the body is; the caller lets it place the links, and calls ``settle``."""
        configuration = self.kinematics.configuration()
        for root in self._free:
            configuration.positions[root.link] = self._data.qpos[root.qpos][:3]
            configuration.quaternions[root.link] = self._data.qpos[root.qpos][3:]
        self._read_followers(configuration)
        self.state.kinematics.restore(configuration)

    def _read_followers(self, configuration: Configuration) -> None:
        count = len(self.state.scene.joints)
        for follower in self.kinematics.followers:
            if follower.qpos != WELDED:
                configuration.passive[follower.joint - count][0] = float(self._data.qpos[follower.qpos])

    def settle(self) -> None:
        """Take note that the body is where the simulation has it."""
        self._stamp = self.state.stamp


def _is_free(model: mujoco.MjModel, body_id: int) -> bool:
    first = int(model.body_jntadr[body_id])
    return first >= 0 and model.jnt_type[first] == mujoco.mjtJoint.mjJNT_FREE


def _free_roots(kinematics: BodyKinematics) -> list[_FreeRoot]:
    model = kinematics.model
    free: list[_FreeRoot] = []
    for link in kinematics.roots:
        body_id = int(kinematics.body_ids[link])
        if _is_free(model, body_id):
            joint = int(model.body_jntadr[body_id])
            qpos, qvel = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
            free.append(_FreeRoot(link, slice(qpos, qpos + 7), slice(qvel, qvel + 6)))
    return free


def _rows(model: mujoco.MjModel, body_ids: list[int]) -> Ints:
    """Return where the velocities of joints between links are in ``qvel``."""
    rows: list[int] = []
    for body_id in body_ids:
        if not _is_free(model, body_id):
            first = int(model.body_dofadr[body_id])
            rows.extend(range(first, first + int(model.body_dofnum[body_id])))
    return np.array(rows, dtype=int)
