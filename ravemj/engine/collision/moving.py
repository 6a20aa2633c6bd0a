"""The query that planners make most: does a body collide when some of its joints have these values?"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.queries import MovedBy, body_and_others, held_with, itself
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import GrabbedBody

_KEY = 1 << 31
"""More than the number of geoms: makes one number of a pair."""


def moving_test(body: BodyState, dofs: Sequence[int]) -> Callable[[Floats], bool] | None:
    """Return a fast test of values of some joints, or None where joints have to be set one by one.

    It looks at what the joints move, and answers for a body that stays as it is otherwise, in a world that stays as it
    is; the caller holds the lock all the time. The model of the world is moved, the body itself is not:
    ``body.moved()`` brings it back.

    Args:
        body: The body; what it holds moves along.
        dofs: The joints: hinges and sliders that no mimic joint follows.
    """
    kinematics = body.kinematics
    followed = {dof for joint in body.scene.all_joints if joint.mimic is not None for dof in joint.mimic.dofs}
    world = body.simulation.collisions()
    places = world.model.qpos_indices(body)[list(dofs)]
    if kinematics.displaced or followed & set(dofs) or (places < 0).any():
        return None
    return _MovingTest(world, body, places, _pairs(world, body, MovedBy(tuple(dofs))))


def _pairs(world: CollisionWorld, body: BodyState, moved: MovedBy) -> Ints:
    """Return the pairs of geoms that joints move against each other, shape (n, 2)."""
    sets = (body_and_others(world, body, moved), itself(world, body, moved))
    return np.concatenate([np.stack([one.first, one.second], axis=1) for one in sets])


def _keys(pairs: Ints) -> Ints:
    """Return a number for each pair."""
    return pairs[:, 0] * _KEY + pairs[:, 1]


class _MovingTest:
    """See ``moving_test``: MuJoCo's own collision detection, and the pairs of geoms that it leaves out."""

    def __init__(self, world: CollisionWorld, body: BodyState, places: Ints, pairs: Ints) -> None:
        self._model, self._data = world.model.model, world.model.data
        self._qpos, self._places, self._world = self._data.qpos, places, world
        tested = world.found_by_mujoco(pairs[:, 0], pairs[:, 1])
        meant = pairs[tested]
        self._meant = {*_keys(meant).tolist(), *_keys(meant[:, ::-1]).tolist()}
        rest = pairs[~tested]
        self._rest = world.make_pairs(rest[:, 0], rest[:, 1]) if len(rest) else None
        self._held = [held for grab in body.grabs for held in _carried(world, body, grab)]

    def __call__(self, values: Floats) -> bool:
        """Return whether the body collides."""
        model, data = self._model, self._data
        self._qpos[self._places] = values
        mujoco.mj_kinematics(model, data)
        if self._held:
            for held in self._held:
                held.follow(model, data)
            mujoco.mj_kinematics(model, data)
            self._world.model.pose_stamp += 1  # else pairs without a joint between them are not looked at again
        mujoco.mj_collision(model, data)
        if data.ncon:
            touch = self._world.shapes.touch  # of meshes, MuJoCo takes the hulls
            for first, second in data.contact.geom.tolist():
                if first * _KEY + second in self._meant and touch(first, second):
                    return True
        return self._rest is not None and self._world.collide(self._rest)


class _Held(NamedTuple):
    """A root link that is held.

    Attributes:
        root: MuJoCo's index of it.
        carrier: MuJoCo's index of the link that holds it.
        offset: Its position in the frame of the carrier [m], shape (3,).
        wxyz: Its orientation there.
    """

    root: int
    carrier: int
    offset: Floats
    wxyz: Floats

    def follow(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Put it where the carrier is."""
        model.body_pos[self.root] = data.xmat[self.carrier].reshape(3, 3) @ self.offset + data.xpos[self.carrier]
        mujoco.mju_mulQuat(model.body_quat[self.root], data.xquat[self.carrier], self.wxyz)


def _carried(world: CollisionWorld, body: BodyState, grab: GrabbedBody) -> list[_Held]:
    """Return the root links of a held body, and of what it holds."""
    model, data = world.model.model, world.model.data
    carrier = int(world.model.part(body).body_ids[grab.link])
    conjugate, found = data.xquat[carrier] * [1, -1, -1, -1], list[_Held]()
    for one in held_with(grab.body):
        for root in world.model.part(one).body_ids.tolist():
            if model.body_parentid[root] == 0:
                offset = data.xmat[carrier].reshape(3, 3).T @ (data.xpos[root] - data.xpos[carrier])
                wxyz = np.empty(4)
                mujoco.mju_mulQuat(wxyz, conjugate, data.xquat[root])
                found.append(_Held(root, carrier, offset, wxyz))
    return found
