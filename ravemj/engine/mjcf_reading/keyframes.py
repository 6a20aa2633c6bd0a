"""Conversion of keyframes to joint values and named configurations."""

from collections.abc import Sequence

import mujoco
import numpy as np

from ravemj.core.transforms import Floats, Pose, rotate
from ravemj.engine.mjcf_reading.joints import BALL
from ravemj.engine.mjcf_reading.numbers import quaternion, vector
from ravemj.engine.mjcf_reading.trees import BodyTree
from ravemj.model.joints import rotation_vector
from ravemj.model.scene import NamedConfiguration

HOME = "home"


def add_keyframes(model: mujoco.MjModel, trees: Sequence[BodyTree]) -> None:
    """Initialize bodies from the keyframe ``home``, else from the first one; named keyframes become configurations."""
    names = [model.key(index).name for index in range(model.nkey)]
    if not names:
        return
    start = names.index(HOME) if HOME in names else 0
    for tree in trees:
        for index, name in enumerate(names):
            values = _values(model, tree, model.key_qpos[index])
            if name and values:
                tree.builder.configurations.append(NamedConfiguration(name, tuple(values.items())))
        active = [(index, joint) for index, joint in tree.joints.items() if joint.active]
        qpos = model.key_qpos[start]
        if active:
            tree.builder.joint_values = [
                part for index, _ in active for part in _joint_values(model, tree, index, qpos)
            ]
        T_world_root = _root_pose(model, tree, start)
        if T_world_root is not None:
            _move(tree, T_world_root)


def _values(model: mujoco.MjModel, tree: BodyTree, qpos: Floats) -> dict[str, float]:
    """Return the values of joints with one axis, by joint name."""
    joints = [(index, joint) for index, joint in tree.joints.items() if joint.active and len(joint.axes) == 1]
    return {joint.name: float(qpos[model.jnt_qposadr[index]]) for index, joint in joints}


def _joint_values(model: mujoco.MjModel, tree: BodyTree, index: int, qpos: Floats) -> list[float]:
    address = int(model.jnt_qposadr[index])
    if model.jnt_type[index] != BALL:
        return [float(qpos[address])]
    turned = rotation_vector(quaternion(_unit(qpos[address : address + 4])))
    return list(rotate(tree.joints[index].T_first_second.wxyz, turned))


def _root_pose(model: mujoco.MjModel, tree: BodyTree, key: int) -> Pose | None:
    """Return the pose of a floating or mocap root in a keyframe; None for other roots."""
    mocap = int(model.body_mocapid[tree.root])
    if tree.free is not None:
        address = int(model.jnt_qposadr[tree.free])
        numbers = model.key_qpos[key, address : address + 7]
        return Pose(vector(numbers[:3]), quaternion(_unit(numbers[3:])))
    if mocap >= 0:
        position, turned = (array.reshape(model.nkey, -1) for array in (model.key_mpos, model.key_mquat))
        return Pose(
            vector(position[key, 3 * mocap : 3 * mocap + 3]),
            quaternion(_unit(turned[key, 4 * mocap : 4 * mocap + 4])),
        )
    return None


def _unit(numbers: Floats) -> Floats:
    length = float(np.linalg.norm(numbers))
    return numbers / length if length else np.array([1.0, 0.0, 0.0, 0.0])


def _move(tree: BodyTree, T_world_root: Pose) -> None:
    moved = T_world_root @ tree.builder.links[0].pose.inverse()
    for index, link in enumerate(tree.builder.links):
        link.pose = moved @ link.pose if index else T_world_root
