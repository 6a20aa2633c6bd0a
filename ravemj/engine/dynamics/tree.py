"""Which moving joint of a body carries which."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Ints
from ravemj.engine.kinematics import BodyKinematics

NONE = -1


class Tree:
    """The movers of a body and what they move.

    A mover is one velocity of MuJoCo's: that of a hinge, a slider, an axis of a ``hinge2``, or one of the three of a
    spherical joint. Followers are movers like others. A mover comes after those that carry it.

    Attributes:
        count: How many movers there are.
        joints: MuJoCo's joint of each mover, shape (count,).
        dofs: MuJoCo's DOF of each mover, shape (count,).
        slides: For each mover, whether it is a slider, shape (count,).
        parents: For each mover the one that carries it, or -1.
        carriers: For each mover the last one that moves its axis: itself, and for the axes of a spherical joint, which
            turn with it, the joint's third.
        balls: The first mover and MuJoCo's body of each spherical joint.
        last: For each link the last mover that moves it, or -1.
        roots: For each link the one that it hangs on and that no joint places.
        mover_roots: The same for each mover.
        reach: 1 where a mover moves a link, else 0; shape (links, count).
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        model = kinematics.model
        link_of = {body_id: link for link, body_id in enumerate(kinematics.body_ids.tolist())}
        order = sorted(link_of)  # MuJoCo's parents come before their children
        self.dofs = np.array([dof for body_id in order for dof in _dofs_of(model, body_id)], dtype=int)
        self.count = len(self.dofs)
        self.joints: Ints = model.dof_jntid[self.dofs].astype(int)
        kinds = model.jnt_type[self.joints]
        self.slides = kinds == mujoco.mjtJoint.mjJNT_SLIDE
        mover_of: dict[int, int] = {dof: mover for mover, dof in enumerate(self.dofs.tolist())}
        self.parents = [mover_of.get(int(model.dof_parentid[dof]), NONE) for dof in self.dofs]
        ends = model.jnt_dofadr[self.joints] + np.where(kinds == mujoco.mjtJoint.mjJNT_BALL, 2, 0)
        self.carriers = np.where(kinds == mujoco.mjtJoint.mjJNT_BALL, ends - self.dofs, 0) + np.arange(self.count)
        is_first = (kinds == mujoco.mjtJoint.mjJNT_BALL) & (model.jnt_dofadr[self.joints] == self.dofs)
        self.balls = [(int(mover), int(model.dof_bodyid[self.dofs[mover]])) for mover in np.flatnonzero(is_first)]
        self.last, self.roots = [NONE] * len(link_of), list(range(len(link_of)))
        for body_id in order:
            link, parent = link_of[body_id], link_of.get(int(model.body_parentid[body_id]))
            own = _dofs_of(model, body_id)
            if parent is not None:
                self.last[link], self.roots[link] = self.last[parent], self.roots[parent]
            if own:
                self.last[link] = mover_of[own[-1]]
        self.mover_roots = [self.roots[link_of[int(model.dof_bodyid[dof])]] for dof in self.dofs]
        self.reach = self._reach()

    def _reach(self) -> Floats:
        reach = np.zeros((len(self.last), self.count))
        for link, last in enumerate(self.last):
            mover = last
            while mover != NONE:
                reach[link, mover] = 1.0
                mover = self.parents[mover]
        return reach

    def mover_of_qpos(self, model: mujoco.MjModel) -> dict[int, int]:
        """Return the first mover of each joint by the joint's place in ``qpos``."""
        first: dict[int, int] = {}
        for mover, joint in enumerate(self.joints):
            first.setdefault(int(model.jnt_qposadr[joint]), mover)
        return first


def _dofs_of(model: mujoco.MjModel, body_id: int) -> list[int]:
    first = int(model.body_dofadr[body_id])
    return list(range(first, first + int(model.body_dofnum[body_id]))) if first >= 0 else []
