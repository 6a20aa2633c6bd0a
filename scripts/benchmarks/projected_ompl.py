"""OMPL's RRTConnect in its projected state space, for motions on a constraint of ravemj."""

from typing import Any

import numpy as np
from ompl import base, geometric, util  # pyright: ignore - optional

from ravemj.core.transforms import Floats
from ravemj.planning.constrained_edges import Manifold
from ravemj.planning.rrt import Problem

State = Any
"""OMPL has no types."""

_RANGE = 0.5  # of edges [rad]; OMPL's own, a fifth of the space, solves no more
_EXACT = 1e-9  # of values that are written into a state


def is_solved(problem: Problem, manifold: Manifold, seconds: float, seed: int) -> bool:
    """Return whether OMPL finds a path for a problem, with its own steps along the constraint.

    The test of configurations, the error and its Jacobian are ravemj's.
    """
    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed + 1)  # 0 means none
    space, count = problem.edges.space, len(problem.starts[0])
    bounds = base.RealVectorBounds(count)
    for axis in range(count):
        bounds.setLow(axis, float(space.lower[axis]))
        bounds.setHigh(axis, float(space.upper[axis]))
    ambient, constraint = base.RealVectorStateSpace(count), _Error(count, manifold)
    ambient.setBounds(bounds)
    projected = base.ProjectedStateSpace(ambient, constraint)
    information = base.ConstrainedSpaceInformation(projected)
    values, allowed = _Reader(count), problem.edges.allowed
    information.setStateValidityChecker(lambda state: bool(allowed(values.of(state))))
    information.setup()
    definition, goals, write = base.ProblemDefinition(information), base.GoalStates(information), _Writer(count)
    for row in problem.starts:
        definition.addStartState(write(projected.allocState(), row))
    for row in problem.goals:
        goals.addState(write(projected.allocState(), row))
    definition.setGoal(goals)
    planner = geometric.RRTConnect(information)
    planner.setRange(_RANGE)
    planner.setProblemDefinition(definition)
    planner.setup()
    planner.solve(seconds)
    return bool(definition.hasExactSolution())


class _Error(base.Constraint):
    """The norm of a manifold's error, which ravemj computes faster than the error."""

    def __init__(self, count: int, manifold: Manifold) -> None:
        super().__init__(count, 1, manifold.threshold)
        self._manifold = manifold

    def function(self, values: Floats, out: Floats) -> None:
        out[0] = self._manifold.off(np.array(values))

    def jacobian(self, values: Floats, out: Floats) -> None:
        error, reducing = self._manifold.error(np.array(values))
        out[0] = -error @ reducing / max(float(np.linalg.norm(error)), _EXACT)


# The wheel of OMPL 2.0.1 has no way to read or write the values of a state on a constraint: ``copyToReals`` and
# ``copyFromReals`` take a ``std::vector`` that Python cannot make, and the state has no items. Constraints are given
# the values, so one that is always satisfied reads them, and a projection writes them.


class _Reader(base.Constraint):
    def __init__(self, count: int) -> None:
        super().__init__(count, 1)
        self._values: Floats = np.zeros(count)

    def function(self, values: Floats, out: Floats) -> None:
        self._values = np.array(values)
        out[:] = 0.0

    def of(self, state: State) -> Floats:
        """Return the values of a state."""
        self.isSatisfied(state)
        return self._values


class _Writer:
    """Writes all values of a state but the last, then all but the first: a constraint leaves one free at least."""

    def __init__(self, count: int) -> None:
        self._parts = _Values(count, 0), _Values(count, 1)

    def __call__(self, state: State, values: Floats) -> State:
        for part in self._parts:
            part.wanted = values
            assert part.project(state)
        return state


class _Values(base.Constraint):
    def __init__(self, count: int, first: int) -> None:
        super().__init__(count, count - 1, _EXACT)
        self._rows = np.arange(first, first + count - 1)
        self.wanted: Floats = np.zeros(count)

    def function(self, values: Floats, out: Floats) -> None:
        # A fresh state holds any numbers, so the Jacobian is that of a step onto the wanted values.
        out[:] = np.where(np.isfinite(values), values, 0.0)[self._rows] - self.wanted[self._rows]

    def jacobian(self, values: Floats, out: Floats) -> None:
        out[:] = np.eye(len(self.wanted))[self._rows]
