"""Inverse kinematics of an arm."""

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ravemj.core.api_object import ApiObject
from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_transform, checked_vector
from ravemj.core.transforms import Floats, inverse, pose_of
from ravemj.engine.simulation import BodyState
from ravemj.errors import ArgumentError, ErrorCode, RavemjError
from ravemj.geometry_functions.ik_parameterization import goal_of_tool, moved_goal
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType, goal_size
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.manipulation.tool import Tool
from ravemj.model import hashes, scene
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.iksolver import IkSolver, split_options, task_of
from ravemj.rave.specification import ConfigurationSpecification, IkParameterization

if TYPE_CHECKING:
    from ravemj.ik import IKSolver
    from ravemj.rave.robot import Robot


_LOG = logging.getLogger("ravemj")
_Type = IkParameterizationType

WITH_DIRECTION = {
    _Type.Direction3D,
    _Type.Ray4D,
    _Type.TranslationDirection5D,
}
"""Types of goals that depend on the direction of the tool."""

_GONE = 1 << 30
"""The place of a manipulator that was removed; no robot has so many."""


class IkBatch(NamedTuple):
    """Joint values for many goals.

    Attributes:
        solutions: Joint values [rad or m], shape (N, B, n); rows that are no solutions have any numbers.
        valid: Which rows are solutions, shape (N, B).
        branches: A name for each of the B branches of solutions.
    """

    solutions: Floats
    valid: NDArray[np.bool_]
    branches: list[str]


class ArmIk(ApiObject):
    """The name and the pose of an arm, and inverse kinematics: joint values for goals, and motions that keep them."""

    _internal = (
        "description",
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
        """What the model says of the manipulator."""
        return self._scene

    def moved_up(self, removed: int) -> None:
        """Take note that the manipulator at a place was removed, which may be this one."""
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
        """Return the tool and the joints as arrays, which are made anew when the description is another one."""
        arm = self._scene
        if self._known is None or self._known.arm is not arm:
            self._known = Tool.of(arm)
        return self._known

    def _edit(self, **changes: Any) -> None:  # noqa: ANN401 - the fields of a scene.Manipulator
        with self._state.simulation.lock:
            arms = list(self._state.scene.manipulators)
            arms[self._index] = replace(self._scene, **changes)
            self._state.edit(manipulators=tuple(arms))

    # Solvers

    def GetIkSolver(self) -> IkSolver | None:
        """Return the solver of inverse kinematics, or None as long as there is none."""
        return self._robot.ik_solvers.get(self._scene.name)

    def SetIkSolver(self, iksolver: IkSolver | None) -> bool:
        """Give the arm a solver in place of the one before.

        Args:
            iksolver: What ``RaveCreateIkSolver`` made; None: none.

        Returns:
            Whether it fits the arm; if not, the log says why.
        """
        if iksolver is None:
            self._robot.ik_solvers.pop(self._scene.name, None)
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
            hint = "databases.inversekinematics.InverseKinematicsModel(...).load() makes it"
            raise RavemjError(f"{message}; {hint}", code)
        return solver

    def GetNumFreeParameters(self) -> int:
        """Return how many joints of the arm are sampled, since it has more than the goals need."""
        return self._solver("GetNumFreeParameters", ErrorCode.Assert).GetNumFreeParameters()  # random-api-51

    def GetFreeParameters(self) -> Floats:
        """Return where the free joints are in their ranges now, from 0 to 1, shape (k,)."""
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
        """Return the joint values nearest to the present ones that take the tool to a goal.

        ``FindIKSolution(param, filteroptions)`` or ``FindIKSolution(param, freevalues, filteroptions)``. The robot
        stays where it is.

        Args:
            param: ``T_world_tool``: 4x4, 3x4 or [w, x, y, z, tx, ty, tz]; or an ``IkParameterization`` in the world.
            arguments: Values of the free joints as shares of their ranges, shape (k,), or nothing; then
                ``IkFilterOptions`` combined with ``|``. 0: within the limits, without self collisions, and approved by
                the filters.
            ikreturn: Whether to return an ``IkReturn`` in any case, which also says why there is no solution.
            releasegil: Not used.
            ikFailureAccumulator: A list that gets an ``IkFailureInfo`` for each solution that was rejected.
            named: The same as ``arguments``, by name.

        Returns:
            Joint values [rad or m] in the order of ``GetArmIndices()``, shape (n,); None where there are none.

        Raises:
            openrave_exception: the arm has no solver; the goal is of another type than the solver's, or none at all.

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
        """Return all joint values that take the tool to a goal.

        Free joints are sampled from 0 to their limits. A joint with a range of more than a turn gives all turns.

        Args:
            param: The goal, as for ``FindIKSolution``; so are the other arguments.
            arguments: Values of the free joints, or nothing; then ``IkFilterOptions``.
            ikreturn: Whether to return a list of ``IkReturn``.
            releasegil: Not used.
            ikFailureAccumulator: A list that gets an ``IkFailureInfo`` for each solution that was rejected.
            named: The same as ``arguments``, by name.

        Returns:
            Joint values [rad or m], a solution in each row, shape (K, n); shape (0,) where there is none. With
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
        """Return a search for joint values that take the tool to a goal in the world; the arm has a solver."""
        with self._state.simulation.lock:
            return self._solver("search").search(self._in_base(param), None, options)

    def _in_base(self, param: ArrayLike | IkParameterization) -> IkParameterization | Floats:
        """Return a goal in the frame of the arm's base; a pose (4, 4) as it is."""
        T_base_world = inverse(self._T_world_base())
        if isinstance(param, IkParameterization):
            return param.Transform(T_base_world)
        return T_base_world @ checked_transform(param, "param")

    # Many goals at once

    def ik_solver(self, iktype: IkParameterizationType = _Type.Transform6D) -> "IKSolver":
        """Return the solver of the arm, which is derived when it is first asked for.

        Args:
            iktype: The type of goal.

        Raises:
            openrave_exception: the arm is none that can be solved, or no solver answers goals of that type.

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
            return own.of(self._state.scene, self._scene)
        except ValueError as error:
            raise ArgumentError(str(error)) from error

    def ik(
        self, goals: ArrayLike, iktype: IkParameterizationType = _Type.Transform6D, *, limits: bool = True
    ) -> IkBatch:
        """Return all joint values that take the tool to many goals, one turn of each; nothing is tested for collision.

        Args:
            goals: ``T_world_tool``, shape (N, 4, 4) or (4, 4); for other types the numbers of goals, shape (N, k).
            iktype: The type of goal.
            limits: Whether only solutions within the limits are valid; else angles are in [-pi, pi].

        Example:
            >>> found = manip.ik(T_world_tools)
            >>> found.solutions[0][found.valid[0]]  # all ways to the first one
        """
        solver = self.ik_solver(iktype)
        T_base_world = inverse(self._T_world_base())
        given = checked_numbers(goals, "ik: goals")
        size = (4, 4) if iktype == _Type.Transform6D else (goal_size(iktype),)
        if given.shape[-len(size) :] != size or given.ndim > len(size) + 1:
            wanted = f"(N, {', '.join(map(str, size))}) for goals of type {_Type(iktype).name}"
            raise ArgumentError(f"ik: goals: has shape {given.shape}, and should have shape {wanted}")
        if iktype == _Type.Transform6D:
            local = T_base_world @ given.reshape(-1, 4, 4)
        else:
            rows = given.reshape(-1, goal_size(iktype))
            local = np.array([moved_goal(iktype, row, pose_of(T_base_world)) for row in rows]).reshape(rows.shape)
        try:
            with self._state.simulation.lock:
                found = solver.solve(local, limits=limits)
        except ValueError as error:
            raise ArgumentError(f"goals: {error}") from error
        return IkBatch(found.values, found.valid, _branch_names(solver, found.values.shape[1]))

    def GetIkParameterization(
        self, iktype: IkParameterizationType | IkParameterization | int, inworld: bool = True
    ) -> IkParameterization:
        """Return where the tool is now, as a goal.

        Args:
            iktype: The type of goal, or a goal of that type, whose point of the tool is kept; so are its custom
                values. Of a point that is looked at, the foot on the ray of the tool is taken.
            inworld: True: in the world. False: in the base link of the arm.
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
            interpolation: How the values change between waypoints.
        """
        names = self._robot.GetName(), self._scene.name
        return IkParameterization.GetConfigurationSpecificationFromType(iktype, interpolation, *names)

    def GetInverseKinematicsStructureHash(self, iktype: IkParameterizationType | int) -> str:
        """Return a text that is the same for arms that one solver fits: 32 hexadecimal digits.

        Args:
            iktype: The type of goal.
        """
        kind = _Type(iktype)
        tool, direction = kind != _Type.Transform6D, kind in WITH_DIRECTION
        return hashes.of_inverse_kinematics(self._state.scene, self._scene, kind.name, tool=tool, direction=direction)

    def _T_world_base(self) -> Floats:
        return np.eye(4) if self._scene.base is None else self._state.link_transform(self._scene.base)

    def null_space(self, iktype: IkParameterizationType = _Type.Transform6D) -> Floats:
        """Return the joint velocities that leave the goal reached in which the tool is now.

        Args:
            iktype: What counts of where the tool is.

        Returns:
            An orthonormal basis of them, a velocity in each column, shape (arm dof, k). In singular configurations
            there are more than elsewhere.

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
        """Return configurations on a path that leaves the goal reached in which the tool is now; nothing moves.

        The path ends where a joint meets its limit, where it comes back to its start, or after a length of 2 pi.
        Nothing is tested for collision.

        Args:
            along: Joint velocities, shape (arm dof,); the path begins with what of them is in the null space.
            iktype: What counts of where the tool is.
            step: Distance of neighbouring configurations in joint space [rad or m].

        Returns:
            Joint values, the present ones first, shape (M, arm dof).

        Raises:
            openrave_exception: the arm cannot move that way while its goal stays reached.

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
        """Return where the tool is in the base of the arm, as solvers take goals."""
        if iktype == _Type.Transform6D:
            return inverse(self._T_world_base()) @ self.GetTransform()
        return np.asarray(self.GetIkParameterization(iktype, inworld=False).GetValues())


def _without_flag(arguments: tuple[object, ...], ikreturn: bool) -> tuple[tuple[object, ...], bool]:
    """Return the arguments without ``ikreturn``, which may stand behind the options without its name."""
    if len(arguments) > 1 and isinstance(arguments[-1], bool) and isinstance(arguments[-2], int | np.integer):
        return arguments[:-1], arguments[-1]
    return arguments, ikreturn


def _branch_names(solver: "IKSolver", count: int) -> list[str]:
    """Return a name for each solution of a goal: the values of free joints, and the choices of the closed form."""
    if solver.closed is None:
        return [f"found {number + 1}" for number in range(count)]
    names = solver.closed.branch_names
    free = [
        " ".join(f"j{joint + 1}={value:.4g}" for joint, value in zip(solver.free, row, strict=True))
        for row in solver.free_samples()
    ]
    return [f"{values} {name}".strip() for values in free for name in names]
