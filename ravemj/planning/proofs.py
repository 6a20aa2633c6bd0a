"""Proofs that a motion is free of collisions at all times, not only at tested ones.

A motion is divided into intervals. An interval is proven for a pair of shapes if their distance in its middle exceeds
their possible approach towards its ends; otherwise it is subdivided (adaptive collision checking: Schwarzer, Saha and
Latombe, IEEE T-RO 21(3), 2005).
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from typing import NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ravemj.core.transforms import Floats, Ints

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
_REFINEMENTS, _REFINED, _CUTS = 4, 8, 2  # rounds for the smallest gap, intervals that are cut in each, their parts
_TOLERANCE, _PART = 1e-3, 0.05  # m, and relative to it: how much too small it may be
_FAR = 1e9  # m
_NOTHING = 1e-12  # m


class Curve(NamedTuple):
    """Polynomial segment of a motion.

    Attributes:
        start: Start time [s].
        end: End time [s].
        control: Bézier control points, shape (k, n): the configurations of the segment are in their convex hull.
    """

    start: float
    end: float
    control: Floats

    @classmethod
    def of_powers(cls, start: float, end: float, coefficients: Floats) -> Self:
        """Return the segment that is a polynomial in (time - start) / (end - start); the lowest power comes first."""
        return cls(start, end, _from_powers(len(coefficients)) @ coefficients)

    def split(self, part: float) -> tuple[Self, Self]:
        """Split the segment at a fraction of its duration."""
        between, number = self.start + part * (self.end - self.start), len(self.control)
        first, second = _weights(number, 0.0, part), _weights(number, part, 1.0)
        head = self._replace(end=between, control=first @ self.control)
        return head, self._replace(start=between, control=second @ self.control)

    def parts(self, number: int) -> list[Self]:
        """Divide the segment into equal durations."""
        start, end, kind = self.start, self.end, type(self)
        times = [start + (end - start) * part / number for part in range(number)] + [end]
        return list(map(kind, times, times[1:], _subdivision(len(self.control), number) @ self.control))

    def at(self, part: float) -> Floats:
        """Return the configuration at a fraction of the duration, shape (n,)."""
        return _bernstein(len(self.control), part) @ self.control


def _bernstein(number: int, part: float) -> Floats:
    """Return the Bernstein polynomials of the control points at a fraction of the duration."""
    powers = range(number)
    return np.array([math.comb(number - 1, k) * part**k * (1 - part) ** (number - 1 - k) for k in powers])


@cache
def _from_powers(number: int) -> Floats:
    """Return the matrix that converts power coefficients to control points."""
    rows = [[math.comb(row, power) / math.comb(number - 1, power) for power in range(number)] for row in range(number)]
    return np.array(rows)


def _weights(number: int, start: float, end: float) -> Floats:
    """Return the matrix from the control points of a curve to those of its part ``start`` to ``end`` (blossom)."""
    matrix = np.zeros((number, number))
    for row in range(number):
        polynomial = np.ones(1)
        for factor in [end] * row + [start] * (number - 1 - row):
            polynomial = np.convolve(polynomial, [1 - factor, factor])
        matrix[row] = polynomial
    return matrix


@cache
def _subdivision(number: int, parts: int) -> Floats:
    """Return the matrices of ``_weights`` for equal parts, shape (parts, number, number)."""
    return np.array([_weights(number, part / parts, (part + 1) / parts) for part in range(parts)])


@cache
def _middle(number: int) -> Floats:
    return _bernstein(number, 0.5)


class PairTests(Protocol):
    """Test results of k pairs of shapes in m configurations, shape (m, k); see ``engine.collision.clearances``."""

    @property
    def pairs(self) -> Ints:
        """Indices of the pairs that were tested in at least one configuration, shape (k,)."""
        ...

    @property
    def is_open(self) -> Bools:
        """Whether contact is possible."""
        ...

    @property
    def travel(self) -> Floats:
        """Maximum relative travel [m]."""
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

    def test(self, middles: Floats, spreads: Floats, asked: Bools, apart: float = 0.0) -> PairTests:
        """Test whether pairs in the mask ``asked`` may come within ``apart`` [m] in boxes ``middles`` ± ``spreads``.

        Args:
            middles: Configurations, shape (m, n).
            spreads: Maximum differences from the configurations, shape (m, n).
            asked: Mask of pairs to test for each configuration, shape (m, pair_count).
            apart: Distance [m].
        """
        ...


class Span(NamedTuple):
    """Time span with a pair of shapes.

    Attributes:
        start: Start time [s].
        end: End time [s].
        pair: The index of the pair.
    """

    start: float
    end: float
    pair: int


class _Proved(NamedTuple):
    """Proven interval of a motion: its least lower bound of a distance [m], its pairs, and their lower bounds [m]."""

    least: float
    curve: Curve
    pairs: Ints
    bounds: Floats


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
    """Return whether a motion is proven free of collisions, except for pairs on their exempt spans."""
    return not any(isinstance(result, Span) for result in _examined(spaces, _asked(spaces, curves, exempt)))


def prove(spaces: Spaces, curves: Sequence[Curve], exempt: Sequence[Span] = (), *, whole: bool = True) -> Proof:
    """Prove as much of a motion as possible; pairs are ignored on their spans in ``exempt``.

    Unless ``whole``, the first undecided span ends the proof.
    """
    proof, proved = Proof(), list[_Proved]()
    for result in _examined(spaces, _asked(spaces, curves, exempt), proof):
        if isinstance(result, Span):
            proof.undecided.append(result)
            if not whole:
                return proof
        else:
            proved.append(result)
    proof.undecided = _joined(proof.undecided)
    _find_smallest_gap(spaces, proved, proof)
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
        asked = np.zeros((len(some), spaces.pair_count), dtype=bool)
        asked[:, pairs] = True
        tested = spaces.test(some, np.zeros_like(some), asked, 2 * APART)
        near = np.where(np.isfinite(tested.measured), tested.measured, tested.gaps)
        table[first : first + len(some)] = near[:, np.searchsorted(tested.pairs, pairs)]
    return table


def _times_apart(spaces: Spaces, curves: Sequence[Curve], pairs: Ints, *, is_start: bool) -> list[float]:
    """Return for each pair the time [s] nearest to start or end at which its distance reaches ``APART``."""
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


def configuration_at(curves: Sequence[Curve], time: float) -> Floats:
    """Return the configuration at a time [s] of a motion, shape (n,)."""
    curve = next(curve for curve in curves if time <= curve.end or curve is curves[-1])
    part = (time - curve.start) / (curve.end - curve.start) if curve.end > curve.start else 0.0
    return curve.at(min(max(part, 0.0), 1.0))


def _asked(spaces: Spaces, curves: Sequence[Curve], exempt: Sequence[Span]) -> list[tuple[Curve, Bools]]:
    """Return the segments of a motion, divided where exempt spans start or end, each with the mask of pairs to test."""
    cuts = sorted({time for span in exempt for time in (span.start, span.end)})
    asked: list[tuple[Curve, Bools]] = []
    for curve in curves:
        rest = curve
        for time in cuts:
            if rest.start < time < rest.end:
                piece, rest = rest.split((time - rest.start) / (rest.end - rest.start))
                asked.append((piece._replace(end=time), _without(spaces, piece, exempt)))
                rest = rest._replace(start=time)
        asked.append((rest, _without(spaces, rest, exempt)))
    return asked


def _without(spaces: Spaces, curve: Curve, exempt: Sequence[Span]) -> Bools:
    asked = np.ones(spaces.pair_count, dtype=bool)
    asked[[span.pair for span in exempt if span.start <= curve.start and curve.end <= span.end]] = False
    return asked


def _examined(
    spaces: Spaces, pending: list[tuple[Curve, Bools]], proof: Proof | None = None
) -> Iterator[Span | _Proved]:
    """Test intervals, and subdivide those without proof; yield proven intervals and undecided spans."""
    while pending:
        batch, pending = pending[: spaces.most], pending[spaces.most :]
        curves, asked = [curve for curve, _ in batch], np.array([asked for _, asked in batch])
        tested = spaces.test(*_reach(curves), asked)
        counted = spaces.counted[tested.pairs]
        if proof is not None:
            _note_nearest(proof, tested, curves, counted)
        free = asked[:, tested.pairs] & ~tested.is_open & counted
        bounds = np.where(free, tested.gaps - tested.travel, np.inf)
        least = bounds.min(axis=1, initial=np.inf).tolist()
        shortest = np.where(tested.measured <= 0, _SHORTEST_IN_CONTACT, _SHORTEST)
        lost = tested.is_open & (tested.travel < shortest)
        open_still = tested.is_open & ~lost
        rest = np.zeros(asked.shape, dtype=bool)
        rest[:, tested.pairs] = open_still
        shares = np.where(open_still, tested.travel / np.maximum(tested.gaps, _NOTHING), 0.0).max(axis=1, initial=0.0)
        lost_rows = set(np.flatnonzero(lost.any(axis=1)).tolist())
        numbers = np.ceil(np.clip(_RESERVE * shares, 2, _PARTS)).astype(int)
        for row, (curve, number) in enumerate(zip(curves, numbers.tolist(), strict=True)):
            yield _Proved(least[row], curve, tested.pairs, bounds[row])
            if row in lost_rows:
                yield from (Span(curve.start, curve.end, pair) for pair in tested.pairs[lost[row]].tolist())
            if shares[row] > 0:
                pending += [(part, rest[row]) for part in curve.parts(number)]


def _reach(curves: Sequence[Curve]) -> tuple[Floats, Floats]:
    """Return the middle of each segment, and the largest deviation of the segment from it; shape (m, n) each."""
    middles, spreads = np.empty((2, len(curves), curves[0].control.shape[1]))
    numbers = [len(curve.control) for curve in curves]
    for number in set(numbers):
        rows = [row for row, its in enumerate(numbers) if its == number]
        control = np.array([curves[row].control for row in rows])
        middles[rows] = at = _middle(number) @ control
        spreads[rows] = np.abs(control - at[:, None]).max(axis=1)
    return middles, spreads


def _note_nearest(proof: Proof, tested: PairTests, curves: Sequence[Curve], counted: Bools) -> None:
    if not counted.any():
        return
    measured = np.where(counted, tested.measured, np.inf)
    row, column = divmod(int(measured.argmin()), len(counted))
    if measured[row, column] < proof.nearest[0]:
        time = (curves[row].start + curves[row].end) / 2
        proof.nearest = float(measured[row, column]), time, int(tested.pairs[column])


def _find_smallest_gap(spaces: Spaces, proved: list[_Proved], proof: Proof) -> None:
    """Subdivide the intervals with the smallest bounds until the lower bound is close to the measured distance."""
    proved = [interval for interval in proved if interval.least < np.inf]
    for _ in range(_REFINEMENTS):
        wanted = proof.nearest[0] - max(_TOLERANCE, _PART * proof.nearest[0])
        proved.sort(key=lambda interval: interval.least)
        near = [interval for interval in proved[:_REFINED] if interval.least < wanted]
        if not near:
            break
        if np.isinf(wanted):  # nothing has been measured yet
            near, wanted = near[:1], _FAR
        parts = [interval._replace(curve=part) for interval in near for part in interval.curve.parts(_CUTS)]
        proved = [*proved[len(near) :], *_raised(spaces, parts, wanted, proof)]
    proof.smallest_gap = min([proof.nearest[0], *(interval.least for interval in proved)])


def _raised(spaces: Spaces, intervals: Sequence[_Proved], wanted: float, proof: Proof) -> list[_Proved]:
    """Return the intervals with better lower bounds for pairs whose bounds are below ``wanted`` [m]."""
    curves, known = [interval.curve for interval in intervals], np.full((len(intervals), spaces.pair_count), np.inf)
    for row, interval in zip(known, intervals, strict=True):
        row[interval.pairs] = interval.bounds
    tested = spaces.test(*_reach(curves), known < wanted, wanted)
    _note_nearest(proof, tested, curves, spaces.counted[tested.pairs])
    bounds = known[:, tested.pairs]
    known[:, tested.pairs] = np.where(bounds < wanted, np.maximum(bounds, tested.gaps - tested.travel), bounds)
    every = np.arange(spaces.pair_count)
    return [_Proved(float(row.min()), curve, every, row) for curve, row in zip(curves, known, strict=True)]


def _joined(spans: list[Span]) -> list[Span]:
    """Merge consecutive spans of one pair; return all in the order of time."""
    joined: list[Span] = []
    for span in sorted(spans, key=lambda span: (span.pair, span.start)):
        if joined and joined[-1].pair == span.pair and span.start <= joined[-1].end + 1e-9:
            joined[-1] = joined[-1]._replace(end=max(joined[-1].end, span.end))
        else:
            joined.append(span)
    return sorted(joined)


def line_curve(start: Floats, step: Floats) -> Curve:
    """Return a straight line as a curve with a duration of 1 s."""
    return Curve(0.0, 1.0, np.array([start, start + step]))


def path_curves(points: Floats, differences: Callable[[Floats, Floats], Floats]) -> list[Curve]:
    """Return a path of straight lines as curves with a duration of 1 s each."""
    return [
        Curve(float(number), number + 1.0, np.array([start, start + differences(end, start)]))
        for number, (start, end) in enumerate(pairwise(points))
    ]
