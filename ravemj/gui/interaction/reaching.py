"""Drags of links by inverse kinematics."""

import math

import numpy as np

from ravemj.core.transforms import Floats, Pose, inverse
from ravemj.engine.simulation import BodyState
from ravemj.gui.interaction.dragging import in_plane
from ravemj.gui.interaction.viewpoint import ViewRay
from ravemj.ik.arms import chain_of
from ravemj.ik.self_motion import null_space
from ravemj.ik.solver import make_solver
from ravemj.ik.tasks import Task
from ravemj.model import drawing
from ravemj.model.chains import joint_dofs
from ravemj.model.drawing import NOTHING, Primitives
from ravemj.model.manipulators import chain
from ravemj.model.scene import KinBody, Manipulator

_TURNING = 0.03
"""Weight of an orientation error of 1 rad relative to a position error of the arm's length: position has priority."""

_WEIGHTS = np.array([1.0, 1.0, 1.0, _TURNING, _TURNING, _TURNING])
_SWEEP = 0.08
"""Length of a null-space motion per wheel step [rad]."""

_MOST_STEPS = 100
"""Maximum number of null-space steps towards a value of the redundant joint."""

_CLOSE = 1e-4
"""Accuracy at which the redundant joint has reached its value [rad or m]."""

_STUCK = 0.1
"""Minimum motion of the redundant joint, as a fraction of a step; below it, limits of other joints stop the arm."""

_SAME = 0.05
"""Maximum difference of joint values [rad or m] of solutions that are drawn as one."""

_GHOST = np.array([0.3, 0.4, 0.75, 0.75])
_WIDTH = 6.0


class Reach:
    """An inverse-kinematics drag: a point of a link follows the pointer by the joints above it, within their limits.

    The link keeps its orientation if possible. If the goal is out of reach, the link goes to the nearest pose.

    Attributes:
        body: The body.
        link: Index of the link.
    """

    def __init__(self, body: BodyState, link: int, point: Floats, normal: Floats) -> None:
        """Start the drag of a link.

        Args:
            body: The body.
            link: Index of the link.
            point: The grabbed point, in the world [m], shape (3,).
            normal: Normal of the drag plane, unit vector, shape (3,).

        Raises:
            ValueError: no joints move the link, or one of them is a mimic or spherical joint; the message says so.
        """
        self.body, self.link = body, link
        self._point, self._normal = point, normal
        self._T_world_goal = body.link_transform(link)
        place = (point - self._T_world_goal[:3, 3]) @ self._T_world_goal[:3, :3]
        self._T_world_goal[:3, 3] = point
        self._base = _root_of(body.scene, link)
        arm = _arm_to(body.scene, self._base, link, place)
        self._solver = make_solver(chain_of(body.scene, arm), Task.TRANSFORM)
        self._dofs = list(arm.arm_dofs)
        self._free = self._free_joint()

    def _free_joint(self) -> int | None:
        """Return the index of the redundant joint, the one that moves most in the null space; None if there is none."""
        if self._solver.free:
            return self._solver.free[0]
        chain = self._solver.chain
        values = np.random.default_rng(0).uniform(-1.0, 1.0, chain.dof)  # away from singular configurations
        basis = null_space(chain, np.clip(values, *chain.bounds))
        return int(np.argmax(np.linalg.norm(basis, axis=1))) if basis.size else None

    @property
    def free_dof(self) -> int | None:
        """The DOF of the redundant joint, or None."""
        return None if self._free is None else self._dofs[self._free]

    @property
    def _values(self) -> Floats:
        return self.body.kinematics.values()[self._dofs]

    def follow(self, ray: ViewRay) -> None:
        """Move the link's grabbed point towards the intersection of the pointer's ray and the drag plane."""
        goal = in_plane(ray, self._point, self._normal)
        if goal is not None:
            self._T_world_goal[:3, 3] = goal
            self._come_near(self._values)

    def _come_near(self, start: Floats) -> None:
        """Move the arm as near to the goal as a numeric search from ``start`` gets."""
        T_base_goal = inverse(self.body.link_transform(self._base)) @ self._T_world_goal
        values = self.body.kinematics.values()
        values[self._dofs] = self._solver.numeric.nearest(T_base_goal, start, _WEIGHTS).values
        self.body.set_values(values)

    def sweep(self, steps: float) -> None:
        """Move a redundant arm in its null space by wheel steps; other arms stay."""
        if self._free is not None:
            self._come_near(self._values + _SWEEP * steps * self._self_motion(self._free))

    def sweep_to(self, value: float) -> None:
        """Move the redundant joint to a value [rad or m] while the link keeps its pose, as far as limits permit."""
        free = self._free
        if free is None:
            return
        start = self._values
        T_world_base, placed = self.body.link_transform(self._base), self._solver.chain.forward(start)
        self._T_world_goal = T_world_base @ placed
        for _ in range(_MOST_STEPS):
            values, along = self._values, self._self_motion(free)
            missing = value - float(values[free])
            if self._solver.chain.circular[free]:
                missing = math.remainder(missing, math.tau)
            rate = float(along[free])
            if abs(missing) < _CLOSE or rate <= 0:
                return
            step = math.copysign(min(abs(missing) / rate, _SWEEP), missing)
            self._come_near(values + step * along)
            if abs(float(self._values[free] - values[free])) < _STUCK * abs(step) * rate:
                return

    def _self_motion(self, free: int) -> Floats:
        """Return the unit null-space velocity in which joint ``free`` moves most; zeros if it cannot move."""
        basis = null_space(self._solver.chain, self._values)
        along = basis @ basis[free]
        return along / max(float(np.linalg.norm(along)), np.finfo(float).tiny)

    def ghosts(self) -> Primitives:
        """Return drawings of the other IK solutions for the link's present pose: lines from joint to joint.

        They are closed-form solutions with the present value of the redundant joint; none if there is no closed form.
        Drawings of solid links would take megabytes per second, since pages receive all drawings with every frame.
        """
        solver, values = self._solver, self._values
        if solver.closed is None:
            return NOTHING
        T_base_tool = solver.chain.forward(values)
        free = values[list(solver.free)][None] if solver.free else None
        rows = solver.solve(T_base_tool[None], free=free).of(0)
        others = rows[np.abs(rows - values).max(axis=1, initial=0.0) > _SAME]
        if not len(others):
            return NOTHING
        joints = solver.chain.placed_axes(others)[1].transpose(1, 0, 2)  # row, joint, xyz
        tools = np.broadcast_to(T_base_tool[:3, 3], (len(others), 1, 3))
        arms = [_ghost(points) for points in np.concatenate([joints, tools], axis=1)]
        return drawing.merge(arms).placed(self.body.link_transform(self._base))


def _ghost(points: Floats) -> Primitives:
    """Return a drawing of the arm in another configuration, as lines between ``points``."""
    colours = np.tile(_GHOST, (len(points), 1))
    return drawing.merge([drawing.line_strip(points, _WIDTH, colours), drawing.points(points, 2 * _WIDTH, colours)])


def _arm_to(body: KinBody, base: int, link: int, place: Floats) -> Manipulator:
    """Return a manipulator from link ``base`` to the point ``place`` [m] of ``link``.

    Raises:
        ValueError: no joint moves the link.
    """
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
    """Return the first link of the kinematic chain to a link."""
    above = {joint.child: joint.parent for joint in body.all_joints if joint.places_child}
    while link in above:
        link = above[link]
    return link
