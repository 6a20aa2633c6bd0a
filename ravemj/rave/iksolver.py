"""Solvers of inverse kinematics: the search for joint values, filters of users, OpenRAVE's answers and failures."""

# ruff: noqa: PLC0415 - inverse kinematics is slow to import

import logging
import operator
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, cast

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
from ravemj.manipulation.arm_search import ArmSearch, Checks, Reason
from ravemj.rave.enums import IkFilterOptions, IkReturnAction, InterfaceType
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.interface import Interface, asked_for
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.ik import IKSolver, Task
    from ravemj.model import scene
    from ravemj.rave.environment import Environment
    from ravemj.rave.manipulator import Manipulator
    from ravemj.rave.robot import Robot


_LOG = logging.getLogger("ravemj")
_NEAR = 1e-4
"""Squared distance from the goal of a configuration that ``CallFilters`` takes."""

# Plain numbers: operators of flags take longer than tests of collision.
_CHECK_ENV = int(IkFilterOptions.CheckEnvCollisions)
_IGNORE_SELF = int(IkFilterOptions.IgnoreSelfCollisions)
_IGNORE_LIMITS = int(IkFilterOptions.IgnoreJointLimits)
_IGNORE_FILTERS = int(IkFilterOptions.IgnoreCustomFilters)
_IGNORE_END = int(IkFilterOptions.IgnoreEndEffectorEnvCollisions)
_IGNORE_END_SELF = int(IkFilterOptions.IgnoreEndEffectorSelfCollisions)
_POSE = IkParameterization.Type.Transform6D
_REJECT, _QUIT, _BY_FILTER = 1, 2, int(IkReturnAction.RejectCustomFilter)

_ACTIONS = {
    Reason.OUT_OF_REACH: (IkReturnAction.RejectKinematics, "out of reach"),
    Reason.LIMITS: (IkReturnAction.RejectJointLimits, "beyond the limits"),
    Reason.SELF_COLLISION: (IkReturnAction.RejectSelfCollision, "collision"),
    Reason.COLLISION: (IkReturnAction.RejectEnvCollision, "collision"),
    Reason.END_COLLISION: (IkReturnAction(0x83), "collision"),
}
"""OpenRAVE's code for each reason, and the description of the failure."""

FilterAnswer = IkReturnAction | IkReturn | None
FilterFunction = Callable[[Floats, "Manipulator", IkParameterization], FilterAnswer]


@dataclass(frozen=True, eq=False)
class Filter:
    """A function of a user's that is asked about each solution: those of higher priority first.

    Those of a priority above 0 are asked before collisions are tested.
    """

    priority: int
    function: FilterFunction


def checks_of(options: int) -> Checks:
    """Return the tests that ``IkFilterOptions`` ask for."""
    return Checks(
        others=bool(options & _CHECK_ENV),
        itself=not options & _IGNORE_SELF,
        limits=not options & _IGNORE_LIMITS,
        end_and_others=not options & _IGNORE_END,
        end_and_rest=not options & _IGNORE_END_SELF,
    )


class Goal(NamedTuple):
    """A goal in the frame of the arm's base: as it was given, where an array is a pose (4, 4); as a solver takes it."""

    given: IkParameterization | Floats
    numbers: Floats


class FilteredSearch(ArmSearch):
    """A search for joint values that asks the filters of users, and answers with objects of OpenRAVE's API.

    Args:
        manip: The manipulator.
        solver: The solver of the arm.
        goal: The goal.
        free: The values of the free joints, shape (k,); None for samples.
        options: ``IkFilterOptions`` combined with ``|``.
        filters: The filters of users.
        failures: Gets what is rejected; None: nothing does.
    """

    def __init__(
        self,
        manip: "Manipulator",
        solver: "IKSolver",
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
        self._filters = [] if options & _IGNORE_FILTERS else sorted(filters, key=lambda one: -one.priority)
        self.asks_users, self.explains = bool(self._filters), failures is not None
        self._started = 0 if failures is None else len(failures)
        self._action = 0
        self._answer = IkReturn(IkReturnAction.Success)

    @cached_property
    def _goal_of_users(self) -> IkParameterization:
        """The goal as users see it; made when it is first asked for, since it checks a pose once more."""
        return self._given if isinstance(self._given, IkParameterization) else IkParameterization(self._given, _POSE)

    @block
    def moving(self) -> Generator[None]:
        """Hold the lock and let the joints of the arm be active; on leaving, restore both and the configuration."""
        with super().moving():
            chosen = self._robot.active_choice
            try:
                dofs = np.array(self.arm.arm_dofs, dtype=int)
                self._robot.active_choice = chosen._replace(dofs=dofs, affine=0, axis=Z_AXIS)
                yield
            finally:
                self._robot.active_choice = chosen

    def accepts(self, row: Floats, *, before_collisions: bool) -> bool:
        """Ask the filters of priority above 0 before collisions are tested, and the others afterwards."""
        if before_collisions:
            self._answer = IkReturn(IkReturnAction.Success)
        return self._pass([one for one in self._filters if (one.priority > 0) == before_collisions], row)

    def _pass(self, filters: Iterable[Filter], row: Floats) -> bool:
        """Ask filters about a solution, and put what they attach into its answer."""
        for one in filters:
            said = self._asked(one, row)
            action = IkReturnAction.Reject if said is None else said.GetAction()
            if action:
                self._reject(int(action) | _BY_FILTER, f"filter of {one.priority}", row)
                self.ended = bool(action & _QUIT)
                return False
            if said is not None:
                self._answer.take(said)
                if len(said.GetSolution()):
                    self._answer.SetSolution(said.GetSolution())
        return True

    def _asked(self, one: Filter, row: Floats) -> IkReturn | None:
        """Return what a filter says.

        Raises:
            RavemjError: with the code ``Assert``, it raises something, or says something that means nothing.
        """
        try:
            said: Any = one.function(row.copy(), self._manip, IkParameterization(self._goal_of_users))
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
        """Return the solution that a filter gave in place of joint values, or these."""
        given = self._answer.GetSolution()
        return given if len(given) else row

    def answer(self, row: Floats) -> IkReturn:
        """Return the answer with a solution that was accepted last, shape (n,)."""
        answer, self._answer = self._answer, IkReturn(IkReturnAction.Success)
        answer.SetSolution(row)
        return answer

    def filtered(self) -> IkReturn:
        """Ask all filters about the present joint values, whatever collides."""
        row = self.present()
        with self.moving():
            return self.answer(self.solution(row)) if self._pass(self._filters, row) else self.failure()

    def reject(self, reason: Reason, row: Floats, findings: Findings | None) -> None:
        """Take note that joint values are rejected; ``row`` is empty if there are none."""
        self._reject(*_ACTIONS[reason], row, findings)

    def _reject(self, action: int, why: str, row: Floats, findings: Findings | None = None) -> None:
        self._action |= int(action)
        if self._failures is not None:
            report = None if findings is None else self._reports.report(findings)
            info = IkFailureInfo(IkReturnAction(action), row.copy(), self._goal_of_users, report, why)
            self._failures.append(info)

    def failure(self) -> IkReturn:
        """Return the answer for a goal without a good solution."""
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
"""Types whose solvers also take a pose, for the part of it that they ask for."""


def task_of(kind: IkParameterizationType) -> "Task":
    """Return what a type of goal asks for.

    Raises:
        UnsupportedError: no solver answers such goals.
    """
    from ravemj.ik import Task

    try:
        return Task(kind.name)
    except ValueError:
        known = ", ".join(task.value for task in Task)
        name = f"goals of type {kind.name} (types that are solved: {known})"
        raise UnsupportedError(name, "inverse kinematics of that type") from None


class IkSolver(Interface):
    """Finds joint values that take the tool of one arm to goals of one type; ``manip.GetIkSolver()`` returns it.

    Goals of its own methods are in the frame of the arm's base.
    """

    _internal = (
        "arm_solver",
        "attach",
        "copy_for",
        "derived",
        "find_all",
        "find_one",
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

        self.arm_solver = ArmSolver(task_of(kind), free)
        self._steps = None if steps is None else tuple(steps)
        self._filters: list[Filter] = []
        self._robot: Robot | None = None
        self._arm_name = ""

    # What it belongs to

    def attach(self, robot: "Robot", arm: str) -> None:
        """Let it answer for an arm.

        Raises:
            ArgumentError: the robot is in another environment than the solver.
            ValueError: the arm is none that can be solved; the message says why.
        """
        if robot.GetEnv() is not self._env:
            raise ArgumentError(f"SetIkSolver: the solver '{self._xmlid}' was made for another environment")
        description = next(one for one in robot.simulation_state.scene.manipulators if one.name == arm)
        self.arm_solver.of(robot.simulation_state.scene, description)
        self._robot, self._arm_name = robot, arm

    def set_steps(self, steps: Sequence[float] | None) -> None:
        """Set how finely free joints are sampled; None: as by default."""
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

    def derived(self) -> "IKSolver":
        """Return what computes, for the arm as it is now."""
        solver = self.arm_solver.of(self._owner().simulation_state.scene, self._description())
        return solver if self._steps is None else replace(solver, steps=self._steps)

    def _free_values(self, solver: "IKSolver", shares: ArrayLike | None) -> Floats | None:
        """Return the values of free joints, shape (k,), that are given as shares of their ranges; None: any."""
        given = np.zeros(0) if shares is None else checked_numbers(shares, "freevalues")
        if not given.size:
            return None
        count, free = len(solver.free), list(solver.free)
        if given.shape != (count,):
            joints = "no free joint" if not count else "one free joint" if count == 1 else f"{count} free joints"
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
            shares: Where the free joints are in their ranges, shape (k,); None: anywhere.
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
        solver = self.derived()
        free = self._free_values(solver, shares)
        goals = Goal(goal, self._numbers(goal))
        return FilteredSearch(self._arm, solver, goals, free, options, self._filters, failures)

    def find_one(
        self,
        goal: IkParameterization | Floats,
        shares: ArrayLike | None,
        options: int,
        *,
        seed: Floats | None = None,
        failures: list[IkFailureInfo] | None = None,
    ) -> IkReturn:
        """Return the good solution that is nearest to a configuration, or why there is none; see ``search``.

        Args:
            goal: As there.
            shares: As there.
            options: As there.
            seed: The configuration, shape (n,); None: the present one.
            failures: Gets what is rejected.
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
        """Return all good solutions; none if a filter ends the search. The arguments are those of ``find_one``."""
        search = self._filtered(goal, shares, options, failures)
        rows = search.rows()
        with search.moving():
            answers = [search.answer(row) for row in search.good(rows)]
        if not answers and failures is not None and not search.ended:
            search.explain()
        return [] if search.ended else answers

    def _numbers(self, goal: IkParameterization | Floats) -> Floats:
        """Return a goal as the solver takes it: a pose (4, 4), or the numbers of its type."""
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
        """Return whether the solver answers goals of the type ``iktype``."""
        return iktype == self.kind

    def copy_for(self, robot: "Robot") -> "IkSolver":
        """Return a solver for the same arm of another robot like this, with the default steps of free joints."""
        copy = IkSolver(robot.GetEnv(), self._xmlid, self.kind, self.arm_solver.free)
        copy.arm_solver = self.arm_solver.copy()
        copy.attach(robot, self._arm_name)
        return copy

    # Free joints

    def GetNumFreeParameters(self) -> int:
        """Return how many joints are sampled, since the arm has more than the goal needs."""
        return len(self.derived().free)

    def GetFreeParameters(self) -> Floats:
        """Return where the free joints of the robot are in their ranges, from 0 to 1, shape (k,)."""
        solver, values = self.derived(), self._configuration()
        free = list(solver.free)
        lower, upper = solver.chain.lower[free], solver.chain.upper[free]
        width = upper - lower
        return np.divide(values[free] - lower, width, out=np.zeros(len(free)), where=width > 0)

    # Filters

    def RegisterCustomFilter(self, priority: int, callback: FilterFunction) -> Handle:
        """Let a function of yours accept or reject solutions.

        Args:
            priority: Functions of higher priority are asked first; those above 0 before collisions are tested.
            callback: ``callback(values, manipulator, ikparam)`` returns an ``IkReturnAction`` (``Success`` keeps the
                solution, ``Reject`` goes on to the next, ``Quit`` ends the search), an ``IkReturn`` whose solution
                takes the place of this one, or None, which rejects. ``ikparam`` is in the frame of the arm's base; the
                robot stands in the solution, and its active DOFs are those of the arm.

        Returns:
            A handle; the function is asked until it is closed or gone.

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

    def CallFilters(self, ikparam: IkParameterization) -> IkReturn:
        """Ask all filters about the configuration in which the robot is.

        Args:
            ikparam: The goal, in the frame of the arm's base, where the tool is within 0.01 (m or rad).

        Returns:
            The configuration as a solution, with what the filters attach; or that they reject it.

        Raises:
            ArgumentError: the tool is elsewhere.
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
            arguments: Values of the free joints as shares of their ranges, then ``IkFilterOptions``.
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


_OPTIONS = "filteroptions"


def split_options(
    caller: str, arguments: Sequence[object], named: Mapping[str, object], free_name: str = "freeparameters"
) -> tuple[ArrayLike | None, int]:
    """Return values of free joints, or None, and ``IkFilterOptions`` of a call: ``([freeparameters,] filteroptions)``.

    Raises:
        TypeError: the options are missing, or there is something else.
    """
    names = [free_name, _OPTIONS] if len(arguments) > 1 or free_name in named else [_OPTIONS]
    given = dict(zip([name for name in names if name not in named], arguments, strict=False)) | dict(named)
    unknown = given.keys() - {free_name, _OPTIONS}
    if unknown:
        raise TypeError(f"{caller}: has no argument {', '.join(unknown)}")
    if _OPTIONS not in given or len(given) != len(arguments) + len(named):
        raise TypeError(f"{caller}: takes param, the goal, [{free_name},] {_OPTIONS}; see IkFilterOptions")
    options = given[_OPTIONS]
    try:
        number = operator.index(cast("int", options))
    except TypeError:
        raise TypeError(f"{caller}: {_OPTIONS} are {options!r}, and should be IkFilterOptions or 0") from None
    return cast("ArrayLike | None", given.get(free_name)), number


def RaveCreateIkSolver(env: "Environment", name: str) -> IkSolver | None:
    """Make a solver of inverse kinematics; ``manip.SetIkSolver`` gives it an arm.

    Args:
        env: The environment.
        name: ``ikfast`` and a word in which the type of goal stands, as ``InverseKinematicsModel.getikname`` returns
            it; what follows are the steps of free joints [rad or m]. ``ikfast Transform6D 0.05``

    Returns:
        The solver; None, and a warning is logged, where the name says no type of goal.

    Raises:
        UnsupportedError: no solver answers goals of that type.

    Example:
        >>> solver = RaveCreateIkSolver(env, "ikfast Translation3D")
        >>> manip.SetIkSolver(solver)
        True
    """
    words = asked_for(env, name, "RaveCreateIkSolver")
    if len(words) > 1 and words[0].lower() == "ikfast":
        kind = next((one for one in GOAL_TYPES if one.name in words[1].split(".")), None)
        steps = _numbers_in(words[2:])
        if kind is not None and steps is not None:
            return IkSolver(env, name, kind, steps=steps or None)
    _LOG.warning("there is no solver '%s': its name should be 'ikfast' and a type of goal, then steps", name)
    return None


def _numbers_in(words: Sequence[str]) -> list[float] | None:
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
