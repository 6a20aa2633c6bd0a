"""Inverse kinematics of an arm."""

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_rows, checked_vector
from ravemj.core.transforms import Floats, inverse, pose_of
from ravemj.engine.collision.moving import Among, batch_collides
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions.ik_parameterization import goal_of_tool, goal_transform, moved_goal
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType, goal_size
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.tool import Tool
from ravemj.model import hashes, scene
from ravemj.rave.ik_options import split_options
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.iksolver import IkSolver, task_of
from ravemj.rave.solver_names import named_in_file
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization

if TYPE_CHECKING:
    from ravemj.ik import ArmSolutions
    from ravemj.rave.robot import Robot


_LOG = logging.getLogger("ravemj")
_Type = IkParameterizationType

WITH_DIRECTION = {
    _Type.Direction3D,
    _Type.Ray4D,
    _Type.TranslationDirection5D,
}
"""Goal types that depend on the direction of the tool."""

_GONE = 1 << 30
"""Index of a removed manipulator, larger than any valid one."""


class IkBatch(NamedTuple):
    """IK solutions of many goals, by branch.

    Attributes:
        solutions: Joint values [rad or m], shape (N, B, n); invalid rows have arbitrary values.
        valid: Whether each row is a solution, shape (N, B).
        branches: A name for each of the B branches of solutions.
    """

    solutions: Floats
    valid: NDArray[np.bool_]
    branches: list[str]


class BatchSolutions(NamedTuple):
    """All IK solutions of many goals.

    Attributes:
        values: Joint values [rad or m], shape (N, K, n); rows after the last solution of a goal are NaN.
        valid: Whether each row is a solution, shape (N, K).
    """

    values: Floats
    valid: NDArray[np.bool_]


class ArmIk(ApiObject):
    """Base of ``Manipulator`` with the tool pose, inverse kinematics, and motions that keep a goal."""

    _often_called = ("__init__",)

    _internal = (
        "description",
        "goals_in_base",
        "moved_up",
        "search",
    )

    def __init__(self, robot: "Robot", state: BodyState, index: int) -> None:
        self._robot = robot
        self._state = state
        self._index = index
        self._known: Tool | None = None

    @property
    def _scene(self) -> scene.Manipulator:
        try:
            return self._state.scene.manipulators[self._index]
        except IndexError:
            message = f"'{self._robot.GetName()}' does not have this manipulator any more"
            raise RavemjError(message, ErrorCode.InvalidState) from None

    @property
    def description(self) -> scene.Manipulator:
        """The manipulator in the scene."""
        return self._scene

    def moved_up(self, removed: int) -> None:
        """Update this manipulator's index after the removal of the one with index ``removed``, perhaps this one."""
        if self._index >= removed:
            self._index = _GONE if self._index == removed else self._index - 1

    def GetName(self) -> str:
        """Return the manipulator's name."""
        return self._scene.name

    def GetTransform(self) -> Floats:
        """Return the pose of the tool in the world.

        Returns:
            ``T_world_tool``, shape (4, 4): that of the effector times the local tool transform.

        Raises:
            openrave_exception: the manipulator has no effector.
        """
        with self._state.simulation.lock:
            return self._tool().pose(self._state)

    GetEndEffectorTransform = GetGraspTransform = GetTransform

    def _tool(self) -> Tool:
        """Return the tool and the joints as arrays, cached until the manipulator's description changes."""
        arm = self._scene
        if self._known is None or self._known.arm is not arm:
            self._known = Tool.for_arm(arm)
        return self._known

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Manipulator
        with self._state.simulation.lock:
            arms = list(self._state.scene.manipulators)
            arms[self._index] = replace(self._scene, **changes)
            self._state.edit(manipulators=tuple(arms))

    # Solvers

    def GetIkSolver(self) -> IkSolver | None:
        """Return the arm's IK solver, or None if it has none.

        The first call makes the solver that the file names by ``<iksolver>``: a name with ``ikfast`` selects a solver
        for poses or, with five joints, for the tool's position and direction.
        """
        solver = self._robot.ik_solvers.get(self._scene.name)
        if solver is None and self._scene.ik_solver:
            named = named_in_file(self._scene.ik_solver, len(self._scene.arm_dofs))
            if named is not None:
                kind, steps = named
                self.SetIkSolver(IkSolver(self._robot.GetEnv(), self._scene.ik_solver, kind, steps=steps))
                return self._robot.ik_solvers.get(self._scene.name)
        return solver

    def SetIkSolver(self, iksolver: IkSolver | None) -> bool:
        """Set the IK solver.

        Args:
            iksolver: A solver of ``RaveCreateIkSolver``; None removes the solver.

        Returns:
            Whether the solver fits the arm; if not, a warning says why.
        """
        if iksolver is None:
            self._robot.ik_solvers.pop(self._scene.name, None)
            if self._scene.ik_solver:
                self._edit(ik_solver="")
            return True
        solver = checked_kind(iksolver, IkSolver, "SetIkSolver: iksolver")
        try:
            solver.attach(self._robot, self._scene.name)
        except ValueError as error:
            _LOG.warning("%s", error)
            return False
        self._robot.ik_solvers[self._scene.name] = solver
        return True

    SetIKSolver = SetIkSolver

    def _solver(self, caller: str, code: ErrorCode = ErrorCode.Failed) -> IkSolver:
        solver = self.GetIkSolver()
        if solver is None:
            message = f"{caller}: manipulator '{self._scene.name}' has no solver of inverse kinematics"
            if self._scene.ik_solver:
                message += f", since there is none of the name '{self._scene.ik_solver}' that the file has"
            hint = "databases.inversekinematics.InverseKinematicsModel(...).load() makes it"
            raise RavemjError(f"{message}; {hint}", code)
        return solver

    def GetNumFreeParameters(self) -> int:
        """Return the number of free joints, which are sampled because the arm has more joints than the goal needs."""
        return self._solver("GetNumFreeParameters", ErrorCode.Assert).GetNumFreeParameters()  # random-api-51

    def GetFreeParameters(self) -> Floats:
        """Return the present values of the free joints as fractions of their ranges, from 0 to 1, shape (k,)."""
        return self._solver("GetFreeParameters").GetFreeParameters()

    @overload
    def FindIKSolution(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: Literal[False] = ...,
        **named: Any,  # noqa: ANN401 - those of the implementation
    ) -> Floats | None: ...
    @overload
    def FindIKSolution(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: bool,
        **named: Any,  # noqa: ANN401 - those of the implementation
    ) -> Floats | IkReturn | None: ...

    def FindIKSolution(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: bool = False,
        releasegil: bool = False,
        ikFailureAccumulator: list[IkFailureInfo] | None = None,
        **named: object,
    ) -> Floats | IkReturn | None:
        """Return the IK solution nearest to the present joint values.

        ``FindIKSolution(param, filteroptions)`` or ``FindIKSolution(param, freevalues, filteroptions)``. The robot does
        not move.

        Args:
            param: ``T_world_tool``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]; or an ``IkParameterization`` in the world.
            arguments: Optionally the values of the free joints as fractions of their ranges, shape (k,); then
                ``IkFilterOptions`` combined with ``|``. With 0, solutions are within the limits, without
                self-collisions, and accepted by the filters.
            ikreturn: Whether to return an ``IkReturn``, which also has the reasons of a failure.
            releasegil: Not used.
            ikFailureAccumulator: A list that receives an ``IkFailureInfo`` for each rejected solution.
            named: The same as ``arguments``, by name.

        Returns:
            Joint values [rad or m] in the order of ``GetArmIndices()``, shape (n,); None if there is no solution.

        Raises:
            openrave_exception: the arm has no solver; the goal is invalid, or its type differs from the solver's.

        Example:
            >>> model = databases.inversekinematics.InverseKinematicsModel(robot, IkParameterization.Type.Transform6D)
            >>> model.load()
            True
            >>> values = manip.FindIKSolution(T_world_tool, IkFilterOptions.CheckEnvCollisions)
            >>> robot.SetDOFValues(values, manip.GetArmIndices())
        """
        del releasegil
        arguments, ikreturn = _without_flag(arguments, ikreturn)
        shares, options = split_options("FindIKSolution", arguments, named, "freevalues")
        solver = self._solver("FindIKSolution")
        with self._state.simulation.lock:
            goal = self._in_base(param)
            if ikreturn or ikFailureAccumulator is not None:
                answer = solver.find_one(goal, shares, options, failures=ikFailureAccumulator)
                return answer if ikreturn else None if answer.GetAction() else answer.GetSolution()
            return solver.search(goal, shares, options).nearest()

    @overload
    def FindIKSolutions(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: Literal[False] = ...,
        **named: Any,  # noqa: ANN401 - those of the implementation
    ) -> Floats: ...
    @overload
    def FindIKSolutions(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: bool,
        **named: Any,  # noqa: ANN401 - those of the implementation
    ) -> Floats | list[IkReturn]: ...

    def FindIKSolutions(
        self,
        param: ArrayLike | IkParameterization,
        *arguments: object,
        ikreturn: bool = False,
        releasegil: bool = False,
        ikFailureAccumulator: list[IkFailureInfo] | None = None,
        **named: object,
    ) -> Floats | list[IkReturn]:
        """Return all IK solutions of a goal.

        Free joints are sampled from 0 to their limits. If the range of a joint exceeds a turn, all turns are returned.
        If no sample has an accepted solution, values between the samples are tried.

        Args:
            param: The goal, as for ``FindIKSolution``; so are the other arguments.
            arguments: Optionally the values of the free joints; then ``IkFilterOptions``.
            ikreturn: Whether to return a list of ``IkReturn``.
            releasegil: Not used.
            ikFailureAccumulator: A list that receives an ``IkFailureInfo`` for each rejected solution.
            named: The same as ``arguments``, by name.

        Returns:
            Joint values [rad or m], a solution in each row, shape (K, n); shape (0,) if there is none. With
            ``ikreturn`` a list.
        """
        del releasegil
        arguments, ikreturn = _without_flag(arguments, ikreturn)
        shares, options = split_options("FindIKSolutions", arguments, named, "freevalues")
        solver = self._solver("FindIKSolutions")
        with self._state.simulation.lock:
            goal = self._in_base(param)
            if ikreturn or ikFailureAccumulator is not None:
                answers = solver.find_all(goal, shares, options, ikFailureAccumulator)
                if ikreturn:
                    return answers
                rows = np.array([answer.GetSolution() for answer in answers])
            else:
                rows = np.array(solver.search(goal, shares, options).every())
            return rows if len(rows) else np.zeros(0)

    def search(self, param: ArrayLike | IkParameterization, options: int) -> ArmSearch:
        """Return an IK search for a goal in the world; the arm must have a solver."""
        with self._state.simulation.lock:
            return self._solver("search").search(self._in_base(param), None, options)

    def _in_base(self, param: ArrayLike | IkParameterization) -> IkParameterization | Floats:
        """Transform a goal, given in the world, to the frame of the arm's base; an array is a pose (4, 4)."""
        T_base_world = inverse(self._T_world_base())
        if isinstance(param, IkParameterization):
            return param.Transform(T_base_world)
        return T_base_world @ goal_transform(param, "param")

    # Many goals at once

    def ik_solver(self, iktype: IkParameterizationType = _Type.Transform6D) -> "ArmSolutions":
        """Return the solver of the arm, derived on first use.

        Args:
            iktype: The type of goal.

        Raises:
            openrave_exception: the arm cannot be solved, or goals of that type are not supported.

        Example:
            >>> print(manip.ik_solver().describe())
        """
        from ravemj.ik.arms import ArmSolver

        solver = self.GetIkSolver()
        try:
            if solver is not None and solver.kind == iktype:
                return solver.derived()
            kept = self._robot.arm_solvers
            own = kept.setdefault((self._scene.name, _Type(iktype)), ArmSolver(task_of(_Type(iktype))))
            return own.solver_for(self._state.scene, self._scene)
        except ValueError as error:
            raise ArgumentError(str(error)) from error

    def ik(
        self, goals: ArrayLike, iktype: IkParameterizationType = _Type.Transform6D, *, limits: bool = True
    ) -> IkBatch:
        """Return the IK solutions of many goals, without collision checks.

        Solutions that differ by full turns of a joint are returned once.

        Args:
            goals: ``T_world_tool``, shape (N, 4, 4) or (4, 4); for other types the values of the goals, shape (N, k).
            iktype: The type of goal.
            limits: Whether only solutions within the limits are valid; else angles are in [-pi, pi].

        Example:
            >>> found = manip.ik(T_world_tools)
            >>> found.solutions[0][found.valid[0]]  # all solutions of the first goal
        """
        from ravemj.ik.candidates import branch_names

        solver = self.ik_solver(iktype)
        local = self.goals_in_base(goals, iktype)
        try:
            with self._state.simulation.lock:
                solutions = solver.solve(local, limits=limits)
        except ValueError as error:
            raise ArgumentError(f"goals: {error}") from error
        return IkBatch(solutions.values, solutions.valid, branch_names(solver, solutions.values.shape[1]))

    def batch_solutions(
        self,
        poses: ArrayLike,
        free: ArrayLike | None = None,
        limits: bool = True,
        collisions: bool = False,
        iktype: IkParameterizationType = _Type.Transform6D,
    ) -> BatchSolutions:
        """Return the solutions of ``FindIKSolutions`` for many goals, in the same order.

        Goals without a solution at the samples of free joints take longer, since values between the samples are tried;
        ``free`` prevents that.

        Args:
            poses: ``T_world_tool``, shape (N, 4, 4); for other types the values of the goals, shape (N, k).
            free: Values of the free joints [rad or m], shape (K, k), all tried for every goal; by default their
                samples.
            limits: Whether to enforce joint limits. Without them, angles are in [-pi, pi].
            collisions: Whether to reject solutions in which moved links or grabbed bodies collide with other bodies or
                the robot. The other joints keep their present values.
            iktype: The type of goal.

        Raises:
            ArgumentError: a shape is wrong, a number is not finite, or the arm cannot be solved.

        Example:
            >>> values, valid = manip.batch_solutions(T_world_tools, collisions=True)
            >>> reached = valid.any(axis=1)
        """
        from ravemj.ik.batches import padded, solve_each

        solver, goals = self.ik_solver(iktype), self.goals_in_base(poses, iktype)
        given = None if free is None else checked_rows(free, len(solver.free), "batch_solutions: free")
        try:
            rows, sources = solve_each(solver, goals, free=given, limits=limits)
        except ValueError as error:
            raise ArgumentError(f"batch_solutions: poses: {error}") from error
        if collisions:
            with self._state.simulation.lock:
                free_of_collisions = ~batch_collides(self._state, rows, Among(dofs=self._scene.arm_dofs))
            rows, sources = rows[free_of_collisions], sources[free_of_collisions]
        return BatchSolutions(*padded(rows, sources, len(goals)))

    def goals_in_base(self, goals: ArrayLike, iktype: IkParameterizationType) -> Floats:
        """Return goals in the frame of the arm's base, shape (N, 4, 4), or (N, k) for other types than poses."""
        T_base_world = inverse(self._T_world_base())
        given = checked_numbers(goals, "ik: goals")
        size = (4, 4) if iktype == _Type.Transform6D else (goal_size(iktype),)
        if given.shape[-len(size) :] != size or given.ndim > len(size) + 1:
            wanted = f"(N, {', '.join(map(str, size))}) for goals of type {_Type(iktype).name}"
            raise ArgumentError(f"ik: goals: has shape {given.shape}, and should have shape {wanted}")
        if iktype == _Type.Transform6D:
            return T_base_world @ given.reshape(-1, 4, 4)
        rows = given.reshape(-1, goal_size(iktype))
        return np.array([moved_goal(iktype, row, pose_of(T_base_world)) for row in rows]).reshape(rows.shape)

    def GetIkParameterization(
        self, iktype: IkParameterizationType | IkParameterization | int, inworld: bool = True
    ) -> IkParameterization:
        """Return the present tool pose as a goal.

        Args:
            iktype: The type of the goal; or a goal of that type, whose tool point and custom values are kept. For a
                look-at point, its projection onto the tool ray is used.
            inworld: Whether the goal is in the world frame; False means the arm's base frame.
        """
        like = iktype if isinstance(iktype, IkParameterization) else None
        kind = _Type(iktype if like is None else like.GetType())
        if kind not in GOAL_TYPES:
            raise ArgumentError(f"GetIkParameterization: iktype is {kind.name}, and should be a type of goal")
        T_world_base = self._T_world_base()
        T_frame_tool, in_base = self.GetTransform(), not inworld or "Angle" in kind.name
        if in_base:
            T_frame_tool = inverse(T_world_base) @ T_frame_tool
        direction = np.array(self._scene.direction)
        values = goal_of_tool(kind, T_frame_tool, direction, None if like is None else like.GetValues())
        if in_base and inworld:  # angles to the axes of the base
            values = moved_goal(kind, values, pose_of(T_world_base))
        goal = IkParameterization() if like is None else IkParameterization(like)
        goal.SetValues(values, kind)
        return goal

    def GetIkConfigurationSpecification(
        self, iktype: IkParameterizationType | int, interpolation: str = ""
    ) -> ConfigurationSpecification:
        """Return the layout of a goal of this arm in a trajectory.

        Args:
            iktype: The type of goal.
            interpolation: The interpolation between waypoints.
        """
        names = self._robot.GetName(), self._scene.name
        return IkParameterization.GetConfigurationSpecificationFromType(iktype, interpolation, *names)

    def GetInverseKinematicsStructureHash(self, iktype: IkParameterizationType | int) -> str:
        """Return a hash that is equal for arms with the same IK solver: 32 hexadecimal digits.

        Args:
            iktype: The type of goal.
        """
        kind = _Type(iktype)
        tool, direction = kind != _Type.Transform6D, kind in WITH_DIRECTION
        return hashes.of_inverse_kinematics(self._state.scene, self._scene, kind.name, tool=tool, direction=direction)

    def _T_world_base(self) -> Floats:
        return np.eye(4) if self._scene.base is None else self._state.link_transform(self._scene.base)

    def null_space(self, iktype: IkParameterizationType = _Type.Transform6D) -> Floats:
        """Return the joint velocities that keep the present goal: the null space of the arm.

        Args:
            iktype: The goal type, whose components of the tool pose are kept.

        Returns:
            An orthonormal basis, one velocity per column, shape (arm dof, k). Singular configurations have more
            columns.

        Example:
            >>> velocity = 0.1 * manip.null_space()[:, 0]
        """
        from ravemj.ik import null_space

        solver = self.ik_solver(iktype)
        with self._state.simulation.lock:
            return null_space(solver.chain, self._values(), solver.task, self._goal_now(iktype))

    def null_space_path(
        self, along: ArrayLike, iktype: IkParameterizationType = _Type.Transform6D, *, step: float = 0.05
    ) -> Floats:
        """Return a path of configurations that keep the present goal (self-motion); the robot does not move.

        The path ends at a joint limit, when it returns to its start, or after a length of 2 pi. Collisions are not
        checked.

        Args:
            along: Joint velocities, shape (arm dof,); the path starts along their projection onto the null space.
            iktype: The goal type, whose components of the tool pose are kept.
            step: Distance of neighbouring configurations in joint space [rad or m].

        Returns:
            Joint values, starting with the present ones, shape (M, arm dof).

        Raises:
            openrave_exception: the arm cannot move in this direction without leaving the goal.

        Example:
            >>> for values in manip.null_space_path([1, 0, 0, 0, 0, 0, 0]):
            ...     robot.SetDOFValues(values, manip.GetArmIndices())
        """
        from ravemj.ik import null_space_path

        solver = self.ik_solver(iktype)
        wanted = checked_vector(along, len(self._scene.arm_dofs), "null_space_path: along")
        if not (np.isfinite(step) and step > 0):
            raise ArgumentError(f"null_space_path: step is {step}, and should be above 0")
        with self._state.simulation.lock:
            goal, start = self._goal_now(iktype), self._values()
            try:
                return null_space_path(solver, goal, start, wanted, step=step)
            except ValueError as error:
                raise ArgumentError(f"null_space_path: {error}") from error

    def _values(self) -> Floats:
        return self._robot.GetDOFValues(self._scene.arm_dofs)

    def _goal_now(self, iktype: IkParameterizationType) -> Floats:
        """Return the present tool pose as a solver's input: goal values in the arm's base frame."""
        if iktype == _Type.Transform6D:
            return inverse(self._T_world_base()) @ self.GetTransform()
        return np.asarray(self.GetIkParameterization(iktype, inworld=False).GetValues())


def _without_flag(arguments: tuple[object, ...], ikreturn: bool) -> tuple[tuple[object, ...], bool]:
    """Split off ``ikreturn``, which may follow the options as a positional argument."""
    if len(arguments) > 1 and isinstance(arguments[-1], bool) and isinstance(arguments[-2], int | np.integer):
        return arguments[:-1], arguments[-1]
    return arguments, ikreturn
