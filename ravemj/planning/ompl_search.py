"""Planners of OMPL, the Open Motion Planning Library, in ravemj's spaces; with the extra ``planning``."""

import importlib
import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import Any

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.rrt import Budget, End, Search, without_repetitions
from ravemj.planning.space import Space

Ompl = Any
"""Object of OMPL, which has no type annotations."""

_PATIENCE = 0.02
"""Interval [s] between checks of the budget, for planners that do not call the termination condition themselves."""

_NO_SETTINGS = ("up", "name")
"""OMPL methods ``setup`` and ``setName`` that do not set parameters."""


class OmplError(Exception):
    """A planner of OMPL does not support a space or a setting; the text gives the reason."""


@cache
def planner_classes() -> Mapping[str, Ompl] | None:
    """Return OMPL's planners by lower-case name; None if OMPL is not installed."""
    try:
        base, geometric = (importlib.import_module(f"ompl.{name}") for name in ("base", "geometric"))
    except ImportError:
        return None
    classes = inspect.getmembers(geometric, inspect.isclass)
    return {name.lower(): planner for name, planner in classes if issubclass(planner, base.Planner)}


def search_with_ompl(
    planner: Ompl,
    edges: Edges,
    starts: Sequence[Floats],
    goals: Sequence[Floats],
    budget: Budget,
    seed: int,
    settings: Mapping[str, str],
) -> Search:
    """Find a path with a planner class of OMPL; optimizing planners use up the budget.

    Starts and goals must be allowed. An iteration is a termination check of the planner, or a node of a roadmap.
    ``settings`` maps parameters of the planner, such as ``range`` or ``goal_bias``, to strings; unknown ones are
    ignored.

    Raises:
        OmplError: the planner does not support the space, or a setting is wrong.
    """
    util = importlib.import_module("ompl.util")
    level = util.getLogLevel()
    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed + 1)  # 0 means none
    try:
        return _searched(planner, edges, (starts, goals), budget, settings)
    except RuntimeError as error:
        raise OmplError(f"OMPL: {' '.join(str(error).split())}") from None
    finally:
        util.setLogLevel(level)


def _searched(
    planner: Ompl,
    edges: Edges,
    ends: tuple[Sequence[Floats], Sequence[Floats]],
    budget: Budget,
    settings: Mapping[str, str],
) -> Search:
    base = importlib.import_module("ompl.base")
    space, questions = _OmplSpace(base, edges.space), _Questions(edges, budget)

    def is_allowed(state: Ompl) -> bool:
        return questions.point(space.values(state))

    class EdgeValidator(base.MotionValidator):
        def checkMotion(self, start: Ompl, other: Ompl) -> bool:  # noqa: N802 - OMPL's name
            return questions.line(space.values(start), space.values(other))

    information = base.SpaceInformation(space.made)
    information.setStateValidityChecker(is_allowed)
    lines = EdgeValidator(information)
    information.setMotionValidator(lines)
    information.setup()
    problem, wanted = base.ProblemDefinition(information), base.GoalStates(information)
    for start in ends[0]:
        problem.addStartState(space.state(information, start))
    for goal in ends[1]:
        wanted.addState(space.state(information, goal))
    problem.setGoal(wanted)
    solver = planner(information)
    _apply(solver, settings)
    solver.setProblemDefinition(problem)
    try:
        solver.setup()
        _solve(solver, base.PlannerTerminationCondition(questions.is_over), questions)
    finally:
        questions.check()
    if not problem.hasExactSolution():
        return Search(questions.end or End.iterations, None, -1, -1, questions.count, ())
    path = np.array([space.values(state) for state in problem.getSolutionPath().getStates()])
    start, goal = (_nearest(edges.space, some, path[place]) for some, place in zip(ends, (0, -1), strict=True))
    path[0], path[-1] = ends[0][start], ends[1][goal]
    return Search(End.found, without_repetitions(path), start, goal, questions.count, ())


def _solve(solver: Ompl, condition: Ompl, questions: "_Questions") -> None:
    """Run a planner until it has a path or the budget ends."""
    if not hasattr(solver, "milestoneCount"):
        solver.solve(condition)
        return
    # Roadmaps are searched in a thread that holds the lock of the Python interpreter, so it must not call Python.
    while not questions.is_over() and not solver.getProblemDefinition().hasExactSolution():
        solver.solve(_PATIENCE)
        questions.count = solver.milestoneCount()


def _nearest(space: Space, configurations: Sequence[Floats], configuration: Floats) -> int:
    return int(np.argmin([space.distance(other, configuration) for other in configurations]))


def _apply(solver: Ompl, settings: Mapping[str, str]) -> None:
    """Set OMPL parameters by their setters, as ``goal_bias`` by ``setGoalBias``, parsed as numbers or booleans."""
    for name, text in settings.items():
        setter = getattr(solver, "set" + "".join(map(str.capitalize, name.split("_"))), None)
        if name in _NO_SETTINGS or setter is None:
            continue
        for kind in (int, float, _truth):
            with suppress(TypeError, ValueError, KeyError):
                setter(kind(text))
                break
        else:
            raise OmplError(f"<{name}>: OMPL's {solver.getName()} does not take '{text}'")


def _truth(text: str) -> bool:
    return {"1": True, "true": True, "0": False, "false": False}[text.lower()]


class _Questions:
    """Callbacks of OMPL. Their exceptions end the search and are stored, since C++ cannot propagate them."""

    def __init__(self, edges: Edges, budget: Budget) -> None:
        self._edges, self._budget = edges, budget
        self.end: End | None = None
        self._errors: list[BaseException] = []
        self.count = 0

    def safely(self, test: Callable[[], bool]) -> bool:
        """Return the result of a test; False after an exception."""
        try:
            return not self._errors and bool(test())  # numpy has its own booleans
        except BaseException as error:  # raised again after the return from C++
            self._errors.append(error)
            return False

    def check(self) -> None:
        """Raise a stored exception, and drop the reference to it, since its traceback refers to OMPL's objects."""
        if self._errors:
            raise self._errors.pop()

    def point(self, values: Floats) -> bool:
        """Return whether a configuration is within the limits and allowed."""
        return self.safely(lambda: self._edges.space.outside(values) is None and self._edges.allowed(values))

    def line(self, start: Floats, end: Floats) -> bool:
        """Return whether the line between two configurations is allowed."""
        return self.safely(lambda: self._edges.line(start, self._edges.space.difference(end, start)))

    def is_over(self) -> bool:
        """Count one iteration; return whether the search must end."""

        def proceeds() -> bool:
            self.end = self._budget.end(self.count)
            self.count += 1
            return self.end is None

        return not self.safely(proceeds)


class _OmplSpace:
    """Configuration space for OMPL: a box of weighted values, and a circle for each circular value."""

    def __init__(self, base: Ompl, space: Space) -> None:
        circular = space.coordinates.circular
        self._weights = np.where(space.weights > 0, space.weights, 1.0)
        self._circles, self._straight = np.flatnonzero(circular).tolist(), np.flatnonzero(~circular).tolist()
        parts: list[Ompl] = []
        if self._straight:
            bounds = base.RealVectorBounds(len(self._straight))
            for axis, column in enumerate(self._straight):
                bounds.setLow(axis, float(space.lower[column] * self._weights[column]))
                bounds.setHigh(axis, float(space.upper[column] * self._weights[column]))
            parts.append(base.RealVectorStateSpace(len(self._straight)))
            parts[0].setBounds(bounds)
        parts += [base.SO2StateSpace() for _ in self._circles]
        weights = [*([1.0] if self._straight else []), *self._weights[self._circles].tolist()]
        self.made = base.CompoundStateSpace(parts, weights) if self._circles else parts[0]

    def values(self, state: Ompl) -> Floats:
        values, first = np.empty(len(self._weights)), int(bool(self._straight))
        if self._straight:
            box = state[0] if self._circles else state
            values[self._straight] = [box[axis] for axis in range(len(self._straight))]
            values[self._straight] /= self._weights[self._straight]
        for place, column in enumerate(self._circles, first):
            values[column] = state[place].value
        return values

    def state(self, information: Ompl, values: Floats) -> Ompl:
        state, first = information.allocState(), int(bool(self._straight))
        box = state[0] if self._circles and self._straight else state
        for axis, column in enumerate(self._straight):
            box[axis] = float(values[column] * self._weights[column])
        for place, column in enumerate(self._circles, first):
            state[place].value = float(np.remainder(values[column] + np.pi, 2 * np.pi) - np.pi)
        return state
