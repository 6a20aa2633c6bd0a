"""Joint kinematics: poses from joint values and vice versa, value differences, changes of the zero configuration."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.graphs import topological_order
from ravemj.core.transforms import (
    ZERO,
    Floats,
    Pose,
    Vec3,
    Wxyz,
    add,
    conjugate,
    dot,
    multiply,
    pose_of,
    rotate,
    scale,
    wxyz_from_axis_angle,
)
from ravemj.model.scene import Joint, KinBody

_X = (1.0, 0.0, 0.0)
_Z = (0.0, 0.0, 1.0)
_NEAR = 1e-9  # tolerance of unit vectors
ROUNDING = 1e-12
"""Absolute joint value [rad or m] up to which a measured value is a rounding error of the poses."""


def place_links(poses: list[Pose], joints: Sequence[Joint], values: Sequence[Sequence[float]]) -> None:
    """Place the child link of each joint in ``poses``, the world poses of all links: forward kinematics in place.

    Parents come before children. ``values`` has the values of each joint's axes [rad or m].
    """
    for joint, joint_values in zip(joints, values, strict=True):
        poses[joint.child] = poses[joint.parent] @ relative_pose(joint, joint_values)


def poses_at(body: KinBody, values: Sequence[Sequence[float]]) -> list[Pose]:
    """Return the poses of all links, with the root links unchanged.

    ``values`` has the values of each joint's axes [rad or m], active joints and then passive ones.
    """
    poses = [link.T_world_link for link in body.links]
    joints = body.all_joints
    placing = {joint.child: index for index, joint in enumerate(joints) if joint.places_child}
    parents = {link: joints[index].parent for link, index in placing.items()}
    order = topological_order(placing, lambda link: [parents[link]] if parents[link] in placing else [])
    indices = [placing[link] for link in order]
    place_links(poses, [joints[index] for index in indices], [values[index] for index in indices])
    return poses


def rests(body: KinBody, index: int) -> bool:
    """Return whether a joint is fixed: it has no DOFs and is not a mimic joint."""
    if index < len(body.joints):
        return False
    mimic = body.passive_joints[index - len(body.joints)].mimic
    return mimic is None or mimic.expression is None


def turns_about_z_of_child(joint: Joint) -> bool:
    """Return whether a hinge's axis is the z axis of its child at value 0."""
    return math.dist(joint.axes[0].direction, rotate(joint.T_parent_child.wxyz, _Z)) < _NEAR


def relative_pose(joint: Joint, values: Sequence[float]) -> Pose:
    """Return the pose of a joint's child in its parent at the given values [rad or m]."""
    return joint.T_parent_child if joint.static else displaced_pose(joint, values)


def displaced_pose(joint: Joint, values: Sequence[float]) -> Pose:
    """Return the pose of a joint's child in its parent at values [rad or m], which may be nonzero for welds, too."""
    if joint.kind == "spherical":
        return about(joint.anchor, wxyz_from_rotation_vector((values[0], values[1], values[2]))) @ joint.T_parent_child
    displaced = joint.T_parent_child
    for index in range(len(joint.axes) - 1, -1, -1):
        displaced = _motion(joint, index, values[index]) @ displaced
    return displaced


def _motion(joint: Joint, index: int, value: float) -> Pose:
    """Return the displacement, in the parent's frame, that the value of one joint axis causes."""
    axis = joint.axes[index]
    way = value - axis.reference
    if joint.slides(index):
        return Pose(scale(axis.direction, way))
    return about(joint.anchor, wxyz_from_axis_angle(axis.direction, way))


def directions_at(joint: Joint, values: Sequence[float]) -> list[Vec3]:
    """Return a joint's axis directions in its parent link for joint values; the second axis rotates with the first."""
    directions = [axis.direction for axis in joint.axes]
    if joint.kind in {"hinge2", "pr"}:
        first = joint.axes[0]
        directions[1] = rotate(wxyz_from_axis_angle(first.direction, values[0] - first.reference), directions[1])
    return directions


def moving_direction(joint: Joint, axis: int) -> Vec3:
    """Return the direction of an axis in the parent; not for ball joints, which have no single axis.

    A spherical mimic joint moves about x: its one value is the first of its rotation vector (tests random-xml-41,
    -102).
    """
    return _X if joint.kind == "spherical" else joint.axes[axis].direction


def reported_anchor(joint: Joint) -> Vec3:
    """Return the anchor reported by OpenRAVE, in the joint's parent; for sliders it is the anchor at value 0."""
    if joint.kind != "slider":
        return joint.anchor
    return add(joint.anchor, scale(joint.axes[0].direction, -joint.axes[0].reference))


def about(anchor: Vec3, wxyz: Wxyz) -> Pose:
    """Return the transform of a rotation about a point."""
    return Pose(add(anchor, scale(rotate(wxyz, anchor), -1.0)), wxyz)


def measured_values(joint: Joint, now: Pose) -> tuple[float, ...]:
    """Return the values [rad or m] of a joint's axes from the pose ``now`` of its child in its parent.

    Angles are at most half a turn; a joint with two axes is assumed not to have moved.
    """
    if joint.static:
        return tuple(0.0 for _ in joint.axes)
    rest = joint.T_parent_child
    turned = multiply(now.wxyz, conjugate(rest.wxyz))
    if joint.kind == "spherical":
        return tuple(part if abs(part) > ROUNDING else 0.0 for part in rotation_vector(turned))
    axis, *others = joint.axes
    if others:
        return tuple(axis.reference for axis in joint.axes)
    if axis.direction == ZERO:
        return (0.0,)
    if joint.kind == "slider":
        D = Pose(add(now.position, scale(rotate(turned, rest.position), -1.0)), turned)
        moved = dot(axis.direction, add(D.apply(joint.anchor), scale(joint.anchor, -1.0)))
    else:
        moved = 2 * math.atan2(dot(axis.direction, turned[1:]), turned[0])
        if math.isnan(moved):
            raise OverflowError("the poses of the links are too far apart to compute with")
        moved -= math.tau * round((axis.reference + moved) / math.tau)
    return (axis.reference + (moved if abs(moved) > ROUNDING else 0.0),)


def wxyz_from_rotation_vector(vector: Vec3) -> Wxyz:
    """Return the rotation about a vector by its norm [rad]."""
    return wxyz_from_axis_angle(vector, math.sqrt(dot(vector, vector)))


def rotation_vector(wxyz: Wxyz) -> Vec3:
    """Return the axis of a rotation times its angle, which is at most pi [rad]."""
    w, x, y, z = wxyz if wxyz[0] >= 0 else (-wxyz[0], -wxyz[1], -wxyz[2], -wxyz[3])
    sine = math.sqrt(x * x + y * y + z * z)
    factor = 2.0 if sine < 1e-12 else 2 * math.atan2(sine, w) / sine
    return (factor * x, factor * y, factor * z)


def subtracts_in_turns(body: KinBody, joint: Joint) -> bool:
    """Return whether differences of a circular joint's values take the shorter arc.

    As in OpenRAVE, they do not if the parent link is static (conformance tests gap-13 and random-api-102).
    """
    return not body.links[joint.parent].static


def value_differences(body: KinBody, dofs: Iterable[int], values: Floats, others: Floats) -> Floats:
    """Return ``values - others`` [rad or m] for the DOFs ``dofs``; circular joints take the shorter arc."""
    turns = [axis.circular and subtracts_in_turns(body, joint) for joint in body.joints for axis in joint.axes]
    differences = values - others
    return np.where([turns[dof] for dof in dofs], wrapped_angle(differences), differences)


def wrapped_angle(angle: ArrayLike) -> Floats:
    """Wrap angles to (-pi, pi]."""
    return np.pi - (np.pi - np.asarray(angle, dtype=np.float64)) % (2 * np.pi)


def rezeroed(body: KinBody, T_world_links: Floats, values: Sequence[float]) -> KinBody:
    """Return a body whose present configuration is its zero configuration; limits keep their numbers.

    ``T_world_links`` are the present link poses, shape (links, 4, 4), and ``values`` the DOF values [rad or m]. The
    zero of passive joints does not change.
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
