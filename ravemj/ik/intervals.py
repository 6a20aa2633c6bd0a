"""Solutions between the samples of free joints.

A redundant arm reaches a pose for intervals of its free joint's values. Samples miss intervals narrower than their
step. Near such an interval, the *excess* of a branch, its pose error plus the violation of limits, is small; so numeric
descents from the samples with the least excess find the interval. Its ends are found by repeated subdivision, as far as
the closed form distinguishes branches.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.closed import Solutions
from ravemj.ik.limits import TOLERANCE, beyond_limits, clamped
from ravemj.ik.numeric import ACCURATE
from ravemj.ik.redundancy import free_range
from ravemj.ik.vectors import Bools, Floats, Ints

if TYPE_CHECKING:
    from ravemj.ik.solver import ArmSolutions

_STEEP = 1.0
"""Maximum ratio of the excess at a minimum to the rise to its higher neighbour, for minima that are searched around.

The function ``excess`` defines the excess.
"""
_CLOSE, _VERY_CLOSE = 0.5, 0.05
"""Maximum excess from which a descent is started: from minima of the excess, and from other samples."""
_ENOUGH = 32
"""Number of samples of the free joint below which 2 * ``_ENOUGH`` further samples are added."""
_MOST_VALLEYS, _FIRST_VALLEYS = 6, 2
"""Maximum number of minima of the excess over the samples that are searched around, and of those searched first."""
_MOST_DESCENTS, _LAST_DESCENTS = 12, 4
"""Maximum number of descents from minima of the excess and, if all fail, from other samples with the least excess."""
_FRACTIONS = np.linspace(0, 1, 12)
"""Values of the free joint tried around a minimum of ``excess``, as fractions of the range between its neighbours."""
_PARTS, _SECTIONS = 8, 5
"""Values tested per subdivision, and number of subdivisions: an end of an interval is found to 1 / 9⁵ of a step."""


class FreeInterval(NamedTuple):
    """Interval of the free joint in which one branch is a solution within the limits.

    Attributes:
        branch: Index of the branch.
        low: Smallest value [rad or m].
        high: Largest value.
    """

    branch: int
    low: float
    high: float


def excess(chain: Chain, solutions: Solutions, *, limits: bool = True) -> Floats:
    """Return pose error plus violation of limits of each branch, shape (N, B); 0 for solutions."""
    missed = np.where(solutions.valid, 0.0, solutions.errors)
    if limits:
        missed = missed + beyond_limits(chain, solutions.values)
    return np.where(np.isfinite(missed), missed, np.inf)


def closest(chain: Chain, solutions: Solutions, most: int) -> list[Floats]:
    """Return joint values of the ``most`` branches with the least excess, clamped to the limits, shape (n,) each."""
    missed = excess(chain, solutions)
    places = _distinct(missed, np.argwhere(np.isfinite(missed)), most)
    return [clamped(chain, solutions.values[sample, branch]) for sample, branch in places.tolist()]


Found = tuple[Floats, Solutions | None]
"""Solution within the limits, shape (n,), and the closed-form solutions at its free joint values, if known."""


def between_samples(solver: "ArmSolutions", pose: Floats, free: Floats, solutions: Solutions) -> Iterator[Found]:
    """Yield solutions with free joint values between the sampled ones.

    Args:
        solver: A solver in closed form.
        pose: The pose (4, 4).
        free: Samples of the free joints, shape (K, k).
        solutions: The closed-form solutions of each sample.
    """
    missed = excess(solver.chain, solutions)
    if free.shape[1] > 1:
        yield from _descents(solver, pose, solutions, missed, np.argwhere((missed > 0) & (missed < _CLOSE)))
        return
    low, high = free_range(solver.chain, *solver.free)
    values = free[:, 0]
    if len(values) < _ENOUGH:
        more = np.linspace(low, high, 2 * _ENOUGH)
        at_more = solver.at(pose, more[:, None])
        values, missed = np.append(values, more), np.vstack([missed, excess(solver.chain, at_more)])
        samples, branches = np.nonzero(missed[len(free) :] <= TOLERANCE)
        if len(samples):
            middle = len(samples) // 2
            yield at_more.values[samples[middle], branches[middle]], at_more.only(samples[middle])
    order = np.argsort(values, kind="stable")
    values, in_order = np.array([low, *values[order], high]), missed[order]
    samples, branches = _valleys(in_order)
    closest_first = samples[np.argsort(in_order[samples, branches], kind="stable")]
    chosen = [*dict.fromkeys(closest_first.tolist())][:_MOST_VALLEYS]
    is_reached = False
    for found in _near(solver, pose, values, [(sample, branches[samples == sample]) for sample in chosen]):
        is_reached = True
        yield found
    if not is_reached and missed.min() > TOLERANCE:
        few = np.argwhere(missed[: len(solutions)] < _VERY_CLOSE)
        yield from _descents(solver, pose, solutions, missed, few, _LAST_DESCENTS)


def _near(solver: "ArmSolutions", pose: Floats, values: Floats, valleys: list[tuple[int, Ints]]) -> Iterator[Found]:
    """Yield solutions near minima of ``excess``.

    Each of the ``valleys`` is the index of a sample and the branches with a minimum there.
    """
    count = len(_FRACTIONS)
    parts, rest = list[Solutions](), list[Ints]()
    for first, some in ((0, valleys[:_FIRST_VALLEYS]), (_FIRST_VALLEYS, valleys[_FIRST_VALLEYS:])):
        if not some:
            break
        before = np.array([sample for sample, _ in some])
        points = values[before, None] + (values[before + 2] - values[before])[:, None] * _FRACTIONS
        parts.append(solutions := solver.at(pose, points.reshape(-1, 1)))
        missed = excess(solver.chain, solutions)
        for number, (_, own) in enumerate(some):
            around = missed[number * count : (number + 1) * count, own]
            rows, hits = np.nonzero(around <= TOLERANCE)
            if len(rows):
                middle = len(rows) // 2
                row = number * count + int(rows[middle])
                yield solutions.values[row, own[hits[middle]]], solutions.only(row)
            else:
                rows, hits = _valleys(around)
                rest.append(np.column_stack([(first + number) * count + rows, own[hits]]))
    if rest:
        closer = Solutions.joined(parts)
        yield from _descents(solver, pose, closer, excess(solver.chain, closer), np.concatenate(rest))


def _descents(
    solver: "ArmSolutions", pose: Floats, solutions: Solutions, missed: Floats, places: Ints, most: int = _MOST_DESCENTS
) -> Iterator[Found]:
    """Yield solutions by descents from ``most`` samples and branches of ``places``, those with the least excess."""
    for sample, branch in _distinct(missed, places, most).tolist():
        reached = solver.numeric.descend(pose, clamped(solver.chain, solutions.values[sample, branch]))
        if reached.error < ACCURATE:
            yield reached.values, None


def _distinct(missed: Floats, places: Ints, most: int) -> Ints:
    """Return the ``most`` samples and branches of ``places`` with the least excess ``missed``, shape (K, 2).

    Of several branches with equal excess at one sample, only one is returned.
    """
    sizes = missed[places[:, 0], places[:, 1]]
    kept: dict[tuple[int, float], int] = {}
    for index in np.argsort(sizes, kind="stable").tolist():
        kept.setdefault((int(places[index, 0]), round(float(sizes[index]), 6)), index)
        if len(kept) == most:
            break
    return places[list(kept.values())]


def _valleys(missed: Floats) -> tuple[Ints, Ints]:
    """Return the samples and branches at which the excess ``missed`` (K, B) has a minimum.

    Minima too high to reach 0 before the neighbouring samples are omitted.
    """
    around = np.pad(missed, ((1, 1), (0, 0)), constant_values=np.inf)
    before, after = around[:-2], around[2:]
    lowest = (missed <= before) & (missed <= after) & (missed > 0) & (missed < _CLOSE)
    rise = np.maximum(before, after) - missed  # infinite beyond the last samples, which are limits of the free joint
    samples, branches = np.nonzero(lowest & (missed <= _STEEP * rise))
    return samples, branches


def intervals(solver: "ArmSolutions", pose: Floats, free: Floats, *, limits: bool = True) -> list[FreeInterval]:
    """Return the intervals of the free joint that contain a sample.

    Args:
        solver: A solver in closed form with one free joint.
        pose: The pose (4, 4).
        free: Samples of the free joint, shape (K,), in rising order; the first and the last are its limits.
        limits: Whether to enforce joint limits.
    """
    good = np.pad(_good(solver, pose, free, limits=limits), ((1, 1), (0, 0)))
    opening, closing = good[1:] & ~good[:-1], good[:-1] & ~good[1:]
    branch, first = np.nonzero(opening.T)
    _, beyond = np.nonzero(closing.T)
    inside = np.concatenate([free[first], free[beyond - 1]])
    outside = np.concatenate([free[np.maximum(first - 1, 0)], free[np.minimum(beyond, len(free) - 1)]])
    low, high = np.split(_ends(solver, pose, np.tile(branch, 2), inside, outside, limits=limits), 2)
    return [FreeInterval(*each) for each in zip(branch.tolist(), low.tolist(), high.tolist(), strict=True)]


def _ends(
    solver: "ArmSolutions", pose: Floats, branch: Ints, inside: Floats, outside: Floats, *, limits: bool
) -> Floats:
    """Return the ends of intervals of the free joint, shape (C,), by repeated subdivision.

    For each end, ``inside`` is a value in the interval, and ``outside`` one beyond the end.
    """
    steps = np.arange(_PARTS + 2) / (_PARTS + 1)
    rows = np.arange(len(branch))
    for _ in range(_SECTIONS if len(branch) else 0):
        points = inside[:, None] + (outside - inside)[:, None] * steps
        good = _good(solver, pose, points[:, 1:-1].ravel(), limits=limits)
        own = good.reshape(len(branch), _PARTS, -1)[rows, :, branch]
        last = np.argmin(np.pad(own, ((0, 0), (0, 1))), axis=1)
        inside, outside = points[rows, last], points[rows, last + 1]
    return inside


def _good(solver: "ArmSolutions", pose: Floats, free: Floats, *, limits: bool) -> Bools:
    return excess(solver.chain, solver.at(pose, free[:, None], limits=limits), limits=limits) <= TOLERANCE


def rows_at(
    solver: "ArmSolutions", pose: Floats, inside: list[FreeInterval], fractions: Floats, *, limits: bool = True
) -> Floats:
    """Return the solutions (K, n) at fractions of intervals, from 0 at their low ends to 1."""
    branch, low, high = (np.array(column) for column in zip(*inside, strict=True))
    free = (low + (high - low) * fractions[:, None]).ravel()
    solutions = solver.at(pose, free[:, None], limits=limits)
    rows, branches = np.arange(len(free)), np.tile(branch, len(fractions))
    good = excess(solver.chain, solutions, limits=limits)[rows, branches] <= TOLERANCE
    return solutions.values[rows, branches][good]
