"""Axes of joints whose child links were displaced."""

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, rows_from_wxyz

_ONE_AXIS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


def fix_to_parents(model: mujoco.MjModel, data: mujoco.MjData, positions: Floats, quaternions: Floats) -> None:
    """Put the axes of joints where their parent links have them, as in OpenRAVE (random-api-234).

    MuJoCo has them in the child links. The two axes of a ``hinge2`` and the ball of a spherical joint stay there.

    Args:
        model: A body's own model.
        data: Its data after ``mj_kinematics``.
        positions: Where joints at rest place each link in its parent [m], shape (nbody, 3).
        quaternions: Orientations there, wxyz, shape (nbody, 4).
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
