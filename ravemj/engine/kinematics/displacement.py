"""Links put where their joints do not place them.

OpenRAVE's state are the poses of the links, and joint values are read off them. MuJoCo's are joint values, from which
``mj_kinematics`` computes the poses. Where poses are given, the joint values that they show are set, and what is left
goes into the fixed part of a link's pose in its parent, ``body_pos`` and ``body_quat``, so that the next
``mj_kinematics`` gives these poses again.
"""

import math

import numpy as np

from ravemj.core.transforms import Floats, inverse, pose_of
from ravemj.engine.kinematics.body import BodyKinematics
from ravemj.model.joints import measured_values
from ravemj.model.scene import Joint

ROUNDING = 1e-10
"""A link this far [m or in its matrix] from where its joint places it is where its joint places it."""

_VALUE_ROUNDING = 1e-12
"""The values [rad or m] of a pose are this exact, for links up to some metres apart."""


def place_links(kinematics: BodyKinematics, T_world_links: Floats, last_values: Floats) -> None:
    """Put every link at a pose; joints get the values that the poses show.

    Args:
        kinematics: The body.
        T_world_links: Shape (links, 4, 4).
        last_values: Joint values to which those of hinges are next, full turns apart [rad or m], shape (dof,).
    """
    for root, link in enumerate(kinematics.roots):
        kinematics.set_root_transform(root, T_world_links[link])
    kinematics.set_values(_shown_values(kinematics, T_world_links, last_values), clamp_mimic=False)
    placed = kinematics.link_transforms()
    if placed.size and np.abs(placed - T_world_links).max() > ROUNDING:
        _displace(kinematics, placed, T_world_links)


def _shown_values(kinematics: BodyKinematics, T_world_links: Floats, last_values: Floats) -> Floats:
    values = last_values.copy()
    poses = [pose_of(transform) for transform in T_world_links]
    for joint, first in zip(kinematics.body.joints, kinematics.first_dofs, strict=True):
        dofs = slice(first, first + len(joint.axes))
        shown = measured_values(joint, poses[joint.parent].inverse() @ poses[joint.child])
        values[dofs] = [_in_turn(joint, *pair) for pair in zip(shown, last_values[dofs].tolist(), strict=True)]
    return values


def _in_turn(joint: Joint, shown: float, last: float) -> float:
    """Return the value that a pose shows; of a hinge in the full turn that is nearest to its last value.

    It is the last value itself where only rounding is between them: values do not drift when poses are put back.
    """
    if joint.kind == "hinge" and not joint.static:
        shown += math.tau * round((last - shown) / math.tau)
    return last if abs(shown - last) < _VALUE_ROUNDING else shown


def _displace(kinematics: BodyKinematics, placed: Floats, wanted: Floats) -> None:
    """Change the fixed part of links' poses so that they come where they are wanted."""
    link_of = {body_id: link for link, body_id in enumerate(kinematics.body_ids.tolist())}
    for body_id, link in link_of.items():
        if link in kinematics.roots:
            continue
        parent = link_of[int(kinematics.model.body_parentid[body_id])]
        by_joint: Floats = inverse(placed[parent] @ kinematics.rest_transform(link)) @ placed[link]
        kinematics.displace(link, inverse(wanted[parent]) @ wanted[link] @ inverse(by_joint))
