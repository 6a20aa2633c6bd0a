"""Filters of users, and OpenRAVE's answers and failures, for the search for joint values of an arm."""

from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ravemj.core.blocks import block
from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.engine.collision.findings import Findings
from ravemj.errors import ErrorCode, RavemjError
from ravemj.manipulation.arm_search import ArmSearch, Checks, Reason
from ravemj.rave.body.active import ActiveChoice
from ravemj.rave.enums import IkFilterOptions, IkReturnAction
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.ik import IKSolver
    from ravemj.rave.manipulator import Manipulator

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
                self._robot.active_choice = ActiveChoice(np.array(self.arm.arm_dofs, dtype=int))
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
