"""The query that planners make most: does a body collide when some of its joints have these values?"""

from collections.abc import Callable, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.held import HeldRoots
from ravemj.engine.collision.pairs import Pairs
from ravemj.engine.collision.queries import MovedBy, body_and_others, itself
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.kinematics import fixed_view
from ravemj.engine.simulation import BodyState

_KEY = 1 << 31
"""More than the number of geoms: makes one number of a pair."""


def moving_test(body: BodyState, dofs: Sequence[int]) -> Callable[[Floats], bool] | None:
    """Return a fast test of values of some joints, or None where links are displaced from their joints.

    It looks at what the joints move, and answers for a body that stays as it is otherwise, in a world that stays as it
    is; the caller holds the lock all the time. The model of the world is moved, the body at most by its joints:
    ``body.restore`` brings both back.

    Args:
        body: The body; what it holds moves along.
        dofs: The joints.
    """
    world = body.simulation.collisions()
    if body.kinematics.displaced:
        return None
    return _MovingTest(world, body, _placement(world, body, dofs), _pairs(world, body, MovedBy(tuple(dofs))))


def batch_collides(body: BodyState, values: Floats, *, itself_too: bool) -> NDArray[np.bool_]:
    """Return for each configuration whether the body collides. The caller holds the lock.

    Args:
        body: The body; it is back in its configuration afterwards, and so is what it holds.
        values: Joint values [rad or m], shape (n, dof).
        itself_too: Whether collisions of the body with itself count.

    Returns:
        Shape (n,).
    """
    before, stamp = body.configuration(), body.stamp
    held = [(grab.body, grab.body.configuration()) for grab in body.grabs]
    try:
        if len(values) and body.kinematics.displaced:
            body.set_values(values[0])  # brings displaced links back to their joints
        dofs, world = range(body.dof), body.simulation.collisions()
        kinds = (body_and_others, itself) if itself_too else (body_and_others,)
        moved = MovedBy(tuple(dofs))
        if any(world.collide(_apart_from(world, kind(world, body), kind(world, body, moved))) for kind in kinds):
            return np.ones(len(values), dtype=bool)
        pairs = np.concatenate([_as_array(kind(world, body, moved)) for kind in kinds])
        collides = _MovingTest(world, body, _placement(world, body, dofs), pairs)
        return np.array([collides(one) for one in values], dtype=bool)
    finally:
        body.restore(before)
        for one, configuration in held:
            one.restore(configuration)
        body.stamp = stamp


def _placement(world: CollisionWorld, body: BodyState, dofs: Sequence[int]) -> Callable[[Floats], None]:
    """Return a function that moves joints of a body in the model of the world."""
    kinematics, part, qpos, columns = body.kinematics, world.model.part(body), world.model.data.qpos, list(dofs)
    followed = {dof for joint in body.scene.all_joints if joint.mimic is not None for dof in joint.mimic.dofs}
    places, multiples = world.model.qpos_indices(body)[columns], kinematics.multiples
    full = kinematics.values()
    target, indices = fixed_view(qpos, places)

    def place(values: Floats) -> None:
        target[indices] = values

    def place_with_multiples(values: Floats) -> None:
        target[indices] = values
        for column, slope, offset, lower, upper, index in followers:
            qpos[index] = min(max(slope * values.item(column) + offset, lower), upper)

    def place_all(values: Floats) -> None:
        full[columns] = values
        kinematics.set_values(full)
        if part.take(kinematics):
            world.model.pose_stamp += 1

    if (places < 0).any() or (multiples is None and followed & set(dofs)):
        return place_all
    followers = [
        (columns.index(dof), *equation, part.qpos.start + kinematics.inner_index(index))
        for dof, *equation, index in multiples or ()
        if dof in columns
    ]
    return place_with_multiples if followers else place


def _pairs(world: CollisionWorld, body: BodyState, moved: MovedBy) -> Ints:
    """Return the pairs of geoms that joints move against each other, shape (n, 2)."""
    return np.concatenate([_as_array(body_and_others(world, body, moved)), _as_array(itself(world, body, moved))])


def _as_array(pairs: Pairs) -> Ints:
    """Return the geoms of pairs, shape (n, 2)."""
    return np.stack([pairs.first, pairs.second], axis=1)


def _apart_from(world: CollisionWorld, pairs: Pairs, others: Pairs) -> Pairs:
    """Return those of some pairs that are not among others."""
    known = _as_array(others)
    kept = ~np.isin(_keys(_as_array(pairs)), _keys(np.concatenate([known, known[:, ::-1]])))
    return world.make_pairs(pairs.first[kept], pairs.second[kept])


def _keys(pairs: Ints) -> Ints:
    """Return a number for each pair."""
    return pairs[:, 0] * _KEY + pairs[:, 1]


class _MovingTest:
    """See ``moving_test``: MuJoCo's own collision detection, and the pairs of geoms that it leaves out."""

    def __init__(self, world: CollisionWorld, body: BodyState, place: Callable[[Floats], None], pairs: Ints) -> None:
        self._model, self._data = world.model.model, world.model.data
        self._place, self._world = place, world
        self._held = held = HeldRoots(world, body) if body.grabs else None
        try:
            if held is not None:
                held.hang()
            tested = world.found_by_mujoco(pairs[:, 0], pairs[:, 1])
        finally:
            if held is not None:
                held.unhang()
        meant = pairs[tested]
        self._meant = {*_keys(meant).tolist(), *_keys(meant[:, ::-1]).tolist()}
        rest = pairs[~tested]
        self._rest = world.make_pairs(rest[:, 0], rest[:, 1]) if len(rest) else None

    def __call__(self, values: Floats) -> bool:
        """Return whether the body collides."""
        model, data = self._model, self._data
        self._place(values)
        if self._held is None:
            mujoco.mj_kinematics(model, data)
            mujoco.mj_collision(model, data)
        else:
            self._detect_with(self._held)
        if data.ncon:
            touch = self._world.shapes.touch  # of meshes, MuJoCo takes the hulls
            for first, second in data.contact.geom.tolist():
                if first * _KEY + second in self._meant and touch(first, second):
                    return True
        return self._rest is not None and self._world.collide(self._rest)

    def _detect_with(self, held: HeldRoots) -> None:
        """Let MuJoCo look for contacts, with what is held where its carriers are."""
        try:
            held.hang()
            mujoco.mj_kinematics(self._model, self._data)
            if held.are_late:
                mujoco.mj_kinematics(self._model, self._data)
            mujoco.mj_collision(self._model, self._data)
        finally:  # also at Ctrl-C
            held.unhang()
        self._world.model.pose_stamp += 1  # else pairs without a joint between them are not looked at again
