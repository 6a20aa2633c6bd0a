"""Snapshot of bodies: a scene with their present values, poses and enabled links."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Pose, pose_of
from ravemj.engine.kinematics.displacement import ROUNDING
from ravemj.engine.simulation import BodyState
from ravemj.model.joints import relative_pose
from ravemj.model.scene import Grab, Joint, KinBody


def snapshot(body: BodyState) -> KinBody:
    """Return the description of a body in its present state.

    The joint of a displaced link gets the link's present pose as its ``T_parent_child``.
    """
    scene = body.scene
    links = [replace(link, enabled=enabled) for link, enabled in zip(scene.links, body.link_enabled, strict=True)]
    grabs = tuple(
        Grab(
            body=grab.body.scene.name,
            link=grab.link,
            T_link_body=pose_of(grab.T_link_body),
            ignored=tuple(sorted(grab.ignored)),
        )
        for grab in body.grabs
    )
    if body.known_kinematics is None:  # it is where its description has it
        return replace(scene, links=tuple(links), grabs=grabs)
    poses = [pose_of(transform) for transform in body.link_transforms()]
    kinematics = body.own_kinematics
    rest = iter(kinematics.values().tolist())
    values: list[Sequence[float]] = [[next(rest) for _ in joint.axes] for joint in scene.joints]
    values += [kinematics.passive_values(index).tolist() for index in range(len(scene.passive_joints))]
    joints = [_settled(joint, given, poses) for joint, given in zip(scene.all_joints, values, strict=True)]
    count = len(scene.joints)
    return replace(
        scene,
        links=tuple(replace(link, T_world_link=pose) for link, pose in zip(links, poses, strict=True)),
        joints=tuple(joints[:count]),
        passive_joints=tuple(joints[count:]),
        grabs=grabs,
    )


def _settled(joint: Joint, values: Sequence[float], poses: Sequence[Pose]) -> Joint:
    """Return a joint with its present values; if its child is displaced, also with the child's pose."""
    axes = tuple(replace(axis, value=value) for axis, value in zip(joint.axes, values, strict=True))
    expected = relative_pose(joint, values)
    T_parent_child = poses[joint.parent].inverse() @ poses[joint.child]
    if not joint.places_child or np.abs(expected.matrix() - T_parent_child.matrix()).max() <= ROUNDING:
        return replace(joint, axes=axes)
    return replace(joint, axes=axes, T_parent_child=joint.T_parent_child @ expected.inverse() @ T_parent_child)
