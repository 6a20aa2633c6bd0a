"""The search for joint values of one arm, in which filters and tests of collision may have a say."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers, checked_vector
from ravemj.core.transforms import Floats
from ravemj.errors import ArgumentError, RavemjError, UnsupportedError
from ravemj.geometry_functions.ik_parameterization import goal_of_tool
from ravemj.geometry_functions.ik_types import GOAL_TYPES, IkParameterizationType
from ravemj.manipulation.arm_search import ArmSearch
from ravemj.rave.ik_validation import Filter, FilteredSearch, Goal, checks_of
from ravemj.rave.ikreturn import IkFailureInfo, IkReturn
from ravemj.rave.interface import Interface
from ravemj.rave.specification import IkParameterization

# Half of what ravemj takes to be imported would be for inverse kinematics, which most scripts do without.
# ruff: noqa: PLC0415

if TYPE_CHECKING:
    from ravemj.ik import IKSolver, Task
    from ravemj.model import scene
    from ravemj.rave.environment import Environment
    from ravemj.rave.manipulator import Manipulator
    from ravemj.rave.robot import Robot

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


class IkSearch(Interface):
    """Finds joint values for goals of one type in the frame of an arm's base; ``IkSolver`` is what users see of it.

    Attributes:
        kind: The type of goal.
        arm_solver: What computes.
    """

    _internal = (
        "arm_solver",
        "attach",
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
