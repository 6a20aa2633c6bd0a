"""Manipulators: resolution of the links, joints and DOFs named in a file."""

import math
from dataclasses import dataclass, field

from ravemj.core.transforms import Pose, Vec3, dot, scale
from ravemj.errors import Diagnostics, ManipulatorError, Source
from ravemj.model import chains, scene
from ravemj.model.chains import joint_dofs


@dataclass(slots=True)
class ManipulatorBuilder:
    """Manipulator as written, with names of links and joints; missing names are empty."""

    name: str
    source: Source
    base: str = ""
    effector: str = ""
    T_effector_tool: Pose = field(default_factory=Pose)
    direction: Vec3 = (0.0, 0.0, 1.0)
    gripper_joints: list[str] = field(default_factory=list[str])
    closing_direction: list[float] = field(default_factory=list[float])
    gripper_name: str = ""
    ik_solver: str = ""


def freeze_manipulator(built: ManipulatorBuilder, body: scene.KinBody, diagnostics: Diagnostics) -> scene.Manipulator:
    """Resolve the links and joints named by a manipulator."""
    base, effector = (
        next((index for index, link in enumerate(body.links) if name and link.name == name), None)
        for name in (built.base, built.effector)
    )
    arm = () if base is None or effector is None else _arm_dofs(body, base, effector)
    if effector is not None and base != effector and not arm:
        ends = f"its base '{built.base}' and its effector '{built.effector}'"
        message = f"manipulator '{built.name}' has no arm: no joint with a DOF lies between {ends}"
        diagnostics.warn("no-arm", message, built.source)
    gripper = _gripper(built, body, arm, diagnostics)
    return scene.Manipulator(
        name=built.name,
        base=base,
        effector=effector,
        T_effector_tool=built.T_effector_tool,
        direction=_direction(built, diagnostics),
        arm_dofs=arm,
        gripper_joints=tuple(gripper),
        gripper_dofs=tuple(dof for joint in gripper for dof in joint_dofs(body, joint)),
        chucking_direction=tuple(sign for signs in gripper.values() for sign in signs),
        source=built.source,
        gripper_name=built.gripper_name,
        ik_solver=built.ik_solver,
    )


def chain(body: scene.KinBody, base: int, effector: int) -> list[int] | None:
    """Return the joints from link ``base`` down the tree to link ``effector``, in order; None if there is no path.

    Joint indices count active joints, then passive ones.
    """
    above = chains.joints_above(body, effector)
    links = [effector, *(body.all_joints[index].parent for index in above)]
    return [*reversed(above[: links.index(base)])] if base in links else None


def check_reach(manipulator: scene.Manipulator, body: scene.KinBody) -> None:
    """Check that each joint of an arm moves its effector, directly or through mimic joints.

    Raises:
        ManipulatorError: a joint does not; OpenRAVE rejects the robot (tests gap-10, gap-39).
    """
    effector = manipulator.effector
    if effector is None:
        return
    between = chains.connections(body).between(effector)
    for dof in manipulator.arm_dofs:
        joint = body.joint_of_dof(dof)
        moved = [
            joint,
            *(other for other in body.passive_joints if other.mimic is not None and dof in other.mimic.dofs),
        ]
        if not any(moved_joint.parent in between and moved_joint.child in between for moved_joint in moved):
            message = f"manipulator '{manipulator.name}': joint '{joint.name}' does not move its effector"
            link = body.links[effector].name
            hint = f"name as base a link between '{body.links[0].name}' and '{link}'"
            if effector == 0:
                hint = "the first link of a body moves by no joint: exchange base and effector"
            raise ManipulatorError(f"{message} '{link}'", manipulator.source, hint)


def _arm_dofs(body: scene.KinBody, base: int, effector: int) -> tuple[int, ...]:
    joints = body.all_joints
    dofs: dict[int, None] = {}
    for index in chains.chain(body, base, effector)[1]:
        joint = joints[index]
        if joint.static:
            continue
        if joint.mimic is not None:
            dofs.update(dict.fromkeys(joint.mimic.dofs))
        elif index < len(body.joints):
            dofs.update(dict.fromkeys(joint_dofs(body, index)))
    return tuple(dofs)


def _gripper(
    built: ManipulatorBuilder, body: scene.KinBody, arm: tuple[int, ...], diagnostics: Diagnostics
) -> dict[int, list[float]]:
    """Return the closing signs of the DOFs of each gripper joint, by joint index.

    The signs are assigned in the order of the joint names; joints of the arm are omitted with a warning.
    """
    directions_by_dof: dict[int, list[float]] = {}
    signs = iter([math.copysign(1.0, value) if value else 0.0 for value in built.closing_direction])
    for name in built.gripper_joints:
        index = next((i for i, joint in enumerate(body.joints) if joint.name == name), None)
        dofs = () if index is None else joint_dofs(body, index)
        is_of_arm = not set(dofs).isdisjoint(arm)
        own = [] if is_of_arm else [next(signs, 0.0) for _ in dofs or (None,)]
        if index is None or is_of_arm:
            message = f"manipulator '{built.name}': '{name}' is not an active joint outside of the arm; left out"
            diagnostics.warn("unknown-joint", message, built.source)
        else:
            directions_by_dof.setdefault(index, own)
    return directions_by_dof


def _direction(built: ManipulatorBuilder, diagnostics: Diagnostics) -> Vec3:
    length = math.sqrt(dot(built.direction, built.direction))
    if length == 0.0:
        message = f"manipulator '{built.name}': the direction 0 0 0 is none; OpenRAVE takes 0 0 1"
        diagnostics.warn("bad-direction", message, built.source)
        return (0.0, 0.0, 1.0)
    return scale(built.direction, 1 / length)
