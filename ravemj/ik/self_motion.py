"""Self-motion of redundant arms: null spaces, paths in them, sweeps of a free joint."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik import redundancy
from ravemj.ik.chain import Chain
from ravemj.ik.limits import distances, nearest_turns
from ravemj.ik.numeric import ACCURATE
from ravemj.ik.solver import ArmSolutions
from ravemj.ik.tasks import Task, goal_poses
from ravemj.ik.vectors import Floats

_SINGULAR = 1e-6
"""Singular values below this are 0; lengths are divided by the reach."""
_JUMP = 0.5
"""Largest joint step [rad or m] between consecutive configurations of one branch."""


def null_space(chain: Chain, values: Floats, task: Task = Task.TRANSFORM, goal: ArrayLike | None = None) -> Floats:
    """Return an orthonormal basis of self-motion velocities, the null space of the task Jacobian, shape (n, k).

    In singular configurations, k is larger.

    Args:
        chain: The arm.
        values: The configuration, shape (n,).
        task: The constrained components of the tool pose.
        goal: The goal that the configuration reaches; needed if it reaches several goals of the task, as with
            ``LOOK_AT``.
    """
    pose = None if goal is None else goal_poses(chain, task, goal)
    jacobian = redundancy.task_jacobians(chain, task, values[None], pose)[0]
    _, sizes, rows = np.linalg.svd(jacobian)
    basis: Floats = rows[int((sizes > _SINGULAR).sum()) :].T
    return basis


def null_space_path(
    solver: ArmSolutions,
    goal: ArrayLike,
    start: Floats,
    along: Floats,
    *,
    step: float = 0.05,
    length: float = 2 * np.pi,
) -> Floats:
    """Return configurations along a self-motion of the arm, during which the tool keeps its goal.

    The path ends at a limit, when it returns to its start, or after ``length``.

    Args:
        solver: The solver of the arm.
        goal: The goal, which the start reaches.
        start: Joint values, shape (n,).
        along: Joint velocities, shape (n,); the path starts along their projection onto the null space.
        step: The distance between configurations, in joint space [rad or m].
        length: Maximum length of the path.

    Returns:
        Configurations, shape (M, n), the first of them the start.

    Raises:
        ValueError: the projection of ``along`` onto the null space is zero.
    """
    chain, pose = solver.chain, goal_poses(solver.chain, solver.task, goal)
    lower, upper = chain.bounds
    rows, direction = [start], along
    for _ in range(int(length / step)):
        basis = null_space(chain, rows[-1], solver.task, goal)
        direction = basis @ (basis.T @ direction)
        size = np.linalg.norm(direction)
        if size < _SINGULAR:
            if len(rows) == 1:
                raise ValueError("the arm cannot move along these joint velocities while its goal stays reached")
            break
        direction = direction / size
        ahead = rows[-1] + step * direction
        if (ahead < lower).any() or (ahead > upper).any():
            break
        reached = solver.numeric.descend(pose, ahead)
        if reached.error > ACCURATE or np.linalg.norm(reached.values - ahead) > step:
            break
        rows.append(reached.values)
        if len(rows) > 3 and distances(chain, reached.values, start) < 0.6 * step:
            break
    return np.array(rows)


def sweep(solver: ArmSolutions, goal: ArrayLike, seed: Floats, *, step: float = 0.01) -> Floats:
    """Return solutions of a goal that change continuously while the free joint is swept over its range.

    Args:
        solver: A solver in closed form, with one free joint.
        goal: The goal.
        seed: A configuration, shape (n,); the sweep contains the solution nearest to it.
        step: The step of the free joint [rad or m].

    Returns:
        Configurations within the limits, shape (M, n), ordered by the free joint; empty if the goal is unreachable.

    Raises:
        ValueError: the solver has no free joint, or several.
    """
    if solver.closed is None or len(solver.free) != 1:
        raise ValueError(f"a sweep needs a solver in closed form with one free joint, and {len(solver.free)} are free")
    middle = solver.nearest(goal, seed)
    if middle is None:
        return np.zeros((0, solver.chain.dof))
    joint, pose = solver.free[0], goal_poses(solver.chain, solver.task, goal)
    values = redundancy.samples(solver.chain, solver.free, [step], middle[[joint]])[1:, 0]
    above = _followed(solver, pose, middle, values[values > middle[joint]])
    below = _followed(solver, pose, middle, values[values < middle[joint]])
    return np.array([*below[::-1], middle, *above])


def _followed(solver: ArmSolutions, pose: Floats, start: Floats, values: Floats) -> list[Floats]:
    """Return a solution for each value of the free joint, nearest to the previous one; stop if there is none."""
    assert solver.closed is not None
    solutions = solver.closed.solve(np.repeat(pose[None], len(values), axis=0), values[:, None])
    rows, last = list[Floats](), start
    for index in range(len(values)):
        near, inside = nearest_turns(solver.chain, solutions.of(index), last)
        near = near[inside]
        away = np.abs(near - last).max(axis=1, initial=0.0)
        if not len(near) or away.min() > _JUMP:
            break
        last = near[np.argmin(away)]
        rows.append(last)
    return rows
