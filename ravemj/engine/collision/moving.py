"""Collision tests of a body at many joint values, the hot path of planners; grabbed bodies follow the joints."""

from collections.abc import Callable, Generator, Iterable, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.transforms import Floats, Ints
from ravemj.engine.collision.pairs import Masks, Pairs
from ravemj.engine.collision.queries import MovedBy, body_and_others, held_with, itself
from ravemj.engine.collision.world import MOST_AT_ONCE, CollisionWorld
from ravemj.engine.kinematics import fixed_view
from ravemj.engine.simulation import BodyState
from ravemj.engine.simulation.body import SavedConfiguration


class HeldRoots:
    """Root links of grabbed bodies, which are children of the world in the model.

    Within ``on_carriers`` they are children of the grabbing links, so that ``mj_kinematics`` places them, and
    ``mj_collision`` tests them against fixed geoms. If a root precedes its grabbing link (``are_late``),
    ``mj_kinematics`` must run twice.
    """

    def __init__(self, world: CollisionWorld, body: BodyState) -> None:
        model, data = world.model.model, world.model.data
        self._parents, self._weld_ids, self._dof_counts = model.body_parentid, model.body_weldid, model.body_dofnum
        self._roots: list[_Root] = []
        self._welds: list[tuple[int, int]] = []
        for grab in body.grabs:
            carrier = int(world.model.part(body).body_ids[grab.link])
            inverse = np.empty(3), np.empty(4)
            mujoco.mju_negPose(*inverse, data.xpos[carrier], data.xquat[carrier])
            ids = [
                index for held_body in held_with(grab.body) for index in world.model.part(held_body).body_ids.tolist()
            ]
            for root in [index for index in ids if self._parents[index] == 0]:
                place = np.empty(3), np.empty(4)
                mujoco.mju_mulPose(*place, *inverse, data.xpos[root], data.xquat[root])
                self._roots.append(_Root(root, carrier, model.body_pos[root], model.body_quat[root], *place))
            fixed = [index for index in ids if self._weld_ids[index] == 0]
            self._welds += zip(fixed, model.body_rootid[fixed].tolist(), strict=True)
        self.are_late = any(held_root.body_id < held_root.carrier for held_root in self._roots)

    @block
    def on_carriers(self) -> Generator[None]:
        """Context manager that attaches the roots to the grabbing links; the caller restores their poses afterwards."""
        with restoring(self._detach):
            self._attach()
            yield

    def _attach(self) -> None:
        for index, carrier, position, wxyz, offset, turn in self._roots:
            self._parents[index] = carrier
            self._dof_counts[index] = 1  # otherwise MuJoCo would treat it as fixed to the world
            position[...] = offset
            wxyz[...] = turn
        for index, root in self._welds:
            self._weld_ids[index] = root

    def _detach(self) -> None:
        for root in self._roots:
            self._parents[root.body_id] = self._dof_counts[root.body_id] = 0
        for index, _ in self._welds:
            self._weld_ids[index] = 0


class _Root(NamedTuple):
    """Root link of a grabbed body, and the link that grabs it, as MuJoCo body indices."""

    body_id: int
    carrier: int
    position: Floats  # in its parent in the model [m]; a view
    wxyz: Floats  # its orientation there; a view
    offset: Floats  # its position in the carrier [m]
    turn: Floats  # its orientation there, wxyz


_Kind = Callable[[CollisionWorld, BodyState, MovedBy | None], Pairs]
_KINDS: tuple[_Kind, ...] = (body_and_others, itself)

_KEY = 1 << 31
"""Upper bound of the number of geoms, for encoding a pair as one number."""

_CLEARANCE = 3e-3
"""Distance at which hulls count as nearly touching, as a fraction of the body's size."""

_MANY = 50
"""Number of configurations from which threads are faster."""


def moving_test(body: BodyState, dofs: Sequence[int]) -> "MovingTest | None":
    """Return a fast collision test of joint values, or None if a link is displaced from the pose given by its joints.

    It tests the moved links and grabbed bodies. While it is used, the world must not change otherwise, and the caller
    holds the lock. The test moves the world's model, and possibly the body's joints: ``body.restore`` restores both.
    """
    world = body.simulation.collisions()
    if body.kinematics.displaced:
        return None
    return MovingTest(world, body, Placement(world, body, dofs), _Chosen.of(world, body, dofs, _KINDS))


def moved_world(body: BodyState, dofs: Sequence[int]) -> Callable[[Floats], None] | None:
    """Return a function that moves the joints ``dofs`` and grabbed bodies in the world's model; see ``moving_test``."""
    world = body.simulation.collisions()
    return None if body.kinematics.displaced else _Mover(world, body, dofs)


class Among(NamedTuple):
    """Selection of geom pairs for a batch of configurations.

    Attributes:
        others: Whether to test the body against other bodies.
        itself: Whether to test the body against itself.
        dofs: The joints of the configurations; only pairs that they move relative to each other are tested. None means
            all joints and all pairs.
    """

    others: bool = True
    itself: bool = True
    dofs: tuple[int, ...] | None = None

    @property
    def kinds(self) -> tuple[_Kind, ...]:
        """Return the selected kinds of queries."""
        return tuple(kind for kind, counts in zip(_KINDS, (self.others, self.itself), strict=True) if counts)


def batch_collides(body: BodyState, values: Floats, among: Among) -> NDArray[np.bool_]:
    """Return for each configuration [rad or m], shape (n, dofs), whether the body collides; shape (n,).

    The caller holds the lock. Afterwards the configurations of the body and grabbed bodies are restored.
    """
    with kept_in_place(body):
        _bring_links_back(body, values)
        world = body.simulation.collisions()
        dofs = range(body.dof) if among.dofs is None else among.dofs
        chosen = _Chosen.of(world, body, dofs, among.kinds)
        if among.dofs is None and any(map(world.collide, chosen.resting)):
            return np.ones(len(values), dtype=bool)
        return MovingTest(world, body, Placement(world, body, dofs), chosen).of_many(values)


def batch_distances(body: BodyState, values: Floats, among: Among) -> Floats:
    """Return for each configuration [rad or m], shape (n, dofs), the smallest signed distance [m], shape (n,).

    It is infinite if there are no pairs. The caller holds the lock, and the configuration is restored afterwards.
    """
    distances = np.full(len(values), np.inf)
    with kept_in_place(body):
        for number, row in enumerate(values):
            body.set_values(row)
            world = body.simulation.collisions()
            for kind in among.kinds:
                distances[number] = world.nearest(kind(world, body, None), float(distances[number]))[0]
    return distances


@block
def kept_in_place(body: BodyState) -> Generator[None]:
    """Context manager that restores the configurations of a body and its grabbed bodies."""
    before, stamp = body.configuration(), body.stamp
    held = [(grab.body, grab.body.configuration()) for grab in body.grabs]
    with restoring(lambda: _restore(body, before, held, stamp)):
        yield


def _bring_links_back(body: BodyState, values: Floats) -> None:
    """Move displaced links back to the poses given by their joints."""
    if len(values) and body.kinematics.displaced:
        body.set_values(body.kinematics.values())


def _restore(
    body: BodyState, before: SavedConfiguration, held: Sequence[tuple[BodyState, SavedConfiguration]], stamp: int
) -> None:
    body.restore(before)
    for held_body, configuration in held:
        held_body.restore(configuration)
    body.stamp = stamp


class _Chosen(NamedTuple):
    """Geom pairs of one collision test of a moving body, and the masks for MuJoCo."""

    meant: frozenset[int]  # ``_keys`` of those that MuJoCo looks at, in both orders
    masks: Masks  # for MuJoCo to look at these
    is_all: bool  # whether it looks at no others, and all geoms are convex
    left_out: Pairs | None  # those that it leaves out
    resting: tuple[Pairs, ...]  # those that joints do not move against each other, of each kind

    @classmethod
    def of(cls, world: CollisionWorld, body: BodyState, dofs: Sequence[int], kinds: Sequence[_Kind]) -> "_Chosen":
        """Return the pairs of a body that ``dofs`` move, for ``kinds`` of queries; cached if only poses change."""
        moved = MovedBy(tuple(dofs))
        return world.kept((body, moved, kinds), lambda: cls._chosen(world, body, moved, kinds))

    @classmethod
    def _chosen(cls, world: CollisionWorld, body: BodyState, moved: MovedBy, kinds: Sequence[_Kind]) -> "_Chosen":
        sets = [kind(world, body, moved) for kind in kinds]
        resting = tuple(
            _apart_from(world, kind(world, body, None), chosen) for kind, chosen in zip(kinds, sets, strict=True)
        )
        pairs = np.concatenate([_as_array(chosen) for chosen in sets])
        with HeldRoots(world, body).on_carriers():  # last, since it does not put the poses back
            tested = world.detection.finds(pairs[:, 0], pairs[:, 1])
            meant, rest = pairs[tested], pairs[~tested]
            masks, is_all = world.best_masks(*meant.T)
        return cls(
            frozenset([*_keys(meant).tolist(), *_keys(meant[:, ::-1]).tolist()]),
            masks,
            is_all,
            world.make_pairs(rest[:, 0], rest[:, 1]) if len(rest) else None,
            resting,
        )


def _as_array(pairs: Pairs) -> Ints:
    return np.stack([pairs.first, pairs.second], axis=1)


def _apart_from(world: CollisionWorld, pairs: Pairs, others: Pairs) -> Pairs:
    """Return the pairs that are not in ``others``, in either order."""
    known = _as_array(others)
    kept = ~np.isin(_keys(_as_array(pairs)), _keys(np.concatenate([known, known[:, ::-1]])))
    return world.make_pairs(pairs.first[kept], pairs.second[kept])


def _keys(pairs: Ints) -> Ints:
    """Encode each pair as a number."""
    return pairs[:, 0] * _KEY + pairs[:, 1]


class Placement:
    """Moves joints of a body in the model of the world.

    Attributes:
        is_plain: Whether the moved elements of ``qpos`` are joint values, or affine functions of them (mimic joints).
    """

    def __init__(self, world: CollisionWorld, body: BodyState, dofs: Sequence[int]) -> None:
        self._kinematics, self._model = kinematics, model = body.kinematics, world.model
        self._part, self._qpos, self._dofs = model.part(body), model.data.qpos, list(dofs)
        followed = {dof for joint in body.scene.all_joints if joint.mimic is not None for dof in joint.mimic.dofs}
        self._places, multiples = model.qpos_indices(body)[self._dofs], kinematics.multiples
        self._full = kinematics.values()
        self._target, self._indices = fixed_view(self._qpos, self._places)
        self.is_plain = bool((self._places >= 0).all()) and (multiples is not None or not followed & set(dofs))
        self._followers = [
            (self._dofs.index(dof), multiple, self._part.qpos.start + kinematics.inner_index(index))
            for dof, multiple, index in multiples or ()
            if dof in self._dofs
        ]

    def __call__(self, values: Floats) -> None:
        """Write joint values [rad or m], shape (dofs,)."""
        if not self.is_plain:
            self._full[self._dofs] = values
            self._kinematics.set_values(self._full)
            if self._part.take(self._kinematics):
                self._model.pose_stamp += 1
            return
        self._target[self._indices] = values
        for column, multiple, index in self._followers:
            self._qpos[index] = multiple.follow(values.item(column))

    def qpos_of_many(self, values: Floats) -> Floats:
        """Return ``qpos`` of the world for many configurations, shape (n, nq), if the placement is plain."""
        qpos = np.tile(self._qpos, (len(values), 1))
        qpos[:, self._places] = values
        for column, multiple, index in self._followers:
            qpos[:, index] = multiple.follow_many(values[:, column])
        return qpos


class _Mover:
    """Implementation of ``moved_world``."""

    def __init__(self, world: CollisionWorld, body: BodyState, dofs: Sequence[int]) -> None:
        self._world, self._model, self._data = world, world.model.model, world.model.data
        self._place, self._held = Placement(world, body, dofs), HeldRoots(world, body) if body.grabs else None

    def __call__(self, values: Floats) -> None:
        self._place(values)
        if self._held is None:
            mujoco.mj_kinematics(self._model, self._data)
            return
        with self._held.on_carriers():
            for _ in range(1 + self._held.are_late):
                mujoco.mj_kinematics(self._model, self._data)
        self._world.model.pose_stamp += 1


class MovingTest:
    """Implementation of ``moving_test``: MuJoCo's collision detection, and tests of the pairs that it ignores."""

    def __init__(self, world: CollisionWorld, body: BodyState, place: Placement, chosen: _Chosen) -> None:
        self._model, self._data = world.model.model, world.model.data
        self._place, self._world, self._body = place, world, body
        self._held = HeldRoots(world, body) if body.grabs else None
        self._meant, self._masks, self._is_all, self._rest, _ = chosen
        self._detect = world.detection.overlaps(self._masks)

    def __call__(self, values: Floats) -> bool:
        """Return whether the body collides."""
        self._move_and(self._detect, values)
        if self._data.ncon:
            touch = self._world.shapes.touch  # MuJoCo uses the hulls of meshes
            for first, second in self._data.contact.geom.tolist():
                if first * _KEY + second in self._meant and touch(first, second):
                    return True
        return self._rest is not None and self._world.collide(self._rest)

    def with_clearance(self, ends: Iterable[Floats]) -> Callable[[Floats], bool]:
        """Return a test whether no shapes collide and no hulls nearly touch, except hulls that do so in ``ends``.

        ``ends`` are configurations, such as the start and the goal of a path. Motions that pass the test at every step
        are rarely in collision between the steps.
        """
        world, shapes, close = self._world, self._world.shapes, set[int]()
        geoms = world.geoms_of_body(self._body)
        places, radii = world.detection.positions[geoms], world.detection.radii[geoms]
        margin = _CLEARANCE * float(np.ptp(places, axis=0).max() + 2 * radii.max()) if len(geoms) else 0.0

        def look() -> None:
            world.detection.detect_near(self._detect, margin)

        def is_clear(values: Floats) -> bool:
            self._move_and(look, values)
            for first, second in self._data.contact.geom.tolist() if self._data.ncon else ():
                key = first * _KEY + second
                is_exact = key in close or shapes.is_concave(first) or shapes.is_concave(second)
                if key in self._meant and (not is_exact or shapes.touch(first, second)):
                    return False
            return self._rest is None or not world.collide(self._rest)

        for end in ends:
            self._move_and(look, end)
            close.update(first * _KEY + second for first, second in self._data.contact.geom.tolist())
        return is_clear

    def of_many(self, values: Floats) -> NDArray[np.bool_]:
        """Return for each configuration, shape (n, dofs), whether the body collides.

        Without grabbed bodies, and if MuJoCo tests all pairs, MuJoCo first counts the contacts of all configurations in
        several threads. Configurations with contacts are tested again, unless MuJoCo's result is already exact.
        """
        if self._held is not None or self._rest is not None or not self._place.is_plain or len(values) < _MANY:
            return np.array([self(configuration) for configuration in values], dtype=bool)
        parts = (values[first : first + MOST_AT_ONCE] for first in range(0, len(values), MOST_AT_ONCE))
        contacts = [self._world.have_contacts(self._masks, self._place.qpos_of_many(part)) for part in parts]
        touching = np.concatenate(contacts)
        if not self._is_all:
            for index in np.flatnonzero(touching).tolist():
                touching[index] = self(values[index])
        return touching

    def _move_and(self, detect: Callable[[], None], values: Floats) -> None:
        """Move the body and its grabbed bodies, then call ``detect``."""
        self._place(values)
        if self._held is None:
            mujoco.mj_kinematics(self._model, self._data)
            detect()
            return
        with self._held.on_carriers():
            mujoco.mj_kinematics(self._model, self._data)
            if self._held.are_late:
                mujoco.mj_kinematics(self._model, self._data)
            detect()
        self._world.model.pose_stamp += 1  # else pairs without a joint between them are not looked at again
