"""Solutions of one goal, one after the other, for those who reject some of them: filters and collision checks."""

from collections.abc import Iterator

import numpy as np

from ravemj.ik.limits import all_turns, distances, nearest_turns
from ravemj.ik.solver import FIRST, NEXT, ArmSolutions
from ravemj.ik.tasks import goal_poses
from ravemj.ik.vectors import Floats


def nearest_first(
    solver: ArmSolutions,
    goal: Floats,
    seed: Floats,
    *,
    weights: Floats | None = None,
    free: Floats | None = None,
    limits: bool = True,
) -> Iterator[Floats]:
    """Yield the solutions, all turns within the limits, those near a configuration first.

    Free joints come before nearness: all solutions for the value nearest to the configuration's come first.

    Args:
        solver: The solver.
        goal: A pose (4, 4), or what else its task asks for.
        seed: The configuration, shape (n,).
        weights: What a radian or a metre of each joint counts, shape (n,); all the same if None.
        free: Values of the free joints, shape (k,); None: samples, from the configuration outwards.
        limits: Whether limits count; if not, every branch comes once, with angles in [-pi, pi].
    """
    for rows in _groups(solver, goal, seed, free, limits=limits):
        turned = all_turns(solver.chain, rows) if limits else rows
        yield from turned[np.argsort(distances(solver.chain, turned, seed, weights), kind="stable")]


def _groups(solver: ArmSolutions, goal: Floats, seed: Floats, free: Floats | None, *, limits: bool) -> Iterator[Floats]:
    """Yield solutions in [-pi, pi], shape (K, n), that come one group after the other."""
    if solver.closed is None:
        pose = goal_poses(solver.chain, solver.task, goal)
        found = solver.numeric.solve(pose, seed)
        if found is not None:
            yield found[None]
            rest = solver.numeric.solve_all(pose)
            yield rest[np.abs(rest - found).max(axis=1, initial=0.0) > 1e-3]
        return
    values = solver.free_samples(seed[list(solver.free)]) if free is None else free.reshape(1, -1)
    some = False
    for part in np.split(values, range(FIRST, len(values), NEXT)):
        solutions = solver.solve(goal[None], free=part, limits=False)
        rows = solutions.values.reshape(len(part), -1, solver.chain.dof)
        for row, valid in zip(rows, solutions.valid.reshape(len(part), -1), strict=True):
            if valid.any():
                some = True
                yield solver.spread(row[valid], seed) if solutions.merged[0] else row[valid]
        if solutions.merged[0] and limits and not solver.free:
            yield _descended(solver, goal, seed)
    if not some and limits and free is None:
        yield _descended(solver, goal, seed)


def _descended(solver: ArmSolutions, goal: Floats, seed: Floats) -> Floats:
    return solver.descent(goal_poses(solver.chain, solver.task, goal), seed)


def shortfall(solver: ArmSolutions, goal: Floats, free: Floats | None = None) -> tuple[bool, bool]:
    """Return whether a goal is out of reach for a value of free joints, and whether limits exclude solutions."""
    if solver.closed is None:
        return True, False
    found = solver.solve(goal[None], free=free, limits=False)
    tries = max(1, found.valid.shape[1] // len(solver.closed.branch_names))
    reached = found.valid.reshape(tries, -1).any(axis=1)
    _, inside = nearest_turns(solver.chain, found.of(0))
    return not reached.all(), not inside.all()
