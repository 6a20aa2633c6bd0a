"""Motion bounds: maximum displacement of any point of a body per unit of each DOF.

They are used in adaptive collision checking, and to compute OpenRAVE's weights and resolutions.
"""

import math

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.model.bounds import link_bounds
from ravemj.model.chains import joints_above
from ravemj.model.mimic import evaluation_order, leaders
from ravemj.model.scene import Joint, KinBody

_SAMPLES = 1000
"""Number of leader values at which the slope of a mimic equation is sampled."""


def motion_bounds(body: KinBody) -> Floats:
    """Return for each DOF the maximum displacement rate of a point of the body's shapes, over all configurations.

    The bounds are conservative: chains of links are assumed to be stretched.

    Returns:
        Metres per radian, for sliders metres per metre, shape (dof,); 0 for a DOF that moves no shape.
    """
    reaches = [_joint_reach(body, joint) for joint in body.all_joints]
    rates = _rates(body)
    largest = np.zeros(len(body.dof_axes))
    for link in range(len(body.links)):
        joints = joints_above(body, link)
        if link_bounds(body.links[link], np.eye(4)) is not None and joints:
            largest = np.maximum(largest, sum(reaches[joint] @ rates[joint] for joint in joints))
    return largest


def reach(body: KinBody) -> float:
    """Return the maximum distance [m] of a body's shapes from the origin of its first link, over all configurations."""
    return _farthest(body, 0, np.zeros(3), np.zeros(3))


def _joint_reach(body: KinBody, joint: Joint) -> Floats:
    """Return for each axis of a joint the largest distance to shapes that it moves [m]; 1 for prismatic axes."""
    if joint.kind == "slider":
        return np.ones(1)
    if joint.static or not joint.places_child:
        return np.zeros(len(joint.axes))
    axis = _direction_in_child(joint, np.array(joint.axes[0].direction)) if joint.kind == "hinge" else np.zeros(3)
    reach = _farthest(body, joint.child, _point_in_child(joint, np.array(joint.anchor)), axis)
    reach = max(0.0, reach + _stroke(joint))
    return np.array([1.0 if joint.slides(axis) else reach for axis in range(len(joint.axes))])


def _farthest(body: KinBody, link: int, point: Floats, axis: Floats) -> float:
    """Return the largest distance, perpendicular to an axis, from a point to the shapes of a link and its descendants.

    Point and axis are fixed to the link and in its frame; the axis is a unit vector, or zero for plain distances.
    """
    across = np.eye(3) - np.outer(axis, axis)
    distances = [-math.inf]
    bounds = link_bounds(body.links[link], np.eye(4))
    if bounds is not None:
        corners = np.stack(np.meshgrid(*zip(*bounds, strict=True), indexing="ij"), axis=-1).reshape(-1, 3)
        distances.append(float(np.linalg.norm((corners - point) @ across, axis=1).max()))
    for joint in body.all_joints:
        if joint.parent != link or not joint.places_child:
            continue
        if joint.static or joint.kind == "slider":
            beyond = _farthest(body, joint.child, _point_in_child(joint, point), _direction_in_child(joint, axis))
            off = _stroke(joint) * across @ joint.axes[0].direction
        else:
            anchor = np.array(joint.anchor)
            beyond = _farthest(body, joint.child, _point_in_child(joint, anchor), np.zeros(3))
            off = across @ (anchor - point)
            beyond += _stroke(joint)
        distances.append(beyond + float(np.linalg.norm(off)))
    return max(distances)


def _stroke(joint: Joint) -> float:
    """Return the largest displacement [m] of a joint's prismatic axes from their reference values; 0 for a weld."""
    if joint.static:
        return 0.0
    sliding = (axis for index, axis in enumerate(joint.axes) if joint.slides(index))
    return sum(max(abs(axis.lower - axis.reference), abs(axis.upper - axis.reference)) for axis in sliding)


def _point_in_child(joint: Joint, point: Floats) -> Floats:
    """Transform a point from a joint's parent frame to its child frame, at the joint's reference values."""
    T_child_parent = joint.T_parent_child.inverse().matrix()
    return T_child_parent[:3, :3] @ point + T_child_parent[:3, 3]


def _direction_in_child(joint: Joint, direction: Floats) -> Floats:
    """Transform a direction from a joint's parent frame to its child frame, at the joint's reference values."""
    return joint.T_parent_child.inverse().matrix()[:3, :3] @ direction


def _rates(body: KinBody) -> list[Floats]:
    """Return bounds on |d axis value / d DOF value| for each joint, as arrays of shape (axes, dof)."""
    joints, numbers, dof = body.all_joints, np.random.default_rng(0), 0
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
