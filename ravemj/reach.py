"""How far the points of a body travel when one of its DOFs moves."""

import math

import numpy as np

from ravemj.bounds import link_bounds
from ravemj.chains import all_joints, joints_above
from ravemj.following import evaluation_order, leaders
from ravemj.scene import Joint, KinBody
from ravemj.transforms import Floats

_SAMPLES = 1000
"""Values of the leaders at which the slope of an equation of a mimic joint is looked at."""


def travel(body: KinBody) -> Floats:
    """Return for each DOF how far a point of the body's shapes moves at most, at any joint values within the limits.

    Where a chain of links bends, it counts as stretched, so that the answer can be too great but not too small.

    Returns:
        Metres per radian, for sliders per metre, shape (dof,); 0 for a DOF that moves no shape.
    """
    reaches = [_joint_reach(body, joint) for joint in all_joints(body)]
    rates = _rates(body)
    found = np.zeros(len(body.dof_axes))
    for link in range(len(body.links)):
        joints = joints_above(body, link)
        if link_bounds(body.links[link], np.eye(4)) is not None and joints:
            found = np.maximum(found, sum(reaches[joint] @ rates[joint] for joint in joints))
    return found


def _joint_reach(body: KinBody, joint: Joint) -> Floats:
    """Return for each axis of a joint how far the shapes beyond it are from it at most; for a slider 1."""
    if joint.kind == "slider":
        return np.ones(1)
    if joint.static or not joint.places_child:
        return np.zeros(len(joint.axes))
    axis = _turned(joint, np.array(joint.axes[0].direction)) if joint.kind == "hinge" else np.zeros(3)
    reach = _farthest(body, joint.child, _moved(joint, np.array(joint.anchor)), axis)
    return np.full(len(joint.axes), max(0.0, reach))


def _farthest(body: KinBody, link: int, point: Floats, axis: Floats) -> float:
    """Return how far the shapes of a link and of those that hang on it get from a point, across an axis.

    Args:
        body: The body.
        link: The link that point and axis are fixed to.
        point: In the link's frame.
        axis: Unit vector through the point in the link's frame, along which nothing counts; zero for none.
    """
    across = np.eye(3) - np.outer(axis, axis)
    found = [-math.inf]
    bounds = link_bounds(body.links[link], np.eye(4))
    if bounds is not None:
        corners = np.stack(np.meshgrid(*zip(*bounds, strict=True), indexing="ij"), axis=-1).reshape(-1, 3)
        found.append(float(np.linalg.norm((corners - point) @ across, axis=1).max()))
    for joint in all_joints(body):
        if joint.parent != link or not joint.places_child:
            continue
        if joint.static or joint.kind == "slider":
            beyond = _farthest(body, joint.child, _moved(joint, point), _turned(joint, axis))
            off = _stroke(joint) * across @ joint.axes[0].direction
        else:
            anchor = np.array(joint.anchor)
            beyond = _farthest(body, joint.child, _moved(joint, anchor), np.zeros(3))
            off = across @ (anchor - point)
        found.append(beyond + float(np.linalg.norm(off)))
    return max(found)


def _stroke(joint: Joint) -> float:
    """Return how far a slider gets from where ``T_parent_child`` holds; 0 for a weld."""
    (axis, *_) = joint.axes
    return 0.0 if joint.static else max(abs(axis.lower - axis.reference), abs(axis.upper - axis.reference))


def _moved(joint: Joint, point: Floats) -> Floats:
    """Return a point of a joint's parent in the frame of the child, at the joint's reference."""
    T_child_parent = joint.T_parent_child.inverse().matrix()
    return T_child_parent[:3, :3] @ point + T_child_parent[:3, 3]


def _turned(joint: Joint, direction: Floats) -> Floats:
    """Return a direction in a joint's parent in the frame of the child, at the joint's reference."""
    return joint.T_parent_child.inverse().matrix()[:3, :3] @ direction


def _rates(body: KinBody) -> list[Floats]:
    """Return how fast each axis of each joint moves at most per unit of each DOF: arrays of shape (axes, dof)."""
    joints, numbers, dof = all_joints(body), np.random.default_rng(0), 0
    rates = [np.zeros((len(joint.axes), len(body.dof_axes))) for joint in joints]
    samples: dict[str, Floats] = {}
    for index, joint in enumerate(joints):
        axis = joint.axes[0]
        low, high = (-math.pi, math.pi) if axis.circular else (axis.lower, axis.upper)
        samples[f"joint{index}"] = np.concatenate([[low, high], numbers.uniform(low, high, _SAMPLES)])
        if index < len(body.joints):
            rates[index][:, dof : dof + len(joint.axes)] = np.eye(len(joint.axes))
            dof += len(joint.axes)
    for index in evaluation_order({index: joint.mimic for index, joint in enumerate(joints) if joint.mimic}):
        equation = joints[index].equation
        if equation is None:
            continue
        for leader in leaders(equation):
            slopes = np.abs(equation.derivative(f"joint{leader}").evaluate_many(samples))
            rates[index][0] += np.max(slopes, initial=0.0, where=np.isfinite(slopes)) * rates[leader][0]
    return rates
