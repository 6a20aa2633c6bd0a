"""Motions as polynomial segments, by their Bézier control points."""

import math
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np

from ravemj.core.transforms import Floats, Ints


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

    def at(self, part: float) -> Floats:
        """Return the configuration at a fraction of the duration, shape (n,)."""
        return _bernstein(len(self.control), part) @ self.control


class Intervals(NamedTuple):
    """Polynomial segments of a motion, all of the same degree.

    Attributes:
        times: Start and end times [s], shape (m, 2).
        control: Bézier control points, shape (m, k, n).
    """

    times: Floats
    control: Floats

    @classmethod
    def of(cls, curves: Sequence[Curve]) -> Self:
        """Return curves as intervals, elevated to the highest of their degrees."""
        number = max(len(curve.control) for curve in curves)
        control = [_elevation(len(curve.control), number) @ curve.control for curve in curves]
        return cls(np.array([(curve.start, curve.end) for curve in curves]), np.array(control))

    def only(self, rows: slice | Ints) -> Self:
        """Return some of the intervals."""
        return type(self)(self.times[rows], self.control[rows])

    def with_others(self, others: Self) -> Self:
        """Return these intervals and others."""
        return type(self)(np.concatenate([self.times, others.times]), np.concatenate([self.control, others.control]))

    def boxes(self) -> tuple[Floats, Floats]:
        """Return the middle configuration of each interval, and the largest differences from it; shape (m, n) each."""
        middles = _middle(self.control.shape[1]) @ self.control
        return middles, np.abs(self.control - middles[:, None]).max(axis=1)

    def parts(self, numbers: Ints) -> tuple[Self, Ints]:
        """Divide each interval into ``numbers`` equal durations; return them, and the index of the interval of each."""
        times, control, origins = [self.times[:0]], [self.control[:0]], [np.zeros(0, dtype=int)]
        for number in np.unique(numbers).tolist():
            rows = np.flatnonzero(numbers == number)
            starts, finish = self.times[rows, 0], self.times[rows, 1]
            ends: list[Floats] = [*(starts + (finish - starts) * (part / number) for part in range(number)), finish]
            times.append(np.stack([ends[:-1], ends[1:]], axis=2).swapaxes(0, 1).reshape(-1, 2))
            divided = _subdivision(self.control.shape[1], number) @ self.control[rows, None]
            control.append(divided.reshape(-1, *self.control.shape[1:]))
            origins.append(np.repeat(rows, number))
        return type(self)(np.concatenate(times), np.concatenate(control)), np.concatenate(origins)


def configuration_at(curves: Sequence[Curve], time: float) -> Floats:
    """Return the configuration at a time [s] of a motion, shape (n,)."""
    curve = next(curve for curve in curves if time <= curve.end or curve is curves[-1])
    part = (time - curve.start) / (curve.end - curve.start) if curve.end > curve.start else 0.0
    return curve.at(min(max(part, 0.0), 1.0))


def line_curve(start: Floats, step: Floats) -> Curve:
    """Return a straight line as a curve with a duration of 1 s."""
    return Curve(0.0, 1.0, np.array([start, start + step]))


def path_curves(points: Floats, differences: Callable[[Floats, Floats], Floats]) -> list[Curve]:
    """Return a path of straight lines as curves with a duration of 1 s each."""
    return [
        Curve(float(number), number + 1.0, np.array([start, start + differences(end, start)]))
        for number, (start, end) in enumerate(pairwise(points))
    ]


def _bernstein(number: int, part: float) -> Floats:
    """Return the values of the ``number`` Bernstein polynomials at a fraction ``part`` of the duration."""
    powers = range(number)
    return np.array([math.comb(number - 1, k) * part**k * (1 - part) ** (number - 1 - k) for k in powers])


@cache
def _from_powers(number: int) -> Floats:
    """Return the matrix that converts the power coefficients of a curve to its Bézier control points."""
    rows = [[math.comb(row, power) / math.comb(number - 1, power) for power in range(number)] for row in range(number)]
    return np.array(rows)


def _weights(number: int, start: float, end: float) -> Floats:
    """Return the matrix from the control points of a curve to those of its part from ``start`` to ``end`` (blossom)."""
    matrix = np.zeros((number, number))
    for row in range(number):
        polynomial = np.ones(1)
        for factor in [end] * row + [start] * (number - 1 - row):
            polynomial = np.convolve(polynomial, [1 - factor, factor])
        matrix[row] = polynomial
    return matrix


@cache
def _subdivision(number: int, parts: int) -> Floats:
    """Return the matrices from a curve's control points to those of equal parts, shape (parts, number, number)."""
    return np.array([_weights(number, part / parts, (part + 1) / parts) for part in range(parts)])


@cache
def _middle(number: int) -> Floats:
    return _bernstein(number, 0.5)


@cache
def _elevation(number: int, larger: int) -> Floats:
    """Return the matrix that elevates the degree of a curve from ``number`` to ``larger`` control points."""
    matrix = np.eye(number)
    for count in range(number, larger):
        shares = np.arange(count + 1)[:, None] / count
        before, after = np.pad(matrix, ((1, 0), (0, 0))), np.pad(matrix, ((0, 1), (0, 0)))
        matrix = shares * before + (1 - shares) * after
    return matrix
