"""Candidate solutions of one goal in sequence, for callers that reject some, such as filters and collision checks."""

from collections.abc import Iterator

import numpy as np

from ravemj.ik import redundancy
from ravemj.ik.closed import Solutions
from ravemj.ik.intervals import excess, intervals, rows_at
from ravemj.ik.limits import TOLERANCE, all_turns, distances, nearest_turns
from ravemj.ik.numeric import DISTINCT
from ravemj.ik.solver import FIRST, NEXT, ArmSolutions
from ravemj.ik.tasks import goal_poses
from ravemj.ik.vectors import Floats

_FINEST = 0.02
"""Minimum spacing of the values tried in an interval of solutions, as a fraction of the free joint's sampling step."""
_MOST = 240
"""Maximum number of values tried in the free joint's intervals of solutions, in addition to its samples."""


def nearest_first(
    solver: ArmSolutions,
    goal: Floats,
    seed: Floats,
    *,
    weights: Floats | None = None,
    free: Floats | None = None,
    limits: bool = True,
    fine: bool = True,
) -> Iterator[Floats]:
    """Yield all solutions and their equivalents by whole turns within the limits, those nearest to ``seed`` first.

    Free joints take precedence: all solutions for the nearest free value come first.

    Args:
        solver: The solver.
        goal: A pose (4, 4), or another goal of the task.
        seed: The configuration from which distances are measured, shape (n,).
        weights: Weight of each joint in distances, shape (n,); by default equal.
        free: Values of the free joints, shape (k,); by default samples, from those of ``seed`` outwards.
        limits: Whether to enforce limits; otherwise each branch is yielded once, with angles in [-pi, pi].
        fine: Whether to try many values between the samples; see ``beyond_samples``.
    """
    for rows in _groups(solver, goal, seed, free, limits=limits, fine=fine):
        turned = all_turns(solver.chain, rows) if limits else rows
        yield from turned[np.argsort(distances(solver.chain, turned, seed, weights), kind="stable")]


def ranked(solver: ArmSolutions, goal: Floats, start: Floats) -> list[tuple[Floats, str]]:
    """Return all solutions and their branch names, those nearest to ``start`` first.

    They include solutions outside the limits; angles are shifted by whole turns into their limits if possible. If no
    sample of the free joints gives a solution within the limits, solutions between the samples are added.

    Args:
        solver: The solver.
        goal: A pose (4, 4), or another goal of the task.
        start: The configuration from which distances are measured, shape (n,).
    """
    solutions = solver.solve(goal[None], limits=False)
    valid, chain = solutions.valid[0], solver.chain
    rows = solutions.values[0][valid]
    names = [name for name, good in zip(branch_names(solver, len(valid)), valid.tolist(), strict=True) if good]
    if solver.free and not nearest_turns(chain, rows, start)[1].any():
        more = solver.solve_one(goal)
        rows = np.vstack([rows, more])
        names += [" ".join(f"j{joint + 1}={row[joint]:.6g}" for joint in solver.free) for row in more]
    moved, _ = nearest_turns(chain, rows, start)  # which also clamps values just beyond a limit
    rows = rows + 2 * np.pi * np.where(chain.turning, np.round((moved - rows) / (2 * np.pi)), 0.0)
    order = np.argsort(distances(chain, rows, start), kind="stable")
    return [(rows[index], names[index]) for index in order.tolist()]


def branch_names(solver: ArmSolutions, count: int) -> list[str]:
    """Return a name for each solution of a goal: values of free joints, and branches of the closed form."""
    if solver.closed is None:
        return [f"found {number + 1}" for number in range(count)]
    free = [
        " ".join(f"j{joint + 1}={value:.4g}" for joint, value in zip(solver.free, row, strict=True))
        for row in solver.free_samples()
    ]
    return [f"{values} {name}".strip() for values in free for name in solver.closed.branch_names]


def everything(
    solver: ArmSolutions, goal: Floats, *, free: Floats | None = None, limits: bool = True, fine: bool = True
) -> Iterator[Floats]:
    """Yield batches of solutions (K, n): first all of ``solve_one``, then others, for callers that reject those.

    The arguments are those of ``nearest_first``.
    """
    rows = solver.solve_one(goal, free=None if free is None else free[None], limits=limits)
    yield rows
    if not len(rows) or free is not None or solver.closed is None or not solver.free:
        return
    pose, samples = goal_poses(solver.chain, solver.task, goal), solver.free_samples()
    solutions = solver.at(pose, samples, limits=limits)
    for group in beyond_samples(solver, pose, samples, solutions, limits=limits, fine=fine):
        yield all_turns(solver.chain, group) if limits else group


def _groups(
    solver: ArmSolutions, goal: Floats, seed: Floats, free: Floats | None, *, limits: bool, fine: bool
) -> Iterator[Floats]:
    """Yield IK solutions in batches of shape (K, n), angles in [-pi, pi]; arguments as in ``nearest_first``."""
    pose = goal_poses(solver.chain, solver.task, goal)
    if solver.closed is None:
        yield from _searched(solver, pose, seed)
        return
    values = solver.free_samples(seed[list(solver.free)]) if free is None else free.reshape(1, -1)
    parts = list[Solutions]()
    for part in np.split(values, range(FIRST, len(values), NEXT)):
        solutions = solver.at(pose, part, limits=False)
        merged = solutions.merged.any()
        for row, valid in zip(solutions.values, solutions.valid, strict=True):
            if valid.any():
                yield solver.spread(row[valid], seed) if merged else row[valid]
        if merged and limits and not solver.free:
            yield solver.descent(pose, seed)
        parts.append(solutions)
    if free is None and solver.free:
        yield from beyond_samples(solver, pose, values, Solutions.joined(parts), seed, limits=limits, fine=fine)
    if not any(part.valid.any() for part in parts) and limits and free is None:
        yield solver.descent(pose, seed)


def _searched(solver: ArmSolutions, pose: Floats, seed: Floats) -> Iterator[Floats]:
    solution = solver.numeric.solve(pose, seed)
    if solution is not None:
        yield solution[None]
        rest = solver.numeric.solve_all(pose)
        yield rest[np.abs(rest - solution).max(axis=1, initial=0.0) > DISTINCT]


def beyond_samples(
    solver: ArmSolutions,
    pose: Floats,
    samples: Floats,
    solutions: Solutions,
    seed: Floats | None = None,
    *,
    limits: bool = True,
    fine: bool = True,
) -> Iterator[Floats]:
    """Yield batches of solutions (K, n) at free joint values other than the samples.

    Callers use it if they rejected the solutions at the samples. First come the solutions of ``solver.between``. Then,
    if one joint is free, the intervals in which it has solutions are tried: in the middle, at the ends, at eight more
    values, and then at values between these.

    Args:
        solver: A solver in closed form with free joints.
        pose: A pose (4, 4).
        samples: The samples, shape (K, k).
        solutions: The results of ``solver.at`` for the samples.
        seed: Configuration whose joint values are also tried for singular solutions, shape (n,); see
            ``ArmSolutions.spread``.
        limits: Whether to enforce joint limits.
        fine: Whether to continue after the ends, the middle and eight values of each interval.
    """
    values = [samples]
    for rows in solver.between(pose, samples, solutions, seed, limits=limits):
        values.append(rows[:1, list(solver.free)])
        yield rows
    if len(solver.free) != 1 or (len(values) == 1 and excess(solver.chain, solutions, limits=limits).min() > TOLERANCE):
        return
    ends = np.array(redundancy.free_range(solver.chain, *solver.free))
    inside = intervals(solver, pose, np.unique(np.concatenate([*values, ends[:, None]])), limits=limits)
    count, parts, (step,) = 0, 10, solver.steps
    for fractions in (np.array([0.5]), np.array([0.0, 1.0]), np.array([1, 2, 3, 4, 6, 7, 8, 9]) / 10):
        if inside:
            rows = rows_at(solver, pose, inside, fractions, limits=limits)
            count += len(rows)
            yield rows
    while fine and count < _MOST:
        inside = [interval for interval in inside if interval.high - interval.low > _FINEST * parts * step]
        if not inside:
            return
        scattered = np.argsort(np.arange(parts) * 0.618 % 1)  # since the caller may stop early
        rows = rows_at(solver, pose, inside, (scattered + 0.5) / parts, limits=limits)[: _MOST - count]
        count, parts = count + len(rows), 2 * parts
        yield rows


def shortfall(solver: ArmSolutions, goal: Floats, free: Floats | None = None) -> tuple[bool, bool]:
    """Return whether the goal is out of reach for some free joint values, and whether limits exclude solutions."""
    if solver.closed is None:
        return True, False
    solutions = solver.solve(goal[None], free=free, limits=False)
    tries = max(1, solutions.valid.shape[1] // len(solver.closed.branch_names))
    reached = solutions.valid.reshape(tries, -1).any(axis=1)
    _, inside = nearest_turns(solver.chain, solutions.of(0))
    return not reached.all(), not inside.all()
