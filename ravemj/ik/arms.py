"""From a manipulator of a scene to a chain: the only module here that knows scenes."""

import numpy as np

from ravemj.core.transforms import Pose, Vec3, rotate
from ravemj.ik.chain import Chain
from ravemj.model.joints import directions_at, relative_pose
from ravemj.model.manipulators import chain as joints_between
from ravemj.model.scene import Axis, Joint, KinBody, Manipulator


def chain_of(body: KinBody, manipulator: Manipulator) -> Chain:
    """Return the joints from the base of a manipulator to its tool; their order is that of ``arm_dofs``.

    Passive joints that follow nothing stay as they were loaded.

    Raises:
        ValueError: there is no base, no effector or no joint between them, or one of these follows others or is
            spherical; the message names it.
    """
    name = f"manipulator '{manipulator.name}' of '{body.name}'"
    if manipulator.base is None or manipulator.effector is None:
        raise ValueError(f"{name} has no base or no effector link: name both in the file")
    way = joints_between(body, manipulator.base, manipulator.effector)
    if not way or not manipulator.arm_dofs:
        raise ValueError(f"{name} has no joint that moves between its base and its effector: name links farther apart")
    T_base_link = Pose()
    moving: list[tuple[Joint, Axis, Vec3, Vec3]] = []
    for index in way:
        joint = (*body.joints, *body.passive_joints)[index]
        if joint.static:
            T_base_link = T_base_link @ joint.T_parent_child
        elif index >= len(body.joints) and joint.mimic is None:
            T_base_link = T_base_link @ relative_pose(joint, [axis.value for axis in joint.axes])
        else:
            moving += _axes(name, joint, T_base_link)
            T_base_link = T_base_link @ relative_pose(joint, [0.0] * len(joint.axes))
    axes = [axis for _, axis, _, _ in moving]
    return Chain.of(
        [direction for _, _, direction, _ in moving],
        [point for _, _, _, point in moving],
        prismatic=[joint.kind == "slider" for joint, _, _, _ in moving],
        lower=[axis.lower for axis in axes],
        upper=[axis.upper for axis in axes],
        circular=[axis.circular for axis in axes],
        T_base_tool=np.array((T_base_link @ manipulator.T_effector_tool).matrix()),
        direction=manipulator.direction,
    )


def _axes(name: str, joint: Joint, T_base_parent: Pose) -> list[tuple[Joint, Axis, Vec3, Vec3]]:
    """Return for each axis of a joint the joint, the axis, its direction and a point, in the base at values of 0."""
    if joint.mimic is not None or joint.kind == "spherical":
        what = "follows other joints" if joint.mimic is not None else "is spherical"
        raise ValueError(f"joint '{joint.name}' in {name} {what}: inverse kinematics needs joints of one value each")
    directions = directions_at(joint, [0.0] * len(joint.axes))
    point = (T_base_parent @ Pose(joint.anchor)).position
    return [
        (joint, axis, rotate(T_base_parent.wxyz, direction), point)
        for axis, direction in zip(joint.axes, directions, strict=True)
    ]
