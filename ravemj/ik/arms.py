"""Conversion of a scene's manipulator to a chain; the only module of ``ik`` that uses scenes."""

from collections.abc import Sequence
from copy import copy
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from ravemj.core.transforms import Floats, Pose, Vec3, rotate
from ravemj.ik.chain import Chain
from ravemj.ik.following import FollowingChain
from ravemj.ik.numeric import NumericSolver
from ravemj.ik.redundancy import default_free, default_steps
from ravemj.ik.solver import ArmSolutions, make_solver
from ravemj.ik.tasks import Task
from ravemj.model.joints import directions_at, relative_pose
from ravemj.model.manipulators import chain as joints_between
from ravemj.model.manipulators import joint_dofs
from ravemj.model.mimic import MimicJoints
from ravemj.model.scene import Axis, Joint, KinBody, Manipulator


class _MovingAxis(NamedTuple):
    """Joint axis of an arm: its index in the body, and its line in the base frame.

    Attributes:
        joint: Index of the joint among the active, then the passive joints of the body.
        number: Index of the axis in the joint.
        axis: Limits and other properties of the axis.
        slides: Whether the axis is prismatic.
        direction: Unit vector along the axis.
        point: A point on the axis [m].
    """

    joint: int
    number: int
    axis: Axis
    slides: bool
    direction: Vec3
    point: Vec3


def chain_of(body: KinBody, manipulator: Manipulator) -> Chain:
    """Return the chain from the base of a manipulator to its tool; its variables are in the order of ``arm_dofs``.

    Passive joints without mimic equation keep their loaded values. Joints locked later by equal limits still belong to
    the arm.

    Raises:
        ValueError: the manipulator has no base or end effector, or no joints between them, or one of the joints is
            spherical; the message says which.
    """
    name = f"manipulator '{manipulator.name}' of '{body.name}'"
    if manipulator.base is None or manipulator.effector is None:
        raise ValueError(f"{name} has no base or no effector link: name both in the file")
    way = joints_between(body, manipulator.base, manipulator.effector)
    if not way or not manipulator.arm_dofs:
        raise ValueError(f"{name} has no joint that moves between its base and its effector: name links farther apart")
    T_base_link = Pose()
    moving: list[_MovingAxis] = []
    for index in way:
        joint = body.all_joints[index]
        locked_later = index < len(body.joints) and set(joint_dofs(body, index)) <= set(manipulator.arm_dofs)
        if joint.static and not locked_later:
            T_base_link = T_base_link @ joint.T_parent_child
        elif index >= len(body.joints) and joint.mimic is None:
            T_base_link = T_base_link @ relative_pose(joint, [axis.value for axis in joint.axes])
        else:
            moving += _axes(name, index, joint, T_base_link)
            T_base_link = T_base_link @ relative_pose(joint, [0.0] * len(joint.axes))
    T_base_tool = np.array((T_base_link @ manipulator.T_effector_tool).matrix())
    chain = _made(moving, T_base_tool, manipulator.direction)
    if all(body.all_joints[moved.joint].mimic is None for moved in moving):
        return chain
    return _following(body, manipulator, chain, moving)


def _made(moving: Sequence[_MovingAxis], T_base_tool: Floats, direction: Vec3) -> Chain:
    axes = [moved.axis for moved in moving]
    chain = Chain.of(
        [moved.direction for moved in moving],
        [moved.point for moved in moving],
        prismatic=[moved.slides for moved in moving],
        circular=[axis.circular for axis in axes],
        T_base_tool=T_base_tool,
        direction=direction,
    )
    lower, upper = np.array([(axis.lower, axis.upper) for axis in axes], dtype=float).T
    return replace(chain, lower=lower, upper=upper)  # unchecked: between limits that scripts crossed is no solution


def _axes(name: str, index: int, joint: Joint, T_base_parent: Pose) -> list[_MovingAxis]:
    """Return the axes of a joint, in the base frame of the arm, at joint values of 0."""
    if joint.kind == "spherical":
        message = f"joint '{joint.name}' in {name} is spherical: inverse kinematics needs joints of one value each"
        raise ValueError(message)
    directions = directions_at(joint, [0.0] * len(joint.axes))
    point = (T_base_parent @ Pose(joint.anchor)).position
    return [
        _MovingAxis(index, number, axis, joint.slides(number), rotate(T_base_parent.wxyz, direction), point)
        for number, (axis, direction) in enumerate(zip(joint.axes, directions, strict=True))
    ]


def _following(body: KinBody, manipulator: Manipulator, inner: Chain, moving: Sequence[_MovingAxis]) -> FollowingChain:
    """Wrap a chain that contains mimic joints, ``inner``, as a chain whose only variables are the arm's DOFs."""
    places = {
        dof: (index, dofs.index(dof))
        for index in range(len(body.joints))
        for dofs in [joint_dofs(body, index)]
        for dof in dofs
    }
    own = [places[dof] for dof in manipulator.arm_dofs]
    known = {(moved.joint, moved.number): moved for moved in moving}
    variables = [known.get(place) or _aside(body, *place) for place in own]
    outer = _made(variables, inner.T_base_tool, manipulator.direction)
    columns = [own.index(place) if place in own else -1 for place in known]
    followers = _Followers(body.all_joints, own, columns, [moved.joint for moved in moving])
    return FollowingChain(
        inner=inner, expand=followers, **{part.name: getattr(outer, part.name) for part in fields(Chain)}
    )


def _aside(body: KinBody, joint: int, number: int) -> _MovingAxis:
    """Return the axis of a DOF that moves the arm only through mimic joints; its line is a placeholder."""
    followed = body.all_joints[joint]
    return _MovingAxis(joint, number, followed.axes[number], followed.slides(number), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))


class _Followers:
    """Function from the DOFs of an arm to the values of all its joints, by mimic equations.

    Args:
        joints: All joints of the body; those that do not belong to the arm keep their loaded values.
        own: For each DOF, its joint and the index of its axis in the joint.
        columns: For each joint axis of the arm, the index of its DOF; -1 for mimic joints.
        indices: For each joint axis of the arm, the index of its joint.
    """

    def __init__(
        self, joints: Sequence[Joint], own: list[tuple[int, int]], columns: list[int], indices: list[int]
    ) -> None:
        self._arguments = joints, own, columns, indices
        self._mimic = MimicJoints(joints)
        self._first = [joint.axes[0].value for joint in joints]

    def __reduce__(self) -> tuple[type["_Followers"], tuple[object, ...]]:
        return _Followers, self._arguments

    def __call__(self, values: Floats) -> Floats:
        _, own, columns, indices = self._arguments
        first, given = list(self._first), values.tolist()
        for (joint, number), value in zip(own, given, strict=True):
            if not number:
                first[joint] = value
        self._mimic.evaluate(first)
        pairs = zip(columns, indices, strict=True)
        return np.array([first[index] if column < 0 else given[column] for column, index in pairs])


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
        """Return the solver for the present arm; if only limits changed, it is not derived again.

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
        if usual is None and self.task is not Task.TRANSFORM and not isinstance(chain, FollowingChain):
            usual = default_free(chain, self.task.value, self.task.dof)
        solver = make_solver(chain, self.task, free=usual)
        if solver.closed is None and usual != self.free:
            solver = make_solver(chain, self.task)  # the arm with other free joints may belong to a family
        return replace(solver, steps=default_steps(chain, solver.free))


def _with_limits(solver: ArmSolutions | None, chain: Chain) -> ArmSolutions | None:
    """Return ``solver`` with the joint limits of ``chain``; None if the chains differ in anything else."""
    if solver is None or isinstance(chain, FollowingChain) or isinstance(solver.chain, FollowingChain):
        return None
    if solver.chain.reach != chain.reach or solver.chain.dof != chain.dof:
        return None
    for part in ("axes", "points", "prismatic", "T_base_tool", "direction"):
        if not np.array_equal(getattr(solver.chain, part), getattr(chain, part)):
            return None
    closed = copy(solver.closed)
    if closed is not None:
        closed.chain = chain
    return replace(solver, chain=chain, closed=closed, numeric=NumericSolver(chain, solver.task))
