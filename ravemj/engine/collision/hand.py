"""Collision tests of a robot whose base and joints move: a hand that flies to a target and closes.

The tests move the model of the world, like those of the module ``moving``. Meanwhile the robot's root links are not
fixed to the world, so that MuJoCo's collision detection also tests them against bodies without joints.
"""

from collections.abc import Generator
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from ravemj.core.blocks import block, restoring
from ravemj.core.graphs import Pair
from ravemj.core.transforms import Floats, Ints, inverse
from ravemj.engine.collision.moving import HeldRoots, Placement, kept_in_place
from ravemj.engine.collision.pairs import Masks
from ravemj.engine.collision.patches import patches
from ravemj.engine.collision.queries import body_and_others, held_with, itself
from ravemj.engine.collision.shapes import Contact
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState

Against = Literal["target", "others", "anything", "itself"]
"""Bodies to test links against: the target, all bodies but the target, both, or the robot itself."""

_TARGET, _OTHER = 1, 2


class _Meant:
    """Geom pairs that are tested for a robot and a target.

    Attributes:
        link: For each geom, its robot link, or the robot link that holds its body; -1 for other geoms.
        side: For each geom, 1 if it belongs to the target, 2 if to another body, 0 if to the robot.
        within: Pairs of geoms of the robot, in both orders.
        masks: Masks with which MuJoCo tests all pairs except ``left_out``.
        left_out: Pairs that MuJoCo cannot test, or None.
    """

    def __init__(self, world: CollisionWorld, body: BodyState, target: BodyState | None) -> None:
        count = world.model.model.ngeom
        link_of, side = np.full(count, -1), np.zeros(count, dtype=int)
        others, within = body_and_others(world, body), itself(world, body)
        side[others.second] = _OTHER
        for link in range(len(body.scene.links)):
            link_of[world.geoms_of_link(body, link)] = link
        for grab in body.grabs:
            for held in held_with(grab.body):
                link_of[world.geoms_of_body(held)] = grab.link
        if target is not None:
            side[world.geoms_of_body(target)] = _TARGET
        self.link: list[int] = link_of.tolist()
        self.side: list[int] = side.tolist()
        both = np.stack([within.first, within.second], axis=1)
        self.within: frozenset[Pair] = frozenset(_pairs(np.concatenate([both, both[:, ::-1]])))
        first = np.concatenate([others.first, within.first])
        second = np.concatenate([others.second, within.second])
        tested = world.detection.finds(first, second)
        self.masks: Masks = world.best_masks(first[tested], second[tested])[0]
        self.left_out = None if tested.all() else world.make_pairs(first[~tested], second[~tested])


class HandTests:
    """Tests of a robot at any base pose and joint values against a target, other bodies and itself.

    Use it within ``hand_tests``, with the lock held.
    """

    def __init__(self, world: CollisionWorld, body: BodyState, target: BodyState | None) -> None:
        self._world, self._body = world, body
        self._model, self._data = world.model.model, world.model.data
        self._held = HeldRoots(world, body) if body.grabs else None
        part, poses = world.model.part(body), body.link_transforms()
        roots = np.flatnonzero(self._model.body_parentid[part.body_ids] == 0).tolist()
        self._roots = [int(part.body_ids[link]) for link in roots]
        places = [(self._model.body_pos[root], self._model.body_quat[root]) for root in self._roots]
        self._places = [
            (*views, inverse(poses[0]) @ poses[link]) for views, link in zip(places, roots, strict=True)
        ]  # views of the poses of the roots in the model, and T_base_root
        fixed = part.body_ids[self._model.body_weldid[part.body_ids] == 0]
        self._welds = [(int(index), int(self._model.body_rootid[index])) for index in fixed]
        self._place = Placement(world, body, range(body.dof))
        self._saved = self._data.qpos.copy(), self._model.body_pos.copy(), self._model.body_quat.copy()
        self._target = target
        self._key = b""
        self._pairs: list[Pair] = []  # those that MuJoCo has found at the present placement
        self._touching: dict[Pair, bool] = {}

    @block
    def freed(self) -> Generator[None]:
        """Free the root links of the robot from the world during the block, then restore the model."""
        with restoring(self._restore):
            self._model.body_dofnum[self._roots] = 1  # otherwise MuJoCo takes them for fixed to the world
            for index, root in self._welds:
                self._model.body_weldid[index] = root
            self._meant = self._world.kept(("hand", self._body, self._target), self._find_meant)
            self._detect = self._world.detection.overlaps(self._meant.masks)
            yield

    def _find_meant(self) -> _Meant:
        return _Meant(self._world, self._body, self._target)

    def _restore(self) -> None:
        self._model.body_dofnum[self._roots] = 0
        for index, _ in self._welds:
            self._model.body_weldid[index] = 0
        self._data.qpos[:], self._model.body_pos[:], self._model.body_quat[:] = self._saved
        mujoco.mj_kinematics(self._model, self._data)
        self._world.model.stamp += 1
        self._world.model.pose_stamp += 1

    def __call__(
        self, links: frozenset[int], T_world_base: Floats, values: Floats, against: Against = "anything"
    ) -> str | None:
        """Return the name of a body, or of a link of the robot, in contact with the given links; None without contact.

        Args:
            links: Indices of links of the robot; bodies that they hold are tested, too.
            T_world_base: Pose of the robot, shape (4, 4).
            values: Values of all its DOFs [rad or m], shape (dof,).
            against: The bodies to test against.
        """
        self._move(T_world_base, values)
        for pair in self._pairs:
            name = self._name(pair, links, against)
            if name is not None and self._touches(pair):
                return name
        return None

    def contacts(
        self, links: frozenset[int], T_world_base: Floats, values: Floats, against: Against = "target"
    ) -> tuple[list[Contact], list[int]]:
        """Return the contacts of the given links, with normals out of the other body, and the link of each contact."""
        self._move(T_world_base, values)
        both = [(a, b) if self._meant.link[a] >= 0 else (b, a) for a, b in self._pairs]
        touching = [pair for pair in sorted(set(both)) if self._name(pair, links, against) and self._touches(pair)]
        points = patches(self._world, touching)
        contacts = [(contact, pair[0]) for pair, some in zip(touching, points, strict=True) for contact in some]
        return [contact for contact, _ in contacts], [self._meant.link[geom] for _, geom in contacts]

    def _name(self, pair: Pair, links: frozenset[int], against: Against) -> str | None:
        """Return the name of the body or link in contact with the hand; None if the pair of geoms is not tested."""
        meant = self._meant
        for geom, other in (pair, (pair[1], pair[0])):
            if meant.link[geom] not in links:
                continue
            if against == "itself":
                if pair in meant.within:
                    return self._body.scene.links[meant.link[other]].name
            elif (side := meant.side[other]) and (against == "anything" or (against == "target") == (side == _TARGET)):
                return self._world.owner(other)[0].scene.name
        return None

    def _touches(self, pair: Pair) -> bool:
        """Return whether two geoms touch, given that their hulls overlap."""
        if pair not in self._touching:
            self._touching[pair] = self._world.shapes.touch(*pair)
        return self._touching[pair]

    def _move(self, T_world_base: Floats, values: Floats) -> None:
        """Place the robot, and detect contacts of hulls with MuJoCo."""
        key = T_world_base.tobytes() + values.tobytes()
        if key == self._key:
            return
        self._place(values)
        for position, wxyz, T_base_root in self._places:
            T_world_root = T_world_base @ T_base_root
            position[:] = T_world_root[:3, 3]
            mujoco.mju_mat2Quat(wxyz, T_world_root[:3, :3].ravel())
        if self._held is None:
            mujoco.mj_kinematics(self._model, self._data)
            self._detect()
        else:
            with self._held.on_carriers():
                mujoco.mj_kinematics(self._model, self._data)
                if self._held.are_late:
                    mujoco.mj_kinematics(self._model, self._data)
                self._detect()
        self._pairs = [*dict.fromkeys(_pairs(self._data.contact.geom))] if self._data.ncon else []
        left_out = self._meant.left_out
        if left_out is not None:
            self._pairs += map(left_out.geoms, left_out.near())
        self._touching.clear()
        self._key = key


def _pairs(rows: Ints | NDArray[np.int32]) -> list[Pair]:
    return [(first, second) for first, second in rows.tolist()]


@block
def hand_tests(world: CollisionWorld, body: BodyState, target: BodyState | None) -> Generator[HandTests]:
    """Yield tests of a robot at many base poses and joint values; afterwards restore the world.

    Args:
        world: The world; the caller holds the lock, and nothing else moves or changes meanwhile.
        body: The robot.
        target: The body called ``target`` in tests.
    """
    with kept_in_place(body):
        tests = HandTests(world, body, target)
        with tests.freed():
            yield tests
