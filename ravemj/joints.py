"""How a joint moves its child: poses from values, and values from poses."""

import math
from collections.abc import Sequence

from ravemj.scene import Axis, Joint
from ravemj.transforms import Pose, add, conjugate, dot, multiply, rotate, scale, wxyz_from_axis_angle

ROUNDING = 1e-12
"""A measured joint value [rad or m] below this is rounding of the poses, not a displacement."""


def place_links(poses: list[Pose], joints: Sequence[Joint]) -> None:
    """Place the child link of each joint, in order, by the joint's value: forward kinematics in place.

    Args:
        poses: World poses of all links.
        joints: The joints that place a link, parents before children.
    """
    for joint in joints:
        poses[joint.child] = poses[joint.parent] @ relative_pose(joint, [axis.value for axis in joint.axes])


def relative_pose(joint: Joint, values: Sequence[float]) -> Pose:
    """Return the pose of a joint's child in its parent at the given values [rad or m]."""
    if joint.static:
        return joint.T_parent_child
    motion = Pose()
    for axis, value in zip(joint.axes, values, strict=True):
        motion = motion @ _axis_motion(joint, axis, value - axis.reference)
    return motion @ joint.T_parent_child


def _axis_motion(joint: Joint, axis: Axis, displacement: float) -> Pose:
    if joint.kind == "slider":
        return Pose(scale(axis.direction, displacement))
    wxyz = wxyz_from_axis_angle(axis.direction, displacement)
    return Pose(add(joint.anchor, scale(rotate(wxyz, joint.anchor), -1.0)), wxyz)


def measured_value(joint: Joint, axis: Axis, now: Pose) -> float:
    """Return the value of a joint that the poses of its links show.

    Args:
        joint: The joint.
        axis: One of its axes.
        now: ``T_parent_child`` as it is.

    Returns:
        The value [rad or m]; an angle lies in (-pi, pi], or in the turn around the middle of limits beyond that.
    """
    rest = joint.T_parent_child
    if joint.kind == "slider":
        moved = dot(axis.direction, add(now.position, scale(rest.position, -1.0)))
    else:
        w, x, y, z = multiply(now.wxyz, conjugate(rest.wxyz))
        moved = 2 * math.atan2(dot(axis.direction, (x, y, z)), w)
        beyond = axis.lower < -math.pi or axis.upper > math.pi
        middle = (axis.lower + axis.upper) / 2 if beyond else 0.0
        moved -= math.tau * round((axis.reference + moved - middle) / math.tau)
    return axis.reference + (moved if abs(moved) > ROUNDING else 0.0)
