"""Links that follow the pointer by inverse kinematics: the arm comes along."""

import numpy as np

from ravemj.core.transforms import Floats, Pose, inverse
from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.dragging import Follow, in_plane
from ravemj.gui.interaction.viewpoint import Ray
from ravemj.ik.arms import chain_of
from ravemj.ik.numeric import NumericSolver
from ravemj.model.chains import joint_dofs
from ravemj.model.manipulators import chain
from ravemj.model.scene import KinBody, Manipulator

_TURNING = 0.03
"""How much turning by 1 rad counts beside a distance as long as the arm: where both cannot be, the point is reached."""


def reach(body: BodyState, link: int, point: Floats, normal: Floats) -> Follow:
    """Let a point of a link follow the pointer in a plane, by the joints above it, as far as their limits go.

    The link keeps its orientation where the joints can do that, too. Goals out of reach are come as near to as can be.

    Args:
        body: The body.
        link: Index of the link.
        point: What the pointer holds, in the world [m], shape (3,).
        normal: Normal of the plane, unit vector, shape (3,).

    Raises:
        ValueError: no joints move the link, or one of them follows others or is spherical; the message says so.
    """
    T_start = body.link_transform(link)
    base = _root_of(body.scene, link)
    arm = _arm_to(body.scene, base, link, (point - T_start[:3, 3]) @ T_start[:3, :3])
    solver = NumericSolver(chain_of(body.scene, arm))
    dofs = list(arm.arm_dofs)
    T_start[:3, 3] = point
    weights = np.array([1.0, 1.0, 1.0, _TURNING, _TURNING, _TURNING])

    def follow(pointer: Ray) -> None:
        goal = in_plane(pointer, point, normal)
        if goal is None:
            return
        T_world_tool = T_start.copy()
        T_world_tool[:3, 3] = goal
        T_base_tool = inverse(body.link_transform(base)) @ T_world_tool
        values = body.kinematics.values()
        values[dofs] = solver.nearest(T_base_tool, values[dofs], weights).values
        body.set_values(values)

    return follow


def _arm_to(body: KinBody, base: int, link: int, place: Floats) -> Manipulator:
    """Return the arm from one link to a point of another, in that link [m], shape (3,)."""
    way = chain(body, base, link) or []
    moving = [index for index in way if index < len(body.joints) and not body.joints[index].static]
    if not moving:
        raise ValueError(f"no joint moves {body.links[link].name}")
    x, y, z = place.tolist()
    return Manipulator(
        name=body.links[link].name,
        base=base,
        effector=link,
        T_effector_tool=Pose((x, y, z)),
        direction=(0.0, 0.0, 1.0),
        arm_dofs=tuple(dof for index in moving for dof in joint_dofs(body, index)),
        gripper_joints=(),
        gripper_dofs=(),
        chucking_direction=(),
        source=body.links[link].source,
    )


def _root_of(body: KinBody, link: int) -> int:
    """Return the link that the chain of joints to a link begins with."""
    above = {joint.child: joint.parent for joint in body.all_joints if joint.places_child}
    while link in above:
        link = above[link]
    return link
