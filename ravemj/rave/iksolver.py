"""IK solvers of the API: the search for solutions, user filters, OpenRAVE's results and failures."""

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

import weakref
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arguments import checked_kind
from ravemj.core.arrays import checked_numbers, checked_vector
from ravemj.core.blocks import block
from ravemj.core.caching import cached_property
from ravemj.core.handles import Handle
from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings
from ravemj.errors import ArgumentError, ErrorCode, RavemjError, UnsupportedError
from ravemj.geometry_functions.affine import Z_AXIS
from ravemj.geometry_functions.ik_parameterization import goal_of_tool
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType
from ravemj.manipulation.arm_search import ArmSearch, Reason
from ravemj.rave.enums import IkFilterOptions, IkReturnAction, InterfaceType
from ravemj.rave.ik_options import checks_of, split_options
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.interface import Interface
from ravemj.rave.solver_names import numbers_in
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.ik import ArmSolutions, Task
    from ravemj.model import scene
    from ravemj.rave.environment import Environment
    from ravemj.rave.manipulator import Manipulator
    from ravemj.rave.robot import Robot


_SAME = 1e-7
"""Maximum difference of joint values [rad or m] that count as equal."""
_NEAR = 1e-4
"""Maximum squared distance between the goal and the tool that ``CallFilters`` accepts."""

_IGNORE_FILTERS = int(IkFilterOptions.IgnoreCustomFilters)
_POSE = IkParameterization.Type.Transform6D
_REJECT, _QUIT, _BY_FILTER = 1, 2, int(IkReturnAction.RejectCustomFilter)

_ACTIONS = {
    Reason.OUT_OF_REACH: (IkReturnAction.RejectKinematics, "out of reach"),
    Reason.LIMITS: (IkReturnAction.RejectJointLimits, "beyond the limits"),
    Reason.SELF_COLLISION: (IkReturnAction.RejectSelfCollision, "collision"),
    Reason.COLLISION: (IkReturnAction.RejectEnvCollision, "collision"),
    Reason.END_COLLISION: (IkReturnAction(0x83), "collision"),
}
"""OpenRAVE's action code and a description for each reason to reject a solution."""

FilterAnswer = IkReturnAction | IkReturn | None
FilterFunction = Callable[[Floats, "Manipulator", IkParameterization], FilterAnswer]


@dataclass(frozen=True, eq=False)
class Filter:
    """User callback that accepts or rejects solutions; higher priorities are called first.

    Those with a priority above 0 are called before collision checks.
    """

    priority: int
    function: FilterFunction


class Goal(NamedTuple):
    """IK goal in the arm's base frame, as given (an array is a pose (4, 4)) and as the solver's input."""

    given: IkParameterization | Floats
    numbers: Floats


class FilteredSearch(ArmSearch):
    """IK search that calls user filters and returns objects of the OpenRAVE API.

    Args:
        manip: The manipulator.
        solver: The solver of the arm.
        goal: The goal.
        free: The values of the free joints, shape (k,); None for samples.
        options: ``IkFilterOptions`` combined with ``|``.
        filters: The filters of users.
        failures: Receives the rejected solutions; None skips collecting them.
    """

    def __init__(
        self,
        manip: "Manipulator",
        solver: "ArmSolutions",
        goal: Goal,
        free: Floats | None,
        options: int,
        filters: Sequence[Filter],
        failures: list[IkFailureInfo] | None,
    ) -> None:
        robot = manip.GetRobot()
        state, checks = robot.simulation_state, checks_of(options)
        self._reports = robot.GetEnv().GetCollisionChecker()
        super().__init__(state, manip.description, solver, goal.numbers, checks, self._reports, free)
        self._robot, self._manip, self._given, self._failures = robot, manip, goal.given, failures
        self._filters = [] if options & _IGNORE_FILTERS else sorted(filters, key=lambda filter_: -filter_.priority)
        self.asks_users, self.explains = bool(self._filters), failures is not None
        self._started = 0 if failures is None else len(failures)
        self._action = 0
        self._answer = IkReturn(IkReturnAction.Success)
        self._seen: list[Floats] = []

    @cached_property
    def _goal_of_users(self) -> IkParameterization:
        """The goal as an ``IkParameterization``, for filters; cached, because its constructor checks the pose."""
        return self._given if isinstance(self._given, IkParameterization) else IkParameterization(self._given, _POSE)

    @block
    def moving(self) -> Generator[None]:
        """Context manager that holds the lock and makes the arm's joints active; at the end, it restores the robot."""
        with super().moving():
            chosen = self._robot.active_choice
            try:
                dofs = np.array(self.arm.arm_dofs, dtype=int)
                self._robot.active_choice = chosen._replace(dofs=dofs, affine=0, axis=Z_AXIS)
                yield
            finally:
                self._robot.active_choice = chosen

    def accepts(self, row: Floats, *, before_collisions: bool) -> bool:
        """Call some of the filters, and return whether they accept a solution.

        If ``before_collisions``, these are the filters with a priority above 0, else the others.
        """
        if before_collisions:
            self._answer = IkReturn(IkReturnAction.Success)
            self._seen.append(row)
        return self._pass([filter_ for filter_ in self._filters if (filter_.priority > 0) == before_collisions], row)

    def is_repeated(self) -> bool:
        """Return whether filters have already seen the present joint values, up to full turns."""
        if not self._seen:
            return False
        moved = np.reshape(self._seen[:-1], (-1, len(self._seen[-1]))) - self._seen[-1]
        turned = np.where(self.solver.chain.prismatic, moved, np.remainder(moved + np.pi, 2 * np.pi) - np.pi)
        return bool((np.abs(turned) < _SAME).all(axis=1).any())

    def _pass(self, filters: Iterable[Filter], row: Floats) -> bool:
        """Call filters for a solution and collect the data that they attach; return whether all accept."""
        for filter_ in filters:
            said = self._asked(filter_, row)
            action = IkReturnAction.Reject if said is None else said.GetAction()
            if action:
                self._reject(int(action) | _BY_FILTER, f"filter of {filter_.priority}", row)
                self.ended = bool(action & _QUIT)
                return False
            if said is not None:
                self._answer.take(said)
                if len(said.GetSolution()):
                    self._answer.SetSolution(said.GetSolution())
        return True

    def _asked(self, filter_: Filter, row: Floats) -> IkReturn | None:
        """Call a user filter with the joint values ``row``, and return its answer.

        Raises:
            RavemjError: with the code ``Assert``, if the filter raised an exception or returned an invalid answer.
        """
        try:
            said: Any = filter_.function(row.copy(), self._manip, IkParameterization(self._goal_of_users))
        except Exception as error:
            message = f"a filter of inverse kinematics raised {type(error).__name__}: {error}"
            raise RavemjError(message, ErrorCode.Assert) from error
        if isinstance(said, IkReturnAction):
            return IkReturn(said)
        if said is not None and not isinstance(said, IkReturn):
            message = (
                f"a filter of inverse kinematics returned {said!r}; it should return an IkReturnAction or IkReturn"
            )
            raise RavemjError(message, ErrorCode.Assert)
        return said

    def solution(self, row: Floats) -> Floats:
        """Return the solution that a filter has substituted for ``row``, else ``row``."""
        given = self._answer.GetSolution()
        return given if len(given) else row

    def answer(self, row: Floats) -> IkReturn:
        """Return the result for the solution accepted last."""
        answer, self._answer = self._answer, IkReturn(IkReturnAction.Success)
        answer.SetSolution(row)
        return answer

    def filtered(self) -> IkReturn:
        """Call all filters for the present joint values, without collision checks."""
        row = self.present()
        with self.moving():
            return self.answer(self.solution(row)) if self._pass(self._filters, row) else self.failure()

    def reject(self, reason: Reason, row: Floats, findings: Findings | None) -> None:
        """Record the rejection of joint values; ``row`` is empty if there are none."""
        self._reject(*_ACTIONS[reason], row, findings)

    def _reject(self, action: int, why: str, row: Floats, findings: Findings | None = None) -> None:
        self._action |= int(action)
        if self._failures is not None:
            report = None if findings is None else self._reports.report(findings)
            info = IkFailureInfo(IkReturnAction(action), row.copy(), self._goal_of_users, report, why)
            self._failures.append(info)

    def failure(self) -> IkReturn:
        """Return the result for a goal without an accepted solution."""
        answer = IkReturn(self._action | _REJECT)
        failures = self._failures
        answer.name_failures([] if failures is None else list(range(self._started, len(failures))))
        return answer


_Type = IkParameterizationType
_OF_POSES = {
    _Type.TranslationDirection5D,
    _Type.TranslationXAxisAngleZNorm4D,
    _Type.TranslationYAxisAngleXNorm4D,
    _Type.TranslationZAxisAngleYNorm4D,
}
"""Goal types whose solvers also accept a pose and use only the constrained components."""


def task_of(kind: IkParameterizationType) -> "Task":
    """Return the IK task of a goal type.

    Raises:
        UnsupportedError: no solver supports this type.
    """
    from ravemj.ik import Task

    try:
        return Task(kind.name)
    except ValueError:
        known = ", ".join(task.value for task in Task)
        name = f"goals of type {kind.name} (types that are solved: {known})"
        raise UnsupportedError(name, "inverse kinematics of that type") from None


class IkSolver(Interface):
    """IK solver of one arm for goals of one type; ``manip.GetIkSolver()`` returns it.

    Its own methods expect goals in the frame of the arm's base.
    """

    _internal = (
        "attach",
        "copy_for",
        "derived",
        "find_all",
        "find_one",
        "given_free",
        "kind",
        "search",
        "set_steps",
    )

    def __init__(
        self,
        env: "Environment",
        name: str,
        kind: IkParameterizationType,
        free: Sequence[int] | None = None,
        steps: Sequence[float] | None = None,
    ) -> None:
        super().__init__(env, name)
        self.kind = kind
        from ravemj.ik.arms import ArmSolver

        self._arm_solver = ArmSolver(task_of(kind), free)
        self._steps = None if steps is None else tuple(steps)
        self._filters: list[Filter] = []
        self._custom_filter: Handle | None = None
        self._robot: Robot | None = None
        self._arm_name = ""
        self._latest: Callable[[], FilteredSearch | None] = lambda: None

    # Commands

    def _free_indices(self, arguments: str) -> str:
        del arguments
        return "".join(f"{joint} " for joint in self.derived().free)

    def _free_increments(self, arguments: str) -> str:
        del arguments
        return "".join(f"{step!r} " for step in map(float, self.derived().steps))

    def _set_free_increments(self, arguments: str) -> str:
        count, steps = len(self.derived().free), numbers_in(arguments.split())
        if steps is None or len(steps) != count or not all(0 < step < np.inf for step in steps):
            raise ArgumentError(f"SetFreeIncrements: '{arguments}' should be {count} numbers above 0 [rad or m]")
        self.set_steps(steps or None)
        return ""

    def _repeat_count(self, arguments: str) -> str:
        """Return 1 if the latest search has already called filters with the present link poses, else 0."""
        del arguments
        search = self._latest()
        return str(int(search is not None and search.is_repeated()))

    def _solution_indices(self, arguments: str) -> str:
        """Raise an error: OpenRAVE's solution indices number branches of ikfast's C++ code, which ravemj lacks."""
        del arguments
        remedy = "solutions are told apart by their joint values: FindIKSolutions returns them all"
        raise UnsupportedError(f"GetSolutionIndices ({remedy})", "numbering of the branches of a solver")

    _commands: ClassVar = {
        "GetSolutionIndices": _solution_indices,
        "SetJacobianRefineBit": lambda solver, arguments: "",  # solutions are exact without refinement
        "GetFreeIndices": _free_indices,
        "GetFreeIncrements": _free_increments,
        "SetFreeIncrements": _set_free_increments,
        "GetRobotLinkStateRepeatCount": _repeat_count,
    }

    # What it belongs to

    def attach(self, robot: "Robot", arm: str) -> None:
        """Assign the solver to an arm.

        Raises:
            ArgumentError: the robot is in another environment than the solver.
            ValueError: the arm cannot be solved; the message says why.
        """
        if robot.GetEnv() is not self._env:
            raise ArgumentError(f"SetIkSolver: the solver '{self._xmlid}' was made for another environment")
        description = next(
            manipulator for manipulator in robot.simulation_state.scene.manipulators if manipulator.name == arm
        )
        self._arm_solver.solver_for(robot.simulation_state.scene, description)
        self._robot, self._arm_name = robot, arm

    @property
    def given_free(self) -> tuple[int, ...] | None:
        """The requested free joints, as indices into the arm; None means as few as necessary."""
        free = self._arm_solver.free
        return None if free is None else tuple(free)

    def set_steps(self, steps: Sequence[float] | None) -> None:
        """Set the sampling steps of the free joints [rad or m]; None means the defaults."""
        self._steps = None if steps is None else tuple(steps)

    def _owner(self) -> "Robot":
        if self._robot is None:
            raise RavemjError(f"the solver '{self._xmlid}' has no arm; manip.SetIkSolver(solver) gives it one")
        return self._robot

    @property
    def _arm(self) -> "Manipulator":
        arm = self._owner().GetManipulator(self._arm_name)
        assert arm is not None
        return arm

    def _description(self) -> "scene.Manipulator":
        for arm in self._owner().simulation_state.scene.manipulators:
            if arm.name == self._arm_name:
                return arm
        raise RavemjError(f"the arm '{self._arm_name}' of the solver '{self._xmlid}' was removed")

    def derived(self) -> "ArmSolutions":
        """Return the computed solver for the arm's present geometry, with the sampling steps of this object."""
        solver = self._arm_solver.solver_for(self._owner().simulation_state.scene, self._description())
        steps = (self._steps or ())[: len(solver.free)]  # a name may have more steps than the arm has free joints
        return replace(solver, steps=(*steps, *solver.steps[len(steps) :])) if steps else solver

    def _free_values(self, solver: "ArmSolutions", shares: ArrayLike | None) -> Floats | None:
        """Convert free joint values from fractions of their ranges to joint values, shape (k,); None means any."""
        given = np.zeros(0) if shares is None else checked_numbers(shares, "freevalues")
        if not given.size:
            return None
        count, free = len(solver.free), list(solver.free)
        if given.shape != (count,):
            joints = ("no free joint", "one free joint", f"{count} free joints")[min(count, 2)]
            raise ArgumentError(f"freevalues have shape {given.shape}, and '{self._arm_name}' has {joints}")
        lower, upper = solver.chain.lower[free], solver.chain.upper[free]
        return lower + checked_vector(given, count, "freevalues") * (upper - lower)

    def _configuration(self) -> Floats:
        return self._owner().simulation_state.kinematics.values()[list(self._description().arm_dofs)]

    # Search

    def search(self, goal: IkParameterization | Floats, shares: ArrayLike | None, options: int) -> ArmSearch:
        """Return a search for joint values.

        Args:
            goal: The goal in the frame of the arm's base; an array is a pose of the tool (4, 4).
            shares: Values of the free joints as fractions of their ranges, shape (k,); None means any.
            options: ``IkFilterOptions`` combined with ``|``.
        """
        if self._filters:
            return self._filtered(goal, shares, options)
        solver, checker = self.derived(), self._owner().GetEnv().GetCollisionChecker()
        numbers, free = self._numbers(goal), self._free_values(solver, shares)
        state, arm = self._owner().simulation_state, self._description()
        return ArmSearch(state, arm, solver, numbers, checks_of(options), checker, free)

    def _filtered(
        self,
        goal: IkParameterization | Floats,
        shares: ArrayLike | None,
        options: int,
        failures: list[IkFailureInfo] | None = None,
    ) -> FilteredSearch:
        solver, numbers = self.derived(), self._numbers(goal)
        free = self._free_values(solver, shares)
        search = FilteredSearch(self._arm, solver, Goal(goal, numbers), free, options, self._filters, failures)
        self._latest = weakref.ref(search)
        return search

    def find_one(
        self,
        goal: IkParameterization | Floats,
        shares: ArrayLike | None,
        options: int,
        *,
        seed: Floats | None = None,
        failures: list[IkFailureInfo] | None = None,
    ) -> IkReturn:
        """Return the accepted solution nearest to a configuration, or the reasons of the failure; see ``search``.

        Args:
            goal: The goal in the frame of the arm's base; an array is a pose of the tool (4, 4).
            shares: Values of the free joints as fractions of their ranges, shape (k,); None means any.
            options: ``IkFilterOptions`` combined with ``|``.
            seed: The configuration, shape (n,); None: the present one.
            failures: Receives the rejected solutions.
        """
        search = self._filtered(goal, shares, options, failures)
        start = search.present() if seed is None else seed
        row = search.nearest(start)
        if row is None:
            if not search.ended:
                search.explain()
            return search.failure()
        from ravemj.ik.limits import distances

        answer = search.answer(row)
        answer.SetMapKeyValue("__distancetosol__", distances(search.solver.chain, row, start, search.weights))
        return answer

    def find_all(
        self,
        goal: IkParameterization | Floats,
        shares: ArrayLike | None,
        options: int,
        failures: list[IkFailureInfo] | None = None,
    ) -> list[IkReturn]:
        """Return all accepted solutions; none if a filter ends the search. The arguments are those of ``find_one``."""
        search = self._filtered(goal, shares, options, failures)
        with search.moving():
            answers = [search.answer(row) for row in search.all_good()]
        if not answers and failures is not None and not search.ended:
            search.explain()
        return [] if search.ended else answers

    def _numbers(self, goal: IkParameterization | Floats) -> Floats:
        """Return a goal as the solver's input: a pose (4, 4), or the values of its type."""
        kind = _Type.Transform6D if isinstance(goal, np.ndarray) else goal.GetType()
        if kind not in GOAL_TYPES:
            raise RavemjError("the goal is empty; give it a value and a type first")
        if kind == _Type.Transform6D:
            T_base_tool = goal if isinstance(goal, np.ndarray) else goal.GetTransform6D()
            if self.kind == kind:
                return T_base_tool
            if self.kind in _OF_POSES:
                return goal_of_tool(self.kind, T_base_tool, np.array(self._description().direction))
        if kind != self.kind or isinstance(goal, np.ndarray):
            message = f"the goal is of type {kind.name}, and the solver of '{self._arm_name}' takes {self.kind.name}"
            raise ArgumentError(f"{message}; load an InverseKinematicsModel of that type first")
        return goal.GetValues()

    _interface_type = InterfaceType.iksolver

    def Supports(self, iktype: IkParameterizationType) -> bool:
        """Return whether the solver supports goals of the type ``iktype``."""
        return iktype == self.kind

    def copy_for(self, robot: "Robot") -> "IkSolver":
        """Return a solver for the same arm of another, similar robot, with the default steps of free joints."""
        copy = IkSolver(robot.GetEnv(), self._xmlid, self.kind, self._arm_solver.free)
        copy._arm_solver = self._arm_solver.copy()
        copy.attach(robot, self._arm_name)
        return copy

    # Free joints

    def GetNumFreeParameters(self) -> int:
        """Return the number of free joints, which are sampled because the arm has more joints than the goal needs."""
        return len(self.derived().free)

    def GetFreeParameters(self) -> Floats:
        """Return the free joint values of the robot as fractions of their ranges, from 0 to 1, shape (k,)."""
        solver, values = self.derived(), self._configuration()
        free = list(solver.free)
        lower, upper = solver.chain.lower[free], solver.chain.upper[free]
        width = upper - lower
        return np.divide(values[free] - lower, width, out=np.zeros(len(free)), where=width > 0)

    # Filters

    def RegisterCustomFilter(self, priority: int, callback: FilterFunction) -> Handle:
        """Register a callback that accepts or rejects solutions.

        If it rejects the solutions at all samples of a free joint, values between the samples are tried: the ends, the
        middle and eight more values of each interval of the joint in which solutions exist. Solutions that it would
        accept only between these values are missed, and so may be those in intervals narrower than a sampling step.

        Args:
            priority: Callbacks of higher priority are called first; those above 0 before collision checks.
            callback: ``callback(values, manipulator, ikparam)`` returns an ``IkReturnAction`` (``Success`` keeps the
                solution, ``Reject`` goes on to the next, ``Quit`` ends the search), an ``IkReturn`` whose solution
                takes the place of this one, or None, which rejects. ``ikparam`` is in the frame of the arm's base; the
                robot is at the solution, and its active DOFs are those of the arm.

        Returns:
            A handle; closing or deleting it removes the callback.

        Example:
            >>> def elbow_up(values, manipulator, ikparam):
            ...     return IkReturnAction.Success if values[2] > 0 else IkReturnAction.Reject
            >>> handle = manip.GetIkSolver().RegisterCustomFilter(0, elbow_up)
        """
        if not callable(callback):
            raise ArgumentError(f"RegisterCustomFilter: callback is {callback!r}, and should be a function")
        entry = Filter(int(priority), callback)
        self._filters.append(entry)
        return Handle(self._filters.remove, entry)

    def SetCustomFilter(self, callback: FilterFunction) -> bool:
        """Register a permanent filter, which replaces the one of an earlier call; see ``RegisterCustomFilter``.

        Args:
            callback: The callback; it is called after collision checks.

        Returns:
            True.
        """
        handle = self.RegisterCustomFilter(0, callback)
        if self._custom_filter is not None:
            self._custom_filter.Close()
        self._custom_filter = handle
        return True

    def CallFilters(self, ikparam: IkParameterization) -> IkReturn:
        """Call all filters for the robot's present configuration.

        Args:
            ikparam: The goal, in the frame of the arm's base, which the tool must match within 0.01 (m or rad).

        Returns:
            The configuration as a solution, with the data that filters attach; or the rejection by a filter.

        Raises:
            ArgumentError: the tool is not at the goal.
        """
        goal = checked_kind(ikparam, IkParameterization, "CallFilters: ikparam")
        here = self._arm.GetIkParameterization(goal, False)
        if here.ComputeDistanceSqr(goal) > _NEAR:
            raise ArgumentError("CallFilters: ikparam is not where the tool is; it is relative to the arm's base")
        return self._filtered(goal, None, 0).filtered()

    # Search

    def Solve(self, ikparam: IkParameterization, q0: ArrayLike | None, *arguments: object, **named: object) -> IkReturn:
        """Return the solution nearest to a configuration: ``Solve(ikparam, q0, [freeparameters,] filteroptions)``.

        Args:
            ikparam: The goal, in the frame of the arm's base.
            q0: The configuration, shape (n,); None: the present one.
            arguments: Free joint values as fractions of their ranges, then ``IkFilterOptions``.
            named: The same by name.
        """
        goal = checked_kind(ikparam, IkParameterization, "Solve: ikparam")
        free, options = split_options("Solve", arguments, named)
        seed = None if q0 is None else checked_vector(q0, self.derived().chain.dof, "Solve: q0")
        with self._env.simulation.lock:
            return self.find_one(goal, free, options, seed=seed)

    def SolveAll(self, ikparam: IkParameterization, *arguments: object, **named: object) -> list[IkReturn]:
        """Return all solutions: ``SolveAll(ikparam, [freeparameters,] filteroptions)``; see ``Solve``."""
        goal = checked_kind(ikparam, IkParameterization, "SolveAll: ikparam")
        free, options = split_options("SolveAll", arguments, named)
        with self._env.simulation.lock:
            return self.find_all(goal, free, options)

    def __repr__(self) -> str:
        return f"RaveCreateIkSolver({self._env!r}, {self._xmlid!r})"
