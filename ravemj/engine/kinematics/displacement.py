"""Links displaced from the poses given by their joints.

OpenRAVE's state consists of the link poses, from which it computes joint values. MuJoCo's state consists of joint
values, from which ``mj_kinematics`` computes the poses. To set given poses, the joint values computed from them are
set, and the remaining displacement is written into the link's fixed pose in its parent, ``body_pos`` and ``body_quat``,
so that the next ``mj_kinematics`` reproduces these poses.
"""

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, inverse, rows_from_wxyz

if TYPE_CHECKING:
    from ravemj.engine.kinematics.body import BodyKinematics

ROUNDING = 1e-10
"""Displacement [m, or of matrix elements] below which a link is considered undisplaced."""

_NO_DISPLACEMENT = ROUNDING / 1000  # of a link in its parent; in a chain they add up
_ONE_AXIS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


def place_links(kinematics: "BodyKinematics", T_world_links: Floats, last_values: Floats) -> None:
    """Set all link poses, shape (links, 4, 4); joint values are computed from them.

    Hinge values are shifted by full turns towards ``last_values`` [rad or m], shape (dof,).
    """
    for root, link in enumerate(kinematics.roots):
        kinematics.set_root_transform(root, T_world_links[link])
    kinematics.set_values(kinematics.shown_values.read(T_world_links, last_values), clamp_mimic=False)
    placed = kinematics.link_transforms()
    if placed.size and np.abs(placed - T_world_links).max() > ROUNDING:
        _displace(kinematics, placed, T_world_links)


def _displace(kinematics: "BodyKinematics", placed: Floats, wanted: Floats) -> None:
    """Change the fixed poses of links in their parents so that the links move from ``placed`` to ``wanted``."""
    link_of = np.zeros(kinematics.model.nbody, dtype=int)
    link_of[kinematics.body_ids] = np.arange(len(placed))
    parents = link_of[kinematics.model.body_parentid[kinematics.body_ids]]
    by_joints, displaced = (_inverses(poses[parents]) @ poses for poses in (placed, wanted))
    off = np.abs(by_joints - displaced).max(axis=(1, 2)) > _NO_DISPLACEMENT
    off[kinematics.roots] = False
    for link in np.flatnonzero(off).tolist():
        moved_by_joint = inverse(kinematics.rest_transform(link)) @ by_joints[link]
        kinematics.displace(link, displaced[link] @ inverse(moved_by_joint))


def _inverses(transforms: Floats) -> Floats:
    """Return the inverse of each of many rigid transforms, shape (n, 4, 4)."""
    inverses = np.zeros_like(transforms)
    inverses[:, :3, :3] = rotations = transforms[:, :3, :3].transpose(0, 2, 1)
    inverses[:, :3, 3:] = -rotations @ transforms[:, :3, 3:]
    inverses[:, 3, 3] = 1.0
    return inverses


def fix_to_parents(model: mujoco.MjModel, data: mujoco.MjData, positions: Floats, quaternions: Floats) -> None:
    """Move joint axes to their parent links, as in OpenRAVE (test random-api-234).

    MuJoCo defines axes in the child links; those of ``hinge2`` and spherical joints stay there. ``mj_kinematics`` must
    have run. ``positions`` and ``quaternions`` (wxyz) are the rest poses of links in their parents, shapes (nbody, 3)
    [m] and (nbody, 4).
    """
    for body_id in np.flatnonzero(model.body_jntnum == 1).tolist():
        joint, parent = int(model.body_jntadr[body_id]), int(model.body_parentid[body_id])
        if model.jnt_type[joint] in _ONE_AXIS:
            w, x, y, z = quaternions[body_id].tolist()
            rotation = np.array(rows_from_wxyz((w, x, y, z)))
            R_world_parent = data.xmat[parent].reshape(3, 3)
            data.xaxis[joint] = R_world_parent @ rotation @ model.jnt_axis[joint]
            anchor = rotation @ model.jnt_pos[joint] + positions[body_id]
            data.xanchor[joint] = R_world_parent @ anchor + data.xpos[parent]
