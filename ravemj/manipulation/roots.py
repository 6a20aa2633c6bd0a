"""Roots of trees: starts and goals sampled before and during planning."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np

from ravemj.core.transforms import Floats
from ravemj.geometry_functions.regions import PoseSet, weights
from ravemj.manipulation.refusals import Cause, RefusedError, Tally

FIRST_ROOTS = 8
"""Number of roots sampled from regions before a search: OpenRAVE's number of IK solutions as goals."""

MOST_DRAWS = 200
"""Maximum number of poses sampled from regions before a search."""

_REPAIRS = 2
"""Maximum number of IK solutions per pose that are projected onto the constraint; each costs hundreds of tests."""

Refuse = Callable[[Floats], RefusedError | None]
"""Returns the reason why a configuration cannot be a start or goal, or None."""


class Sampler(NamedTuple):
    """Source of starts or goals, with its sampling probability.

    Attributes:
        source: The source.
        probability: The probability of sampling it in an iteration.
    """

    source: "RootSource"
    probability: float


class RootSource(Protocol):
    """Protocol of a source of starts or goals."""

    def first(self, refuse: Refuse, random: np.random.Generator, *, enough: int) -> list[Floats]:
        """Restart with new random numbers, and return initial roots, at least ``enough`` if they are found in time."""
        ...

    def next(self, refuse: Refuse) -> Floats | None:
        """Return another root of a search tree that is not refused; None if there is none at this time."""
        ...

    @property
    def tally(self) -> Tally | None:
        """Counts of samples by region and cause, or None."""
        ...

    def region_of(self, root: Floats) -> int:
        """Return the index of the region that a root was sampled from; -1 if unknown."""
        ...


@dataclass(frozen=True)
class FunctionRoots:
    """Starts or goals from a user callback.

    Attributes:
        sample: Returns a start or goal, shape (n,), or None.
    """

    sample: Callable[[], Floats | None]
    tally: None = None

    def first(self, refuse: Refuse, random: np.random.Generator, *, enough: int) -> list[Floats]:
        """Return an empty list: the callback is only used during the search."""
        del refuse, random, enough
        return []

    def next(self, refuse: Refuse) -> Floats | None:
        """Return the start or goal that the callback returns; None if it returns none or one that is refused."""
        root = self.sample()
        return None if root is None or refuse(root) is not None else root

    def region_of(self, root: Floats) -> int:
        """Return -1: there are no regions."""
        del root
        return -1


class PoseSolutions(NamedTuple):
    """IK solutions of a pose.

    Attributes:
        rows: The solutions within the limits, shape (K, n). Of solutions that differ by full turns, all but the nearest
            to the present configuration come last.
        cause: The cause of rejection if there is no solution.
    """

    rows: Floats
    cause: Cause


class RegionRoots:
    """Configurations with the tool in one of several regions: all IK solutions of random poses.

    Args:
        regions: The regions in the world.
        names: Their names.
        solve: Returns the solutions of a pose ``T_world_tool`` of a region, by the index of the region.
        repair: Returns a configuration nearby that keeps the constraint and is still in the region, or None.
        shortfall: Describes how far the arm stays from a region, given its index and one of its poses.
    """

    def __init__(
        self,
        regions: Sequence[PoseSet],
        names: Sequence[str],
        solve: Callable[[int, Floats, np.random.Generator], PoseSolutions],
        repair: Callable[[int, Floats], Floats | None],
        shortfall: Callable[[int, Floats], str],
    ) -> None:
        self._shortfall = shortfall
        self._regions, self._names, self._solve, self._repair = list(regions), names, solve, repair
        self._weights = weights(self._regions)
        self._random = np.random.default_rng(0)
        self._ready: list[Floats] = []
        self._tally = Tally(names)
        self._drawn: list[tuple[Floats, int]] = []

    @property
    def tally(self) -> Tally:
        """Counts of samples by region and cause."""
        return self._tally

    def first(self, refuse: Refuse, random: np.random.Generator, *, enough: int) -> list[Floats]:
        """Restart with new random numbers, and return at least ``enough`` initial roots.

        They come from different poses. Each region is sampled once before any is sampled again.
        """
        self._random, self._tally, self._ready, self._drawn = random, Tally(self._names), [], []
        roots: list[Floats] = []
        order = random.permutation(len(self._regions)).tolist()
        for number in range(MOST_DRAWS):
            if len(roots) >= enough and number >= min(len(order), enough):
                break
            roots += self._draw(refuse, order[number] if number < len(order) else None)
        return roots

    def next(self, refuse: Refuse) -> Floats | None:
        """Return another IK solution of a random pose of a region; None if no solution of the pose is allowed."""
        if not self._ready:
            self._ready = self._draw(refuse)
        return self._ready.pop() if self._ready else None

    def region_of(self, root: Floats) -> int:
        """Return the index of the region that a root was sampled from; -1 if none."""
        same = [region for drawn, region in self._drawn if np.array_equal(drawn, root)]
        return same[0] if same else -1

    def _draw(self, refuse: Refuse, region: int | None = None) -> list[Floats]:
        """Sample a pose of a region (None: a random region); return its allowed IK solutions in random order."""
        if region is None:
            region = int(self._random.choice(len(self._regions), p=self._weights))
        pose = self._regions[region].sample(self._random, 1, over_rotations=True)[0]
        rows, cause = self._solve(region, pose, self._random)
        refusals: list[RefusedError] = []
        roots: list[Floats] = []
        for row in rows:
            self._test(region, row, refuse, roots, refusals)
        if not len(rows):
            refusals = [RefusedError(cause.value, cause=cause)]
            if cause is Cause.REACH and self._tally.shortfall is None:
                self._tally.shortfall = partial(self._shortfall, region, pose)
        self._tally.note(region, [] if roots else refusals)
        self._drawn += [(root, region) for root in roots]
        return [roots[index] for index in self._random.permutation(len(roots))]

    def _test(
        self, region: int, row: Floats, refuse: Refuse, roots: list[Floats], refusals: list[RefusedError]
    ) -> None:
        why = refuse(row)
        tried = sum(refusal.cause is Cause.CONSTRAINT for refusal in refusals)
        if why is not None and why.cause is Cause.CONSTRAINT and tried < _REPAIRS:
            repaired = self._repair(region, row)
            if repaired is not None and refuse(repaired) is None:
                row, why = repaired, None
        if why is None:
            roots.append(row)
        else:
            refusals.append(why)
