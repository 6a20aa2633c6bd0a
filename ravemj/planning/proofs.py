"""Proofs that a motion is free of collisions at all times, not only at tested ones.

A motion is divided into intervals. An interval is proven for a pair of shapes if their distance in its middle exceeds
their possible approach towards its ends; otherwise it is subdivided (adaptive collision checking: Schwarzer, Saha and
Latombe, IEEE T-RO 21(3), 2005).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints
from ravemj.planning.curves import Curve, Intervals, configuration_at

Bools = NDArray[np.bool_]

TOUCHING = 1e-4
"""Maximum distance and depth [m] of shapes at the start or goal that touch by intention, as a box on a table."""

APART = 2e-3
"""Distance [m] from which shapes that touch by intention are tested like all others."""

_SHORTEST = 1e-4  # m, of the travel on an interval that is not cut
_SHORTEST_IN_CONTACT = 5e-3  # m, of the travel on an interval in whose middle shapes touch
_PARTS = 8  # of an interval, at most
_RESERVE = 1.1  # intervals are cut so much finer than gaps in their middles ask for
_SEARCH = 200  # steps, for the time at which shapes are apart
_REFINEMENTS, _REFINED, _CUTS = 3, 16, 3  # rounds for the smallest gap, intervals that are cut in each, their parts
_TOLERANCE, _PART = 1e-3, 0.05  # m, and relative to it: how much too small it may be
_FAR = 1e9  # m
_NOTHING = 1e-12  # m


class PairTests(Protocol):
    """Test results of pairs of shapes in boxes of configurations, shape (k,); see ``engine.collision.clearances``."""

    @property
    def is_open(self) -> Bools:
        """Whether contact is possible."""
        ...

    @property
    def travel(self) -> Floats:
        """Maximum travel of the shapes relative to each other, from the middle of the box to its boundary [m]."""
        ...

    @property
    def gaps(self) -> Floats:
        """Lower bounds of the distances [m]."""
        ...

    @property
    def measured(self) -> Floats:
        """Distances [m]; infinite if not measured."""
        ...


class Spaces(Protocol):
    """Clearance between moving shapes."""

    @property
    def most(self) -> int:
        """Maximum number of configurations per call."""
        ...

    @property
    def pair_count(self) -> int:
        """The number of pairs of shapes."""
        ...

    @property
    def counted(self) -> Bools:
        """Whether each pair contributes to the smallest gap, shape (pair_count,)."""
        ...

    def test(self, middles: Floats, spreads: Floats, cases: "Cases", apart: float = 0.0) -> PairTests:
        """Test whether pairs may come within ``apart`` [m] in boxes ``middles`` ± ``spreads``, shape (m, n)."""
        ...


class Span(NamedTuple):
    """Time span in which a pair of shapes is not proven free of collisions, or is exempt from the proof.

    Attributes:
        start: Start time [s].
        end: End time [s].
        pair: The index of the pair.
    """

    start: float
    end: float
    pair: int


class Cases(NamedTuple):
    """Tests of a proof, ordered by interval: each is for one interval and one pair of shapes.

    Attributes:
        rows: Indices of the intervals, shape (k,).
        pairs: Indices of the pairs, shape (k,).
    """

    rows: Ints
    pairs: Ints

    def of_rows(self, start: int, end: int | None = None) -> "Cases":
        """Return the tests of the intervals from ``start`` to ``end``; ``rows`` then counts from 0 at ``start``."""
        first, last = np.searchsorted(self.rows, (start, len(self.rows) + start if end is None else end)).tolist()
        return Cases(self.rows[first:last] - start, self.pairs[first:last])


class _Examined(NamedTuple):
    """Test results of intervals: proven lower bounds of pair distances [m], and undecided spans."""

    intervals: Intervals
    cases: Cases
    tested: PairTests
    bounds: Floats  # shape (k,); infinite for other pairs
    undecided: list[Span]


class _Proved(NamedTuple):
    """Interval of a motion without collisions: lower bounds of the distances of pairs [m], and their minimum."""

    least: float
    times: Floats
    control: Floats
    bounds: Floats
    pairs: Ints


@dataclass
class Proof:
    """Result of a proof.

    Attributes:
        undecided: Spans of pairs without proof.
        smallest_gap: Lower bound of the distances of counted pairs in proven intervals [m]; infinite without any.
        nearest: The smallest measured distance of counted pairs [m], its time [s] and its pair.
    """

    undecided: list[Span] = field(default_factory=lambda: [])
    smallest_gap: float = math.inf
    nearest: tuple[float, float, int] = (math.inf, 0.0, -1)


def is_proved(spaces: Spaces, curves: Sequence[Curve], exempt: Sequence[Span] = ()) -> bool:
    """Return whether a motion is proven free of collisions, except for the pairs and times in ``exempt``."""
    return not any(examined.undecided for examined in _examined(spaces, *_asked(spaces, curves, exempt)))


def prove(spaces: Spaces, curves: Sequence[Curve], exempt: Sequence[Span] = (), *, whole: bool = True) -> Proof:
    """Prove for as much of a motion as possible that no pair of shapes touches, except on the spans ``exempt``.

    Unless ``whole``, the first undecided span ends the proof.
    """
    proof, every = Proof(), list[_Examined]()
    for examined in _examined(spaces, *_asked(spaces, curves, exempt)):
        _note_nearest(proof, spaces, examined.intervals, examined.cases, examined.tested)
        every.append(examined)
        proof.undecided += examined.undecided
        if proof.undecided and not whole:
            return proof
    proof.undecided = _joined(proof.undecided)
    _find_smallest_gap(spaces, every, proof)
    return proof


def exempt_spans(spaces: Spaces, curves: Sequence[Curve], touching: Ints) -> list[Span]:
    """Return the spans next to both ends of a motion on which pairs that touch there are ignored.

    Args:
        spaces: The clearance between shapes.
        curves: The motion.
        touching: The pairs that touch at the start or goal.
    """
    spans: list[Span] = []
    if not len(touching):
        return spans
    ends: list[Floats] = [curves[0].control[0], curves[-1].control[-1]]
    for is_start, near in zip((True, False), distances(spaces, ends, touching), strict=True):
        close = touching[near < APART]
        for pair, time in zip(close.tolist(), _times_apart(spaces, curves, close, is_start=is_start), strict=True):
            start, end = (curves[0].start, time) if is_start else (time, curves[-1].end)
            spans.append(Span(start, end, pair))
    return spans


def distances(spaces: Spaces, configurations: Sequence[Floats], pairs: Ints) -> Floats:
    """Return the distances of ``pairs`` [m], shape (configurations, pairs); large distances may be underestimated."""
    table = np.zeros((len(configurations), len(pairs)))
    for first in range(0, len(configurations), spaces.most):
        some = np.array(configurations[first : first + spaces.most])
        cases = Cases(np.repeat(np.arange(len(some)), len(pairs)), np.tile(pairs, len(some)))
        tested = spaces.test(some, np.zeros_like(some), cases, 2 * APART)
        near = np.where(np.isfinite(tested.measured), tested.measured, tested.gaps)
        table[first : first + len(some)] = near.reshape(len(some), -1)
    return table


def _times_apart(spaces: Spaces, curves: Sequence[Curve], pairs: Ints, *, is_start: bool) -> list[float]:
    """Return when each pair's distance first reaches ``APART`` [s], from the start on or from the end backwards."""
    begin, finish = curves[0].start, curves[-1].end
    times = np.linspace(begin, finish, _SEARCH + 1) if is_start else np.linspace(finish, begin, _SEARCH + 1)
    times_apart, left = np.full(len(pairs), times[-1]), np.ones(len(pairs), dtype=bool)
    for time in times.tolist():
        if not left.any():
            break
        (far,) = distances(spaces, [configuration_at(curves, time)], pairs)
        reached = left & (far >= APART)
        times_apart[reached], left[reached] = time, False
    return times_apart.tolist()


def _asked(spaces: Spaces, curves: Sequence[Curve], exempt: Sequence[Span]) -> tuple[Intervals, Cases]:
    """Return the segments of a motion and the pairs to test in each.

    Segments are divided at both ends of each ``exempt`` span, in which its pair is not tested.
    """
    cuts = sorted({time for span in exempt for time in (span.start, span.end)})
    pieces: list[Curve] = []
    for curve in curves:
        rest = curve
        for time in cuts:
            if rest.start < time < rest.end:
                piece, rest = rest.split((time - rest.start) / (rest.end - rest.start))
                pieces.append(piece._replace(end=time))
                rest = rest._replace(start=time)
        pieces.append(rest)
    return Intervals.of(pieces), Cases(*np.nonzero([_without(spaces, piece, exempt) for piece in pieces]))


def _without(spaces: Spaces, curve: Curve, exempt: Sequence[Span]) -> Bools:
    asked = np.ones(spaces.pair_count, dtype=bool)
    asked[[span.pair for span in exempt if span.start <= curve.start and curve.end <= span.end]] = False
    return asked


def _examined(spaces: Spaces, intervals: Intervals, cases: Cases) -> Iterator[_Examined]:
    """Test intervals for collisions, and subdivide undecided ones until they are too short."""
    while len(intervals.times):
        some, rest = intervals.only(slice(spaces.most)), intervals.only(slice(spaces.most, None))
        now, later = cases.of_rows(0, spaces.most), cases.of_rows(spaces.most)
        tested = spaces.test(*some.boxes(), now)
        bounds = np.where(~tested.is_open & spaces.counted[now.pairs], tested.gaps - tested.travel, np.inf)
        shortest = np.where(tested.measured <= 0, _SHORTEST_IN_CONTACT, _SHORTEST)
        is_lost = tested.is_open & (tested.travel < shortest)
        yield _Examined(some, now, tested, bounds, _spans(some, now, np.flatnonzero(is_lost)))
        left = np.flatnonzero(tested.is_open & ~is_lost)
        parts, cases = _subdivided(some, now, left, tested.travel[left] / np.maximum(tested.gaps[left], _NOTHING))
        intervals, rows = rest.with_others(parts), cases.rows + len(rest.times)
        cases = Cases(np.concatenate([later.rows, rows]), np.concatenate([later.pairs, cases.pairs]))


def _subdivided(intervals: Intervals, cases: Cases, left: Ints, shares: Floats) -> tuple[Intervals, Cases]:
    """Subdivide the intervals of the undecided tests.

    Args:
        intervals: The intervals.
        cases: Tests, each of an interval and a pair of shapes.
        left: Indices of the undecided tests.
        shares: Travel of each undecided pair during its interval, as a multiple of the gap between its geoms.
    """
    largest = np.zeros(len(intervals.times))
    np.maximum.at(largest, cases.rows[left], shares)
    rows = np.flatnonzero(largest)
    parts, origins = intervals.only(rows).parts(np.ceil(np.clip(_RESERVE * largest[rows], 2, _PARTS)).astype(int))
    is_left = np.zeros((len(rows), int(cases.pairs[left].max(initial=-1)) + 1), dtype=bool)
    is_left[np.searchsorted(rows, cases.rows[left]), cases.pairs[left]] = True
    return parts, Cases(*np.nonzero(is_left[origins]))


def _spans(intervals: Intervals, cases: Cases, lost: Ints) -> list[Span]:
    times, pairs = intervals.times[cases.rows[lost]].tolist(), cases.pairs[lost].tolist()
    return [Span(start, end, pair) for (start, end), pair in zip(times, pairs, strict=True)]


def _note_nearest(proof: Proof, spaces: Spaces, intervals: Intervals, cases: Cases, tested: PairTests) -> None:
    measured = np.where(spaces.counted[cases.pairs], tested.measured, np.inf)
    nearest = int(measured.argmin()) if len(measured) else -1
    if nearest >= 0 and measured[nearest] < proof.nearest[0]:
        row, pair = int(cases.rows[nearest]), int(cases.pairs[nearest])
        proof.nearest = float(measured[nearest]), float(intervals.times[row].mean()), pair


def _find_smallest_gap(spaces: Spaces, every: Sequence[_Examined], proof: Proof) -> None:
    """Set ``proof.smallest_gap`` to a close lower bound of the smallest distance, by subdividing critical intervals."""
    proved, rest = _smallest(every)
    for _ in range(_REFINEMENTS):
        wanted = proof.nearest[0] - max(_TOLERANCE, _PART * proof.nearest[0])
        proved.sort(key=lambda interval: interval.least)
        near = [interval for interval in proved[:_REFINED] if interval.least < wanted]
        if not near:
            break
        if np.isinf(wanted):  # nothing has been measured yet
            near, wanted = near[:1], _FAR
        proved = [*proved[len(near) :], *_raised(spaces, near, wanted, proof)]
    proof.smallest_gap = min([proof.nearest[0], rest, *(interval.least for interval in proved)])


def _smallest(every: Sequence[_Examined]) -> tuple[list[_Proved], float]:
    """Return the intervals with the least bounds, which refinement may subdivide, and the least bound of the others."""
    most, proved = _REFINEMENTS * _REFINED, list[_Proved]()
    for (times, control), cases, _, bounds, _ in every:
        least = np.full(len(times), np.inf)
        np.minimum.at(least, cases.rows, bounds)
        for row in np.argsort(least)[: most + 1].tolist():
            its = slice(*np.searchsorted(cases.rows, (row, row + 1)).tolist())
            proved.append(_Proved(float(least[row]), times[row], control[row], bounds[its], cases.pairs[its]))
    proved = sorted((interval for interval in proved if interval.least < np.inf), key=lambda interval: interval.least)
    return proved[:most], proved[most].least if len(proved) > most else np.inf


def _raised(spaces: Spaces, near: Sequence[_Proved], wanted: float, proof: Proof) -> list[_Proved]:
    """Subdivide intervals; return the parts. Pairs whose lower bounds are below ``wanted`` [m] get new ones."""
    whole = Intervals(np.array([interval.times for interval in near]), np.array([each.control for each in near]))
    parts, origins = whole.parts(np.full(len(near), _CUTS))
    known = np.full((len(origins), spaces.pair_count), np.inf)
    for row, origin in enumerate(origins):
        interval = near[int(origin)]
        known[row, interval.pairs] = interval.bounds
    cases = Cases(*np.nonzero(known < wanted))
    tested = spaces.test(*parts.boxes(), cases, wanted)
    _note_nearest(proof, spaces, parts, cases, tested)
    known[cases] = np.maximum(known[cases], tested.gaps - tested.travel)
    pairs, least = np.arange(spaces.pair_count), known.min(axis=1).tolist()
    return [_Proved(*fields, pairs=pairs) for fields in zip(least, *parts, known, strict=True)]


def _joined(spans: list[Span]) -> list[Span]:
    """Merge adjacent or overlapping time spans of the same pair; return all spans in the order of time."""
    joined: list[Span] = []
    for span in sorted(spans, key=lambda span: (span.pair, span.start)):
        if joined and joined[-1].pair == span.pair and span.start <= joined[-1].end + 1e-9:
            joined[-1] = joined[-1]._replace(end=max(joined[-1].end, span.end))
        else:
            joined.append(span)
    return sorted(joined)
