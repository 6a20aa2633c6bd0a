"""Conversion of joints to mimic joints and back."""

from dataclasses import replace

from ravemj.errors import ArgumentError, Diagnostics
from ravemj.model.manipulators import ManipulatorBuilder, freeze_manipulator
from ravemj.model.mimic import Equations, NamedJoint, resolve
from ravemj.model.scene import KinBody, Manipulator


def with_equations(body: KinBody, index: int, equations: Equations) -> tuple[KinBody, list[int]]:
    """Return a body with new mimic equations of one joint, and the previous index of each of its joints.

    As in OpenRAVE (test gap-15), an active joint that becomes a mimic joint is the last passive joint. A mimic joint
    whose position equation becomes empty is active, as the last active joint. So DOFs are renumbered.

    Raises:
        ArgumentError: the equations are invalid.
    """
    active, passive = list(range(len(body.joints))), list(range(len(body.joints), len(body.all_joints)))
    if equations.position and index in active:
        active.remove(index)
        passive.append(index)
    elif not equations.position and body.all_joints[index].mimic is not None:
        passive.remove(index)
        active.append(index)
    order = active + passive
    named: list[NamedJoint] = []
    for place in order:
        joint = body.all_joints[place]
        mimic = joint.mimic
        written = None if mimic is None else Equations(mimic.position, mimic.velocity, mimic.acceleration)
        if place == index:
            written = equations if equations.position else None
        dof = len(joint.axes) if place in active else 0
        named.append(NamedJoint(joint.name, dof, written, joint.source))
    diagnostics = Diagnostics()
    mimics = resolve(named, diagnostics)
    for finding in diagnostics:
        raise ArgumentError(finding.message)
    joints = tuple(replace(body.all_joints[place], mimic=mimics.get(new)) for new, place in enumerate(order))
    changed = replace(body, joints=joints[: len(active)], passive_joints=joints[len(active) :])
    manipulators = tuple(_found_again(manipulator, body, changed) for manipulator in body.manipulators)
    return replace(changed, manipulators=manipulators), order


def _found_again(arm: Manipulator, before: KinBody, body: KinBody) -> Manipulator:
    """Transfer a manipulator from ``before`` to ``body``, which has other DOFs; remove gripper joints without DOF."""
    signs = dict(zip(arm.gripper_dofs, arm.chucking_direction, strict=True))
    dofs = {joint.name: sign for dof, sign in signs.items() for joint in [before.joint_of_dof(dof)]}
    kept = [name for name in dofs if any(joint.name == name for joint in body.joints)]
    built = ManipulatorBuilder(
        name=arm.name,
        source=arm.source,
        base="" if arm.base is None else body.links[arm.base].name,
        effector="" if arm.effector is None else body.links[arm.effector].name,
        T_effector_tool=arm.T_effector_tool,
        direction=arm.direction,
        gripper_joints=kept,
        closing_direction=[dofs[name] for name in kept],
        gripper_name=arm.gripper_name,
        ik_solver=arm.ik_solver,
    )
    return freeze_manipulator(built, body, Diagnostics())
