"""What a body holds follows it in the model of the world while only joint values change there."""

from collections.abc import Generator
from typing import NamedTuple

import mujoco
import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.transforms import Floats
from ravemj.engine.collision.queries import held_with
from ravemj.engine.collision.world import CollisionWorld
from ravemj.engine.simulation import BodyState


class HeldRoots:
    """The root links of what a body holds: children of the world in the model.

    Inside ``on_carriers`` they hang on their carriers: ``mj_kinematics`` places them, and ``mj_collision`` looks at
    them and what is fixed to the world. Where one comes before its carrier (``are_late``), ``mj_kinematics`` has to
    run twice.
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
            ids = [index for one in held_with(grab.body) for index in world.model.part(one).body_ids.tolist()]
            for root in [index for index in ids if self._parents[index] == 0]:
                place = np.empty(3), np.empty(4)
                mujoco.mju_mulPose(*place, *inverse, data.xpos[root], data.xquat[root])
                self._roots.append(_Root(root, carrier, model.body_pos[root], model.body_quat[root], *place))
            fixed = [index for index in ids if self._weld_ids[index] == 0]
            self._welds += zip(fixed, model.body_rootid[fixed].tolist(), strict=True)
        self.are_late = any(one.body_id < one.carrier for one in self._roots)

    @block
    def on_carriers(self) -> Generator[None]:
        """Make them children of their carriers, and of the world again; the caller restores their poses there."""
        with restoring(self._detach):
            self._attach()
            yield

    def _attach(self) -> None:
        for index, carrier, position, wxyz, offset, turn in self._roots:
            self._parents[index] = carrier
            self._dof_counts[index] = 1  # else MuJoCo would take it for fixed to the world
            position[...] = offset
            wxyz[...] = turn
        for index, root in self._welds:
            self._weld_ids[index] = root

    def _detach(self) -> None:
        for one in self._roots:
            self._parents[one.body_id] = self._dof_counts[one.body_id] = 0
        for index, _ in self._welds:
            self._weld_ids[index] = 0


class _Root(NamedTuple):
    """A root link that is held, and the link that holds it, by MuJoCo's indices."""

    body_id: int
    carrier: int
    position: Floats  # in its parent in the model [m]; a view
    wxyz: Floats  # its orientation there; a view
    offset: Floats  # its position in the carrier [m]
    turn: Floats  # its orientation there, wxyz
