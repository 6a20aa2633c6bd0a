"""Manipulators: the links, joints and DOFs that a file names."""

import math
from dataclasses import dataclass, field

from ravemj.core.transforms import Pose, Vec3, dot, scale
from ravemj.errors import Diagnostics, Source, SourceError
from ravemj.model import scene


@dataclass(slots=True)
class ManipulatorBuilder:
    """A manipulator as written; links and joints by name. A name that is missing is empty."""

    name: str
    source: Source
    base: str = ""
    effector: str = ""
    T_effector_tool: Pose = field(default_factory=Pose)
    direction: Vec3 = (0.0, 0.0, 1.0)
    gripper_joints: list[str] = field(default_factory=list[str])
    closing_direction: list[float] = field(default_factory=list[float])
    gripper_name: str = ""


def freeze_manipulator(built: ManipulatorBuilder, body: scene.KinBody, diagnostics: Diagnostics) -> scene.Manipulator:
    """Find the links and joints that a manipulator names.

    Raises:
        SourceError: the effector is not moved by the arm's joints, so that OpenRAVE refuses the robot.
    """
    names = [link.name for link in body.links]
    base = names.index(built.base) if built.base in names else None
    effector = names.index(built.effector) if built.effector in names else None
    arm = () if base is None or effector is None else _arm_dofs(built, body, base, effector)
    gripper_joints = _gripper(built, body, arm, diagnostics)
    gripper_dofs = tuple(dof for joint in gripper_joints for dof in joint_dofs(body, joint))
    signs = [math.copysign(1.0, value) if value else 0.0 for value in built.closing_direction]
    return scene.Manipulator(
        name=built.name,
        base=base,
        effector=effector,
        T_effector_tool=built.T_effector_tool,
        direction=_direction(built, diagnostics),
        arm_dofs=arm,
        gripper_joints=gripper_joints,
        gripper_dofs=gripper_dofs,
        chucking_direction=tuple((signs + [0.0] * len(gripper_dofs))[: len(gripper_dofs)]),
        source=built.source,
        gripper_name=built.gripper_name,
    )


def joint_dofs(body: scene.KinBody, joint: int) -> tuple[int, ...]:
    """Return the DOFs of an active joint."""
    first = sum(len(other.axes) for other in body.joints[:joint])
    return tuple(range(first, first + len(body.joints[joint].axes)))


def chain(body: scene.KinBody, base: int, effector: int) -> list[int] | None:
    """Return the joints from one link up the tree to another, in that order; None if there is no such way.

    Returns:
        Indices into the active joints followed by the passive ones.
    """
    joints = body.all_joints
    placing = {joint.child: index for index, joint in enumerate(joints) if joint.places_child}
    way: list[int] = []
    link = effector
    while link != base:
        if link not in placing:
            return None
        way.append(placing[link])
        link = joints[placing[link]].parent
    return way[::-1]


def _arm_dofs(built: ManipulatorBuilder, body: scene.KinBody, base: int, effector: int) -> tuple[int, ...]:
    joints = body.all_joints
    way = chain(body, base, effector)
    if way is None:
        message = f"manipulator '{built.name}': no joints lead from '{built.base}' out to '{built.effector}'"
        raise SourceError(message, built.source)
    dofs: dict[int, None] = {}
    for index in way:
        joint = joints[index]
        if joint.mimic is not None:
            dofs.update(dict.fromkeys(joint.mimic.dofs))
        elif index < len(body.joints) and not joint.static:
            dofs.update(dict.fromkeys(joint_dofs(body, index)))
    return tuple(dofs)


def _gripper(
    built: ManipulatorBuilder, body: scene.KinBody, arm: tuple[int, ...], diagnostics: Diagnostics
) -> tuple[int, ...]:
    found: dict[int, None] = {}
    for name in built.gripper_joints:
        index = next((i for i, joint in enumerate(body.joints) if joint.name == name), None)
        if index is None or set(joint_dofs(body, index)) & set(arm):
            message = f"manipulator '{built.name}': '{name}' is no active joint outside of the arm; left out"
            diagnostics.warn("unknown-joint", message, built.source)
        else:
            found.setdefault(index)
    return tuple(found)


def _direction(built: ManipulatorBuilder, diagnostics: Diagnostics) -> Vec3:
    length = math.sqrt(dot(built.direction, built.direction))
    if length == 0.0:
        message = f"manipulator '{built.name}': the direction 0 0 0 is none; OpenRAVE takes 0 0 1"
        diagnostics.warn("bad-direction", message, built.source)
        return (0.0, 0.0, 1.0)
    return scale(built.direction, 1 / length)
