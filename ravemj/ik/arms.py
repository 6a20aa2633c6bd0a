"""Conversion of a scene's manipulator to a chain; the only module of ``ik`` that uses scenes."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace

import numpy as np

from ravemj.core.transforms import Pose, Vec3, rotate
from ravemj.ik.chain import Chain
from ravemj.ik.numeric import NumericSolver
from ravemj.ik.redundancy import default_free, default_steps
from ravemj.ik.solver import ArmSolutions, make_solver
from ravemj.ik.tasks import Task
from ravemj.model.joints import directions_at, relative_pose
from ravemj.model.manipulators import chain as joints_between
from ravemj.model.manipulators import joint_dofs
from ravemj.model.scene import Axis, Joint, KinBody, Manipulator


def chain_of(body: KinBody, manipulator: Manipulator) -> Chain:
    """Return the joints from the base of a manipulator to its tool, in the order of ``arm_dofs``.

    Passive joints without mimic equation keep their loaded values. Joints locked later by equal limits still belong to
    the arm.

    Raises:
        ValueError: the base, the end effector or joints between them are missing, or such a joint is a mimic or
            spherical joint; the message names it.
    """
    name = f"manipulator '{manipulator.name}' of '{body.name}'"
    if manipulator.base is None or manipulator.effector is None:
        raise ValueError(f"{name} has no base or no effector link: name both in the file")
    way = joints_between(body, manipulator.base, manipulator.effector)
    if not way or not manipulator.arm_dofs:
        raise ValueError(f"{name} has no joint that moves between its base and its effector: name links farther apart")
    T_base_link = Pose()
    moving: list[tuple[bool, Axis, Vec3, Vec3]] = []
    for index in way:
        joint = body.all_joints[index]
        locked_later = index < len(body.joints) and set(joint_dofs(body, index)) <= set(manipulator.arm_dofs)
        if joint.static and not locked_later:
            T_base_link = T_base_link @ joint.T_parent_child
        elif index >= len(body.joints) and joint.mimic is None:
            T_base_link = T_base_link @ relative_pose(joint, [axis.value for axis in joint.axes])
        else:
            moving += _axes(name, joint, T_base_link)
            T_base_link = T_base_link @ relative_pose(joint, [0.0] * len(joint.axes))
    axes = [axis for _, axis, _, _ in moving]
    chain = Chain.of(
        [direction for _, _, direction, _ in moving],
        [point for _, _, _, point in moving],
        prismatic=[slides for slides, _, _, _ in moving],
        circular=[axis.circular for axis in axes],
        T_base_tool=np.array((T_base_link @ manipulator.T_effector_tool).matrix()),
        direction=manipulator.direction,
    )
    lower, upper = np.array([(axis.lower, axis.upper) for axis in axes], dtype=float).T
    return replace(chain, lower=lower, upper=upper)  # unchecked: between limits that scripts crossed is no solution


def _axes(name: str, joint: Joint, T_base_parent: Pose) -> list[tuple[bool, Axis, Vec3, Vec3]]:
    """Return for each joint axis whether it is prismatic, the axis, its direction and a point, in the base frame."""
    if joint.mimic is not None or joint.kind == "spherical":
        what = "follows other joints" if joint.mimic is not None else "is spherical"
        raise ValueError(f"joint '{joint.name}' in {name} {what}: inverse kinematics needs joints of one value each")
    directions = directions_at(joint, [0.0] * len(joint.axes))
    point = (T_base_parent @ Pose(joint.anchor)).position
    return [
        (joint.slides(index), axis, rotate(T_base_parent.wxyz, direction), point)
        for index, (axis, direction) in enumerate(zip(joint.axes, directions, strict=True))
    ]


class ArmSolver:
    """Solver cache of an arm: derives the solver on first use, and again if the arm has changed.

    Attributes:
        task: The constrained components of the tool pose.
        free: Joints of the chain to sample; None means as few as necessary.
    """

    def __init__(self, task: Task, free: Sequence[int] | None = None) -> None:
        self.task, self.free = task, free
        self._of: tuple[object, ...] = ()
        self._solver: ArmSolutions | None = None

    def solver_for(self, body: KinBody, manipulator: Manipulator) -> ArmSolutions:
        """Return the solver for the present arm; changed limits do not require a new derivation.

        Raises:
            ValueError: the arm cannot be solved; the message says why.
        """
        now = body.joints, body.passive_joints, manipulator
        if self._solver is None or any(old is not new for old, new in zip(self._of, now, strict=True)):
            chain = chain_of(body, manipulator)
            self._solver = _with_limits(self._solver, chain) or self._derived(chain)
            self._of = now
        return self._solver

    def copy(self) -> "ArmSolver":
        """Return a copy that another thread can use for similar arms at the same time."""
        other = ArmSolver(self.task, self.free)
        if self._solver is not None:
            other._of = self._of
            other._solver = replace(self._solver, numeric=NumericSolver(self._solver.chain, self.task))
        return other

    def _derived(self, chain: Chain) -> ArmSolutions:
        usual = self.free
        if usual is None and self.task is not Task.TRANSFORM:
            usual = default_free(chain, self.task.value, self.task.dof)
        solver = make_solver(chain, self.task, free=usual)
        if solver.closed is None and usual != self.free:
            solver = make_solver(chain, self.task)  # the arm with other free joints may belong to a family
        return replace(solver, steps=default_steps(chain, solver.free))


def _with_limits(solver: ArmSolutions | None, chain: Chain) -> ArmSolutions | None:
    """Return a solver with the limits of a chain; None if other properties of the chain differ."""
    if solver is None or solver.chain.reach != chain.reach or solver.chain.dof != chain.dof:
        return None
    for part in ("axes", "points", "prismatic", "T_base_tool", "direction"):
        if not np.array_equal(getattr(solver.chain, part), getattr(chain, part)):
            return None
    closed = copy(solver.closed)
    if closed is not None:
        closed.chain = chain
    return replace(solver, chain=chain, closed=closed, numeric=NumericSolver(chain, solver.task))
