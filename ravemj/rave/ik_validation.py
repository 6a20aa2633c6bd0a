"""Which solutions of inverse kinematics are good: filters of users, and collisions, with the robot at the solution."""

from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from ravemj.core.blocks import block, restoring
from ravemj.core.caching import cached_property
from ravemj.core.transforms import Floats
from ravemj.engine.collision import arms
from ravemj.engine.collision.world import CollisionWorld, Pairs
from ravemj.errors import ErrorCode, RavemjError
from ravemj.model import scene
from ravemj.rave.body.active import ActiveChoice
from ravemj.rave.enums import IkFilterOptions, IkReturnAction
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.report import CollisionReport
from ravemj.rave.specification import IkParameterization

if TYPE_CHECKING:
    from ravemj.rave.manipulator import Manipulator
    from ravemj.rave.robot import Robot

# Plain numbers: operators of flags take longer than tests of collision.
CHECK_ENV = int(IkFilterOptions.CheckEnvCollisions)
IGNORE_SELF = int(IkFilterOptions.IgnoreSelfCollisions)
IGNORE_LIMITS = int(IkFilterOptions.IgnoreJointLimits)
IGNORE_FILTERS = int(IkFilterOptions.IgnoreCustomFilters)
_IGNORE_END = int(IkFilterOptions.IgnoreEndEffectorEnvCollisions)
_IGNORE_END_SELF = int(IkFilterOptions.IgnoreEndEffectorSelfCollisions)
_POSE = IkParameterization.Type.Transform6D
_REJECT, _QUIT = int(IkReturnAction.Reject), int(IkReturnAction.Quit)

FilterAnswer = IkReturnAction | IkReturn | None
FilterFunction = Callable[[Floats, "Manipulator", IkParameterization], FilterAnswer]


@dataclass(frozen=True, eq=False)
class Filter:
    """A function of a user's that is asked about each solution: those of higher priority first.

    Those of a priority above 0 are asked before collisions are tested.
    """

    priority: int
    function: FilterFunction


class Query(NamedTuple):
    """What solutions are validated against.

    Attributes:
        robot: The robot.
        arm: The manipulator.
        description: Its description.
        goal: The goal in the frame of the arm's base; an array is a pose of the tool (4, 4).
        options: ``IkFilterOptions`` combined with ``|``.
        filters: The filters of users.
        failures: Gets what is rejected; None: nothing does.
    """

    robot: "Robot"
    arm: "Manipulator"
    description: scene.Manipulator
    goal: IkParameterization | Floats
    options: int
    filters: Sequence[Filter]
    failures: list[IkFailureInfo] | None = None


class Validator:
    """Validates solutions inside ``moving_robot``, after which the robot is as before.

    Attributes:
        filters: The filters, those of high priority first.
        action: All that happened to the solutions that were rejected.
        quit: Whether the search is over.
    """

    def __init__(self, query: Query) -> None:
        self._query = query
        self._state = query.robot.simulation_state
        self.filters = sorted(query.filters, key=lambda one: -one.priority)
        self._options = query.options
        self._tests = bool(query.options & CHECK_ENV or not query.options & IGNORE_SELF)
        self._end_is_free = False
        self._started = 0 if query.failures is None else len(query.failures)
        self.action = 0
        self.quit = False

    @block
    def moving_robot(self) -> Generator[Self]:
        """Hold the lock, and bring the robot back to where it was at the end."""
        state, robot = self._state, self._query.robot
        with state.simulation.lock:
            saved, chosen = state.configuration(), robot.active_choice
            with restoring(lambda: state.restore(saved)):
                try:
                    robot.active_choice = ActiveChoice(np.array(self._query.description.arm_dofs, dtype=int))
                    self._values = state.kinematics.values()
                    yield self
                finally:
                    robot.active_choice = chosen

    @cached_property
    def _goal(self) -> IkParameterization:
        """The goal as users see it; made when it is first asked for, since it checks a pose once more."""
        goal = self._query.goal
        return goal if isinstance(goal, IkParameterization) else IkParameterization(goal, _POSE)

    def first(self, rows: Iterable[Floats]) -> IkReturn | None:
        """Return the answer for the first good one of solutions, or None."""
        for row in rows:
            answer = self.ask(row)
            if answer is not None or self.quit:
                return answer
        return None

    def all(self, rows: Iterable[Floats]) -> list[IkReturn]:
        """Return the answers for all good ones of solutions; none if a filter ends the search."""
        answers: list[IkReturn] = []
        for row in rows:
            answer = self.ask(row)
            if self.quit:
                return []
            if answer is not None:
                answers.append(answer)
        return answers

    def ask(self, row: Floats) -> IkReturn | None:
        """Return the answer for one solution, shape (n,), or None where it is rejected."""
        answer = solution(row)
        if not (self.filters or self._tests):
            return answer
        values = self._values.copy()
        values[list(self._query.description.arm_dofs)] = row
        self._state.set_values(values)
        before = [one for one in self.filters if one.priority > 0]
        if not self.passes(before, row, answer) or self._collides(row):
            return None
        return answer if self.passes(self.filters[len(before) :], row, answer) else None

    def passes(self, filters: Iterable[Filter], row: Floats, answer: IkReturn) -> bool:
        """Ask filters about a solution, and put what they attach into its answer."""
        for one in filters:
            said = self._asked(one, row)
            action = IkReturnAction.Reject if said is None else said.GetAction()
            if action:
                self._reject(row, int(action) | int(IkReturnAction.RejectCustomFilter), f"filter of {one.priority}")
                self.quit = bool(action & _QUIT)
                return False
            if said is not None:
                answer.take(said)
                if len(said.GetSolution()):
                    answer.SetSolution(said.GetSolution())
        return True

    def _asked(self, one: Filter, row: Floats) -> IkReturn | None:
        """Return what a filter says.

        Raises:
            RavemjError: with the code ``Assert``, it raises something, or says something that means nothing.
        """
        query = self._query
        try:
            said: Any = one.function(row.copy(), query.arm, IkParameterization(self._goal))
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

    def _collides(self, row: Floats) -> bool:
        """Return whether the robot, which is at the solution, collides."""
        if not self._tests:
            return False
        with self._query.robot.GetEnv().GetCollisionChecker().groups.world() as world:
            return self._collides_in(world, row)

    def _collides_in(self, world: CollisionWorld, row: Floats) -> bool:
        options, state, arm = self._options, self._state, self._query.description
        check_env, check_self = options & CHECK_ENV, not options & IGNORE_SELF
        without_end = bool(options & _IGNORE_END)
        if check_env and not without_end and self._goal.GetType() == _POSE:
            # All solutions have the end at the same place.
            if not self._end_is_free and self._hits(world, arms.end_and_others(world, state, arm), row, 0x83):
                self.quit = True
                return True
            self._end_is_free = without_end = True
        if check_self:
            pairs = arms.arm_and_rest(world, state, arm, without_end=bool(options & _IGNORE_END_SELF))
            if self._hits(world, pairs, row, IkReturnAction.RejectSelfCollision):
                return True
        if not check_env:
            return False
        pairs = arms.arm_and_others(world, state, arm, without_end=without_end)
        return self._hits(world, pairs, row, IkReturnAction.RejectEnvCollision)

    def _hits(self, world: CollisionWorld, pairs: Pairs, row: Floats, action: int) -> bool:
        """Test pairs; where there is a collision, reject the solution."""
        report = None if self._query.failures is None else CollisionReport()
        hit = self._query.robot.GetEnv().GetCollisionChecker().answer(world, pairs, report)
        if hit:
            self._reject(row, action, "collision", report)
        return hit

    def _reject(self, row: Floats, action: int, why: str, report: CollisionReport | None = None) -> None:
        self.action |= int(action)
        if self._query.failures is not None:
            info = IkFailureInfo(IkReturnAction(action), row.copy(), self._goal, report, why)
            self._query.failures.append(info)

    def fall_short(self, unreached: bool, limited: bool, *, limits: bool) -> None:
        """Take note that the goal is out of reach, or, where limits count, that solutions are beyond them."""
        if unreached:
            self._reject(np.zeros(0), int(IkReturnAction.RejectKinematics), "out of reach")
        if limited and limits:
            self._reject(np.zeros(0), int(IkReturnAction.RejectJointLimits), "beyond the limits")

    def failure(self) -> IkReturn:
        """Return the answer for a goal without a good solution."""
        answer = IkReturn(self.action | _REJECT)
        failures = self._query.failures
        answer.name_failures([] if failures is None else list(range(self._started, len(failures))))
        return answer


def solution(row: Floats) -> IkReturn:
    """Return the answer with a solution, shape (n,)."""
    answer = IkReturn(IkReturnAction.Success)
    answer.SetSolution(row)
    return answer
