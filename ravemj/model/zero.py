"""Another zero of joint values."""

from collections.abc import Sequence
from dataclasses import replace

from ravemj.core.transforms import Floats, Pose, pose_of
from ravemj.model.joints import directions_at
from ravemj.model.scene import Joint, KinBody


def rezeroed(body: KinBody, T_world_links: Floats, values: Sequence[float]) -> KinBody:
    """Return a body whose DOFs are 0 where its links stand; limits keep their numbers, and passive joints their zero.

    Args:
        body: The body.
        T_world_links: Where its links stand, shape (links, 4, 4).
        values: The values of its DOFs there [rad or m].
    """
    poses = [pose_of(transform) for transform in T_world_links]
    links = tuple(replace(link, T_world_link=pose) for link, pose in zip(body.links, poses, strict=True))
    rest = iter(values)
    joints = tuple(
        _rezeroed(joint, poses[joint.parent].inverse() @ poses[joint.child], [next(rest) for _ in joint.axes])
        for joint in body.joints
    )
    return replace(body, links=links, joints=joints)


def _rezeroed(joint: Joint, T_parent_child: Pose, values: Sequence[float]) -> Joint:
    if joint.static:
        return joint
    axes = tuple(
        replace(axis, direction=direction, reference=0.0, value=0.0)
        for axis, direction in zip(joint.axes, directions_at(joint, values), strict=True)
    )
    return replace(joint, T_parent_child=T_parent_child, axes=axes)
