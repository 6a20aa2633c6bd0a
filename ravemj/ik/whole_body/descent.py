"""Steps of whole-body inverse kinematics, and descent by steps until convergence.

The cost is the weighted sum of squared errors. Steps are those of K. Levenberg and D. Marquardt, with damping
multiplied by four if the cost rises and divided by three if it falls. Contacts are equalities: multipliers, updated by
the method of M. Hestenes and M. Powell, enforce them against other tasks, and Newton steps on the contacts alone
correct the drift of finite steps.
"""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from typing import NamedTuple, Protocol

import mujoco
import numpy as np

from ravemj.ik.vectors import Floats
from ravemj.ik.whole_body.bounds import MotionLimits
from ravemj.ik.whole_body.box_qp import BoxProblem
from ravemj.ik.whole_body.levels import daqp, minimise_levels
from ravemj.ik.whole_body.tasks import Inequality, TaskRows, WeightedTask

EXACT = 1e-9
"""Remaining contact error after a step [m or rad]."""
_NEAR = 1e-5
"""Contact error of a displacement at which multiplier updates stop; Newton steps correct the rest."""
_NEWTON = 1e-5
"""Contact error from which one Newton step leaves less than ``EXACT``."""
_TURNS = 3
"""Maximum number of multiplier updates, and of Newton steps on contacts."""
_EXACTLY = 1e-6
"""Maximum remaining fraction of a contact error that counts as removed."""
_DRIFT = 0.05
"""Contact error above which contacts are approached as tasks instead of enforced [m or rad]."""
_LEAST_DAMPING, _MOST_DAMPING = 1e-6, 1e3
_BOUNCE = 1e-7
"""Displacement above which a step that reverses the last one counts as oscillation, as near unreachable targets."""
_WINDOW, _LITTLE = 40, 1e-6
"""Convergence test: the number of steps, and the relative decrease of the cost over them."""
_MINOR = 1e-3
"""Relative decrease of the cost over ``_WINDOW`` steps below which a descent that used all its steps has converged."""
_STILL = 1e-10
"""Displacement that counts as zero."""


class Mechanism(Protocol):
    """Protocol of a moving mechanism; its variables are joint values and a twist of the base."""

    def values(self) -> Floats:
        """Return the joint values to compare with limits, and zeros for the base, which has none; shape (n,)."""
        ...

    def move(self, displacement: Floats) -> None:
        """Move by a displacement, shape (n,)."""
        ...

    def saved(self) -> Floats:
        """Return the configuration."""
        ...

    def restore(self, configuration: Floats) -> None:
        """Restore a configuration."""
        ...

    def inequalities(self) -> Sequence[Inequality]:
        """Return the inequality constraints of displacements."""
        ...


@dataclass(frozen=True)
class DescentResult:
    """Result of a descent.

    Attributes:
        steps: Number of steps.
        cost: Remaining weighted sum of squared errors.
        stopped: Whether it converged; False if the cost still decreased after the maximum number of steps.
    """

    steps: int
    cost: float
    stopped: bool


class _State(NamedTuple):
    """Errors and Jacobians of tasks, and inequalities, in one configuration."""

    measured: Sequence[tuple[WeightedTask, TaskRows]]
    inequalities: Sequence[Inequality]

    def cost(self) -> float:
        """Return the weighted sum of the tasks' squared errors."""
        return _cost(self.measured)

    def costs(self) -> list[tuple[float, float]]:
        """Return (cost, sum of weights) of each level: the violated inequalities, then the tasks by priority."""
        violations = float(sum(np.square(np.maximum(inequality.least, 0.0)).sum() for inequality in self.inequalities))
        numbers = sorted({task.priority for task, _ in self.measured})
        levels = [[task for task in self.measured if task[0].priority == number] for number in numbers]
        costs = [(_cost(level), sum(task.weight for task, _ in level)) for level in levels]
        return [(violations, 1.0), *costs]


class Descent:
    """Minimizes the task errors of a mechanism.

    Attributes:
        tasks: The tasks; disabled ones are ignored.
        limits: Limits of the variables.
        exact_contacts: Whether contacts are equalities; otherwise they are weighted like other tasks.
        velocities: Velocities of the last step [rad/s and m/s], shape (n,).
    """

    def __init__(self, mechanism: Mechanism, limits: MotionLimits) -> None:
        self._mechanism = mechanism
        self.tasks: list[WeightedTask] = []
        self.limits = limits
        self.exact_contacts = True
        self.velocities = np.zeros(len(limits.lower))
        self._damping = _LEAST_DAMPING

    def step(self, dt: float) -> None:
        """Move for ``dt`` seconds, within position, velocity and acceleration limits."""
        state = self._state()
        bounds = self.limits.displacements(self._mechanism.values(), self.velocities, dt)
        moved = self._advance(state, self._damping, bounds)
        velocities = moved / dt
        bounces = velocities.dot(self.velocities) < 0 and float(np.abs(moved).max()) > _BOUNCE
        factor = 10 if bounces else 1 / 1.3
        self._damping = min(max(self._damping * factor, _LEAST_DAMPING), _MOST_DAMPING)
        self.velocities = velocities

    def solve(self, max_steps: int, longest: float) -> DescentResult:
        """Take steps of at most ``longest`` [rad or m] until the cost no longer decreases."""
        mechanism, damping, steps = self._mechanism, 1e-3, 0
        state = self._state()
        stopped = False
        history: deque[float] = deque(maxlen=_WINDOW)
        while steps < max_steps and not stopped:
            steps += 1
            saved = mechanism.saved()
            bounds = self.limits.reachable(mechanism.values(), longest)
            moved = self._advance(state, damping, bounds)
            ahead = self._state()
            size = float(np.abs(moved).max(initial=0.0))
            stopped = size < _STILL
            if improves(state.costs(), ahead.costs(), float(moved.dot(moved))):
                damping, state = max(damping / 3, 1e-12), ahead
            else:
                mechanism.restore(saved)
                damping *= 4
            cost = state.cost()
            stopped = stopped or (len(history) == _WINDOW and history[0] - cost < _LITTLE * abs(cost))
            history.append(cost)
        stopped = stopped or (len(history) == _WINDOW and history[0] - history[-1] < _MINOR * history[-1])
        if len(state.costs()) > 2 or state.inequalities:
            self._settle(state, longest)
        elif self.exact_contacts:
            self._restore_contacts(longest)
        return DescentResult(steps, _cost(self._measured()), stopped)

    def _settle(self, state: _State, longest: float) -> None:
        """Correct the errors that linearization left in all priorities but the lowest.

        Strong damping suppresses motions for the lowest priority.
        """
        for _ in range(_TURNS):
            saved = self._mechanism.saved()
            moved = self._advance(state, _MOST_DAMPING, self.limits.reachable(self._mechanism.values(), longest))
            before, state = state, self._state()
            if not improves(before.costs(), state.costs(), float(moved.dot(moved))):
                self._mechanism.restore(saved)
                break

    def _restore_contacts(self, longest: float) -> None:
        """Close contacts that a target out of reach has pulled open, as far as the limits allow."""
        for _ in range(_TURNS * _TURNS):
            nothing = np.zeros(len(self.limits.lower))
            bounds = self.limits.reachable(self._mechanism.values(), longest)
            if float(np.abs(self._on_contacts(nothing, *bounds, math.inf)).max(initial=0.0)) < _STILL:
                break

    def pressing(self) -> Floats:
        """Return the descent direction of the cost, shape (n,); the bounds that block it are active."""
        pull = np.zeros(len(self.limits.lower))
        for task, rows in self._measured():
            if not task.is_met or not np.isfinite(task.tolerance):
                pull += task.weight * (rows.error @ rows.jacobian)
        return pull

    def _measured(self) -> list[tuple[WeightedTask, TaskRows]]:
        return [(task, task.rows()) for task in self.tasks if task.enabled]

    def _state(self) -> _State:
        return _State(self._measured(), self._mechanism.inequalities())

    def _advance(self, state: _State, damping: float, bounds: tuple[Floats, Floats]) -> Floats:
        """Move by the best displacement within bounds, then correct the contacts; return the total displacement."""
        lower, upper = bounds
        x = self._displacement(state, damping, lower, upper)
        self._mechanism.move(x)
        return self._on_contacts(x, lower, upper) if self.exact_contacts else x

    def _displacement(self, state: _State, damping: float, lower: Floats, upper: Floats) -> Floats:
        measured, inequalities = state
        if inequalities or len({task.priority for task, _ in measured}) > 1:
            daqp()
            return minimise_levels(self._levels(measured), damping, lower, upper, inequalities)
        contacts = [pair for pair in measured if pair[0].is_contact] if self.exact_contacts else []
        others = [pair for pair in measured if not pair[0].is_contact] if contacts else measured
        jacobian, error = _weighted([*contacts, *(pair for pair in others if not pair[1].is_identity)], len(lower))
        hessian, gradient = jacobian.T.dot(jacobian), -error.dot(jacobian)
        diagonal, square = hessian.ravel()[:: len(lower) + 1], float(error.dot(error))
        for task, rows in others:
            if rows.is_identity:
                size, pull = len(rows.error), task.weight * task.gain * rows.error
                diagonal[:size] += task.weight
                gradient[:size] -= pull
                square += task.gain * float(pull.dot(rows.error))
        diagonal += damping * min(square, 1.0)
        problem = BoxProblem(hessian, lower, upper)
        x = problem.minimise(gradient)
        if not contacts:
            return x
        first = sum(len(rows.error) for _, rows in contacts)
        return _on_equalities(problem, gradient, x, jacobian[:first], error[:first])

    def _levels(self, measured: Sequence[tuple[WeightedTask, TaskRows]]) -> list[TaskRows]:
        """Return weighted errors and Jacobians by priority; exact contacts come first within their priority."""

        def level(task: tuple[WeightedTask, TaskRows]) -> tuple[int, bool]:
            return task[0].priority, not (task[0].is_contact and self.exact_contacts)

        parts = (
            _weighted(list(group), len(self.limits.lower)) for _, group in groupby(sorted(measured, key=level), level)
        )
        return [TaskRows(error, jacobian) for jacobian, error in parts]

    def _on_contacts(self, x: Floats, lower: Floats, upper: Floats, most: float = _DRIFT) -> Floats:
        """Correct contact errors below ``most`` after the displacement ``x``; return the total displacement."""
        contacts = [task for task in self.tasks if task.is_contact and task.enabled]
        for _ in range(_TURNS if contacts else 0):
            measured = [(task, task.rows()) for task in contacts]
            error = np.concatenate([rows.error for _, rows in measured])
            left = _length(error)
            if not EXACT < left < most:
                break
            jacobian = np.concatenate([rows.jacobian for _, rows in measured])
            back = _shortest(jacobian, error, lower - x, upper - x)
            self._mechanism.move(back)
            x = x + back
            if left < _NEWTON:
                break
        return x


def _on_equalities(problem: BoxProblem, gradient: Floats, x: Floats, jacobian: Floats, error: Floats) -> Floats:
    """Minimize a box QP subject to ``jacobian @ x = error``, as far as the bounds allow, by multiplier updates."""
    left = error - jacobian.dot(x)
    size = _length(left)
    for _ in range(_TURNS):
        if size < _NEAR:
            break
        gradient = gradient - left.dot(jacobian)
        ahead = problem.minimise(gradient)
        left = error - jacobian.dot(ahead)
        before, size = size, _length(left)
        if size > before / 2:  # bounds, or contradictory rows
            return ahead if size < before else x
        x = ahead
    return x


def _length(error: Floats) -> float:
    """Return the Euclidean norm, which does not depend on the directions of the world's axes."""
    return math.sqrt(float(error.dot(error)))


def _shortest(jacobian: Floats, error: Floats, lower: Floats, upper: Floats) -> Floats:
    """Return a short displacement that removes a contact error; if none is found, the one that reduces it most.

    Variables that leave the box are fixed at their bounds, and the others remove the remaining error.
    """
    x = _least_norm(jacobian, error)
    free = np.ones(len(x), dtype=bool)
    for _ in range(_TURNS):
        outside = (x < lower) | (x > upper)
        if not outside.any():
            return x
        free &= ~outside
        x = np.minimum(np.maximum(x, lower), upper)
        if not free.any():
            break
        left = error - jacobian.dot(np.where(free, 0.0, x))
        x[free] = _least_norm(jacobian[:, free], left)
        if _length(error - jacobian.dot(x)) > _EXACTLY * _length(error):
            break
    hessian = jacobian.T.dot(jacobian)
    hessian.ravel()[:: len(x) + 1] += 1e-6 * np.trace(hessian) / len(x)
    return BoxProblem(hessian, lower, upper).minimise(-error.dot(jacobian))


def _least_norm(jacobian: Floats, error: Floats) -> Floats:
    """Return the shortest x with ``jacobian @ x = error``, slightly damped for dependent rows."""
    square, multipliers = jacobian.dot(jacobian.T), np.empty(len(error))
    diagonal = square.ravel()[:: len(error) + 1]
    diagonal += 1e-9 * float(diagonal.sum()) / len(error) + 1e-300
    mujoco.mju_cholFactor(square, 0.0)
    mujoco.mju_cholSolve(multipliers, square, error)
    return multipliers.dot(jacobian)


def _weighted(measured: Sequence[tuple[WeightedTask, TaskRows]], count: int) -> tuple[Floats, Floats]:
    """Return the stacked Jacobian and error of tasks, scaled by the square roots of their weights."""
    if not measured:
        return np.zeros((0, count)), np.zeros(0)
    jacobian = np.concatenate([rows.jacobian for _, rows in measured])
    error = np.concatenate([rows.error for _, rows in measured])
    roots, gains = _factors(tuple([(task.weight, task.gain, len(rows.error)) for task, rows in measured]))
    jacobian *= roots
    error *= gains
    return jacobian, error


@lru_cache(maxsize=64)
def _factors(tasks: tuple[tuple[float, float, int], ...]) -> tuple[Floats, Floats]:
    """Return the factors of Jacobian rows, (m, 1), and of errors, (m,), for tasks (weight, gain, number of rows)."""
    sizes = [size for _, _, size in tasks]
    roots = np.repeat([math.sqrt(weight) for weight, _, _ in tasks], sizes)
    return roots[:, None], roots * np.repeat([gain for _, gain, _ in tasks], sizes)


def _cost(measured: Sequence[tuple[WeightedTask, TaskRows]]) -> float:
    return float(sum(task.weight * rows.error.dot(rows.error) for task, rows in measured))


def improves(before: Sequence[tuple[float, float]], after: Sequence[tuple[float, float]], square: float) -> bool:
    """Return whether the costs of levels decreased, judged by the first level that changed.

    A displacement changes the errors of higher levels by about the square of its length, which the next step corrects.
    So only larger changes count, except in the last level.

    Args:
        before: For each level its cost and the sum of its weights.
        after: The same after the displacement.
        square: Square of the length of the displacement.
    """
    *firsts, last = zip(before, after, strict=True)
    for (cost, weight), (cost_after, _) in firsts:
        drift = weight * min(square * square, _DRIFT**4)
        if abs(cost_after - cost) > drift:
            return cost_after < cost
    return last[1][0] < last[0][0]
