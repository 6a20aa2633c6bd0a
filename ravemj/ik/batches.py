"""Inverse kinematics for batches of goals; the order of solutions is that of ``ArmSolutions.solve_one``."""

import numpy as np
from numpy.typing import ArrayLike

from ravemj.ik.limits import all_turns_with_sources
from ravemj.ik.solver import ArmSolutions
from ravemj.ik.tasks import goal_poses
from ravemj.ik.vectors import Bools, Floats, Ints


def solve_each(
    solver: ArmSolutions, goals: ArrayLike, *, free: Floats | None = None, limits: bool = True
) -> tuple[Floats, Ints]:
    """Return all solutions of all goals, including equivalents by whole turns within the limits.

    Goals with singular solutions, or with solutions only between the samples of free joints, are solved one by one.

    Args:
        solver: The solver.
        goals: Poses of the tool in the base (N, 4, 4), or other goals of the task, with N as first axis.
        free: Values of the free joints, shape (K, k), all tried for every goal; by default their samples.
        limits: Whether to enforce joint limits; otherwise angles are in [-pi, pi].

    Returns:
        Joint values, shape (M, n), and the index of the goal of each row, ascending, shape (M,).

    Raises:
        ValueError: goals have a wrong shape, are not finite, or are not rigid transforms.
    """
    poses = goal_poses(solver.chain, solver.task, goals)
    if solver.closed is None:
        return _joined(solver, {goal: _one(solver, poses, goal, free, limits=limits) for goal in range(len(poses))})
    solutions = solver.solve(goals, free=free, limits=False)
    rows, sources, _ = solutions.rows
    if limits:
        rows, kept = all_turns_with_sources(solver.chain, rows)
        sources = sources[kept]
    again = solutions.merged.copy()
    if solver.free and free is None:
        again |= np.bincount(sources, minlength=len(poses)) == 0
    if not again.any():
        return rows, sources
    slow = {goal: _one(solver, poses, goal, free, limits=limits) for goal in np.flatnonzero(again).tolist()}
    slow_rows, slow_sources = _joined(solver, slow)
    kept = ~again[sources]
    rows, sources = np.concatenate([rows[kept], slow_rows]), np.concatenate([sources[kept], slow_sources])
    order = np.argsort(sources, kind="stable")
    return rows[order], sources[order]


def _one(solver: ArmSolutions, poses: Floats, goal: int, free: Floats | None, *, limits: bool) -> Floats:
    return solver.solve_one(poses[goal], free=free, limits=limits)


def _joined(solver: ArmSolutions, rows: dict[int, Floats]) -> tuple[Floats, Ints]:
    counts = np.array([len(group) for group in rows.values()], dtype=int)
    values = np.concatenate([np.zeros((0, solver.chain.dof)), *rows.values()])
    return values, np.repeat(np.array([*rows], dtype=int), counts)


def padded(rows: Floats, sources: Ints, count: int) -> tuple[Floats, Bools]:
    """Group solutions (M, n) by goal, padded with NaN to the same number K for each goal.

    Args:
        rows: The solutions.
        sources: The index of the goal of each solution, ascending, shape (M,).
        count: The number of goals.

    Returns:
        Joint values, shape (count, K, n), and the mask of valid rows, shape (count, K).
    """
    numbers = np.bincount(sources, minlength=count)
    most = int(numbers.max(initial=0))
    valid: Bools = np.arange(most) < numbers[:, None]
    values = np.full((count, most, rows.shape[1]), np.nan)
    values[valid] = rows
    return values, valid
