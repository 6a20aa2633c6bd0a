"""Damped least-squares steps that reduce an error, along a gradient and onto a constraint."""

from collections.abc import Callable, Sequence

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.planning.edges import Edges
from ravemj.planning.rrt import Budget, End, Search
from ravemj.planning.space import Space

Error = Callable[[Floats], tuple[Floats, Floats]]
"""Function of a configuration that returns its error, shape (k,), and the negative derivative, shape (k, n)."""

PROJECTION_STEPS = 40
"""Maximum number of steps of a projection: OpenRAVE's number."""

_DAMPING = 1e-8
"""Constant part of the damping, which keeps steps finite if the Jacobian is rank-deficient."""

_STEP = 0.1
"""Maximum length of a step of the iterative projection [rad or m]."""

_PATIENCE = 30
"""Maximum number of consecutive steps of a projection that do not reduce the error."""


def damped_step(error: Floats, jacobian: Floats) -> Floats:
    """Return a damped step that reduces an error (K. Levenberg and D. Marquardt), shape (n,)."""
    damping = _DAMPING + 0.05 * float(error @ error)
    return jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping * np.eye(len(error)), error)


def project(values: Floats, error: Error, space: Space, threshold: float, most: int) -> tuple[int, Floats]:
    """Project a configuration in at most ``most`` steps; return the number of steps (-1: failed) and the result.

    The projection succeeds if the error norm is at most ``threshold``. The limits of the space are kept.
    """
    for step in range(most + 1):
        lacking, jacobian = error(values)
        if np.linalg.norm(lacking) <= threshold:
            return step, values
        values = space.clamp(values + damped_step(lacking, jacobian))
    return -1, values


def descend(
    edges: Edges,
    start: Floats,
    errors: Sequence[Error],
    tolerance: float,
    budget: Budget,
    random: np.random.Generator,
    tries: int,
) -> Search:
    """Reduce each error in turn by descent from the start; stop at the first whose norm is at most ``tolerance``.

    If a damped step is not allowed or increases the error, the best of ``tries`` random steps is taken.
    """
    iteration, stopped = 0, budget.end(0)
    for goal, error in enumerate(errors):
        path, waited, best = [start], 0, np.inf
        while stopped is None and waited < _PATIENCE:
            lacking, jacobian = error(path[-1])
            left = float(np.linalg.norm(lacking))
            if left <= tolerance:
                return Search(End.found, np.array(path), 0, goal, iteration, ())
            waited = 0 if left < best else waited + 1
            best = min(best, left)
            down = _bounded(edges.space, path[-1], damped_step(lacking, jacobian))
            steps = [down] if _comes_nearer(edges, path[-1], down, error, left) else []
            steps = steps or _random_steps(edges, path[-1], random, tries)
            if steps:
                path.append(min(steps, key=lambda step: float(np.linalg.norm(error(step)[0]))))
            iteration += 1
            stopped = budget.end(iteration)
    return Search(stopped or End.stuck, None, -1, -1, iteration, ())


def _comes_nearer(edges: Edges, here: Floats, ahead: Floats, error: Error, left: float) -> bool:
    return float(np.linalg.norm(error(ahead)[0])) < left and edges.line(here, edges.space.difference(ahead, here))


def _random_steps(edges: Edges, here: Floats, random: np.random.Generator, tries: int) -> list[Floats]:
    ends = [_bounded(edges.space, here, random.normal(0.0, _STEP, len(here))) for _ in range(tries)]
    return [end for end in ends if edges.line(here, edges.space.difference(end, here))]


def _bounded(space: Space, here: Floats, step: Floats) -> Floats:
    """Return the configuration after a step from ``here``, shortened to ``_STEP`` and clipped to the limits."""
    far = float(np.linalg.norm(step))
    return space.clamp(here + (step * (_STEP / far) if far > _STEP else step))
