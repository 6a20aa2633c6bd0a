"""Part of a MuJoCo model that is one body."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.core.transforms import Ints
from ravemj.engine.kinematics import BodyKinematics

if TYPE_CHECKING:
    from ravemj.formats.mjcf import BodyNames

_WIDTHS = {int(mujoco.mjtJoint.mjJNT_FREE): (7, 6), int(mujoco.mjtJoint.mjJNT_BALL): (4, 3)}
"""Lengths in ``qpos`` and ``qvel`` of joint types with more than one element."""


class ModelPart:
    """Part of a model that is one body: its links and joints, in the order of the body's own model."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, names: "BodyNames") -> None:
        self._model = model
        self.names = names  # of links and joints in the model
        ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in names.links]
        self.body_ids: Ints = np.array(ids, dtype=int)  # MuJoCo's index of each link
        first = min(ids, default=0)
        bodies = slice(first, first + len(ids))
        self._positions, self._quaternions = model.body_pos[bodies], model.body_quat[bodies]  # views of the model
        self._roots: list[int] = np.flatnonzero(model.body_parentid[self.body_ids] == 0).tolist()
        joints = np.flatnonzero((model.jnt_bodyid >= first) & (model.jnt_bodyid < first + len(ids)))
        self.qpos = self.qvel = slice(0, 0)  # indices of the body in ``qpos`` and ``qvel``
        self.is_free = False  # whether its roots have free joints, as in its own model; else the world holds them
        if len(joints):
            start, last = int(joints[0]), int(joints[-1])
            width, speeds = _WIDTHS.get(int(model.jnt_type[last]), (1, 1))
            self.qpos = slice(int(model.jnt_qposadr[start]), int(model.jnt_qposadr[last]) + width)
            self.qvel = slice(int(model.jnt_dofadr[start]), int(model.jnt_dofadr[last]) + speeds)
            self.is_free = model.jnt_type[start] == mujoco.mjtJoint.mjJNT_FREE
        self._qpos = data.qpos[self.qpos]
        self.stamp = -1  # ``BodyKinematics.stamp`` of the last update

    def take(self, kinematics: BodyKinematics) -> bool:
        """Copy the body's configuration into this model; return whether more than joint values changed."""
        if self.is_free:
            self._qpos[...] = kinematics.qpos
        elif kinematics.inner_values is not None:
            self._qpos[...] = kinematics.inner_values
        else:
            self._qpos[...] = kinematics.qpos[kinematics.inner_qpos]
        has_moved = kinematics.pose_stamp > self.stamp
        if has_moved:
            self._take_poses(kinematics)
        self.stamp = kinematics.stamp
        return has_moved

    def _take_poses(self, kinematics: BodyKinematics) -> None:
        self._positions[:] = kinematics.model.body_pos[1:]
        self._quaternions[:] = kinematics.model.body_quat[1:]
        for root, place in zip(() if self.is_free else self._roots, kinematics.root_qpos, strict=not self.is_free):
            body_id, pose = self.body_ids[root], kinematics.qpos[place : place + 7]
            self._model.body_pos[body_id], self._model.body_quat[body_id] = pose[:3], pose[3:]

    def give(self, kinematics: BodyKinematics) -> None:
        """Copy this model's configuration to the body."""
        kinematics.set_qpos(self._qpos, inner_only=not self.is_free)
        self.stamp = kinematics.stamp
