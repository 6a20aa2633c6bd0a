"""Tree of a body's joints."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats
from ravemj.engine.kinematics import BodyKinematics

NONE = -1


class CoordinateTree:
    """Tree of the velocity coordinates of the joints between links, and the links that they move.

    A coordinate is one of MuJoCo's velocities: of a hinge, a slider, an axis of a ``hinge2``, or one of the three of a
    spherical joint; mimic joints have coordinates, too. They are counted in the order of ``qvel`` without the free
    joints of the roots. A coordinate comes after those that carry it.
    """

    def __init__(self, kinematics: BodyKinematics) -> None:
        model = kinematics.model
        dofs = np.arange(model.nv)[kinematics.inner_qvel]
        self.count = len(dofs)
        index_of = {dof: index for index, dof in enumerate(dofs.tolist())}
        joints = model.dof_jntid[dofs]
        kinds = model.jnt_type[joints]
        self.slides = kinds == mujoco.mjtJoint.mjJNT_SLIDE
        # parent coordinate of each coordinate, or NONE
        self.parents = [index_of.get(int(model.dof_parentid[dof]), NONE) for dof in dofs]
        # For each one the last one that moves its axis: itself; for the axes of a spherical joint, which rotate with
        # it, the joint's third.
        thirds = model.jnt_dofadr[joints] + 2 - dofs
        self.carriers = np.arange(self.count) + np.where(kinds == mujoco.mjtJoint.mjJNT_BALL, thirds, 0)
        self.of_qpos: dict[int, int] = {}  # first coordinate of each joint, by its index in ``qpos``
        for index, joint in enumerate(joints):
            self.of_qpos.setdefault(int(model.jnt_qposadr[joint]), index)
        link_of = {body_id: link for link, body_id in enumerate(kinematics.body_ids.tolist())}
        self.last = [NONE] * len(link_of)  # last coordinate that moves each link
        for body_id in sorted(link_of):  # MuJoCo's parents come before their children
            link, parent = link_of[body_id], link_of.get(int(model.body_parentid[body_id]))
            if parent is not None:
                self.last[link] = self.last[parent]
            final = int(model.body_dofadr[body_id]) + int(model.body_dofnum[body_id]) - 1
            if model.body_dofnum[body_id] and final in index_of:
                self.last[link] = index_of[final]
        self.moves = self._moves()

    def _moves(self) -> Floats:
        """Return a matrix, shape (links, count), with 1 if a coordinate moves a link, else 0."""
        moves = np.zeros((len(self.last), self.count))
        for link, last in enumerate(self.last):
            index = last
            while index != NONE:
                moves[link, index] = 1.0
                index = self.parents[index]
        return moves
