"""Two equations in the values of two joints, after elimination of the middle one of three joints.

Three joints in series must carry a point or a plane from a start to a goal: F1 F2 F3 s = g. F2 has two invariants,
which must be equal for F3 s and F1⁻¹ g. Each side depends on one joint only, linearly in the cosine and sine of a
revolute one and as a polynomial of degree two in the value of a prismatic one. If axes are parallel, intersect, or are
perpendicular, an equation has only one unknown, and all equations are linear or quadratic; otherwise the result is a
quartic (D. L. Pieper, 1968; subproblems 5 and 6 of IK-Geo).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ravemj.ik.subproblems import normalized, solve_linear, solve_parabola, solve_quadratic
from ravemj.ik.vectors import Floats, Screw, dot, tile

NEGLIGIBLE = 1e-9
"""Relative size; a coefficient smaller than this in all examples is zero by the arm's geometry."""


class Side(NamedTuple):
    """Both invariants on one side of the equations: constant + factors · (cos, sin) or factors · (value, value²).

    Attributes:
        constant: Constants of both equations, shape (2, B, N).
        factors: Two factors of each equation, shape (2, 2, B, N).
    """

    constant: Floats
    factors: Floats


@dataclass(frozen=True)
class Measure:
    """Invariants of the middle joint for a point, or for a plane given by its normal and an offset.

    Attributes:
        first: The first invariant is the dot product of this vector with the point or normal, shape (3, B, N).
        second: Vector whose dot product is the second invariant; if ``sphere``, the point from which distances are
            measured.
        sphere: Whether the second invariant is a squared distance.
    """

    first: Floats
    second: Floats
    sphere: bool

    def side(self, joint: Screw, point: Floats, sign: float) -> Side:
        """Return the invariants of points moved by a joint, or moved backwards if ``sign`` is -1.

        To move normals instead of points, pass a joint whose axis goes through the origin.
        """
        if joint.prismatic:
            return self._sliding(joint, point, sign)
        arm = point - joint.point
        along, across, later = joint.split(arm)
        still = along + joint.point
        rows = [dot(self.first, still)], [[dot(self.first, across), sign * dot(self.first, later)]]
        if self.sphere:
            away = joint.point - self.second
            distance = dot(arm, arm) + dot(away, away) + 2 * dot(away, along)
            rows[0].append(distance)
            rows[1].append([2 * dot(away, across), 2 * sign * dot(away, later)])
        else:
            rows[0].append(dot(self.second, still))
            rows[1].append([dot(self.second, across), sign * dot(self.second, later)])
        return _side(*rows)

    def _sliding(self, joint: Screw, point: Floats, sign: float) -> Side:
        constants = [dot(self.first, point)]
        factors = [[sign * dot(self.first, joint.axis), np.zeros((1, 1))]]
        if self.sphere:
            away = point - self.second
            constants.append(dot(away, away))
            factors.append([2 * sign * dot(away, joint.axis), np.ones((1, 1))])
        else:
            constants.append(dot(self.second, point))
            factors.append([sign * dot(self.second, joint.axis), np.zeros((1, 1))])
        return _side(constants, factors)


def _side(constants: list[Floats], factors: list[list[Floats]]) -> Side:
    shape = np.broadcast_shapes(
        *(array.shape for array in constants), *(array.shape for row in factors for array in row)
    )
    constant, factor = np.empty((2, *shape)), np.empty((2, 2, *shape))
    for row in range(2):
        constant[row] = constants[row]
        factor[row, 0], factor[row, 1] = factors[row]
    return Side(constant, factor)


@dataclass(frozen=True)
class Pair:
    """Solution method of two equations in two joints, detected from examples by ``Pair.detect``.

    Attributes:
        sliding: Whether the joints of the two sides are prismatic.
        alone: Indices of a side and of an equation in which only the joint of this side appears; None if both joints
            appear in both equations.
        sphere: Whether the second equation is of degree two in the value of a prismatic joint.
        branches: The number of solutions.
    """

    sliding: tuple[bool, bool]
    alone: tuple[int, int] | None
    sphere: bool

    @classmethod
    def detect(cls, sides: tuple[Side, Side], sliding: tuple[bool, bool], *, sphere: bool) -> "Pair | None":
        """Return the solution method for example equations; None if a joint or an equation has no terms."""
        sizes = np.array([np.abs(side.factors).max(axis=(1, 2, 3)) for side in sides])  # side, equation
        present = sizes > NEGLIGIBLE * np.maximum(sizes.max(axis=0), sizes.max(axis=0).max() * 1e-3)
        if not present.any(axis=1).all() or not present.any(axis=0).all():
            return None
        for equation in range(2):
            for side in range(2):
                if not present[1 - side, equation]:
                    return cls(sliding, (side, equation), sphere) if present[1 - side, 1 - equation] else None
        return cls(sliding, None, sphere)

    @property
    def choices(self) -> tuple[int, int]:
        """Number of solutions of the side solved first, and of the other side."""
        if self.alone is None:
            return (2 if all(self.sliding) else 4), 1
        side, equation = self.alone
        return self._degree(side, equation), self._degree(1 - side, 1 - equation)

    @property
    def branches(self) -> int:
        """Number of solutions."""
        return self.choices[0] * self.choices[1]

    def _degree(self, side: int, equation: int) -> int:
        return 1 if self.sliding[side] and not (self.sphere and equation == 1) else 2

    def solve(self, one: Side, three: Side) -> tuple[Floats, Floats]:
        """Return the values of the first and the third joint, with all branches: cosine and sine, or distances."""
        factors = (one.factors, -three.factors)
        rest = three.constant - one.constant
        if self.alone is not None:
            return self._one_by_one(factors, rest, *self.alone)
        if all(self.sliding):
            return self._both_sliding(factors, rest)
        slider = 1 if self.sliding[1] else 0
        if any(self.sliding):
            return _in_order(slider, *self._slider_and_turn(factors[slider], factors[1 - slider], rest))
        turn, other = self._two_turns(factors[0], factors[1], rest)
        return turn, other

    def _one_by_one(
        self, factors: tuple[Floats, Floats], rest: Floats, side: int, equation: int
    ) -> tuple[Floats, Floats]:
        """Solve ``equation``, in which only the joint ``side`` is unknown, then the other equation for the other joint.

        ``rest`` are the right-hand sides.
        """
        first = self._single(side, equation, factors[side][equation], rest[equation])
        known = factors[side][1 - equation]
        left = rest[1 - equation] - (known[0] * first[0] + known[1] * (first[1] if len(first) > 1 else first[0] ** 2))
        second = self._single(1 - side, 1 - equation, factors[1 - side][1 - equation], left)
        return _in_order(side, tile(first, second.shape[-2]), second)

    def _single(self, side: int, equation: int, factors: Floats, rest: Floats) -> Floats:
        if not self.sliding[side]:
            return solve_linear(factors[0], factors[1], rest)
        if self._degree(side, equation) == 1:
            return (rest / _safe(factors[0]))[None]
        return solve_parabola(factors[0], factors[1], rest)

    def _both_sliding(self, factors: tuple[Floats, Floats], rest: Floats) -> tuple[Floats, Floats]:
        """Solve for two prismatic joints: the first equation is linear, and eliminates one of the two values."""
        slope, start = -factors[1][0, 0] / factors[0][0, 0], rest[0] / factors[0][0, 0]
        (a1, b1), (a3, b3) = factors[0][1], factors[1][1]
        linear, square = a3 + a1 * slope + 2 * b1 * start * slope, b3 + b1 * slope * slope
        left = rest[1] - a1 * start - b1 * start * start
        other = solve_parabola(linear, square, left) if self.sphere else (left / linear)[None]
        return tile(start, other.shape[-2]) + slope * other, other

    def _slider_and_turn(self, slider: Floats, turn: Floats, rest: Floats) -> tuple[Floats, Floats]:
        """Solve for a prismatic and a revolute joint: the first equation, linear in the distance, eliminates it."""
        start, slope = rest[0] / slider[0, 0], -turn[0] / slider[0, 0]
        a, b = slider[1]
        k = a * start + b * start * start - rest[1]
        linear = turn[1] + (a + 2 * b * start) * slope
        square = np.array([b * slope[0] ** 2, b * slope[0] * slope[1], b * slope[1] ** 2])
        turns = solve_quadratic(k, linear, square)
        distance = tile(start, turns.shape[-2]) + tile(slope[0], turns.shape[-2]) * turns[0]
        return (distance + tile(slope[1], turns.shape[-2]) * turns[1])[None], turns

    def _two_turns(self, one: Floats, three: Floats, rest: Floats) -> tuple[Floats, Floats]:
        """Solve A x + C y = rest for unit vectors; eliminating x leaves |adj(A) (rest - C y)|² = det(A)²."""
        adjugate = np.array([np.array([one[1, 1], -one[0, 1]]), np.array([-one[1, 0], one[0, 0]])])
        determinant = one[0, 0] * one[1, 1] - one[0, 1] * one[1, 0]
        scale = np.abs(one).max(axis=(0, 1))
        adjugate, determinant = adjugate / _safe(scale), determinant / _safe(scale)
        m = [row[0] * rest[0] + row[1] * rest[1] for row in adjugate]
        c = [[row[0] * three[0, j] + row[1] * three[1, j] for j in range(2)] for row in adjugate]
        k = m[0] * m[0] + m[1] * m[1] - determinant * determinant
        linear = np.array([-2 * (m[0] * c[0][j] + m[1] * c[1][j]) for j in range(2)])
        square = np.array([c[0][i] * c[0][j] + c[1][i] * c[1][j] for i, j in ((0, 0), (0, 1), (1, 1))])
        turns = solve_quadratic(k, linear, square)
        sign = np.where(determinant < 0, -1.0, 1.0)
        values = [
            tile(sign * m[i], turns.shape[-2])
            - tile(sign * c[i][0], turns.shape[-2]) * turns[0]
            - tile(sign * c[i][1], turns.shape[-2]) * turns[1]
            for i in range(2)
        ]
        return normalized(np.stack(values)), turns


def _in_order(side: int, first: Floats, second: Floats) -> tuple[Floats, Floats]:
    return (first, second) if side == 0 else (second, first)


def _safe(divisor: Floats) -> Floats:
    return np.where(divisor == 0, 1.0, divisor)
