"""Denavit-Hartenberg parameters."""

from dataclasses import dataclass

import numpy as np

from ravemj.core.arguments import checked_kind
from ravemj.core.transforms import Floats
from ravemj.rave.enums import CheckLimitsAction
from ravemj.rave.joint import Joint
from ravemj.rave.kinbody import KinBody

_PARALLEL = 1e-9
"""Tolerance below which axes count as parallel (sine of their angle) or intersecting (distance [m])."""


@dataclass(frozen=True, eq=False)
class DHParameter:
    """Denavit-Hartenberg parameters of a joint relative to the previous one, in the classical convention.

    ``transform = parent @ turn about z by theta @ move along z by d @ move along x by a @ turn about x by alpha``

    Attributes:
        joint: The joint; its axis is the z axis of its frame.
        parentindex: Index of the previous joint's record; -1 if the previous frame is the body's.
        transform: ``T_body_joint`` with all joints at 0, shape (4, 4).
        d: Distance along the previous z axis [m].
        a: Signed distance between both z axes [m], along the x axis of the joint's frame.
        theta: Angle about the previous z axis [rad], at most 90 degrees either way.
        alpha: Angle between both z axes [rad].
    """

    joint: Joint
    parentindex: int
    transform: Floats
    d: float
    a: float
    theta: float
    alpha: float


def GetDHParameters(body: KinBody) -> list[DHParameter]:
    """Return Denavit-Hartenberg parameters of all joints, parents before children.

    Args:
        body: The body; it is not changed.

    Example:
        >>> [(record.d, record.a, record.alpha) for record in planningutils.GetDHParameters(robot)]
        [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    """
    checked_kind(body, KinBody, "GetDHParameters: body")
    parameters: list[DHParameter] = []
    index_of_link: dict[int, int] = {}
    with body, body.GetEnv().simulation.lock:
        body.SetDOFValues(np.zeros(body.GetDOF()), checklimits=CheckLimitsAction.Nothing)
        body.SetTransform(np.eye(4))
        for joint in body.GetDependencyOrderedJoints():
            parent, child = joint.GetHierarchyParentLink(), joint.GetHierarchyChildLink()
            before = _before(body, parent.GetIndex() if parent else 0, index_of_link)
            start = np.eye(4) if before < 0 else parameters[before].transform
            parameters.append(_record(joint, before, start, joint.GetAnchor(), joint.GetAxis()))
            index_of_link[child.GetIndex()] = len(parameters) - 1
    return parameters


def _before(body: KinBody, link: int, index_of_link: dict[int, int]) -> int:
    """Return the index of the ``DHParameter`` of the nearest joint before a link; -1 if there is none."""
    chain = body.GetChain(0, link, returnjoints=False)
    moved = [index_of_link[joint_.GetIndex()] for joint_ in chain if joint_.GetIndex() in index_of_link]
    return moved[-1] if moved else -1


def _record(joint: Joint, before: int, start: Floats, anchor: Floats, axis: Floats) -> DHParameter:
    x, z, origin = start[:3, 0], start[:3, 2], start[:3, 3]
    normal = np.cross(z, axis)
    sine = float(np.linalg.norm(normal))
    apart = anchor - origin
    if sine < _PARALLEL:
        d = float(z @ apart)
        foot, across = anchor, apart - d * z
        direction = across
    else:
        # End points of the common normal: origin + d z on one axis, anchor + s axis on the other.
        d = float(np.cross(apart, axis) @ normal) / sine**2
        foot = anchor + axis * (float(np.cross(apart, z) @ normal) / sine**2)
        across, direction = foot - origin - d * z, normal
    length = float(np.linalg.norm(direction))
    new_x = direction / length if length > _PARALLEL else x
    if new_x @ x < -_PARALLEL:  # of both directions along the common normal that which turns x by less: 90 degrees
        new_x = -new_x
    a = float(across @ new_x)
    theta = float(np.arctan2(np.cross(x, new_x) @ z, x @ new_x))
    alpha = float(np.arctan2(np.cross(z, axis) @ new_x, z @ axis))
    transform = np.eye(4)
    transform[:3, 0], transform[:3, 1], transform[:3, 2] = new_x, np.cross(axis, new_x), axis
    transform[:3, 3] = foot
    return DHParameter(joint, before, transform, d, a, theta, alpha)
