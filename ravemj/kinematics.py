"""Joint values and link poses of one body: the map between OpenRAVE's DOFs and MuJoCo's ``qpos``.

Functions over ``(MjModel, MjData)`` with the index maps made once. Nothing here recompiles a model.
"""

from collections.abc import Sequence

import mujoco
import numpy as np

from ravemj.joints import measured_value
from ravemj.mjcf import BodyNames
from ravemj.scene import KinBody
from ravemj.transforms import Floats, Ints, Pose, wxyz_from_rows

LARGEST = float(np.finfo(np.float64).max)


class BodyKinematics:
    """Reads and writes the configuration of one body in a compiled model.

    Attributes:
        dof: Number of degrees of freedom.
        lower: Lower limits, shape (dof,); of circular joints the limits that OpenRAVE reports.
        upper: Upper limits, shape (dof,).
        circular: For each DOF, whether it turns without end, shape (dof,).
        body_ids: MuJoCo's index of each link, shape (links,).
        qpos_indices: Where each DOF is in ``qpos``, shape (dof,); -1 for that of a joint that moves no link.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, body: KinBody, names: BodyNames) -> None:
        self._model, self._data = model, data
        self._qpos, self._xpos, self._xmat = data.qpos, data.xpos, data.xmat
        axes = body.dof_axes
        self.dof = len(axes)
        self.lower = np.array([axis.lower for axis in axes])
        self.upper = np.array([axis.upper for axis in axes])
        self.circular = np.array([axis.circular for axis in axes], dtype=bool)
        self.body_ids = np.array([_index(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in names.links], dtype=int)
        self.qpos_indices = np.array([_qpos_index(model, name) for name in names.joints], dtype=int)
        self._bounds = [
            (-LARGEST, LARGEST) if axis.circular else (axis.lower, axis.upper) for axis in axes
        ]  # plain floats: for few joints a loop over them is faster than numpy
        self._free = self.qpos_indices >= 0
        self._to_qpos = _index_range(self.qpos_indices[self._free])
        self._all_free = bool(self._free.all())
        self._links = _index_range(self.body_ids)
        self._loose = [(dof, joint) for dof, joint in enumerate(body.joints) if names.joints[dof] is None]
        self._homogeneous = np.tile(np.eye(4), (len(self.body_ids), 1, 1))

    def values(self) -> Floats:
        """Return the joint values [rad or m], shape (dof,); a copy.

        A weld's is 0; a joint that closes a loop has the value that the poses of its links show.
        """
        if self._all_free:
            return self._qpos[self._to_qpos].copy()
        values = np.zeros(self.dof)
        values[self._free] = self._qpos[self._to_qpos]
        for dof, joint in self._loose:
            if not joint.static:
                T_parent_child = self._pose(joint.parent).inverse() @ self._pose(joint.child)
                values[dof] = measured_value(joint, joint.axes[0], T_parent_child)
        return values

    def _pose(self, link: int) -> Pose:
        body_id = self.body_ids[link]
        x, y, z = self._xpos[body_id].tolist()
        return Pose((x, y, z), wxyz_from_rows(self._xmat[body_id].reshape(3, 3).tolist()))

    def set_values(self, values: Floats) -> None:
        """Set the joint values and place the links: forward kinematics, no limits checked.

        Args:
            values: Joint values [rad or m], shape (dof,).
        """
        self._qpos[self._to_qpos] = values if self._all_free else values[self._free]
        mujoco.mj_kinematics(self._model, self._data)

    def within_limits(self, values: Sequence[float]) -> bool:
        """Return whether all values are finite numbers inside the limits; circular joints have none."""
        return all(lower <= value <= upper for value, (lower, upper) in zip(values, self._bounds, strict=True))

    def link_transforms(self) -> Floats:
        """Return ``T_world_link`` of every link, shape (links, 4, 4); a copy."""
        transforms = self._homogeneous.copy()
        transforms[:, :3, 3] = self._xpos[self._links]
        transforms[:, :3, :3] = self._xmat[self._links].reshape(-1, 3, 3)
        return transforms

    def link_transform(self, link: int) -> Floats:
        """Return ``T_world_link`` of one link, shape (4, 4); a copy."""
        transform = np.eye(4)
        body_id = self.body_ids[link]
        transform[:3, 3] = self._xpos[body_id]
        transform[:3, :3] = self._xmat[body_id].reshape(3, 3)
        return transform


def _index(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str) -> int:
    return mujoco.mj_name2id(model, kind, name)


def _qpos_index(model: mujoco.MjModel, joint_name: str | None) -> int:
    if joint_name is None:
        return -1
    return int(model.jnt_qposadr[_index(model, mujoco.mjtObj.mjOBJ_JOINT, joint_name)])


def _index_range(
    indices: Ints,
) -> slice | Ints:
    """Return the indices as a slice if they follow one another, since slices are faster."""
    first = int(indices[0]) if len(indices) else 0
    if np.array_equal(indices, np.arange(first, first + len(indices))):
        return slice(first, first + len(indices))
    return indices
